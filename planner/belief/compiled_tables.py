# pyright: standard
"""What the compiled evidence looks up: densities of bearings in rows of equally spaced nodes, made once for all places.

The nodes of the bias are equally spaced, so what a cell needs of a bearing's Gaussian is a piece of one row of a table,
the row by how far the error lies past a node; between rows it is interpolated linearly.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from planner import sweep_likelihood
from planner.belief.compiled_on_the_way import OnTheWay, on_the_way
from planner.belief.evidence import Sightings
from planner.belief.source_errors import Nodes
from planner.compiling import SOURCES, allocating, entry
from planner.on_the_way import Stretch
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
    on_way: OnTheWay
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


def prepared(seen: Sightings, nodes: Nodes, weight: FloatArray, stretches: Sequence[Stretch]) -> Prepared:
    """What these bearings and stretches say, for any place. weight: (k, e, b) of the nodes. Bearings of one sigma have
    one table."""
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
        on_the_way(stretches, nodes),
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


def _entry_point(sources: int):
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

    return tables_of


_tables = _entry_point(SOURCES)
