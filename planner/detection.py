"""What it says of places that an emitter was not heard from here: a careful model of detection.

At distance r and relative bearing a the signal exceeds the receiver's threshold by

    m(r, a) = M + u + G(a) - 10 n log10(r / r_0)      u ~ N(0, S^2): power, height, shadow: the same for the whole turn

where M is the margin at r_0 in the antenna's maximum, G <= 0 its pattern and n the path loss exponent. One chance to
hear (a pulse, or an independent stretch of a carrier) is taken with probability Phi(m / F), F the fading. Silence over
all chances k of a turn therefore has, with the emitter sending at all with probability 1 - q,

    p(silence | x) = q + (1 - q) E_u prod_k (1 - Phi(m_k(x, u) / F))

It is careful in two ways. u is common to all chances, so that a hundred unheard pulses are not a hundred witnesses; and
q (switched off, its antenna in the grass, another channel) is never refuted, so that no place is ever excluded.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from planner.types import FloatArray

_NODES, _HERMITE = np.polynomial.hermite_e.hermegauss(41)
_WEIGHTS = _HERMITE / _HERMITE.sum()
NEAREST_M = 1.0
_LARGEST = 8.0


@dataclass(frozen=True, slots=True)
class DetectionModel:
    """margin_db: M at reference_m. spread_db: S. exponent: n, 2 in free space, up to 4 along the ground.

    fading_db: F. never: q. The defaults are wide: little is known of an emitter nobody has heard.
    """

    margin_db: float
    reference_m: float = 100.0
    spread_db: float = 10.0
    exponent: float = 3.0
    fading_db: float = 5.0
    never: float = 0.2


def silence_log_likelihood(
    model: DetectionModel,
    gain_db: FloatArray,
    chances: FloatArray,
    sensor: tuple[float, float],
    x: FloatArray,
    y: FloatArray,
) -> FloatArray:
    """Natural log of p(silence | x) at places (x, y) of any shape; 0 where nothing would have been heard anyway.

    gain_db: (m,) the pattern at source direction minus antenna heading = 2 pi k / m, ccw, below its maximum (<= 0).
    chances: (h,) how many chances there were with the antenna pointing to 2 pi k / h, rad ccw from east; 0: not
    listened. sensor: m ENU.
    """
    off_x, off_y = np.ravel(x) - sensor[0], np.ravel(y) - sensor[1]
    distance = np.maximum(np.hypot(off_x, off_y), NEAREST_M)
    loss_db = 10.0 * model.exponent * np.log10(distance / model.reference_m)
    heading = np.flatnonzero(chances > 0.0)
    turned = 2.0 * math.pi * heading / chances.size
    relative = (np.arctan2(off_y, off_x)[:, None] - turned[None, :]) / (2.0 * math.pi) % 1.0
    gain = gain_db[np.rint(relative * gain_db.size).astype(np.int64) % gain_db.size]
    margin = model.margin_db + gain - loss_db[:, None]
    silence = np.zeros(distance.size)
    for node, weight in zip(_NODES, _WEIGHTS, strict=True):
        missed = _normal_tail((margin + node * model.spread_db) / model.fading_db)
        silence += weight * np.exp(np.log(missed) @ chances[heading])
    likelihood = model.never + (1.0 - model.never) * silence
    return np.asarray(np.log(likelihood), dtype=np.float64).reshape(np.shape(x))


def _normal_tail(z: FloatArray) -> FloatArray:
    """1 - Phi(z), not under that of 8 standard deviations."""
    from scipy.special import ndtr  # loaded by the first silence, not by every start

    return np.asarray(ndtr(-np.minimum(z, _LARGEST)), dtype=np.float64)
