"""The arithmetic of a turn: how far telemetry says the nose has come round, and where to send it next. Pure."""

from __future__ import annotations

import math

FULL_CIRCLE = 360.0
TOLERANCE = 3.0
"""deg short of a turn that still count as one; turning overshoots by as much, so that nothing is missing."""
_GAP = 120.0
"""deg between two headings above which the way round is ambiguous; telemetry at 20 Hz never comes near it."""


class TurnProgress:
    """Accumulates turning from successive headings (degrees, any). by_deg: wanted, negative: counterclockwise."""

    def __init__(self, heading_deg: float, by_deg: float = FULL_CIRCLE) -> None:
        self.start_deg = heading_deg
        self.goal_deg = abs(by_deg)
        self.direction = math.copysign(1.0, by_deg)
        self.turned_deg = 0.0
        """Net degrees in the wanted direction since the start; a swing back counts back."""
        self.furthest_deg = 0.0
        self._last = heading_deg

    def see(self, heading_deg: float) -> float:
        """Take the next heading in; returns `turned_deg`. A jump too large to be a turn restarts from there."""
        change = math.remainder(heading_deg - self._last, FULL_CIRCLE)
        self._last = heading_deg
        if abs(change) < _GAP:
            self.turned_deg += self.direction * change
            self.furthest_deg = max(self.furthest_deg, self.turned_deg)
        return self.turned_deg

    @property
    def done(self) -> bool:
        """The furthest it came round counts: swinging back afterwards does not undo it."""
        return self.furthest_deg >= self.goal_deg - TOLERANCE


def step_size(rate_deg_s: float) -> float:
    """Degrees of one yaw step so that steps come about every 0.75 s: smooth enough, and few enough for a thin link."""
    return min(45.0, max(10.0, 0.75 * rate_deg_s))


def next_target(
    elapsed_s: float, rate_deg_s: float, turned_deg: float, step_deg: float, goal_deg: float = FULL_CIRCLE
) -> float:
    """Degrees from the start to send the nose to now: paced by the rate, never 100 or more ahead of where it is
    (past 180 it would turn the other way), and a little past the goal at the end."""
    paced = (math.floor(elapsed_s * rate_deg_s / step_deg) + 1) * step_deg
    return min(paced, turned_deg + 100.0, goal_deg + TOLERANCE)
