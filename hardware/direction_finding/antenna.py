"""The antenna pattern: gain against heading relative to the antenna's front, and the antenna's offset to the nose."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from hardware.reasons.pattern import PatternOfOtherFrequency

OTHER_FREQUENCY = 0.1
"""A pattern says little about a frequency that differs by a larger share from its own."""

UNCHECKED_SQUINT_DEG = 6.0
"""An antenna that nobody checked on its vehicle may point 10 degrees beside where it should: within two of these."""
BORROWED_SQUINT_DEG = 9.0
"""The same when not even the antenna is the one that was measured."""


@dataclass(frozen=True, slots=True)
class AntennaPattern:
    """A measured or modelled pattern.

    relative_bearing_deg: (n,), ascending in [0, 360), clockwise seen from above, 0 = the antenna's front.
    gain_db: (n,) gain at those angles; interpolated linearly in dB around the circle.
    offset_to_nose_deg: the antenna's front points this far clockwise of the vehicle's nose.
    pointing_sigma_deg: what bearings found with it are uncertain by together, measured on the vehicle; None: not
    measured. borrowed: of another antenna than the one that flies, as far as anybody said.
    """

    name: str
    relative_bearing_deg: NDArray[np.float64] = field(repr=False)
    gain_db: NDArray[np.float64] = field(repr=False)
    offset_to_nose_deg: float = 0.0
    frequency_hz: float | None = None
    polarization: str | None = None
    measured_on: str | None = None
    pointing_sigma_deg: float | None = None
    borrowed: bool = False

    @property
    def beam_deg(self) -> float:
        """Width of everything within 3 dB of the maximum."""
        gain = self.gain_at(np.arange(0.0, 360.0, 0.5))
        return 0.5 * float(np.sum(gain > gain.max() - 3.0))

    @property
    def lobe_deg(self) -> float:
        """Middle of everything within 3 dB of the maximum, degrees clockwise from the antenna's front."""
        angle = np.arange(0.0, 360.0, 0.5)
        gain = self.gain_at(angle)
        top = np.exp(1j * np.radians(angle[gain > gain.max() - 3.0]))
        return math.degrees(float(np.angle(top.sum())))

    @property
    def checked(self) -> bool:
        """Whether somebody measured, with the antenna on its vehicle, where it points."""
        return self.pointing_sigma_deg is not None and not self.borrowed

    @property
    def mismatch_sigma_deg(self) -> float:
        """What bearings found with this pattern may be off by together, in degrees: no single sweep can show it."""
        if self.pointing_sigma_deg is not None and not self.borrowed:
            return self.pointing_sigma_deg
        return BORROWED_SQUINT_DEG if self.borrowed else UNCHECKED_SQUINT_DEG

    def gain_at(self, relative_bearing_deg: NDArray[np.float64]) -> NDArray[np.float64]:
        """Gain in dB at any relative bearings (degrees, any shape)."""
        return np.interp(relative_bearing_deg, self.relative_bearing_deg, self.gain_db, period=360.0)

    def other_frequency(self, frequency_hz: float) -> PatternOfOtherFrequency | None:
        """Why the pattern does not hold at `frequency_hz`; None when it does, or when nobody said where it does."""
        own = self.frequency_hz
        if own is None or abs(own / frequency_hz - 1.0) <= OTHER_FREQUENCY:
            return None
        return PatternOfOtherFrequency(self.name, own, frequency_hz)
