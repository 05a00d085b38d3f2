# pyright: standard
"""The fast twin of planner.on_the_way: what stretches of way say of one cell, for all biases of a source at once.

A stretch is looked up in its own table (compiled_way_tables.py). Bearings may ask for nodes of the bias far closer than
a beam of tens of degrees does: stretches, never sharper than a bearing, are weighed at every few of them, all together,
and the logarithm of what they say is linear between. How good that is stands in docs/truth.md.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from planner.belief.compiled_rows import (
    blended,
    blended_more,
    by_fours,
    by_twos,
    largest,
    mixed,
    ratios,
    rooted,
    shifted,
    times,
    times_each,
)
from planner.belief.compiled_way_tables import ACROSS, ALONG, COLUMNS, NEAREST, TURN, middle_of, table_of
from planner.belief.source_errors import EVEN_STEP, Nodes
from planner.compiling import allocating, in_order, jit
from planner.on_the_way import LEAST_INDEPENDENT, NEAR_M, Stretch, worth_of
from planner.types import FloatArray, IntArray

MOST_HALVINGS = 2
"""Of EVEN_STEP, down to FINEST_SPACING."""
RESCALED_EVERY = 16
"""Stretches: none multiplies by less than the rate of outliers, or by more than a bearing's peak."""


@jit
def halvings_of(spacing):
    """How often EVEN_STEP is halved to the `spacing` of the nodes, rad."""
    found = 0
    while spacing * 2.0 ** (found + 0.5) < EVEN_STEP:
        found += 1
    return found


@jit
def coarse_nodes(count, spacing):
    """How many of these steps hold `count` nodes, and one beyond."""
    return ((count - 1) >> halvings_of(spacing)) + 2


class Scratch(NamedTuple):
    """Of the n nodes at which stretches are weighed. coarse: (k e, n); found: (n,); root: (n - 1,). row: (n + 2,)
    columns of a table."""

    coarse: FloatArray
    found: NDArray[np.float32]
    root: NDArray[np.float32]
    row: NDArray[np.float32]


@allocating
def scratch_of(count, spacing, scales, rates):
    """For `count` nodes of the bias, `spacing` rad apart."""
    coarse = coarse_nodes(count, spacing)
    return Scratch(
        np.empty((scales * rates, coarse)),
        np.empty(coarse, dtype=np.float32),
        np.empty(coarse - 1, dtype=np.float32),
        np.empty(coarse + 2, dtype=np.float32),
    )


class OnTheWay(NamedTuple):
    """first: (k + 1,) where the places of each stretch's readings begin in read_x, read_y (n,), m. x, y: (k,) m, their
    middles; along: (2, k); reach: (k,) m, beyond which no place is near. table: (k, ...) as compiled_way_tables.Table.
    """

    first: IntArray
    read_x: FloatArray
    read_y: FloatArray
    x: FloatArray
    y: FloatArray
    along: FloatArray
    reach: FloatArray
    table: NDArray[np.float32]


def on_the_way(stretches: Sequence[Stretch], grid: Nodes) -> OnTheWay:
    """Of one source. Raises ValueError for nodes that are not `even`, or reach farther than a table: no kernel checks
    an index."""
    halvings = np.log2(EVEN_STEP / grid.spacing)
    if stretches and min(abs(halvings - whole) for whole in range(MOST_HALVINGS + 1)) > 1e-9:
        raise ValueError(f"stretches are weighed at even steps of the bias, not {grid.spacing} rad")
    if stretches and TURN + (len(grid.bias) - 1 >> round(halvings)) + 4 > COLUMNS:
        raise ValueError(f"stretches are not tabulated for {len(grid.bias)} nodes {grid.spacing} rad apart")
    scale = grid.scale
    kept = [one for one in stretches if worth_of(one) >= LEAST_INDEPENDENT]
    middles = [middle_of(one) for one in kept]
    table = np.empty((len(kept), ACROSS, ALONG, len(scale), COLUMNS), dtype=np.float32)
    for out, one in zip(table, kept, strict=True):
        out[:] = table_of(one, tuple(scale.tolist()))
    return OnTheWay(
        np.cumsum([0, *(len(one.x) for one in kept)], dtype=np.int64),
        np.array([v for one in kept for v in one.x]),
        np.array([v for one in kept for v in one.y]),
        np.array([one.x for one in middles]),
        np.array([one.y for one in middles]),
        np.ascontiguousarray(np.array([one.along for one in middles]).reshape(-1, 2).T),
        np.array([one.reach + NEAR_M for one in middles]),
        table,
    )


