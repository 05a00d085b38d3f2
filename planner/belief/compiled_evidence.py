# pyright: standard
"""The fast twin of evidence.py: the same sums, compiled by numba, without the GIL.

What makes it fast: the nodes of the bias are equally spaced, so what a cell needs of a bearing's Gaussian is a piece
of one row of a table, the row by how far the error lies past a node; between rows it is interpolated linearly, and the
loops over the nodes become vector instructions and touch only the nodes that some bearing reaches. Products are taken
instead of sums of logarithms, and brought back into range every few bearings.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from planner import sweep_likelihood
from planner.belief.compiled_on_the_way import SUMS, coarse_nodes, weigh_stretches
from planner.belief.evidence import Evidence, SharedOut, Sightings
from planner.belief.source_errors import Nodes
from planner.compiling import SOURCES, allocating, entry, inlined, jit
from planner.on_the_way import Heard, Stretch, heard
from planner.types import FloatArray, IntArray

RESCALED_EVERY = 8
"""Bearings: a density is never below e sigma / sqrt(2 pi), about 1e-5 at the smallest."""
STEPS = 64
"""Rows of the table from node to node: the interpolation is good to (spacing / 64 sigma)^2 / 8, 3e-5 at worst."""
FAR_SIGMAS = 9.0
"""Where a Gaussian counts as zero: beside an outlier's share nothing of it is left in 64 bits."""


class Prepared(NamedTuple):
    """What is the same for all places. prior: (k e, b) weights of the nodes; before, moment: (k e, b + 1) sums of them,
    and of them times the bias, over all nodes before one. table: (t, k, f, n) densities, of bearing i those of
    `table_of[i]`; reach: (i, k) nodes to each side. odds: (i, k, e) of an honest bearing. shares: (2, e) of the rates,
    after RESCALED_EVERY bearings and after those left over. outliers: logarithm of what all have in common.
    """

    seen: Sightings
    on_way: Heard
    bias: FloatArray
    spacing: float
    scale: FloatArray
    rate: FloatArray
    prior: FloatArray
    before: FloatArray
    moment: FloatArray
    reach: IntArray
    odds: FloatArray
    table: FloatArray
    table_of: IntArray
    shares: FloatArray
    outliers: float


