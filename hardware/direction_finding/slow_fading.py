"""A wave that fades slowly while the antenna turns, or a receiver whose scale is compressed.

    m_i = L + k T(b - h_i) + s z(h_i) + w_i,      w_i ~ N(0, e^2)

T: the pattern, L: the level. k: decibels that the receiver shows for one; automatic gain and S-meters show fewer. z: a
Gaussian process of variance 1 whose correlation falls off over ALIKE_DEG, the same in the lobe and beside it, since a
wave that fades or an emitter that turns is the same for all headings. That sets it apart from echoes, which bend the
sides and the back of a lobe most. k and s are one of three each. With C = s^2 K + e^2 I, the level's direction g and
the residual r at a level nearby, the level integrated out flat,

    log p = -1/2 (r' C^-1 r - (g' C^-1 r)^2 / g' C^-1 g) - 1/2 log |C| - 1/2 log (g' C^-1 g)

C knows no bearing: one decomposition of K serves them all.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hardware.direction_finding.bent import BEARINGS_DEG, Bent, found_in
from hardware.direction_finding.refine import PatternCurve
from hardware.direction_finding.slices import LOG_NOISE_PRIOR, NOISE_DB, Slices, log_sum

SLOPES = (1.0, 0.75, 0.5)
SPREADS_DB = (0.7, 1.5, 3.0)
ALIKE_DEG = 25.0
DEEPEST_DB = 30.0
"""Below the antenna's maximum: what lies deeper no turn shows."""
_DB = 10.0 / np.log(10.0)


def slow_fading(
    curve: PatternCurve, slices: Slices, level_db: float, noise_db: float | None, known: float, known_reach_deg: float
) -> Bent:
    """As `bent`, of a wave that fades."""
    return found_in(log_evidence(curve, slices, level_db, noise_db), known, known_reach_deg)


def log_evidence(curve: PatternCurve, slices: Slices, level_db: float, noise_db: float | None) -> NDArray[np.float64]:
    """(k s, 72) from BEARINGS_DEG, of each slope and spread; noise (log-normal) integrated out."""
    gain_db = curve.gain_db(np.subtract.outer(BEARINGS_DEG, slices.heading_deg)) - curve.peak_db
    shown_db = np.multiply.outer(SLOPES, np.maximum(gain_db, -DEEPEST_DB))
    wave = 10.0 ** ((level_db + shown_db) / 10.0)
    total = wave if noise_db is None else wave + 10.0 ** (noise_db / 10.0)
    apart = (np.subtract.outer(slices.heading_deg, slices.heading_deg) + 180.0) % 360.0 - 180.0
    variance, axes = np.linalg.eigh(np.exp(-0.5 * (apart / ALIKE_DEG) ** 2))
    residual = ((slices.power_db - _DB * np.log(total)) @ axes)[:, None, :, None, :]
    level = ((wave / total) @ axes)[:, None, :, None, :]
    spread = np.multiply.outer(np.square(SPREADS_DB), np.maximum(variance, 0.0))[:, None, None, :]
    spread = spread + np.square(NOISE_DB)[:, None]
    held = np.sum(level**2 / spread, axis=-1)
    squares = np.sum(residual**2 / spread, axis=-1) - np.sum(level * residual / spread, axis=-1) ** 2 / held
    volume = np.sum(np.log(spread), axis=-1) + np.log(held / slices.heading_deg.size)
    return log_sum(LOG_NOISE_PRIOR - 0.5 * (squares + volume), axis=-1).reshape(-1, BEARINGS_DEG.size)
