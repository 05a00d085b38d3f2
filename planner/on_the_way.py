"""What readings that were taken in flight say of places: stretches of way, each with a power of its own.

Reading i of a stretch was taken at (x_i, y_i) with the antenna's front towards a_i by the craft's compass, whose
bearings are turned by b. An emitter at (x, y) is seen from there in direction d_i at distance r_i:

    p_i = L + G(d_i + b - a_i) - 20 log10 r_i + w_i,    w_i ~ N(0, t^2 v_i),    t^2 ~ s^2 scaled-inv-chi^2(4)

L, what was sent and the shadow that the stretch lies in, is unknown and marginalized, so that only the shape of the
power over direction counts; s is the scale of the source's errors. Waves from all sides fill the antenna's minima,
more the deeper they are:

    v = V_0 + (8.7 q)^2 min(10^(-G / 10), 30)    dB^2

with q the amplitude of those waves over the direct one (a small phasor's first order: 20 log10 e = 8.7 dB). Readings of
one stretch share their echoes: n of them are worth k independent ones besides that which finds L, so that their
likelihood is tempered by k / (n - 1). With weighted residuals about the weighted mean, S, and s_r^2 = S / (n - 1),
marginalizing L and t leaves, up to what is the same everywhere,

    log f = -(4 + k) / 2 log(1 + k s_r^2 / (4 s^2)) - k / (2 (n - 1)) (sum log v_i + log sum 1 / v_i)

k grows with the turn of the antenna in the stretch, one for each INDEPENDENT of it: an antenna that points one way
tells nothing. Over directions at RING_M f has a mean c; a stretch counts by f / c. Its k is lowered until no direction
has a higher f / c, with s = 1, than the bearing has that the sensor would take: N(0, sigma^2), in units of 1 / 2 pi. An
emitter nearer than NEAR_M to the way is seen from above, where the pattern holds no more: there f / c counts as 1.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from planner.types import FloatArray, IntArray

SCATTERED = 0.15
LEAST_VARIANCE = 2.0**2
"""V_0, dB^2."""
DEEPEST = 30.0
"""What lies deeper under the antenna's maximum than this power ratio is filled by other lobes' waves already."""
FREEDOM = 4.0
"""Of t^2: how well the spread of the readings is known before they are seen."""
INDEPENDENT = math.radians(50.0)
MOST_INDEPENDENT = 15.0
LEAST_INDEPENDENT = 0.2
"""A stretch that is worth less is not weighed."""
RING_M = 100.0
RING = 72
NEAR_M = 40.0
_KEPT = 1024
"""Stretches whose worth is known: a belief is weighed several times with the same ones."""
DB_PER_NEPER = 20.0 / math.log(10.0)
DIRECTIONS = 1440
"""Of the tabulated antenna, of which the nearest one counts."""


@dataclass(frozen=True, slots=True)
class Stretch:
    """x, y: (n,) m ENU. front: (n,) rad ccw from east, unwrapped, where the antenna pointed by the compass. power_db:
    (n,). gain_db: (m,) as of `planner.detection.Silence`. source: whose compass. sigma: rad, of a bearing that the
    sensor would have taken there. leg: that it is a part of."""

    source: str
    x: tuple[float, ...]
    y: tuple[float, ...]
    front: tuple[float, ...]
    power_db: tuple[float, ...]
    gain_db: tuple[float, ...]
    sigma: float
    leg: str = ""

    @property
    def turned(self) -> float:
        """rad, between the outermost directions of the antenna."""
        return max(self.front) - min(self.front)


class Heard(NamedTuple):
    """Stretches of one source as arrays. first: (k + 1,) where the readings of each begin in x, y, front, power (n,).

    gain, weight, log_variance: (k, DIRECTIONS) G dB, 1 / v, log v at relative bearings 2 pi j / DIRECTIONS ccw. worth:
    (k,) independent readings besides the level. log_mean: (k, s) log c for each scale.
    """

    first: IntArray
    x: FloatArray
    y: FloatArray
    front: FloatArray
    power: FloatArray
    gain: FloatArray
    weight: FloatArray
    log_variance: FloatArray
    worth: FloatArray
    log_mean: FloatArray


def heard(stretches: Sequence[Stretch], scale: FloatArray) -> Heard:
    """scale: (s,) of the source's errors. Stretches that tell nothing are left out."""
    kept = [(one, worth) for one in stretches if (worth := worth_of(one)) >= LEAST_INDEPENDENT]
    found = _arrays([one for one, _ in kept], np.array([worth for _, worth in kept]), len(scale))
    for k in range(len(kept)):
        found.log_mean[k] = _log_mean(_on_ring(found, k, float(found.worth[k]), scale))
    return found