class Weigher:
    """evidence.Weigher of a source that took these bearings and heard these stretches."""

    def __init__(self, seen: Sightings, nodes: Nodes, stretches: Sequence[Stretch] = ()) -> None:
        self._nodes = nodes
        self._known = _prepared(seen, nodes, nodes.weight, stretches)

    def log(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """As there."""
        found = np.empty(len(x))
        _log_evidence(_plain(x), _plain(y), self._known, found)
        return found

    def shared_out(self, x: FloatArray, y: FloatArray, mass: FloatArray) -> SharedOut:
        """As there."""
        found, mean = np.zeros_like(self._known.prior), np.empty(len(x))
        _shared_out_over(_plain(x), _plain(y), _plain(mass), self._known, found, mean)
        table = found.reshape(self._nodes.weight.shape)
        return SharedOut(table.sum(axis=(0, 1)), table.sum(axis=(1, 2)), table.sum(axis=(0, 2)), mean)


def evidence(
    x: FloatArray, y: FloatArray, seen: Sightings, nodes: Nodes, stretches: Sequence[Stretch] = ()
) -> Evidence:
    """See evidence.evidence."""
    cells = len(x)
    out = Evidence(
        np.empty(cells),
        np.empty((cells, len(nodes.bias))),
        np.empty((cells, len(nodes.scale))),
        np.empty((cells, len(nodes.rate))),
    )
    _evidence(_plain(x), _plain(y), _prepared(seen, nodes, nodes.weight, stretches), out)
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
    known = _prepared(seen, nodes, np.ones(nodes.weight.shape), stretches)
    found = np.empty_like(known.prior)
    top = _node_evidence(_plain(x), _plain(y), _plain(log), known, found)
    return (top + np.log(np.maximum(found, np.finfo(float).tiny))).reshape(nodes.weight.shape)


def _plain(array: FloatArray) -> FloatArray:
    return np.ascontiguousarray(array, dtype=float)


def _prepared(seen: Sightings, nodes: Nodes, weight: FloatArray, stretches: Sequence[Stretch]) -> Prepared:
    """weight: (k, e, b). Bearings of one sigma have one table."""
    prior = np.ascontiguousarray(weight.reshape(-1, len(nodes.bias)))
    before, moment = (np.pad(np.cumsum(w, axis=1), ((0, 0), (1, 0))) for w in (prior, prior * nodes.bias))
    of_sigma: dict[float, int] = {}
    first = [
        of_sigma.setdefault(float(sigma), i) if whole < 0 else i
        for i, (sigma, whole) in enumerate(zip(seen.sigma, seen.whole, strict=True))
    ]
    tabulated, table_of = np.unique(np.array(first, dtype=np.int64), return_inverse=True)
    reach, odds, table, shares, outliers = _tables(
        seen, _profiles(seen, nodes), nodes.bias, nodes.spacing, nodes.scale, nodes.rate, tabulated
    )
    return Prepared(
        seen,
        heard(stretches, nodes.scale),
        nodes.bias,
        nodes.spacing,
        nodes.scale,
        nodes.rate,
        prior,
        before,
        moment,
        reach,
        odds,
        table,
        table_of.astype(np.int64),
        shares,
        outliers,
    )


def _profiles(seen: Sightings, nodes: Nodes) -> FloatArray:
    """(q, k, m) the whole sweeps' densities at each scale."""
    profiles = np.empty((len(seen.profile), len(nodes.scale), seen.profile.shape[1]))
    for i, profile in enumerate(seen.profile):
        profiles[i] = sweep_likelihood.scaled(profile, nodes.scale)
    return profiles


@allocating
def _tabulate(table, spacing, sigma):
    """table (f, n): exp(-(f / STEPS - (n - n_0))^2 spacing^2 / (2 sigma^2)), n_0 the middle column."""
    rows, columns = table.shape
    middle, scaled = (columns - 1) // 2, spacing / sigma
    for f in range(rows):
        for n in range(columns):
            off = (f / STEPS - (n - middle)) * scaled
            table[f, n] = np.exp(-0.5 * off * off) if abs(off) < FAR_SIGMAS else 0.0


@allocating
def _tabulate_profile(table, spacing, profile, angle, unit):
    """The same of a profile (m,) about `angle`, times `unit`."""
    rows, columns = table.shape
    middle, directions = (columns - 1) // 2, len(profile)
    for f in range(rows):
        for n in range(columns):
            turned = (angle - (f / STEPS - (n - middle)) * spacing) / (2.0 * np.pi)
            place = (turned - np.floor(turned)) * directions
            low = int(place)
            part = place - low
            between = profile[low % directions] * (1.0 - part) + profile[(low + 1) % directions] * part
            table[f, n] = unit * between


@jit
def _interpolated(density, lower, upper, below, above):
    """Two rows of a table, weighed, onto the nodes that they are cut to.

    An index that might be negative would keep the loop from becoming vectors.
    """
    for b in range(len(density)):
        density[b] += below * lower[b] + above * upper[b]


@jit
def _weighed(row, density, odds):
    for b in range(len(density)):
        row[b] *= 1.0 + odds * density[b]


@jit
def _weighed_at_once(row, lower, upper, below, above):
    """The same of one peak, its two rows of the table already times the odds."""
    for b in range(len(row)):
        row[b] *= 1.0 + (below * lower[b] + above * upper[b])


@jit
def _copied(row, from_row):
    for b in range(len(row)):
        row[b] = from_row[b]


@jit
def _times(row, factor):
    for b in range(len(row)):
        row[b] *= factor


@jit
def _largest(row):
    top = 0.0
    for b in range(len(row)):
        top = max(top, row[b])
    return top


@jit
def _sum(row):
    total = 0.0
    for b in range(len(row)):
        total += row[b]
    return total


@jit
def _dot(row, other):
    total = 0.0
    for b in range(len(row)):
        total += row[b] * other[b]
    return total


@jit
def _added(found, row, apart, weight):
    for b in range(len(row)):
        found[b] += weight * (row[b] - apart)


@jit
def _added_beside(found, row, prior, apart, weight):
    for b in range(len(row)):
        found[b] += weight * (row[b] - apart * prior[b])


@jit
def _rescaled(table, low, high, apart, shares):
    """Each row times its rate's share, then all over the largest entry; returns its logarithm."""
    top = 0.0
    for r in range(table.shape[0]):
        share = shares[r % len(shares)]
        apart[r] *= share
        _times(table[r, low:high], share)
        top = max(top, apart[r], _largest(table[r, low:high]))
    for r in range(table.shape[0]):
        apart[r] /= top
        _times(table[r, low:high], 1.0 / top)
    return np.log(top)


@jit
def _past(x, y, seen, i, j, first, spacing):
    """By how many nodes peak j of bearing i lies past the first one, for the emitter at (x, y)."""
    error = seen.angle[j] - np.arctan2(y - seen.y[i], x - seen.x[i])
    error -= 2.0 * np.pi * np.floor(error / (2.0 * np.pi) + 0.5)
    return (error - first) / spacing


@jit
def _last(seen, i):
    """One past the last of bearing i's peaks that count: a profile was tabulated about the first and holds them all."""
    return seen.first[i] + 1 if seen.whole[i] >= 0 else seen.first[i + 1]


@inlined
def _reached(x, y, known, past):
    """First and past-last node that any bearing reaches, for the emitter at (x, y); past (p,) of each peak is set."""
    seen, count = known.seen, len(known.bias)
    low, high = count, 0
    for i in range(len(seen.x)):
        reach = 0
        for k in range(known.reach.shape[1]):
            reach = max(reach, known.reach[i, k])
        for j in range(seen.first[i], _last(seen, i)):
            past[j] = _past(x, y, seen, i, j, known.bias[0], known.spacing)
            node = int(np.floor(past[j]))
            if node + reach + 2 > 0 and node - reach < count:
                low, high = min(low, max(0, node - reach)), max(high, min(count, node + reach + 2))
    if len(known.on_way.worth) > 0:
        return 0, count
    return (low, high) if low < high else (0, 0)


@inlined
def _one_peak(known, i, past, share, table):
    count, rates = table.shape[1], known.odds.shape[2]
    node = int(np.floor(past))
    fine = (past - node) * STEPS
    f = int(fine)
    above = share * (fine - f)
    for k in range(known.odds.shape[1]):
        reach = known.reach[i, k]
        left, right = max(0, node - reach), min(count, node + reach + 2)
        if left >= right:
            continue
        start, stop = left - node + reach, right - node + reach
        lower = known.table[known.table_of[i], k, f, start:stop]
        upper = known.table[known.table_of[i], k, f + 1, start:stop]
        for e in range(rates):
            odds = known.odds[i, k, e]
            _weighed_at_once(table[k * rates + e, left:right], lower, upper, odds * (share - above), odds * above)


@inlined
def _several_peaks(known, i, past, table, density):
    seen, count, rates = known.seen, table.shape[1], known.odds.shape[2]
    begin, end = seen.first[i], seen.first[i + 1]
    low, high = past[begin], past[begin]
    for j in range(begin + 1, end):
        low, high = min(low, past[j]), max(high, past[j])
    for k in range(known.odds.shape[1]):
        reach = known.reach[i, k]
        least, most = max(0, int(np.floor(low)) - reach), min(count, int(np.floor(high)) + reach + 2)
        if least >= most:
            continue
        density[least:most] = 0.0
        for j in range(begin, end):
            node = int(np.floor(past[j]))
            fine = (past[j] - node) * STEPS
            f = int(fine)
            above = seen.weight[j] * (fine - f)
            left, right = max(0, node - reach), min(count, node + reach + 2)
            if left < right:
                start, stop = left - node + reach, right - node + reach
                lower = known.table[known.table_of[i], k, f, start:stop]
                upper = known.table[known.table_of[i], k, f + 1, start:stop]
                _interpolated(density[left:right], lower, upper, seen.weight[j] - above, above)
        for e in range(rates):
            _weighed(table[k * rates + e, least:most], density[least:most], known.odds[i, k, e])


@inlined
def _of_cell(x, y, known, past, low, high, apart, table, density, sums):
    """Weighs nodes low to high of table (k e, b) by all bearings and stretches, for the emitter at (x, y), as far as
    `_reached` finds: all others have their prior times apart (k e,). Returns the logarithm taken out of both.

    A bearing's factor is taken relative to an outlier's, 1 + odds p(error), so that nodes beyond its reach keep theirs.
    """
    seen, log = known.seen, known.outliers
    apart[:] = 1.0
    for r in range(table.shape[0]):
        _copied(table[r, low:high], known.prior[r, low:high])
    for i in range(len(seen.x)):
        first = seen.first[i]
        if _last(seen, i) - first == 1:
            _one_peak(known, i, past[first], 1.0 if seen.whole[i] >= 0 else seen.weight[first], table)
        else:
            _several_peaks(known, i, past, table, density)
        if i % RESCALED_EVERY == RESCALED_EVERY - 1:
            log += _rescaled(table, low, high, apart, known.shares[0])
    rates = len(known.rate)
    for r in range(table.shape[0]):
        share = known.shares[1, r % rates]
        apart[r] *= share
        _times(table[r, low:high], share)
    if len(known.on_way.worth) > 0:
        apart[:] = 0.0
        log += weigh_stretches(x, y, known.on_way, known.bias, known.spacing, known.scale, known.rate, sums, table)
    return log


@inlined
def _whole(known, low, high, apart, table):
    """The sum over all nodes."""
    whole = 0.0
    for r in range(table.shape[0]):
        reached = known.before[r, high] - known.before[r, low]
        whole += apart[r] * (known.before[r, known.before.shape[1] - 1] - reached) + _sum(table[r, low:high])
    return whole


@allocating
def _scratch(known):
    """past, apart, table, density and sums as `_of_cell` takes them."""
    count = len(known.bias)
    sums = np.empty((SUMS, coarse_nodes(count, known.spacing)))
    return (
        np.empty(len(known.seen.angle)),
        np.empty(len(known.prior)),
        np.empty_like(known.prior),
        np.empty(count),
        sums,
    )


def _entry_points(sources: int):
    """sources: what is compiled in, as a number. numba tells cached functions apart by what they close over."""

    @entry
    def tables_of(seen, profiles, bias, spacing, scale, rate, tabulated):
        """reach, odds, table, shares and outliers as `Prepared` has them. tabulated: (t,) the bearing of each table."""
        _ = sources
        scales, rates, count, bearings = len(scale), len(rate), len(bias), len(seen.x)
        everywhere = int(np.ceil((np.pi + max(abs(bias[0]), abs(bias[count - 1]))) / spacing)) + 1 + count
        reach, odds = np.empty((bearings, scales), dtype=np.int64), np.empty((bearings, scales, rates))
        outliers, widest = 0.0, 0
        for i in range(bearings):
            uniform = seen.sigma[i] / np.sqrt(2.0 * np.pi)
            outliers += np.log(rate.max() * uniform)
            for k in range(scales):
                reach[i, k] = everywhere
                if seen.whole[i] < 0:
                    reach[i, k] = min(everywhere, int(np.ceil(FAR_SIGMAS * scale[k] * seen.sigma[i] / spacing)) + 1)
                widest = max(widest, reach[i, k])
                for e in range(rates):
                    odds[i, k, e] = (1.0 - rate[e]) / scale[k] / (rate[e] * uniform)
        table = np.empty((len(tabulated), scales, STEPS + 2, 2 * widest + 2))
        for t in range(len(tabulated)):
            i = tabulated[t]
            for k in range(scales):
                of_scale = table[t, k, :, : 2 * reach[i, k] + 2]
                if seen.whole[i] >= 0:
                    unit = scale[k] * seen.sigma[i] * np.sqrt(2.0 * np.pi)
                    _tabulate_profile(of_scale, spacing, profiles[seen.whole[i], k], seen.angle[seen.first[i]], unit)
                else:
                    _tabulate(of_scale, spacing, scale[k] * seen.sigma[i])
        shares = np.empty((2, rates))
        for e in range(rates):
            shares[0, e] = (rate[e] / rate.max()) ** RESCALED_EVERY
            shares[1, e] = (rate[e] / rate.max()) ** (bearings % RESCALED_EVERY)
        return reach, odds, table, shares, outliers

    @entry
    def log_evidence_of(x, y, known, found):
        _ = sources
        past, apart, table, density, sums = _scratch(known)
        for c in range(len(x)):
            low, high = _reached(x[c], y[c], known, past)
            log = _of_cell(x[c], y[c], known, past, low, high, apart, table, density, sums)
            found[c] = log + np.log(_whole(known, low, high, apart, table))

    @entry
    def shared_out_over(x, y, mass, known, found, mean):
        """found (k e, b): the sum over the cells of the nodes' shares in their mass. mean: (c,) bias of each cell."""
        _ = sources
        past, apart, table, density, sums = _scratch(known)
        alone = np.zeros(len(apart))
        for c in range(len(x)):
            low, high = _reached(x[c], y[c], known, past)
            _of_cell(x[c], y[c], known, past, low, high, apart, table, density, sums)
            whole, bias = _whole(known, low, high, apart, table), 0.0
            for r in range(len(apart)):
                reached = known.moment[r, high] - known.moment[r, low]
                bias += apart[r] * (known.moment[r, known.moment.shape[1] - 1] - reached)
                bias += _dot(table[r, low:high], known.bias[low:high])
                alone[r] += mass[c] / whole * apart[r]
                within = table[r, low:high]
                _added_beside(found[r, low:high], within, known.prior[r, low:high], apart[r], mass[c] / whole)
            mean[c] = bias / whole
        for r in range(len(alone)):
            for b in range(found.shape[1]):
                found[r, b] += alone[r] * known.prior[r, b]

    @entry
    def evidence_of(x, y, known, out):
        _ = sources
        past, apart, table, density, sums = _scratch(known)
        rates = len(known.rate)
        for c in range(len(x)):
            low, high = _reached(x[c], y[c], known, past)
            log = _of_cell(x[c], y[c], known, past, low, high, apart, table, density, sums)
            whole = _whole(known, low, high, apart, table)
            out.log[c] = log + np.log(whole)
            out.bias[c] = 0.0
            out.scale[c] = 0.0
            out.rate[c] = 0.0
            for r in range(len(apart)):
                reached = known.before[r, high] - known.before[r, low]
                row = apart[r] * (known.before[r, known.before.shape[1] - 1] - reached) + _sum(table[r, low:high])
                out.scale[c, r // rates] += row / whole
                out.rate[c, r % rates] += row / whole
                _added(out.bias[c, :], known.prior[r, :], 0.0, apart[r] / whole)
                within = table[r, low:high]
                _added_beside(out.bias[c, low:high], within, known.prior[r, low:high], apart[r], 1.0 / whole)

    @entry
    def node_evidence_of(x, y, before, known, found):
        """found (k e, b): the sum over the cells, without a factor whose logarithm is returned. before: (c,) logarithm
        of each cell's weight."""
        _ = sources
        past, apart, table, density, sums = _scratch(known)
        alone = np.zeros(len(apart))
        found[:] = 0.0
        top = -np.inf
        for c in range(len(x)):
            low, high = _reached(x[c], y[c], known, past)
            log = before[c] + _of_cell(x[c], y[c], known, past, low, high, apart, table, density, sums)
            if log > top:
                factor = np.exp(top - log)
                alone *= factor
                found *= factor
                top = log
            weight = np.exp(log - top)
            for r in range(len(apart)):
                alone[r] += weight * apart[r]
                _added(found[r, low:high], table[r, low:high], apart[r], weight)
        for r in range(len(alone)):
            found[r] += alone[r]
        return top

    return tables_of, log_evidence_of, shared_out_over, evidence_of, node_evidence_of


_tables, _log_evidence, _shared_out_over, _evidence, _node_evidence = _entry_points(SOURCES)
