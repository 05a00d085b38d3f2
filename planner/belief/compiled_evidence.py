# pyright: standard
"""The fast twin of evidence.py: the same sums, compiled by numba, without the GIL.

What makes it fast: densities are looked up in tables (compiled_tables.py), loops over the nodes become vector
instructions (compiled_rows.py), and a place touches only the nodes that some bearing reaches (compiled_cell.py).
"""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from planner.belief.compiled_cell import of_cell, reached, scratch, whole_of
from planner.belief.compiled_rows import added, added_beside, dot, times, total
from planner.belief.compiled_tables import Prepared, prepared
from planner.belief.evidence import Evidence, SharedOut, Sightings
from planner.belief.source_errors import Nodes
from planner.compiling import SOURCES, entry
from planner.on_the_way import Stretch
from planner.threads import in_parts
from planner.types import FloatArray

THREADS = 2
"""Among which the places are shared out. Sums over them are those of two parts, on every machine."""
WORTH_A_THREAD = 200
"""Places."""
MOST_KEPT = 20_000
"""Places of which is kept what they say of the errors, two kilobytes each. In forty beliefs of flights all rounds of
refinement together weighed 18,000 at most, and only the last round is asked for."""


class Weigher:
    """evidence.Weigher of a source that took these bearings and heard these stretches.

    Where stretches make a place dear, what it says of the errors is kept with it: sharing out those that were weighed
    last weighs none again.
    """

    def __init__(self, seen: Sightings, nodes: Nodes, stretches: Sequence[Stretch] = ()) -> None:
        self._nodes = nodes
        self._known = prepared(seen, nodes, nodes.weight, stretches)
        self._kept: _Kept | None = _Kept() if stretches else None

    def log(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """As there."""
        x, y = _plain(x), _plain(y)
        if self._kept is not None:
            return self._kept.keep(x, y, _told(x, y, self._known, THREADS)).log
        found = np.empty(len(x))

        def work(part: slice) -> None:
            _log_evidence(x[part], y[part], self._known, found[part])

        in_parts(len(x), min(THREADS, len(x) // WORTH_A_THREAD), work)
        return found

    def shared_out(self, x: FloatArray, y: FloatArray, mass: FloatArray) -> SharedOut:
        """As there."""
        x, y, mass = _plain(x), _plain(y), _plain(mass)
        if self._kept is not None:
            told = self._kept.of(x, y) or _told(x, y, self._known, THREADS)
            return SharedOut(mass @ told.bias, mass @ told.scale, mass @ told.rate, told.bias @ self._nodes.bias)
        of_part, mean = dict[int, FloatArray](), np.empty(len(x))

        def work(part: slice) -> None:
            found = of_part[part.start] = np.zeros_like(self._known.prior)
            _shared_out_over(x[part], y[part], mass[part], self._known, found, mean[part])

        in_parts(len(x), min(THREADS, len(x) // WORTH_A_THREAD), work)
        table = np.sum([of_part[start] for start in sorted(of_part)], axis=0).reshape(self._nodes.weight.shape)
        return SharedOut(table.sum(axis=(0, 1)), table.sum(axis=(1, 2)), table.sum(axis=(0, 2)), mean)


class _Call(NamedTuple):
    """place: (c,) x + i y, m."""

    place: NDArray[np.complex128]
    told: Evidence


class _Kept:
    """What was told of the places that were weighed last."""

    def __init__(self) -> None:
        self._calls = deque[_Call]()

    def keep(self, x: FloatArray, y: FloatArray, told: Evidence) -> Evidence:
        """x, y (c,) m. Returns `told`."""
        self._calls.append(_Call(x + 1j * y, told))
        while sum(len(one.place) for one in self._calls) > MOST_KEPT:
            self._calls.popleft()
        return told

    def of(self, x: FloatArray, y: FloatArray) -> Evidence | None:
        """Of the places (c,) x, y; None where one of them is not kept."""
        if not self._calls:
            return None
        kept, wanted = np.concatenate([call.place for call in self._calls]), x + 1j * y
        order = np.argsort(kept)
        found = order[np.minimum(np.searchsorted(kept, wanted, sorter=order), len(kept) - 1)]
        if (kept[found] != wanted).any():
            return None
        return Evidence(
            *(np.concatenate(some)[found] for some in zip(*(call.told for call in self._calls), strict=True))
        )


def evidence(
    x: FloatArray, y: FloatArray, seen: Sightings, nodes: Nodes, stretches: Sequence[Stretch] = ()
) -> Evidence:
    """See evidence.evidence."""
    return _told(_plain(x), _plain(y), prepared(seen, nodes, nodes.weight, stretches), 1)


def _told(x: FloatArray, y: FloatArray, known: Prepared, threads: int) -> Evidence:
    cells = len(x)
    out = Evidence(
        np.empty(cells),
        np.empty((cells, len(known.bias))),
        np.empty((cells, len(known.scale))),
        np.empty((cells, len(known.rate))),
    )

    def work(part: slice) -> None:
        _evidence(x[part], y[part], known, Evidence(*(told[part] for told in out)))

    in_parts(cells, min(threads, cells // WORTH_A_THREAD), work)
    return out


def node_evidence(
    x: FloatArray,
    y: FloatArray,
    log: FloatArray,
    seen: Sightings,
    nodes: Nodes,
    stretches: Sequence[Stretch] = (),
) -> FloatArray:
    """See evidence.node_evidence."""
    known = prepared(seen, nodes, np.ones(nodes.weight.shape), stretches)
    found = np.empty_like(known.prior)
    top = _node_evidence(_plain(x), _plain(y), _plain(log), known, found)
    return (top + np.log(np.maximum(found, np.finfo(float).tiny))).reshape(nodes.weight.shape)


def _plain(array: FloatArray) -> FloatArray:
    return np.ascontiguousarray(array, dtype=float)


def _entry_points(sources: int):
    """sources: what is compiled in, as a number. numba tells cached functions apart by what they close over."""

    @entry
    def log_evidence_of(x, y, known, found):
        _ = sources
        past, apart, table, density, way = scratch(known)
        for c in range(len(x)):
            low, high = reached(x[c], y[c], known, past)
            log = of_cell(x[c], y[c], known, past, low, high, apart, table, density, way)
            found[c] = log + np.log(whole_of(known, low, high, apart, table))

    @entry
    def shared_out_over(x, y, mass, known, found, mean):
        """found (k e, b): the sum over the cells of the nodes' shares in their mass. mean: (c,) bias of each cell."""
        _ = sources
        past, apart, table, density, way = scratch(known)
        alone = np.zeros(len(apart))
        for c in range(len(x)):
            low, high = reached(x[c], y[c], known, past)
            of_cell(x[c], y[c], known, past, low, high, apart, table, density, way)
            whole, bias = whole_of(known, low, high, apart, table), 0.0
            for r in range(len(apart)):
                within_reach = known.moment[r, high] - known.moment[r, low]
                bias += apart[r] * (known.moment[r, known.moment.shape[1] - 1] - within_reach)
                bias += dot(table[r, low:high], known.bias[low:high])
                alone[r] += mass[c] / whole * apart[r]
                within = table[r, low:high]
                added_beside(found[r, low:high], within, known.prior[r, low:high], apart[r], mass[c] / whole)
            mean[c] = bias / whole
        for r in range(len(alone)):
            for b in range(found.shape[1]):
                found[r, b] += alone[r] * known.prior[r, b]

    @entry
    def evidence_of(x, y, known, out):
        _ = sources
        past, apart, table, density, way = scratch(known)
        rates = len(known.rate)
        for c in range(len(x)):
            low, high = reached(x[c], y[c], known, past)
            log = of_cell(x[c], y[c], known, past, low, high, apart, table, density, way)
            bias, scale, rate = out.bias[c], out.scale[c], out.rate[c]
            bias[:] = 0.0
            scale[:] = 0.0
            rate[:] = 0.0
            for r in range(len(apart)):
                within_reach = known.before[r, high] - known.before[r, low]
                row = apart[r] * (known.before[r, known.before.shape[1] - 1] - within_reach) + total(table[r, low:high])
                scale[r // rates] += row
                rate[r % rates] += row
                added(bias[:low], known.prior[r, :low], 0.0, apart[r])
                added(bias[low:high], table[r, low:high], 0.0, 1.0)
                added(bias[high:], known.prior[r, high:], 0.0, apart[r])
            whole = total(scale)
            out.log[c] = log + np.log(whole)
            times(bias, 1.0 / whole)
            times(scale, 1.0 / whole)
            times(rate, 1.0 / whole)

    @entry
    def node_evidence_of(x, y, before, known, found):
        """found (k e, b): the sum over the cells, without a factor whose logarithm is returned. before: (c,) logarithm
        of each cell's weight."""
        _ = sources
        past, apart, table, density, way = scratch(known)
        alone = np.zeros(len(apart))
        found[:] = 0.0
        top = -np.inf
        for c in range(len(x)):
            low, high = reached(x[c], y[c], known, past)
            log = before[c] + of_cell(x[c], y[c], known, past, low, high, apart, table, density, way)
            if log > top:
                factor = np.exp(top - log)
                alone *= factor
                found *= factor
                top = log
            weight = np.exp(log - top)
            for r in range(len(apart)):
                alone[r] += weight * apart[r]
                added(found[r, low:high], table[r, low:high], apart[r], weight)
        for r in range(len(alone)):
            found[r] += alone[r]
        return top

    return log_evidence_of, shared_out_over, evidence_of, node_evidence_of


_log_evidence, _shared_out_over, _evidence, _node_evidence = _entry_points(SOURCES)
