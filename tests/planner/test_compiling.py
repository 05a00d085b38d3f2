import ast
import importlib
import subprocess
import sys
from typing import Any

import numpy as np
import pytest

from planner.belief import compiled_evidence, compiled_tables
from planner.compiling import COMPILED_IN, SOURCES, in_order, jit
from planner.kernels.compiled.rollout import rollouts
from planner.kernels.value.iteration import iterate
from planner.kernels.value.transitions import transitions
from planner.plan import warm_up
from planner.sources import PLANNER

ENTRY_POINT = """
from planner.compiling import entry

def entry_point(sources):
    @entry
    def successor(number):
        _ = sources
        return number + 1
    return successor
"""

FRESH_PROCESS = """
import sys
from planner.plan import warm_up
warm_up()
for unneeded in ("scipy.linalg", "cffi", "coverage", "yaml"):
    assert unneeded not in sys.modules, f"a first plan imports {unneeded}"

import numba
import numpy as np
identity = np.eye(2)
assert (numba.njit(lambda a: a @ a)(identity) == identity).all()
assert hasattr(sys.modules["scipy.linalg.cython_blas"], "__pyx_capi__"), "the stand-in for BLAS is still there"
import cffi, coverage, yaml
"""


def test_machine_code_is_kept_for_the_same_sources_only(tmp_path, monkeypatch):
    (tmp_path / "kernel_under_test.py").write_text(ENTRY_POINT)
    monkeypatch.syspath_prepend(tmp_path)
    module = importlib.import_module("kernel_under_test")
    hits = []
    for sources in (1, 1, 2):
        successor = module.entry_point(sources)
        assert successor(1) == 2
        hits.append(sum(successor.stats.cache_hits.values()))
    assert hits == [0, 1, 0]


EVIDENCE = ("_log_evidence", "_shared_out_over", "_evidence", "_node_evidence")


@pytest.mark.parametrize(
    "kernel",
    [
        rollouts,
        iterate,
        transitions,
        getattr(compiled_tables, "_tables"),  # noqa: B009 (private)
        *(getattr(compiled_evidence, name) for name in EVIDENCE),
    ],
)
def test_each_kept_kernel_closes_over_its_sources(kernel):
    """numba looks at no other file than the kernel's own, and at no globals: it would run the code of before."""
    assert [cell.cell_contents for cell in kernel.py_func.__closure__] == [SOURCES]


def test_all_that_is_compiled_in_is_among_the_sources():
    sources = {path for pattern in COMPILED_IN for path in PLANNER.glob(pattern)}
    imported = {
        node.module.replace(".", "/") + ".py"
        for path in PLANNER.glob("kernels/compiled/*.py")
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.ImportFrom) and node.module and node.module.startswith("planner.")
    }
    types_only = {"planner/types.py"}
    evidence = ast.walk(ast.parse((PLANNER / "belief/compiled_evidence.py").read_text(encoding="utf-8")))
    modules = (node.module for node in evidence if isinstance(node, ast.ImportFrom) and node.module)
    imported |= {module.replace(".", "/") + ".py" for module in modules if ".belief.compiled_" in module}
    assert "planner/belief/compiled_cell.py" in imported
    assert imported - types_only <= {path.relative_to(PLANNER.parent).as_posix() for path in sources}
    assert "planner/belief/grid.py" in imported


@pytest.mark.timeout(900)  # the kernel may have to be compiled first, on a busy machine
def test_a_first_plan_does_without_what_numba_only_looks_for_and_leaves_it_usable():
    warm_up()
    done = subprocess.run([sys.executable, "-c", FRESH_PROCESS], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def machine_code(compiled: Any) -> str:
    """As LLVM has it."""
    return next(iter(compiled.inspect_llvm().values()))


def test_code_that_keeps_its_order_does_so_within_code_that_does_not() -> None:
    @in_order
    def inner(a, b, c):
        return a * b + c

    @jit
    def outer(a, b, c):
        return inner(a, b, c) * c

    outer(*np.ones(3, dtype=np.float32))
    strict, fast = (machine_code(some) for some in (inner, outer))
    assert "fmul float" in strict
    assert "contract" not in strict
    assert "contract" in fast
