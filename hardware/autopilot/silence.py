"""How long the vehicle has been silent, and whether it may still act on that."""

from __future__ import annotations

import math
import time

from hardware.ports import Clock

LONGEST_LOOK_S = 0.5
"""Wall time. A look that came later means that this program stood still: what waits to be read was not read late
because of the vehicle."""


class Silence:
    """How long nothing was heard, in seconds of wall time in which it would have been noticed.

    A radio link and its messages live in wall time, however fast a simulation runs; and a look that came late
    because this program stood still counts for `longest_look_s` only: what waits to be read was heard.
    """

    def __init__(self, longest_look_s: float = LONGEST_LOOK_S) -> None:
        self._longest_look_s = longest_look_s
        self.seconds = 0.0

    def heard(self) -> None:
        """Something came in: the count starts again."""
        self.seconds = 0.0

    def look(self, elapsed_s: float) -> None:
        """Nothing new; elapsed_s: of wall time, since the last look."""
        self.seconds += min(max(elapsed_s, 0.0), self._longest_look_s)


class AfterSilence:
    """For some time after a silence the vehicle may still act on it: by the clock and by the wall clock, each at least.

    Time in which this program stood still does not count (a busy machine loads a server for a minute): the mode of a
    failsafe that waited that long to be read is not a pilot's.
    """

    def __init__(self, clock: Clock) -> None:
        self._clock = clock
        self._left_s = self._left_wall_s = -math.inf
        self._looked_s = self._looked_wall_s = 0.0

    def begin(self, seconds: float, wall_s: float) -> None:
        """The vehicle is heard again, or this server has come back."""
        self._left_s, self._left_wall_s = seconds, wall_s
        self._looked_s, self._looked_wall_s = self._clock.now(), time.monotonic()

    def look(self) -> bool:
        """Whether it may still. Two looks further apart than LONGEST_LOOK_S count as that far apart."""
        now_s, wall_s = self._clock.now(), time.monotonic()
        elapsed_wall_s = wall_s - self._looked_wall_s
        share = min(1.0, LONGEST_LOOK_S / elapsed_wall_s) if elapsed_wall_s > 0.0 else 1.0
        self._left_s -= share * (now_s - self._looked_s)
        self._left_wall_s -= share * elapsed_wall_s
        self._looked_s, self._looked_wall_s = now_s, wall_s
        return self._left_s > 0.0 or self._left_wall_s > 0.0
