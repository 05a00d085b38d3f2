"""How well each place explains the bearings of one source, its bias, scale and outlier rate marginalized: in numpy.

The specification of `compiled_evidence`, and its oracle in the tests.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from planner import on_the_way, sweep_likelihood
from planner.belief.same_place import one_a_place
from planner.belief.source_errors import Nodes
from planner.observation import expected_bearing, wrap
from planner.on_the_way import Stretch
from planner.types import Bearing, FloatArray, IntArray


class Sightings(NamedTuple):
    """The bearings of one source as arrays. x, y: (n,) m. sigma: (n,) rad, of each bearing's own error.

    first: (n + 1,) where the peaks of each bearing begin in angle (p,) rad and weight (p,); a bearing's weights sum
    to 1. profile: (q, m) densities a radian over the directions 2 pi k / m, which count in the place of peaks and
    sigma; whole: (n,) which of them is a bearing's, -1: none.
    """

    x: FloatArray
    y: FloatArray
    sigma: FloatArray
    first: IntArray
    angle: FloatArray
    weight: FloatArray
    profile: FloatArray
    whole: IntArray


class Evidence(NamedTuple):
    """Of c places. log: (c,) the logarithm of p(bearings | place), up to the same constant everywhere.

    bias (c, b), scale (c, k), rate (c, e): the errors' masses if the emitter is there; rows sum to 1.
    """

    log: FloatArray
    bias: FloatArray
    scale: FloatArray
    rate: FloatArray


class SharedOut(NamedTuple):
    """The errors' masses, summed over places: bias (b,), scale (k,), rate (e,). mean: (c,) rad, bias of each place."""

    bias: FloatArray
    scale: FloatArray
    rate: FloatArray
    mean: FloatArray


SMALLEST_SIGMA = float(np.deg2rad(1.0))
"""A source's bearings are never taken to be better than this: neither the position nor the pattern is."""


def sightings(bearings: Sequence[Bearing]) -> Sightings:
    """The bearings' outlier probability is not used: the source's rate stands for it. Profiles have equally many
    directions. Those from one place count as one bearing (planner.belief.same_place), so n may be fewer."""
    bearings = one_a_place(bearings)
    peaks = [[(b.angle, 1.0), *((peak.angle, peak.weight) for peak in b.peaks)] for b in bearings]
    first = np.concatenate([[0], np.cumsum([len(some) for some in peaks])]).astype(np.int64)
    weights = [w / sum(v for _, v in some) for some in peaks for _, w in some]
    profiles = [sweep_likelihood.density(b.profile, SMALLEST_SIGMA) for b in bearings if b.profile]
    has = np.array([bool(b.profile) for b in bearings], dtype=bool)
    whole = np.where(has, np.cumsum(has) - 1, -1).astype(np.int64)
    sigma = np.array([max(b.sigma, SMALLEST_SIGMA) for b in bearings], dtype=float)
    sigma[has] = [sweep_likelihood.width(profile) for profile in profiles]
    return Sightings(
        np.array([b.x for b in bearings], dtype=float),
        np.array([b.y for b in bearings], dtype=float),
        sigma,
        first,
        np.array([angle for some in peaks for angle, _ in some], dtype=float),
        np.array(weights, dtype=float),
        np.array(profiles, dtype=float).reshape(len(profiles), -1) if profiles else np.ones((0, 1)),
        whole,
    )


