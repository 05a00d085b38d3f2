"""When the samples of a stream were taken, from when they arrived."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable

WINDOW_S = 20.0
"""Two crystals 100 ppm apart drift 2 ms in it."""


class SampleClock:
    """UTC of every sample of a steady stream that is handed over in bursts: late, but never early.

    Sample k was taken at start + k / rate. Each arrival bounds the start from above; the least bound of the last
    20 s is it. Reckoned on the monotonic clock, so that a UTC clock that is set in mid-stream counts at once.
    """

    def __init__(
        self,
        rate_hz: float,
        utc: Callable[[], float] = time.time,
        monotonic: Callable[[], float] = time.monotonic,
    ) -> None:
        self._rate_hz = rate_hz
        self._utc, self._monotonic = utc, monotonic
        self._bounds: deque[tuple[float, float]] = deque()

    def arrived(self, first: int, count: int) -> float:
        """UTC of sample `first` of `count` that have just arrived; numbers count on over samples that were lost."""
        now = self._monotonic()
        bound = now - (first + count) / self._rate_hz
        while self._bounds and self._bounds[-1][1] >= bound:
            self._bounds.pop()
        self._bounds.append((now, bound))
        while self._bounds[0][0] < now - WINDOW_S:
            self._bounds.popleft()
        return self._bounds[0][1] + first / self._rate_hz + self._utc() - now

    def restart(self) -> None:
        """The numbers begin again, or an unknown number of samples was lost."""
        self._bounds.clear()
