"""What a turn can look like: one wave; one wave and its echo; one wave from far below. As templates in linear power.

With g the antenna's amplitude (square root of the power pattern, scaled to a maximum of 1) against x = source bearing -
antenna heading:

    one wave             P(x) = g(x)^2
    with an echo         P(x) = g(x)^2 + a^2 g(x + d)^2 + 2 a cos(t) g(x) g(x + d)
    from e degrees below P(x) = g(arccos(cos x cos e))^2

The echo arrives d degrees clockwise, weaker by a (a <= 1), with phase t: both waves have one frequency, so fields add,
not powers. An echo within the beam is seen as a lobe that is shifted, wider or narrower, hardly as a second one.
Looking down, an antenna whose gain depends on the angle to its boom (any end-fire array) sees each heading difference x
as the angle arccos(cos x cos e): its lobe widens and its front stops standing out.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hardware.direction_finding.antenna import AntennaPattern
from hardware.direction_finding.sweep import BIN_DEG, BINS

ECHO_APART_DEG = 12.0
ECHO_LEVELS_DB = (-16.0, -10.0, -6.0, -3.0, 0.0)
"""The direct wave is the strongest, or no stronger than its echo."""
ECHO_PHASES_DEG = (22.5, 67.5, 112.5, 157.5)
"""Midpoints of quarters of the half circle: +t and -t look alike."""
LOOK_DOWN_DEG = (25.0, 35.0, 45.0, 55.0)
PRIOR = (0.6, 0.33, 0.07)
"""How probable the three are before the sweep is seen."""
KINDS = len(PRIOR)
_LEAST_POWER = 1e-5


@dataclass(frozen=True, slots=True)
class Alternatives:
    """power: (k, 180) at x = 0, 2, .. 358 degrees. log_prior, kind: (k,).

    kind 0: one wave (row 0 only), 1: with an echo, 2: from below.
    """

    power: NDArray[np.float64]
    log_prior: NDArray[np.float64]
    kind: NDArray[np.int64]

    @classmethod
    def of(cls, pattern: AntennaPattern) -> Alternatives:
        """The templates of one antenna, whose strongest gain counts as 1."""
        x: NDArray[np.float64] = np.arange(0.0, 360.0, BIN_DEG)
        peak_db = float(pattern.gain_db.max())

        def amplitude(relative_deg: NDArray[np.float64]) -> NDArray[np.float64]:
            return 10.0 ** ((pattern.gain_at(relative_deg) - peak_db) / 20.0)

        direct = amplitude(x)
        apart = np.arange(ECHO_APART_DEG, 360.0, ECHO_APART_DEG)
        a = 10.0 ** (np.array(ECHO_LEVELS_DB) / 20.0)[None, :, None, None]
        cos_t = np.cos(np.radians(ECHO_PHASES_DEG))[None, None, :, None]
        echo = a * np.array([amplitude(x + d) for d in apart])[:, None, None, :]
        echoed = (direct**2 + echo**2 + 2.0 * cos_t * direct * echo).reshape(-1, BINS)
        below = np.array([amplitude(_angle_to_boom(x, e)) ** 2 for e in LOOK_DOWN_DEG])
        parts = (direct[None, :] ** 2, echoed, below)
        return cls(
            np.maximum(np.concatenate(parts), _LEAST_POWER),
            np.concatenate([np.full(len(p), math.log(w / len(p))) for p, w in zip(parts, PRIOR, strict=True)]),
            np.concatenate([np.full(len(p), kind, dtype=np.int64) for kind, p in enumerate(parts)]),
        )


def _angle_to_boom(relative_deg: NDArray[np.float64], below_deg: float) -> NDArray[np.float64]:
    """arccos(cos x cos e), on the side of x; degrees in [0, 360)."""
    angle = np.degrees(np.arccos(np.cos(np.radians(relative_deg)) * math.cos(math.radians(below_deg))))
    return np.where(relative_deg <= 180.0, angle, 360.0 - angle)
