"""What a turn tells of a wave where the antenna's lobe is bent (bent_lobes.py): evidence, and bearings all round."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hardware.direction_finding.bent_lobes import BentLobes, log_evidence
from hardware.direction_finding.slices import Slices, log_sum

STEP_DEG = 5.0
BEARINGS_DEG: NDArray[np.float64] = np.arange(0.0, 360.0, STEP_DEG)
MODE_REACH_DEG = 50.0
"""The bearing is the mean of the density within this of its maximum."""
SPREAD_REACH_DEG = 60.0
"""Mass further from a bearing is an outlier's, which no standard deviation describes."""


@dataclass(frozen=True, slots=True)
class Bent:
    """log_odds: of such lobes to the evidence they were compared with, before any prior.

    at_deg, log_density: (73,) the bearing's density all round, the first direction again at the end.
    """

    log_odds: float
    bearing_deg: float
    at_deg: NDArray[np.float64]
    log_density: NDArray[np.float64]

    def spread_deg(self, bearing_deg: float, reach_deg: float = SPREAD_REACH_DEG) -> float:
        """Standard deviation about any bearing, of the mass within reach_deg of it."""
        off, mass = self._about(bearing_deg)
        mass = mass * (np.abs(off) <= reach_deg)
        return math.hypot(math.sqrt(float(mass @ off**2) / max(float(mass.sum()), 1e-12)), STEP_DEG / math.sqrt(12.0))

    def beyond(self, bearing_deg: float) -> float:
        """Probability of directions further than 60 degrees from any bearing."""
        off, mass = self._about(bearing_deg)
        return float(mass[np.abs(off) > SPREAD_REACH_DEG].sum())

    def _about(self, bearing_deg: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        mass = np.exp(self.log_density[:-1] - self.log_density.max())
        return (self.at_deg[:-1] - bearing_deg + 180.0) % 360.0 - 180.0, mass / mass.sum()


def bent(
    lobes: BentLobes, slices: Slices, level_db: float, noise_db: float | None, known: float, known_reach_deg: float
) -> Bent:
    """known: log evidence of other shapes, a mean over bearings of +- known_reach_deg. level_db: the direct wave's,
    roughly, where the antenna is strongest; noise_db: the receiver's floor, None: unknown."""
    return found_in(log_evidence(lobes, slices, BEARINGS_DEG, level_db, noise_db), known, known_reach_deg)


def found_in(of_each: NDArray[np.float64], known: float, known_reach_deg: float) -> Bent:
    """of_each: (v, 72) log evidence from BEARINGS_DEG of lobes that are equally likely."""
    at = BEARINGS_DEG
    log_density = log_sum(of_each, axis=0) - math.log(len(of_each))
    evidence = float(log_sum(log_density)) - math.log(2.0 * known_reach_deg / STEP_DEG)
    mode = float(at[int(np.argmax(log_density))])
    off = (at - mode + 180.0) % 360.0 - 180.0
    mass = np.exp(log_density - log_density.max()) * (np.abs(off) <= MODE_REACH_DEG)
    bearing = (mode + float(mass @ off) / float(mass.sum())) % 360.0
    return Bent(evidence - known, bearing, np.append(at, 360.0), np.append(log_density, log_density[0]))
