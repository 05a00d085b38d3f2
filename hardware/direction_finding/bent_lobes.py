"""A lobe bent by a Gaussian process: how likely a turn is where its shape is known on average and not in detail.

    m_i = L + M(b - h_i) + s(b - h_i) z(h_i) + w_i,        z a stationary process of variance 1, w_i ~ N(0, e^2)

(Rasmussen & Williams 2006, ch. 2). With z a sum of few harmonics of the turn, z(h) = sum_q c_q W_q(h), c_q ~ N(0, 1), a
bearing costs an eigenproblem of their number. The level is integrated out flat, and so is the noise, about 1 dB. Near
the receiver's floor the wave is a share of the power only, and bends it by as much.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hardware.direction_finding.slices import LOG_NOISE_PRIOR, NOISE_DB, Slices, log_sum
from hardware.direction_finding.sweep import BIN_DEG, BINS

_LEAST_HARMONIC = 2e-4
"""Of the process' variance: what less makes is left out."""
_DB = 10.0 / math.log(10.0)


@dataclass(frozen=True, slots=True)
class BentLobes:
    """Some lobes, every 2 degrees of x = bearing - heading. mean_db, spread_db: (v, 180) M and s. waves: (180, q) W."""

    mean_db: NDArray[np.float64]
    spread_db: NDArray[np.float64]
    waves: NDArray[np.float64]


def waves_of(spectrum: NDArray[np.float64]) -> NDArray[np.float64]:
    """(180, q) the process' harmonics. spectrum: (m,) power of its orders 0, 1, .., of any scale."""
    power = np.where(np.arange(spectrum.size) == 0, spectrum, 2.0 * spectrum)
    power = power / power.sum()
    order = np.flatnonzero(power > _LEAST_HARMONIC)
    angle = np.outer(np.arange(BINS) * math.radians(BIN_DEG), order)
    waves = np.concatenate([np.cos(angle), np.sin(angle[:, order > 0])], axis=1)
    return waves * np.sqrt(np.concatenate([power[order], power[order[order > 0]]]))


def log_evidence(
    lobes: BentLobes, slices: Slices, bearing_deg: NDArray[np.float64], level_db: float, noise_db: float | None
) -> NDArray[np.float64]:
    """(v, j): of each lobe from (j,) bearings, its bending, level (flat) and noise (log-normal) integrated out.

    level_db: the wave's power where the antenna is strongest, roughly; noise_db: the receiver's floor, None: unknown.
    """
    place = np.rint((np.subtract.outer(bearing_deg, slices.heading_deg) % 360.0) / BIN_DEG).astype(np.int64) % BINS
    wave = 10.0 ** ((level_db + lobes.mean_db[:, place]) / 10.0)
    total = wave if noise_db is None else wave + 10.0 ** (noise_db / 10.0)
    share = wave / total
    count, harmonics = place.shape[1], lobes.waves.shape[1]
    norm = np.sum(share**2, axis=-1)
    residual = slices.power_db - _DB * np.log(total)
    bends = lobes.waves[place] * (lobes.spread_db[:, place] * share)[..., None]
    # what a change of level explains is taken out of both
    residual = residual - share * (np.sum(share * residual, axis=-1) / norm)[..., None]
    by_level = np.matmul(share[..., None, :], bends) / norm[..., None, None]
    bends = bends - share[..., None] * by_level
    turned = np.swapaxes(bends, -1, -2)
    variance, axes = np.linalg.eigh(turned @ bends)
    along = np.matmul(np.matmul(residual[..., None, :], bends), axes)[..., 0, :] ** 2
    explained = np.where(variance > 1e-6, along / np.maximum(variance, 1e-6), 0.0)
    rest = np.maximum(np.sum(residual**2, axis=-1) - explained.sum(axis=-1), 0.0)[..., None]
    noise = NOISE_DB**2
    spread = np.maximum(variance, 0.0)[..., None, :] + noise[:, None]
    squares = np.sum(explained[..., None, :] / spread, axis=-1) + rest / noise
    volume = np.sum(np.log(spread), axis=-1) + (count - 1 - harmonics) * np.log(noise)
    log_likelihood = -0.5 * (squares + volume + np.log(norm / count)[..., None])
    return log_sum(log_likelihood + LOG_NOISE_PRIOR, axis=-1)
