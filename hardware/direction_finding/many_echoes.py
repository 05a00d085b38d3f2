"""A wave among many echoes: what a turn tells of its direction where no single echo explains what was heard.

With g the antenna's field gain against x = bearing - heading, and echoes from anywhere of total power v times the
direct wave's, the field at heading h is g(x) plus a sum of many waves of no known phase: complex Gaussian, with the
correlation of the antenna with itself,

    R(d) = mean over y of g(y) g(y + d),     k(x) = v R(0) / g(x)^2

k: the echoes' power over the direct wave's at that heading. The power is then Rice's, and in decibels

    mean  10 log10 g^2 + (10 / ln 10) E1(1 / k)                                 E1: exponential integral
    sd    (10 / ln 10) sqrt(1 / (1 / 2k + 6 / pi^2))                            between its limits for small and large k
    correlation between headings d apart  R(d) / R(0)

so that a lobe is bent smoothly, and its sides and back more than its top. As a Gaussian process on the mean
(bent_lobes.py), v one of five, it gives the evidence of such a place and the density of the direct wave's bearing all
round.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hardware.direction_finding.antenna import AntennaPattern
from hardware.direction_finding.bent_lobes import BentLobes, log_evidence, waves_of
from hardware.direction_finding.slices import Slices, log_sum
from hardware.direction_finding.sweep import BIN_DEG

ECHO_POWERS = (0.03, 0.08, 0.2, 0.5, 1.2)
"""v: of all echoes together, over the direct wave's."""
STEP_DEG = 5.0
MODE_REACH_DEG = 50.0
"""The bearing is the mean of the density within this of its maximum."""
SPREAD_REACH_DEG = 60.0
"""Mass further from a bearing is an outlier's, which no standard deviation describes."""
_LEAST_GAIN = 1e-4
_DB = 10.0 / math.log(10.0)


def echo_field(pattern: AntennaPattern) -> BentLobes:
    """What echoes make of one antenna, for each of their powers; the antenna's strongest gain counts as 1."""
    from scipy.special import exp1  # as in refine.py: only sweeps need it

    x: NDArray[np.float64] = np.arange(0.0, 360.0, BIN_DEG)
    gain = np.maximum(10.0 ** ((pattern.gain_at(x) - float(pattern.gain_db.max())) / 10.0), _LEAST_GAIN)
    k = np.array(ECHO_POWERS)[:, None] * gain.mean() / gain
    return BentLobes(
        _DB * (np.log(gain) + np.asarray(exp1(1.0 / k), dtype=np.float64)),
        _DB * np.sqrt(1.0 / (1.0 / (2.0 * k) + 6.0 / math.pi**2)),
        waves_of(np.abs(np.fft.rfft(np.sqrt(gain))) ** 2),
    )


@dataclass(frozen=True, slots=True)
class ManyEchoes:
    """log_odds: of many echoes to the evidence they were compared with, before any prior.

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


def many_echoes(
    field: BentLobes, slices: Slices, level_db: float, noise_db: float | None, known: float, known_reach_deg: float
) -> ManyEchoes:
    """known: log evidence of other shapes, a mean over bearings of +- known_reach_deg. level_db: the direct wave's,
    roughly, where the antenna is strongest; noise_db: the receiver's floor, None: unknown."""
    at: NDArray[np.float64] = np.arange(0.0, 360.0, STEP_DEG)
    log_density = log_sum(log_evidence(field, slices, at, level_db, noise_db), axis=0) - math.log(len(ECHO_POWERS))
    evidence = float(log_sum(log_density)) - math.log(2.0 * known_reach_deg / STEP_DEG)
    mode = float(at[int(np.argmax(log_density))])
    off = (at - mode + 180.0) % 360.0 - 180.0
    mass = np.exp(log_density - log_density.max()) * (np.abs(off) <= MODE_REACH_DEG)
    bearing = (mode + float(mass @ off) / float(mass.sum())) % 360.0
    return ManyEchoes(evidence - known, bearing, np.append(at, 360.0), np.append(log_density, log_density[0]))
