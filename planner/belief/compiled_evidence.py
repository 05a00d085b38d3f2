# pyright: standard
"""The fast twin of evidence.py: the same sums, compiled by numba, without the GIL.

What makes it fast: the nodes of the bias are equally spaced, so what a cell needs of a bearing's Gaussian is a piece
of one row of a table, the row by how far the error lies past a node; between rows it is interpolated linearly, and the
loops over the nodes become vector instructions and touch only the nodes that the bearing reaches. Products are taken
instead of sums of logarithms, and brought back into range every few bearings.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from planner import sweep_likelihood
from planner.belief.compiled_on_the_way import SUMS, coarse_nodes, weigh_stretches
from planner.belief.evidence import Evidence, Sightings
from planner.belief.source_errors import Nodes
from planner.compiling import SOURCES, allocating, entry, jit
from planner.on_the_way import Stretch, heard
from planner.types import FloatArray

RESCALED_EVERY = 8
"""Bearings: a density is never below e sigma / sqrt(2 pi), about 1e-5 at the smallest."""
STEPS = 64
"""Rows of the table from node to node: the interpolation is good to (spacing / 64 sigma)^2 / 8, 3e-5 at worst."""
FAR_SIGMAS = 9.0
"""Where a Gaussian counts as zero: beside an outlier's share nothing of it is left in 64 bits."""


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
    _evidence(
        np.ascontiguousarray(x, dtype=float),
        np.ascontiguousarray(y, dtype=float),
        seen,
        heard(stretches, nodes.scale),
        _profiles(seen, nodes),
        nodes.bias,
        nodes.spacing,
        nodes.scale,
        nodes.rate,
        np.ascontiguousarray(nodes.weight.reshape(-1, len(nodes.bias))),
        out,
    )
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
    found = np.empty((len(nodes.scale) * len(nodes.rate), len(nodes.bias)))
    top = _node_evidence(
        np.ascontiguousarray(x, dtype=float),
        np.ascontiguousarray(y, dtype=float),
        np.ascontiguousarray(log, dtype=float),
        seen,
        heard(stretches, nodes.scale),
        _profiles(seen, nodes),
        nodes.bias,
        nodes.spacing,
        nodes.scale,
        nodes.rate,
        found,
    )
    return (top + np.log(np.maximum(found, np.finfo(float).tiny))).reshape(nodes.weight.shape)


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
def _shared_out(table, shares):
    """Each row times its rate's share."""
    for r in range(table.shape[0]):
        for b in range(table.shape[1]):
            table[r, b] *= shares[r % len(shares)]


@jit
def _rescaled(table):
    """Divides by the largest entry; returns its logarithm."""
    top = 0.0
    for r in range(table.shape[0]):
        for b in range(table.shape[1]):
            top = max(top, table[r, b])
    for r in range(table.shape[0]):
        for b in range(table.shape[1]):
            table[r, b] /= top
    return np.log(top)


@jit
def _past(x, y, seen, i, j, first, spacing):
    """By how many nodes peak j of bearing i lies past the first one, for the emitter at (x, y)."""
    error = seen.angle[j] - np.arctan2(y - seen.y[i], x - seen.x[i])
    error -= 2.0 * np.pi * np.floor(error / (2.0 * np.pi) + 0.5)
    return (error - first) / spacing


@jit
def _of_cell(x, y, seen, first, spacing, odds, reach, shares, tables, past, table, density):
    """Multiplies all bearings into table (k e, b), for the emitter at (x, y); returns the logarithm taken out of it.

    A bearing's factor is taken relative to an outlier's, 1 + odds p(error), so that nodes beyond its reach keep theirs.
    """
    log, count, rates = 0.0, table.shape[1], odds.shape[2]
    for i in range(len(seen.x)):
        # a profile was tabulated about its main peak and holds the others
        begin, end = seen.first[i], seen.first[i] + 1 if seen.whole[i] >= 0 else seen.first[i + 1]
        low, high = np.inf, -np.inf
        for j in range(begin, end):
            past[j - begin] = _past(x, y, seen, i, j, first, spacing)
            low, high = min(low, past[j - begin]), max(high, past[j - begin])
        for k in range(odds.shape[1]):
            least = max(0, int(np.floor(low)) - reach[i, k])
            most = min(count, int(np.floor(high)) + reach[i, k] + 2)
            if least >= most:
                continue
            density[least:most] = 0.0
            for j in range(begin, end):
                share = 1.0 if seen.whole[i] >= 0 else seen.weight[j]
                node = int(np.floor(past[j - begin]))
                fine = (past[j - begin] - node) * STEPS
                f = int(fine)
                above = share * (fine - f)
                left, right = max(0, node - reach[i, k]), min(count, node + reach[i, k] + 2)
                if left < right:
                    start, stop = left - node + reach[i, k], right - node + reach[i, k]
                    lower, upper = tables[i, k, f, start:stop], tables[i, k, f + 1, start:stop]
                    _interpolated(density[left:right], lower, upper, share - above, above)
            for e in range(rates):
                _weighed(table[k * rates + e, least:most], density[least:most], odds[i, k, e])
        if i % RESCALED_EVERY == RESCALED_EVERY - 1:
            _shared_out(table, shares[0])
            log += _rescaled(table)
    _shared_out(table, shares[1])
    return log


