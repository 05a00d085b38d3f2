"""Directions that a sweep fits nearly as well as its bearing: of a dipole or a loop the opposite one.

The sparse reconstruction needs one direction for what comes from one, and does not name the others.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from hardware.direction_finding.circle import DIRECTIONS, SweepLikelihood
from hardware.readings import BearingPeak

AS_LIKELY = 0.25
"""Of the likelihood about the bearing."""
AWAY_DEG = 60.0
NEAR_DEG = 30.0
"""What lies so near a direction belongs to it."""
SAME_DEG = 15.0
_DIRECTION = np.arange(float(DIRECTIONS))


def likely_too(likelihood: SweepLikelihood, bearing_deg: float) -> tuple[BearingPeak, ...]:
    """The likeliest first, more than AWAY_DEG from the bearing; weight: of the likelihood about the bearing."""
    mass = np.exp(likelihood.log_likelihood)
    away = np.abs(_off(bearing_deg)) > AWAY_DEG
    left, about = np.where(away, mass, 0.0), float(mass[~away].sum())
    found: list[BearingPeak] = []
    while True:
        top = float(np.argmax(left))
        off = _off(top)
        own = np.where(np.abs(off) <= NEAR_DEG, left, 0.0)
        weight = float(own.sum()) / about
        if weight < AS_LIKELY:
            return tuple(found)
        found.append(BearingPeak((top + float(own @ off) / float(own.sum())) % 360.0, min(weight, 1.0)))
        left = left - own


def new_beside(peak: BearingPeak, others: Sequence[BearingPeak]) -> bool:
    """Whether none of the others is in the same direction."""
    return all(abs((other.bearing_deg - peak.bearing_deg + 180.0) % 360.0 - 180.0) > SAME_DEG for other in others)


def _off(from_deg: float) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    return (_DIRECTION - from_deg + 180.0) % 360.0 - 180.0
