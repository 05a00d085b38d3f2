"""When a simulated tag sends: an oscillator of its own, which is a little off, and pulses that stray."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class Beat:
    """Pulse n begins at phase_s + n period_s (1 + clock_error) + stray_s u_n, u_n even in [-1, 1] and the same whenever
    it is asked. What strays must be shorter than the pause."""

    period_s: float
    width_s: float
    phase_s: float = 0.0
    clock_error: float = 0.0
    stray_s: float = 0.0

    def begin_s(self, number: int) -> float:
        """Of pulse `number`."""
        begin_s = self.phase_s + number * self._own_period_s
        return begin_s + self.stray_s * _unit(number, self.phase_s) if self.stray_s else begin_s

    def next_s(self, after_s: float) -> float:
        """When the next pulse begins whose middle lies later than `after_s`; a millionth of a period is now."""
        middle_s = self.width_s / 2.0
        number = math.floor((after_s - middle_s - self.phase_s) / self._own_period_s + 1e-6) + 1
        if self.stray_s and self.begin_s(number - 1) + middle_s > after_s:
            number -= 1
        while self.stray_s and self.begin_s(number) + middle_s <= after_s:
            number += 1
        return self.begin_s(number)

    def sends(self, at_s: NDArray[np.float64]) -> NDArray[np.bool_]:
        """(n,) whether it sends at each of (n,) times."""
        if not self.stray_s:
            return (at_s - self.phase_s) % self._own_period_s < self.width_s
        number = np.rint((at_s - self.phase_s) / self._own_period_s)
        sending = np.zeros(at_s.size, dtype=bool)
        for n in {int(one) + by for one in np.unique(number) for by in (-1, 0, 1)}:
            since = at_s - self.begin_s(n)
            sending |= (since >= 0.0) & (since < self.width_s)
        return sending

    @property
    def _own_period_s(self) -> float:
        return self.period_s * (1.0 + self.clock_error)


def _unit(number: int, phase_s: float) -> float:
    """In [-1, 1], by chance but always the same."""
    seed = [number % 2**32, int(phase_s * 1e6) % 2**32]
    return float(np.random.default_rng(seed).uniform(-1.0, 1.0))
