"""How an emitter walks or drifts, as the belief assumes it: a velocity that forgets itself.

Each of the two components of the velocity is an Ornstein-Uhlenbeck process with standard deviation v / sqrt(2) and
autocorrelation exp(-|t| / tau) (Uhlenbeck and Ornstein 1930; Johnson et al. 2008 for animals). v: root mean square of
the speed. tau: the time after which the direction is forgotten: seconds for an animal that feeds, minutes for somebody
who walks somewhere, longer than a search for what drifts.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from planner.types import FloatArray

WALKING_S = 30.0
"""tau of an animal that feeds, and of anybody who wanders about."""
PURPOSEFUL_S = 180.0
"""tau of a person who walks somewhere."""
DRIFTING_S = 900.0
"""tau of what wind or water carries."""

FLIGHT_S = 15.0
"""From one place to the next, usually."""


@dataclass(frozen=True, slots=True)
class Movement:
    """speed: root mean square, m/s, > 0. persistence: tau, s, > 0."""

    speed: float
    persistence: float

    def variance(self, seconds: FloatArray | float) -> FloatArray:
        """Of the way gone in that time along one axis, m^2.

        2 s^2 tau^2 (t / tau - 1 + exp(-t / tau)) with s^2 = v^2 / 2.
        """
        shares = np.abs(np.asarray(seconds, dtype=float)) / self.persistence
        return self.speed**2 * self.persistence**2 * (shares + np.expm1(-shares))

    def way(self, seconds: float) -> float:
        """Root mean square of the distance between where it is and where it was that long before, m."""
        return float(np.sqrt(2.0 * self.variance(seconds)))

    def goal(self, threshold: float, measurement_time: float) -> float:
        """Expected error, m, at which an emitter that moves counts as localized.

        sqrt(mu^2 + way(t)^2), t from one bearing to the next: of two bearings that cross, one is always that old, so
        nothing better can be hoped for, however many there are.
        """
        return float(np.hypot(threshold, self.way(measurement_time + FLIGHT_S)))