@jit
def _near(x, y, way, k):
    for i in range(way.first[k], way.first[k + 1]):
        if (x - way.read_x[i]) ** 2 + (y - way.read_y[i]) ** 2 < NEAR_M * NEAR_M:
            return True
    return False


@in_order
def _weigh(off_x, off_y, way, k, bias, rate, scratch):
    """Multiplies (1 - e) f / c + e of stretch k into the coarse nodes, `bias` the first of them, for the emitter at
    (off_x, off_y) m from its middle: f / c linear across the stretch, of second degree along it and between columns."""
    table, scaled = way.table[k], 0.5 / (NEAREST * max(off_x * off_x + off_y * off_y, 1.0))
    across = (way.along[0, k] * off_y - way.along[1, k] * off_x) * scaled + 0.5
    along = (way.along[0, k] * off_x + way.along[1, k] * off_y) * scaled + 0.5
    across = min(max(across, 0.0), 0.999999) * (ACROSS - 1)
    along = min(max(along, 0.0), 1.0) * (ALONG - 1)
    psi = (np.arctan2(off_y, off_x) + bias) / (2.0 * np.pi)
    psi = (psi - np.floor(psi)) * TURN
    a, b, first = int(across), min(max(int(along + 0.5), 1), ALONG - 2), min(int(psi + 0.5), TURN)
    right, end = np.float32(across - a), first + len(scratch.row)
    left = np.float32(1.0) - right
    behind, here, ahead = _of_three(np.float32(along - b))
    before, at, after = _of_three(np.float32(psi - first))
    scales, rates = table.shape[2], len(rate)
    for s in range(scales):
        near, far = table[a, b - 1 : b + 2, s, first:end], table[a + 1, b - 1 : b + 2, s, first:end]
        blended(scratch.row, near[0], near[1], near[2], left * behind, left * here, left * ahead)
        blended_more(scratch.row, far[0], far[1], far[2], right * behind, right * here, right * ahead)
        shifted(scratch.found, scratch.row, before, at, after)
        for e in range(rates):
            mixed(scratch.coarse[s * rates + e], scratch.found, 1.0 - rate[e], rate[e])


@in_order
def _of_three(t):
    """Weights of three neighbours for what lies t from the middle one: a parabola through them."""
    half, one = np.float32(0.5), np.float32(1.0)
    return half * t * (t - one), one - t * t, half * t * (t + one)


@jit
def _rescaled(table):
    """Divides by the largest of the table, and returns its logarithm."""
    top = 0.0
    for r in range(table.shape[0]):
        top = max(top, largest(table[r]))
    for r in range(table.shape[0]):
        times(table[r], 1.0 / top)
    return np.log(top)


@jit
def _spread_out(row, coarse, root, halvings):
    """A row (b,) times what stretches say at each node: coarse (n,) at every 2^halvings of them, its logarithm linear
    between. root: (n - 1,) scratch."""
    if halvings == 0:
        times_each(row, coarse)
        return
    ratios(root, coarse)
    rooted(root)
    if halvings == 1:
        by_twos(row, coarse, root)
    else:
        rooted(root)
        by_fours(row, coarse, root)


@jit
def weigh_stretches(x, y, way, bias, spacing, rate, scratch, table):
    """Multiplies (1 - e) f / c + e of every stretch into table (k e, b), for the emitter at (x, y), but for a factor
    whose logarithm is returned: hundreds of stretches leave the range of numbers."""
    coarse, weighed, log = scratch.coarse, 0, 0.0
    coarse[:] = 1.0
    for k in range(len(way.x)):
        off_x, off_y = x - way.x[k], y - way.y[k]
        if off_x * off_x + off_y * off_y < way.reach[k] * way.reach[k] and _near(x, y, way, k):
            continue
        _weigh(off_x, off_y, way, k, bias[0], rate, scratch)
        weighed += 1
        if weighed % RESCALED_EVERY == 0:
            log += _rescaled(coarse)
    for r in range(table.shape[0]):
        _spread_out(table[r], coarse[r], scratch.root, halvings_of(spacing))
    return log