@jit
def _sums(table, rates, bias, scale, rate):
    """Sums of table (k e, b) over all but one of its axes, each normalized; returns the whole sum."""
    whole = 0.0
    bias[:] = 0.0
    scale[:] = 0.0
    rate[:] = 0.0
    for r in range(table.shape[0]):
        row = 0.0
        for b in range(table.shape[1]):
            row += table[r, b]
            bias[b] += table[r, b]
        scale[r // rates] += row
        rate[r % rates] += row
        whole += row
    for some in (bias, scale, rate):
        for n in range(len(some)):
            some[n] /= whole
    return whole


@allocating
def _prepared(seen, profiles, bias, spacing, scale, rate):
    """reach and odds as `_of_cell` has them, its tables and shares, the outliers' logarithm, the most peaks."""
    scales, rates, count, bearings = len(scale), len(rate), len(bias), len(seen.x)
    everywhere = int(np.ceil((np.pi + max(abs(bias[0]), abs(bias[count - 1]))) / spacing)) + 1 + count
    reach, odds = np.empty((bearings, scales), dtype=np.int64), np.empty((bearings, scales, rates))
    outliers, widest, most_peaks = 0.0, 0, 1
    for i in range(bearings):
        uniform = seen.sigma[i] / np.sqrt(2.0 * np.pi)
        outliers += np.log(rate.max() * uniform)
        most_peaks = max(most_peaks, seen.first[i + 1] - seen.first[i])
        for k in range(scales):
            reach[i, k] = everywhere
            if seen.whole[i] < 0:
                reach[i, k] = min(everywhere, int(np.ceil(FAR_SIGMAS * scale[k] * seen.sigma[i] / spacing)) + 1)
            widest = max(widest, reach[i, k])
            for e in range(rates):
                odds[i, k, e] = (1.0 - rate[e]) / scale[k] / (rate[e] * uniform)
    tables = np.empty((bearings, scales, STEPS + 2, 2 * widest + 2))
    for i in range(bearings):
        for k in range(scales):
            table_of = tables[i, k, :, : 2 * reach[i, k] + 2]
            if seen.whole[i] >= 0:
                unit = scale[k] * seen.sigma[i] * np.sqrt(2.0 * np.pi)
                _tabulate_profile(table_of, spacing, profiles[seen.whole[i], k], seen.angle[seen.first[i]], unit)
            else:
                _tabulate(table_of, spacing, scale[k] * seen.sigma[i])
    shares = np.empty((2, rates))
    for e in range(rates):
        shares[0, e] = (rate[e] / rate.max()) ** RESCALED_EVERY
        shares[1, e] = (rate[e] / rate.max()) ** (bearings % RESCALED_EVERY)
    return reach, odds, tables, shares, outliers, most_peaks


@jit
def _added(found, table, weight):
    for r in range(found.shape[0]):
        for b in range(found.shape[1]):
            found[r, b] += weight * table[r, b]


@jit
def _scaled(found, factor):
    for r in range(found.shape[0]):
        for b in range(found.shape[1]):
            found[r, b] *= factor


def _entry_points(sources: int):
    """sources: what is compiled in, as a number. numba tells cached functions apart by what they close over."""

    @entry
    def evidence_of(x, y, seen, on_way, profiles, bias, spacing, scale, rate, prior, out):
        _ = sources
        reach, odds, tables, shares, outliers, most_peaks = _prepared(seen, profiles, bias, spacing, scale, rate)
        table, density, past = np.empty_like(prior), np.empty(len(bias)), np.empty(most_peaks)
        sums = np.empty((SUMS, coarse_nodes(len(bias), spacing)))
        for c in range(len(x)):
            table[:] = prior
            log = _of_cell(x[c], y[c], seen, bias[0], spacing, odds, reach, shares, tables, past, table, density)
            log += weigh_stretches(x[c], y[c], on_way, bias, spacing, scale, rate, sums, table)
            out.log[c] = outliers + log + np.log(_sums(table, len(rate), out.bias[c], out.scale[c], out.rate[c]))

    @entry
    def node_evidence_of(x, y, before, seen, on_way, profiles, bias, spacing, scale, rate, found):
        """found (k e, b): the sum over the cells, without a factor whose logarithm is returned."""
        _ = sources
        reach, odds, tables, shares, outliers, most_peaks = _prepared(seen, profiles, bias, spacing, scale, rate)
        table, density, past = np.empty_like(found), np.empty(len(bias)), np.empty(most_peaks)
        sums = np.empty((SUMS, coarse_nodes(len(bias), spacing)))
        found[:] = 0.0
        top = before[0]
        for c in range(len(x)):
            table[:] = 1.0
            log = before[c]
            log += _of_cell(x[c], y[c], seen, bias[0], spacing, odds, reach, shares, tables, past, table, density)
            log += weigh_stretches(x[c], y[c], on_way, bias, spacing, scale, rate, sums, table)
            if log > top:
                _scaled(found, np.exp(top - log))
                top = log
            _added(found, table, np.exp(log - top))
        return outliers + top

    return evidence_of, node_evidence_of


_evidence, _node_evidence = _entry_points(SOURCES)