def _arrays(stretches: Sequence[Stretch], worth: FloatArray, scales: int) -> Heard:
    """log_mean: zeros."""
    gain = np.array([_tabulated(one.gain_db) for one in stretches]).reshape(len(stretches), DIRECTIONS)
    variance = variance_of(gain)
    return Heard(
        first=np.concatenate([[0], np.cumsum([len(one.x) for one in stretches])]).astype(np.int64),
        x=np.array([v for one in stretches for v in one.x]),
        y=np.array([v for one in stretches for v in one.y]),
        front=np.array([v for one in stretches for v in one.front]),
        power=np.array([v for one in stretches for v in one.power_db]),
        gain=gain,
        weight=1.0 / variance,
        log_variance=np.log(variance),
        worth=worth,
        log_mean=np.zeros((len(stretches), scales)),
    )


@lru_cache(_KEPT)
def worth_of(stretch: Stretch) -> float:
    """Independent readings besides the one that finds the level; at most what makes it as good as a bearing."""
    if len(stretch.x) < 2:
        return 0.0
    most = min(stretch.turned / INDEPENDENT, MOST_INDEPENDENT, len(stretch.x) - 1.0)
    one = _arrays([stretch], np.array([most]), 1)
    highest, low, high = math.log(math.sqrt(2.0 * math.pi) / stretch.sigma), 0.0, most

    def height(worth: float) -> float:
        on_ring = _on_ring(one, 0, worth, np.ones(1))
        return float((on_ring.max(axis=0) - _log_mean(on_ring))[0])

    if height(most) <= highest:
        return most
    for _ in range(20):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if height(middle) <= highest else (low, middle)
    return low


def variance_of(gain_db: FloatArray) -> FloatArray:
    """dB^2, of a reading in a direction with this gain below the antenna's maximum."""
    depth = 10.0 ** np.minimum(-gain_db / 10.0, math.log10(DEEPEST))
    return LEAST_VARIANCE + (DB_PER_NEPER * SCATTERED) ** 2 * depth


def log_ratio(x: FloatArray, y: FloatArray, found: Heard, bias: FloatArray, scale: FloatArray) -> FloatArray:
    """(k, c, s, b): log f / c of each stretch at places (c,) x, y, m ENU, for each scale and bias (rad)."""
    out = np.zeros((len(found.worth), len(x), len(scale), len(bias)))
    for k in range(len(found.worth)):
        out[k] = _log_density(found, k, float(found.worth[k]), x, y, bias, scale) - found.log_mean[k][:, None]
        here = slice(found.first[k], found.first[k + 1])
        off = np.hypot(x[:, None] - found.x[here], y[:, None] - found.y[here])
        out[k, off.min(axis=1) < NEAR_M] = 0.0
    return out


def _log_density(
    found: Heard, k: int, worth: float, x: FloatArray, y: FloatArray, bias: FloatArray, scale: FloatArray
) -> FloatArray:
    """(c, s, b) log f of stretch k."""
    here = slice(found.first[k], found.first[k + 1])
    off_x, off_y = x[:, None] - found.x[here], y[:, None] - found.y[here]
    relative = (np.arctan2(off_y, off_x) - found.front[here])[:, :, None] + bias
    direction = nearest(relative)
    gain, weight, log_variance = (table[k, direction] for table in (found.gain, found.weight, found.log_variance))
    rest = found.power[here][:, None] - gain + 10.0 * np.log10(off_x**2 + off_y**2)[:, :, None]
    whole = weight.sum(axis=1)
    level = (weight * rest).sum(axis=1) / whole
    square = (weight * (rest - level[:, None]) ** 2).sum(axis=1)  # S
    readings = rest.shape[1] - 1
    volume = log_variance.sum(axis=1) + np.log(whole)
    spread = worth * square / readings / FREEDOM
    fit = np.log1p(spread[:, None, :] / scale[:, None] ** 2)
    return np.asarray(-0.5 * (FREEDOM + worth) * fit - 0.5 * worth / readings * volume[:, None, :], dtype=np.float64)


def _on_ring(found: Heard, k: int, worth: float, scale: FloatArray) -> FloatArray:
    """(RING, s) log f in all directions."""
    here = slice(found.first[k], found.first[k + 1])
    angle = 2.0 * np.pi * np.arange(RING) / RING
    x = found.x[here].mean() + RING_M * np.cos(angle)
    y = found.y[here].mean() + RING_M * np.sin(angle)
    return _log_density(found, k, worth, x, y, np.zeros(1), scale)[:, :, 0]


def _log_mean(on_ring: FloatArray) -> FloatArray:
    """(s,) log of the mean over directions."""
    top = on_ring.max(axis=0)
    return np.asarray(top + np.log(np.exp(on_ring - top).mean(axis=0)), dtype=np.float64)


def _tabulated(gain_db: tuple[float, ...]) -> FloatArray:
    """(DIRECTIONS,) dB, linear between the pattern's."""
    angle = np.arange(DIRECTIONS) / DIRECTIONS
    return np.interp(angle, np.arange(len(gain_db)) / len(gain_db), np.array(gain_db), period=1.0)


def nearest(angle: FloatArray) -> IntArray:
    """The tabulated direction next to an angle, rad."""
    return np.floor(angle / (2.0 * np.pi) * DIRECTIONS + 0.5).astype(np.int64) % DIRECTIONS
