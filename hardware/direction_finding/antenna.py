"""The antenna pattern: gain against heading relative to the antenna's front, and the antenna's offset to the nose."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hardware.reasons.pattern import PatternOfOtherFrequency

OTHER_FREQUENCY = 0.1
"""A pattern says little about a frequency that differs by a larger share from its own."""


@dataclass(frozen=True, slots=True)
class AntennaPattern:
    """A measured or modelled pattern.

    relative_bearing_deg: (n,), ascending in [0, 360), clockwise seen from above, 0 = the antenna's front.
    gain_db: (n,) gain at those angles; interpolated linearly in dB around the circle.
    offset_to_nose_deg: the antenna's front points this far clockwise of the vehicle's nose.
    """

    name: str
    relative_bearing_deg: NDArray[np.float64]
    gain_db: NDArray[np.float64]
    offset_to_nose_deg: float = 0.0
    frequency_hz: float | None = None
    polarization: str | None = None
    measured_on: str | None = None

    def gain_at(self, relative_bearing_deg: NDArray[np.float64]) -> NDArray[np.float64]:
        """Gain in dB at any relative bearings (degrees, any shape)."""
        return np.interp(relative_bearing_deg, self.relative_bearing_deg, self.gain_db, period=360.0)

    def other_frequency(self, frequency_hz: float) -> PatternOfOtherFrequency | None:
        """Why the pattern does not hold at `frequency_hz`; None when it does, or when nobody said where it does."""
        own = self.frequency_hz
        if own is None or abs(own / frequency_hz - 1.0) <= OTHER_FREQUENCY:
            return None
        return PatternOfOtherFrequency(self.name, own, frequency_hz)
