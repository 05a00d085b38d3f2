"""What the vehicle believes of itself: position with a wandering GPS error, heading with an offset and noise."""

from __future__ import annotations

import math
from random import Random

from hardware.sim.autopilot.copter import Copter


class Navigation:
    """Estimate = truth + error. The position error wanders (Ornstein-Uhlenbeck, `gps_sigma` m, 40 s) and may jump."""

    def __init__(
        self, copter: Copter, rng: Random, gps_sigma: float, heading_error: float, heading_sigma: float
    ) -> None:
        self._copter = copter
        self._rng = rng
        self._gps_sigma = gps_sigma
        self._heading_sigma = heading_sigma
        self.heading_error = heading_error
        self._wander = [0.0, 0.0, 0.0]
        self._jump = (0.0, 0.0)
        self._jump_left = 0.0
        self._next_fix = 0.0
        self._age = 0.0
        self._fix_lost_left = 0.0
        self.without_fix_for = 0.0
        """Seconds; 0 while there is a fix."""

    def jump(self, north: float, east: float, seconds: float) -> None:
        """The GPS position steps by (north, east) m for that many seconds, then comes back."""
        self._jump, self._jump_left = (north, east), seconds

    def lose_fix(self, seconds: float) -> None:
        """No satellites for that long: it navigates on by what else it has, which drifts."""
        self._fix_lost_left = seconds

    @property
    def has_fix(self) -> bool:
        """Satellites are heard."""
        return self._fix_lost_left <= 0.0

    @property
    def satellites(self) -> int:
        """How many are used."""
        return 14 if self.has_fix else 0

    def step(self, dt: float) -> None:
        """Advance by dt seconds; the position error changes with each fix, every 0.2 s."""
        self._age += dt
        self._fix_lost_left = max(0.0, self._fix_lost_left - dt)
        self.without_fix_for = 0.0 if self.has_fix else self.without_fix_for + dt
        self._jump_left = max(0.0, self._jump_left - dt)
        if self._age < self._next_fix:
            return
        self._next_fix = self._age + 0.2
        kick = self._gps_sigma * math.sqrt(2.0 * 0.2 / 40.0)
        for axis in range(3):
            self._wander[axis] += -self._wander[axis] * 0.2 / 40.0 + kick * self._rng.gauss(0.0, 1.0)

    @property
    def error(self) -> tuple[float, float, float]:
        """(north, east, up) m, estimate minus truth."""
        jump_n, jump_e = self._jump if self._jump_left > 0.0 else (0.0, 0.0)
        return self._wander[0] + jump_n, self._wander[1] + jump_e, 0.5 * self._wander[2]

    @property
    def north(self) -> float:
        """Estimated, m from home."""
        return self._copter.north + self.error[0]

    @property
    def east(self) -> float:
        """Estimated, m from home."""
        return self._copter.east + self.error[1]

    @property
    def up(self) -> float:
        """Estimated, m above home."""
        return self._copter.up + self.error[2]

    def heading_deg(self) -> float:
        """[0, 360)."""
        noise = self._rng.gauss(0.0, self._heading_sigma) if self._heading_sigma > 0.0 else 0.0
        return (self._copter.heading + self.heading_error + noise) % 360.0