def evidence(
    x: FloatArray, y: FloatArray, seen: Sightings, nodes: Nodes, stretches: Sequence[Stretch] = ()
) -> Evidence:
    """Of the places (c,) x, y, m ENU. stretches: what the same source heard in flight.

    p(z | x) = sum_b,s,e p(b) p(s) p(e) prod_i [(1 - e) sum_j w_ij N(z_ij - dir_i(x) - b; 0, (s sigma_i)^2) + e / 2 pi],
    each bearing's density in units of that at the peak of N(0, sigma_i^2). Of a sweep's profile p_i instead of the sum
    over peaks (1 - e) p_i,s(dir_i(x) + b), its scale as in planner.sweep_likelihood. A stretch's factor is
    (1 - e) f_s(x, b) / c_s + e, as in planner.on_the_way: with one indicator of an outlier for all of its readings.
    """
    log = _by_node(x, y, seen, nodes, stretches) + np.log(nodes.weight)
    top = log.max(axis=(1, 2, 3), keepdims=True)
    mass = np.exp(log - top)
    whole = mass.sum(axis=(1, 2, 3))
    mass /= whole[:, None, None, None]
    return Evidence(
        np.log(whole) + top[:, 0, 0, 0], mass.sum(axis=(1, 2)), mass.sum(axis=(2, 3)), mass.sum(axis=(1, 3))
    )


class Weigher:
    """What one source's bearings and stretches say of places, asked again and again."""

    def __init__(self, seen: Sightings, nodes: Nodes, stretches: Sequence[Stretch] = ()) -> None:
        self._known = seen, nodes, stretches

    def log(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """(c,) as in `Evidence`."""
        return evidence(x, y, *self._known).log

    def shared_out(self, x: FloatArray, y: FloatArray, mass: FloatArray) -> SharedOut:
        """mass: (c,) probability of the places by all that is known."""
        found = evidence(x, y, *self._known)
        return SharedOut(mass @ found.bias, mass @ found.scale, mass @ found.rate, found.bias @ self._known[1].bias)


def node_evidence(
    x: FloatArray,
    y: FloatArray,
    log: FloatArray,
    seen: Sightings,
    nodes: Nodes,
    stretches: Sequence[Stretch] = (),
) -> FloatArray:
    """(k, e, b) logarithm of sum_x p(x) p(z | x, s, e, b), p(x) given by its logarithm (c,): what the bearings of an
    emitter, and the stretches on which it was heard, tell of their source's errors. The nodes' weights do not count; in
    the units of `evidence`."""
    by_place = _by_node(x, y, seen, nodes, stretches) + log[:, None, None, None]
    top = by_place.max(axis=0)
    return np.log(np.exp(by_place - top).sum(axis=0)) + top


def _by_node(x: FloatArray, y: FloatArray, seen: Sightings, nodes: Nodes, stretches: Sequence[Stretch]) -> FloatArray:
    """(c, k, e, b) logarithm of p(z | x, s, e, b)."""
    log = np.zeros((len(x), len(nodes.scale), len(nodes.rate), len(nodes.bias)))
    for i in range(len(seen.x)):
        direction = expected_bearing(seen.x[i], seen.y[i], x, y)
        sigma = nodes.scale * seen.sigma[i]
        density = np.zeros((len(x), len(sigma), len(nodes.bias)))
        if seen.whole[i] >= 0:
            for k, profile in enumerate(sweep_likelihood.scaled(seen.profile[seen.whole[i]], nodes.scale)):
                towards = direction[:, None] + nodes.bias
                density[:, k] = sigma[k] * np.sqrt(2.0 * np.pi) * sweep_likelihood.at(profile, towards)
        else:
            for j in range(seen.first[i], seen.first[i + 1]):
                error = wrap(seen.angle[j] - direction)[:, None] - nodes.bias
                density += seen.weight[j] * np.exp(-0.5 * (error[:, None, :] / sigma[:, None]) ** 2)
        honest = (1.0 - nodes.rate[:, None]) * density[:, :, None, :] / nodes.scale[:, None, None]
        log += np.log(honest + nodes.rate[:, None] * seen.sigma[i] / np.sqrt(2.0 * np.pi))
    for ratio in on_the_way.log_ratio(x, y, on_the_way.heard(stretches, nodes.scale), nodes.bias, nodes.scale):
        honest = (1.0 - nodes.rate[:, None]) * np.exp(ratio)[:, :, None, :]
        log += np.log(honest + nodes.rate[:, None])
    return log
