"""Still air and a battery that is known: what flying takes without any doubt."""

from __future__ import annotations

import numpy as np

from backend.craft.endurance import Endurance


def still_air(percent_s: float) -> Endurance:
    """One hypothesis: no wind, and `percent_s` of the battery a second however fast the vehicle flies."""
    nothing, one = np.zeros(1), np.ones(1)
    return Endurance(nothing, nothing, one, np.array([[percent_s, 0.0]]), np.zeros((1, 2, 2)))


def blowing(speed_m_s: float, percent_s: float = 0.07, percent_s_cube: float = 8e-5) -> Endurance:
    """One hypothesis: a wind towards the north."""
    one = np.ones(1)
    return Endurance(np.zeros(1), speed_m_s * one, one, np.array([[percent_s, percent_s_cube]]), np.zeros((1, 2, 2)))
