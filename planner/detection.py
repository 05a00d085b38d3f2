"""What it says of places that an emitter was not heard from here: a careful model of detection.

At distance r and relative bearing a the signal exceeds the receiver's threshold by

    m(r, a) = M + u + G(a) - 10 n log10(r / r_0)      u ~ N(0, S^2): power, height, shadow: the same for all turns

where M is the margin at r_0 in the antenna's maximum, G <= 0 its pattern and n the path loss exponent. One chance to
hear (a pulse, or an independent stretch of a carrier) is taken with probability Phi(m / F), F the fading. Silence over
all chances k of all turns i therefore has, with the emitter sending at all with probability 1 - q,

    p(silence | x) = q + (1 - q) E_u prod_i prod_k (1 - Phi(m_ik(x, u) / F))

It is careful in two ways. u is common to all chances, so that a hundred unheard pulses are not a hundred witnesses, nor
ten turns ten; and q (switched off, its antenna in the grass, another channel) is never refuted, so that no place is
ever excluded: all silence together makes a place at most 1 / q times less likely than another.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from planner.types import FloatArray

_NODES, _HERMITE = np.polynomial.hermite_e.hermegauss(21)
_WEIGHTS = _HERMITE / _HERMITE.sum()
NEAREST_M = 1.0
_LARGEST = 8.0
LATTICE = 64
"""Points a side on which silence is computed for more places than that: over metres it hardly changes."""


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


@dataclass(frozen=True, slots=True)
class Silence:
    """A turn at (x, y), m ENU, in which the emitter was not heard.

    chances: (h,) how many there were with the antenna pointing to 2 pi k / h, rad ccw from east; 0: not listened.
    gain_db: (m,) the pattern at source direction minus antenna heading = 2 pi k / m, ccw, below its maximum (<= 0).
    """

    x: float
    y: float
    chances: tuple[float, ...]
    gain_db: tuple[float, ...]


def silence_log_likelihood(
    model: DetectionModel, silences: Sequence[Silence], x: FloatArray, y: FloatArray
) -> FloatArray:
    """Natural log of p(silence | x) at places (x, y) of any shape, m ENU; 0 where nothing could have been heard."""
    if np.size(x) > LATTICE**2:
        return _between(model, silences, x, y)
    missed = np.zeros((len(_NODES), np.size(x)))
    for one in silences:
        missed += _log_missed(model, one, np.ravel(x), np.ravel(y))
    heard = _WEIGHTS @ -np.expm1(missed)
    return np.asarray(np.log1p(-(1.0 - model.never) * heard), dtype=np.float64).reshape(np.shape(x))


def _log_missed(model: DetectionModel, one: Silence, x: FloatArray, y: FloatArray) -> FloatArray:
    """(u, c) logarithm of the probability that all chances of a turn were missed, for each u and place."""
    chances, gain_db = np.array(one.chances), np.array(one.gain_db)
    off_x, off_y = x - one.x, y - one.y
    distance = np.maximum(np.hypot(off_x, off_y), NEAREST_M)
    loss_db = 10.0 * model.exponent * np.log10(distance / model.reference_m)
    heading = np.flatnonzero(chances > 0.0)
    turned = 2.0 * math.pi * heading / chances.size
    relative = (np.arctan2(off_y, off_x)[:, None] - turned[None, :]) / (2.0 * math.pi) % 1.0
    gain = gain_db[np.rint(relative * gain_db.size).astype(np.int64) % gain_db.size]
    margin = model.margin_db + gain - loss_db[:, None]
    return np.array(
        [
            np.log(_normal_tail((margin + node * model.spread_db) / model.fading_db)) @ chances[heading]
            for node in _NODES
        ]
    )


def _between(model: DetectionModel, silences: Sequence[Silence], x: FloatArray, y: FloatArray) -> FloatArray:
    """Linear between the points of a lattice over the places' rectangle."""
    from scipy.ndimage import map_coordinates  # loaded by the first silence, not by every start

    sides = [np.linspace(float(np.min(along)), float(np.max(along)), LATTICE) for along in (x, y)]
    on = silence_log_likelihood(model, silences, *np.meshgrid(*sides))
    at = [
        (along - side[0]) / max(float(side[-1] - side[0]), NEAREST_M) * (LATTICE - 1)
        for along, side in zip((y, x), reversed(sides), strict=True)
    ]
    return np.asarray(map_coordinates(on, at, order=1, mode="nearest"), dtype=np.float64)


def _normal_tail(z: FloatArray) -> FloatArray:
    """1 - Phi(z), not under that of 8 standard deviations."""
    from scipy.special import ndtr  # loaded by the first silence, not by every start

    return np.asarray(ndtr(-np.minimum(z, _LARGEST)), dtype=np.float64)
