# pyright: standard
"""The fast twin of evidence.py: the same sums, compiled by numba, without the GIL.

What makes it fast: the nodes of the bias are equally spaced, so what a cell needs of a bearing's Gaussian is a piece
of one row of a table, the row by how far the error lies past a node; between rows it is interpolated linearly, and the
loops over the nodes become vector instructions. Products are taken instead of sums of logarithms, and brought back into
range every few bearings.
"""

from __future__ import annotations

import numpy as np

from planner import sweep_likelihood
from planner.belief.evidence import Evidence, Sightings
from planner.belief.source_errors import Nodes
from planner.compiling import SOURCES, allocating, entry, jit
from planner.types import FloatArray

RESCALED_EVERY = 8
"""Bearings: a density is never below e sigma / sqrt(2 pi), about 1e-5 at the smallest."""
STEPS = 64
"""Rows of the table from node to node: the interpolation is good to (spacing / 64 sigma)^2 / 8, 3e-5 at worst."""
FAR_SIGMAS = 9.0
"""Where a Gaussian counts as zero: beside an outlier's share nothing of it is left in 64 bits."""


def evidence(x: FloatArray, y: FloatArray, seen: Sightings, nodes: Nodes) -> Evidence:
    """See evidence.evidence."""
    cells, directions = len(x), seen.profile.shape[1]
    profiles = np.empty((len(seen.profile), len(nodes.scale), directions))
    for i, profile in enumerate(seen.profile):
        profiles[i] = sweep_likelihood.scaled(profile, nodes.scale)
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
        profiles,
        nodes.bias,
        nodes.spacing,
        nodes.bias_weight,
        nodes.scale,
        nodes.scale_weight,
        nodes.rate,
        nodes.rate_weight,
        out,
    )
    return out


@allocating
def _tabulate(table, spacing, sigma):
    """table (f, n): exp(-(f / STEPS - (n - n_0))^2 spacing^2 / (2 sigma^2)), n_0 the middle column."""
    rows, columns = table.shape
    middle, scaled = columns // 2, spacing / sigma
    for f in range(rows):
        for n in range(columns):
            off = (f / STEPS - (n - middle)) * scaled
            table[f, n] = np.exp(-0.5 * off * off) if abs(off) < FAR_SIGMAS else 0.0


@allocating
def _tabulate_profile(table, spacing, profile, angle, unit):
    """The same of a profile (m,) about `angle`, times `unit`."""
    rows, columns = table.shape
    middle, directions = columns // 2, len(profile)
    for f in range(rows):
        for n in range(columns):
            turned = (angle - (f / STEPS - (n - middle)) * spacing) / (2.0 * np.pi)
            place = (turned - np.floor(turned)) * directions
            low = int(place)
            part = place - low
            between = profile[low % directions] * (1.0 - part) + profile[(low + 1) % directions] * part
            table[f, n] = unit * between


@jit
def _interpolated(density, tables, i, k, f, start, below, above):
    """Two rows of a table, weighed, onto the nodes."""
    for b in range(len(density)):
        density[b] += below * tables[i, k, f, start + b] + above * tables[i, k, f + 1, start + b]


@jit
def _weighed(row, density, honest, outlier):
    for b in range(len(density)):
        row[b] *= honest * density[b] + outlier


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
def _of_cell(x, y, seen, first, spacing, scale, rate, tables, middle, table, density):
    """Multiplies all bearings into table (k e, b), for the emitter at (x, y); returns the logarithm taken out of it."""
    log = 0.0
    for i in range(len(seen.x)):
        direction = np.arctan2(y - seen.y[i], x - seen.x[i])
        for k in range(len(scale)):
            for b in range(len(density)):
                density[b] = 0.0
            # a profile was tabulated about its main peak and holds the others
            last = seen.first[i] + 1 if seen.whole[i] >= 0 else seen.first[i + 1]
            for j in range(seen.first[i], last):
                share = 1.0 if seen.whole[i] >= 0 else seen.weight[j]
                error = seen.angle[j] - direction
                error -= 2.0 * np.pi * np.floor(error / (2.0 * np.pi) + 0.5)
                at = (error - first) / spacing
                nodes_past = np.floor(at)
                fine = (at - nodes_past) * STEPS
                f = int(fine)
                above = share * (fine - f)
                _interpolated(density, tables, i, k, f, middle - int(nodes_past), share - above, above)
            for e in range(len(rate)):
                honest = (1.0 - rate[e]) / scale[k]
                _weighed(table[k * len(rate) + e], density, honest, rate[e] * seen.sigma[i] / np.sqrt(2.0 * np.pi))
        if i % RESCALED_EVERY == RESCALED_EVERY - 1:
            log += _rescaled(table)
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


@entry
def _evidence(x, y, seen, profiles, bias, spacing, bias_weight, scale, scale_weight, rate, rate_weight, out):
    _ = SOURCES
    scales, rates, count, bearings = len(scale), len(rate), len(bias), len(seen.x)
    middle = int(np.ceil((np.pi + max(abs(bias[0]), abs(bias[count - 1]))) / spacing)) + 1 + count
    tables = np.empty((bearings, scales, STEPS + 2, 2 * middle + 1))
    for i in range(bearings):
        for k in range(scales):
            if seen.whole[i] >= 0:
                unit = scale[k] * seen.sigma[i] * np.sqrt(2.0 * np.pi)
                _tabulate_profile(tables[i, k], spacing, profiles[seen.whole[i], k], seen.angle[seen.first[i]], unit)
            elif i > 0 and seen.whole[i - 1] < 0 and seen.sigma[i] == seen.sigma[i - 1]:
                tables[i, k] = tables[i - 1, k]
            else:
                _tabulate(tables[i, k], spacing, scale[k] * seen.sigma[i])
    prior = np.empty((scales * rates, count))
    for r in range(scales * rates):
        prior[r] = scale_weight[r // rates] * rate_weight[r % rates] * bias_weight
    table, density = np.empty_like(prior), np.empty(count)
    for c in range(len(x)):
        table[:] = prior
        log = _of_cell(x[c], y[c], seen, bias[0], spacing, scale, rate, tables, middle, table, density)
        out.log[c] = log + np.log(_sums(table, rates, out.bias[c], out.scale[c], out.rate[c]))
