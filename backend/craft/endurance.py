"""What a flight takes of the battery, in the wind that the flight so far has shown. Pure.

The wind is not known but believed: hypotheses of it, each with a weight and with the consumption that the battery shows
if it is true. A promise is what nine of ten of these would keep. While nothing is known of the wind the hypotheses
reach evenly from none to FASTEST_WIND_M_S, from everywhere: the promise then allows for a strong wind against.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache

import numpy as np

from planner.types import FloatArray

FASTEST_WIND_M_S = 10.0
AIRSPEED_M_S = 12.0
"""As fast through the air as a vehicle is taken to fly: against more wind it comes home slowly."""
SLOWEST_M_S = 1.0
LEG_S = 8.0
"""Added to each leg's time at full speed, because it starts from a stop, ends in one, and settles."""
SINK_M_S, LAND_M_S, LOW_M = 1.0, 0.5, 10.0
"""Sinking, and below LOW_M landing: the slower of what PX4 and ArduCopter do as they are shipped."""
TOUCH_DOWN_S = 10.0
CLIMB_M_S, CLIMB_FACTOR = 2.0, 1.25
KEPT_BY = 0.9
"""The share of the hypotheses (by weight) that a promise holds for."""
SPREAD = 1.28
"""Standard deviations of a hypothesis' own consumption that are added: nine of ten again."""
READING_PERCENT = 0.5
"""How far off the charge is that the vehicle reports; most report whole percents."""


@dataclass(frozen=True, slots=True)
class Endurance:
    """n hypotheses. Wind blows *towards* (east, north) m/s. weight: sums to one.

    take: (n, 2) what the battery loses: percent a second in the air, and besides percent a second per (m/s)^3 of
    airspeed. spread: (n, 2, 2) the covariance of these.
    """

    wind_east: FloatArray
    wind_north: FloatArray
    weight: FloatArray
    take: FloatArray
    spread: FloatArray

    def way_percent(
        self, legs: Sequence[tuple[float, float]], speed_m_s: float, hover_s: float = 0.0, climb_m: float = 0.0
    ) -> float:
        """Charge that flying the legs (east, north m) and hovering take; of nine of ten hypotheses less."""
        hover_s += CLIMB_FACTOR * max(climb_m, 0.0) / CLIMB_M_S
        in_wind = np.hypot(self.wind_east, self.wind_north) ** 3
        seconds = np.full(len(self.weight), hover_s + LEG_S * len(legs))
        cubes = seconds * in_wind
        for leg in legs:
            took, airspeed = self._leg(leg, speed_m_s)
            seconds = seconds + took
            cubes = cubes + took * airspeed**3
        flown = np.column_stack([seconds, cubes])
        variance = np.einsum("ni,nij,nj->n", flown, self.spread, flown) + READING_PERCENT**2
        return self._kept((flown * self.take).sum(axis=1) + SPREAD * np.sqrt(variance))

    def likely_percent(self, hover_s: float) -> float:
        """Charge that hovering takes: the mean over the hypotheses, and no promise."""
        in_wind = np.hypot(self.wind_east, self.wind_north) ** 3
        return float(self.weight @ (hover_s * (self.take[:, 0] + in_wind * self.take[:, 1])))

    def _leg(self, leg: tuple[float, float], speed_m_s: float) -> tuple[FloatArray, FloatArray]:
        """(seconds, airspeed) by hypothesis: over the ground as fast as asked, or as the airspeed allows."""
        length = max(math.hypot(*leg), 1e-9)
        along = (leg[0] * self.wind_east + leg[1] * self.wind_north) / length
        across2 = np.maximum(self.wind_east**2 + self.wind_north**2 - along**2, 0.0)
        fastest = along + np.sqrt(np.maximum(AIRSPEED_M_S**2 - across2, 0.0))
        speed = np.clip(fastest, SLOWEST_M_S, max(speed_m_s, SLOWEST_M_S))
        return length / speed, np.sqrt((speed - along) ** 2 + across2)

    def _kept(self, percent: FloatArray) -> float:
        order = np.argsort(percent)
        reached = np.searchsorted(np.cumsum(self.weight[order]), KEPT_BY - 1e-9)
        return float(percent[order[min(int(reached), len(order) - 1)]])


def landing_s(height_m: float) -> float:
    """Seconds from so high above the ground until the vehicle stands."""
    return max(height_m - LOW_M, 0.0) / SINK_M_S + min(max(height_m, 0.0), LOW_M) / LAND_M_S + TOUCH_DOWN_S


TAKE = np.array([0.075, 4e-5])
TAKE_SIGMA = np.array([0.025, 4e-5])
"""Before the flight has shown it: 22 minutes of hovering from full to empty, at 10 m/s through the air 15."""


@cache
def winds() -> tuple[FloatArray, FloatArray]:
    """(n,) east, (n,) north m/s of the hypotheses: as many of each speed."""
    speeds = np.repeat(np.arange(0.5, FASTEST_WIND_M_S, 1.0), 16)
    towards = np.tile(np.arange(16) * math.tau / 16, len(speeds) // 16)
    return speeds * np.sin(towards), speeds * np.cos(towards)


def in_strong_wind() -> tuple[Endurance, ...]:
    """One for each direction. A climb tells which way the wind blows and hardly how fast, so that what is promised
    after it holds for the fastest wind that way."""
    still = unknown()
    speed = np.hypot(still.wind_east, still.wind_north)
    fastest = np.flatnonzero(speed > speed.max() - 1e-6)
    return tuple(replace(still, weight=np.eye(len(speed))[one]) for one in fastest)


@cache
def unknown() -> Endurance:
    """Nothing has been flown yet."""
    east, north = winds()
    n = len(east)
    return Endurance(
        east, north, np.full(n, 1.0 / n), np.tile(TAKE, (n, 1)), np.tile(np.diag(TAKE_SIGMA**2), (n, 1, 1))
    )
