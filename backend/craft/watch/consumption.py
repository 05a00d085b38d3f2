"""What the battery loses in this flight, learned by wind hypothesis: hovering, and besides by the cube of airspeed.

A wind that explains badly why some legs took more than others loses weight, attitude or not.

Bayesian linear regression: charge lost = a seconds + b sum |v - w|^3 seconds, between two readings of the charge that
are LOST_PERCENT or more apart. Time is the charge's own: what a lost link did not bring drained nothing.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from backend.craft.endurance import READING_PERCENT, TAKE, TAKE_SIGMA, Endurance, unknown, winds
from backend.craft.watch.wind import STRAIGHT_M_S2, WindBelief
from hardware.readings import Telemetry
from planner.types import FloatArray

LOST_PERCENT = 2.0
TRUST = 0.5
"""What the battery says of the wind counts half: climbing, gusts and its own temper are in it, too."""
SHORTEST_S = 10.0
MOST_PERCENT_S = 1.0
"""A charge that falls faster has jumped: nothing is learned from that."""
STEP_S, LONGEST_GAP_S = 0.4, 2.0
"""Positions are looked at so far apart. What happened in a longer gap is not known: the interval is given up."""


def _prior() -> FloatArray:
    return np.tile(np.diag(TAKE_SIGMA**-2.0), (len(winds()[0]), 1, 1))


@dataclass(slots=True)
class Consumption:
    """Fed with telemetry several times a second. Forgets the wind on the ground, not what the vehicle takes."""

    endurance: Endurance = field(default_factory=unknown)
    _wind: WindBelief = field(default_factory=WindBelief)
    _precision: FloatArray = field(default_factory=_prior)
    _vector: FloatArray = field(default_factory=lambda: np.tile(TAKE * TAKE_SIGMA**-2.0, (len(winds()[0]), 1)))
    _at_s: float | None = None
    _velocity: tuple[float, float] = (0.0, 0.0)
    _charge: float | None = None
    """At the beginning of the interval, when the reading changed to it."""
    _last: float | None = None
    _seconds: float = 0.0
    _cubes: FloatArray = field(default_factory=lambda: np.zeros(len(winds()[0])))

    def update(self, telemetry: Telemetry) -> None:
        """One look; what came in while the link was away or the vehicle stood teaches nothing."""
        if not telemetry.in_air or not telemetry.connected:
            self._at_s = None
            self._begin(None)
            if telemetry.in_air is False:
                self._wind = WindBelief()
            return
        north, east, at_s = telemetry.velocity_north_m_s, telemetry.velocity_east_m_s, telemetry.position_at_s
        if north is None or east is None or at_s is None:
            return
        before_s = self._at_s
        if before_s is None or not 0.0 <= at_s - before_s <= LONGEST_GAP_S:
            self._at_s, self._velocity = at_s, (east, north)
            self._begin(None)
        elif at_s - before_s >= STEP_S:
            self._fly(at_s - before_s, (east, north), telemetry)
            self._at_s, self._velocity = at_s, (east, north)
            self._look_at_charge(telemetry.battery_percent)
            self._judge()

    def _fly(self, seconds: float, velocity: tuple[float, float], telemetry: Telemetry) -> None:
        wind_east, wind_north = winds()
        self._seconds += seconds
        self._cubes += seconds * np.hypot(velocity[0] - wind_east, velocity[1] - wind_north) ** 3
        push_east, push_north = telemetry.push_east_m_s2, telemetry.push_north_m_s2
        straight = math.dist(self._velocity, velocity) / seconds < STRAIGHT_M_S2
        if push_east is not None and push_north is not None and straight:
            self._wind.see(velocity, (push_east, push_north), seconds)

    def _look_at_charge(self, charge: float | None) -> None:
        last, self._last = self._last, charge
        if charge is None or last is None or charge == last:
            return
        lost = 0.0 if self._charge is None else self._charge - charge
        if charge > last:
            self._begin(None)
        elif self._charge is None or lost > LOST_PERCENT + MOST_PERCENT_S * self._seconds:
            self._begin(charge)
        elif lost >= LOST_PERCENT and self._seconds >= SHORTEST_S:
            self._learn(lost)
            self._begin(charge)

    def _learn(self, lost: float) -> None:
        flown = np.column_stack([np.full(len(self._cubes), self._seconds), self._cubes])
        self._precision = self._precision + flown[:, :, None] * flown[:, None, :] / READING_PERCENT**2
        self._vector = self._vector + flown * lost / READING_PERCENT**2

    def _judge(self) -> None:
        spread: FloatArray = np.asarray(np.linalg.inv(self._precision), np.float64)
        take = np.maximum(np.einsum("nij,nj->ni", spread, self._vector), 0.0)
        weight = self._wind.weights() * self._evidence(spread)
        self.endurance = Endurance(*winds(), weight / weight.sum(), take, spread)

    def _evidence(self, spread: FloatArray) -> FloatArray:
        """(n,) how well each hypothesis explains the charge used, relative to the best.

        log p(lost | w) = (v' S v + log det S) / 2 + const, with the posterior's precision S^-1 and S^-1 mean = v.
        """
        explained = np.einsum("ni,nij,nj->n", self._vector, spread, self._vector) + np.linalg.slogdet(spread)[1]
        return np.exp(0.5 * TRUST * (explained - explained.max()))

    def _begin(self, charge: float | None) -> None:
        self._charge = charge
        self._seconds, self._cubes = 0.0, np.zeros(len(self._cubes))
