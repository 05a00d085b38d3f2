"""A wave that fades slowly while the antenna turns, or a receiver whose scale is compressed.

    m_i = L + k T(b - h_i) + s z(h_i) + w_i

T: the pattern. k: decibels that the receiver shows for one; automatic gain and S-meters show fewer. z: a process of
variance 1 whose correlation falls off over ALIKE_DEG, the same in the lobe and beside it, since a wave that fades or an
emitter that turns is the same for all headings. That sets it apart from echoes, which bend the sides and the back of a
lobe most. k and s are one of three each (bent_lobes.py has the evidence).
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from hardware.direction_finding.antenna import AntennaPattern
from hardware.direction_finding.bent_lobes import BentLobes, waves_of
from hardware.direction_finding.sweep import BIN_DEG, BINS

SLOPES = (1.0, 0.75, 0.5)
SPREADS_DB = (0.7, 1.5, 3.0)
ALIKE_DEG = 25.0
DEEPEST_DB = 30.0
"""Below the antenna's maximum: what lies deeper no turn shows."""
# exp(-(d / a)^2 / 2) has the Fourier coefficients exp(-(n a)^2 / 2)
_WAVES = waves_of(np.exp(-0.5 * (np.arange(BINS // 2) * math.radians(ALIKE_DEG)) ** 2))


def fading_field(pattern: AntennaPattern) -> BentLobes:
    """What fading makes of one antenna, for each slope and spread."""
    x: NDArray[np.float64] = np.arange(0.0, 360.0, BIN_DEG)
    gain_db = np.maximum(pattern.gain_at(x) - float(pattern.gain_db.max()), -DEEPEST_DB)
    return BentLobes(np.outer(SLOPES, gain_db), np.ones((len(SLOPES), BINS)), _WAVES, SPREADS_DB)
