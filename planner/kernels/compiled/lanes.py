"""Whole blocks of cells at once, as LLVM vectors, and a float's bits: what numba's Python cannot say."""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba import extending, types

intrinsic: Any = extending.intrinsic  # whose callers leave out the typing context: no type says so
BLOCK = 16
"""Doubles in a block. Arrays of cells are longer by as many, because the last block of a row runs over its end."""


@intrinsic
def bits(typingctx, value):
    """The 64 bits of a float as an integer; for floats >= 0 both are ordered alike."""

    def codegen(context, builder, signature, arguments):
        return builder.bitcast(arguments[0], ir.IntType(64))

    return types.int64(types.float64), codegen


def _lanes(context, builder, array_type, array, index):
    """Pointer to BLOCK neighbouring doubles of an array, as one LLVM vector."""
    data = context.make_array(array_type)(context, builder, array).data
    return builder.bitcast(builder.gep(data, [index]), ir.VectorType(ir.DoubleType(), BLOCK).as_pointer())


@intrinsic
def store_ramp(typingctx, target, index, start, step):
    """target[index + i] = start + i * step for a whole block."""

    def codegen(context, builder, signature, arguments):
        lanes = ir.VectorType(ir.DoubleType(), BLOCK)
        spread = ir.Constant(ir.VectorType(ir.IntType(32), BLOCK), [0] * BLOCK)

        def everywhere(value):
            single = builder.insert_element(ir.Constant(lanes, ir.Undefined), value, ir.IntType(32)(0))
            return builder.shuffle_vector(single, ir.Constant(lanes, ir.Undefined), spread)

        counts = ir.Constant(lanes, [float(i) for i in range(BLOCK)])
        values = builder.fadd(everywhere(arguments[2]), builder.fmul(everywhere(arguments[3]), counts))
        builder.store(values, _lanes(context, builder, signature.args[0], arguments[0], arguments[1]), align=8)
        return context.get_dummy_value()

    return types.void(target, types.int64, types.float64, types.float64), codegen


@intrinsic
def copy_block(typingctx, target, index, source, begin):
    """target[index + i] = source[begin + i] for a whole block."""

    def codegen(context, builder, signature, arguments):
        values = builder.load(_lanes(context, builder, signature.args[2], arguments[2], arguments[3]), align=8)
        builder.store(values, _lanes(context, builder, signature.args[0], arguments[0], arguments[1]), align=8)
        return context.get_dummy_value()

    return types.void(target, types.int64, source, types.int64), codegen


@intrinsic
def copy_doubled_block(typingctx, target, index, source, begin):
    """target[index + i] = source[begin + i // 2] for a whole block."""

    def codegen(context, builder, signature, arguments):
        lanes = ir.VectorType(ir.DoubleType(), BLOCK)
        values = builder.load(_lanes(context, builder, signature.args[2], arguments[2], arguments[3]), align=8)
        twice = ir.Constant(ir.VectorType(ir.IntType(32), BLOCK), [i // 2 for i in range(BLOCK)])
        values = builder.shuffle_vector(values, ir.Constant(lanes, ir.Undefined), twice)
        builder.store(values, _lanes(context, builder, signature.args[0], arguments[0], arguments[1]), align=8)
        return context.get_dummy_value()

    return types.void(target, types.int64, source, types.int64), codegen
