"""Bearings of one source from one place: the echoes there bend all of them alike, so they count as one bearing.

With l_i(d) the logarithm of what bearing i says of direction d, an outlier's even share in it, n bearings say

    l(d) = sum_i l_i(d) / (1 + (n' - 1) r),    r: share of their variance that is the place's
    n' = sum_i min_j sigma_j^2 / sigma_i^2,    n of bearings that are equally good

which makes of such normal ones N(mean, sigma^2 (r + (1 - r) / n)): what two errors with covariance r sigma^2 leave of
their mean. Worse ones beside a good one never make it worse than it is alone. They have one indicator of an outlier,
since where an echo is louder than the direct wave all of them see it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from planner.observation import wrap
from planner.types import Bearing, FloatArray

SAME_PLACE_M = 5.0
"""So far apart GPS tells positions of one place. Farther away an emitter nearby is seen in another direction."""
OF_THE_PLACE = 0.75
"""r: bearings of drones to phones are off by 5 to 14 degrees at a place or on a flight, their sweeps alone by 3."""
EVEN = 0.1
"""Share of outliers in what one of several bearings says: two that contradict each other leave both directions."""
DIRECTIONS = 360
"""Of a combined bearing whose bearings are peaks and sigmas."""


def one_a_place(bearings: Sequence[Bearing]) -> list[Bearing]:
    """In the order in which the places were first looked from; one that is alone there stays as it is."""
    count = max((len(b.profile) for b in bearings), default=0) or DIRECTIONS
    return [there[0] if len(there) == 1 else _combined(there, count) for there in by_place(bearings)]


def by_place(bearings: Sequence[Bearing]) -> list[list[Bearing]]:
    """Those of one source from within SAME_PLACE_M of the first there, in the order of these first ones."""
    places: list[list[Bearing]] = []
    for bearing in bearings:
        same = (p for p in places if p[0].source == bearing.source and _together(p[0], bearing))
        there = next(same, None)
        if there is None:
            places.append([bearing])
        else:
            there.append(bearing)
    return places


def _together(one: Bearing, other: Bearing) -> bool:
    return math.hypot(one.x - other.x, one.y - other.y) < SAME_PLACE_M


def _combined(bearings: Sequence[Bearing], count: int) -> Bearing:
    """From their middle. count: directions of its profile."""
    densities = np.array([_density(bearing, count) for bearing in bearings])
    said = np.log((1.0 - EVEN) * densities + EVEN).sum(axis=0)
    sharpness = densities.max(axis=1) ** 2  # of normal ones proportional to 1 / sigma^2
    as_good = float(sharpness.sum() / sharpness.max())
    said = (said - said.max()) / (1.0 + (as_good - 1.0) * OF_THE_PLACE)
    x, y = np.mean([(b.x, b.y) for b in bearings], axis=0)
    return replace(bearings[0], x=float(x), y=float(y), profile=tuple(said.tolist()))


def _density(bearing: Bearing, count: int) -> FloatArray:
    """(count,) of the directions 2 pi k / count, ccw from east; 1 in the mean."""
    if bearing.profile:
        density = np.exp(np.array(bearing.profile) - max(bearing.profile))
    else:
        direction = 2.0 * np.pi * np.arange(count) / count
        peaks = [(bearing.angle, 1.0), *((peak.angle, peak.weight) for peak in bearing.peaks)]
        off = np.array([wrap(direction - angle) / max(bearing.sigma, 2.0 * np.pi / count) for angle, _ in peaks])
        density = np.array([weight for _, weight in peaks]) @ np.exp(-0.5 * off**2)
    return np.asarray(density / density.mean())
