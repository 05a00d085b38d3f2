"""Whether a sweep was heard with the antenna that was measured, and what it tells when it was not.

Two hypotheses of the same slices of 10 degrees, m_i in decibels, noise of unknown scale e in all of them:

    the pattern's antenna    m_i = L + T_k(b - h_i) + w_i,                    T_k: the shapes of alternatives.py
                             m_i = L + T_0(b - h_i) + g(b - h_i) + w_i        where no shape is quite right
    another antenna          m_i = L - d_v(b - h_i) + g(b - h_i) + w_i,       w_i ~ N(0, e^2)

d_v(x) = D (1 - exp(-12 (x / v)^2 / D)) is a lobe of 3 dB width v that is D = 14 dB deep all around; g is how any real
antenna differs from it: a Gaussian process (Rasmussen & Williams 2006, eq. 2.22) with a correlation of 20 degrees whose
standard deviation grows from 0.7 dB in the lobe to 4 dB beside it: an antenna's main lobe is like another's, its side
lobes are not. Each hypothesis' evidence integrates over bearing, shape, level (flat) and noise (log-normal about 1 dB):

    p(m) = sum_e p(e) int dL N(m; mean + L, C + e^2 I)                        (level profiled: eq. 2.43)

A right pattern is much the better forecast of its own sweeps; one sweep of 16 slices mostly sets an antenna with other
side lobes apart from it, one of 36 slices always. What no sweep shows is a pattern that is merely turned (squint).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hardware.direction_finding.alternatives import Alternatives
from hardware.direction_finding.sweep import BIN_DEG, BINS, BinnedSweep

SLICES = 36
FEWEST_SLICES = 8
WIDTHS_DEG = (50.0, 70.0, 95.0, 125.0)
DEPTH_DB = 14.0
LOBE_DB = 0.7
BESIDE_DB = 4.0
ALIKE_DEG = 20.0
REACH_DEG = 60.0
STEP_DEG = 5.0
KNOWN_REACH_DEG = 40.0
AXIS_WITHIN_DEG = 10.0
FITS_DB = 0.8
"""A sweep that some shape of the pattern fits so well needs no other antenna."""
_NOISE_DB = np.array([0.3, 0.5, 0.7, 1.0, 1.4, 2.0, 2.8, 4.0])
_NOISE_SPREAD = 0.5
"""Of the noise's natural logarithm about 1 dB."""
_NOISE_WEIGHTS = np.exp(-0.5 * (np.log(_NOISE_DB) / _NOISE_SPREAD) ** 2)
_LOG_NOISE_PRIOR = np.log(_NOISE_WEIGHTS / _NOISE_WEIGHTS.sum())
_PER_SLICE = BINS // SLICES
_OFF_DEG = (BIN_DEG * np.arange(BINS) + 180.0) % 360.0 - 180.0
_LOBES_DB = DEPTH_DB * (1.0 - np.exp(-12.0 * (_OFF_DEG / np.array(WIDTHS_DEG)[:, None]) ** 2 / DEPTH_DB))


@dataclass(frozen=True, slots=True)
class OtherAntenna:
    """log_odds: of another antenna to the pattern's, before any prior. bearing_deg, sigma_deg: with another antenna.

    off_deg, log_density: (j,) the bearing's posterior with another antenna, off_deg from bearing_deg.
    """

    log_odds: float
    bearing_deg: float
    sigma_deg: float
    off_deg: NDArray[np.float64]
    log_density: NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class _Slices:
    """heading_deg, power_db: (n,) means. smooth: the slices are 10 degrees of several bins each."""

    heading_deg: NDArray[np.float64]
    power_db: NDArray[np.float64]
    smooth: bool


def other_antenna(
    alternatives: Alternatives,
    binned: BinnedSweep,
    near_deg: float,
    level_db: float,
    fitted_db: NDArray[np.float64],
    noise_db: float | None,
) -> OtherAntenna | None:
    """None where the pattern fits too well, or too little was heard, for the question to arise.

    near_deg: the bearing found with the pattern. level_db: the wave's power there at the antenna's maximum.
    fitted_db: (180,) the likeliest shape of the pattern.
    """
    slices = _slices(binned, binned.power_db)
    if slices.heading_deg.size < FEWEST_SLICES:
        return None
    residual_db = slices.power_db - _slices(binned, fitted_db).power_db
    if float(np.sqrt(np.mean(residual_db**2))) < FITS_DB:
        return None
    reach: NDArray[np.float64] = np.arange(-KNOWN_REACH_DEG, KNOWN_REACH_DEG + 0.1, STEP_DEG)
    own_db = -10.0 * np.log10(_box(alternatives.power[:1]) if slices.smooth else alternatives.power[:1])[0]
    disturbed = _with_deviation(slices, near_deg + reach, own_db[None, :], level_db, noise_db)
    known = np.logaddexp(
        _known(alternatives, slices, near_deg, level_db, noise_db),
        _log_sum(disturbed.ravel()) - math.log(disturbed.size),
    )
    strongest = float(slices.heading_deg[int(np.argmax(slices.power_db))])
    bearing = strongest + np.arange(-REACH_DEG, REACH_DEG + 0.1, STEP_DEG)
    score = _with_deviation(slices, bearing, _LOBES_DB, level_db, noise_db)
    evidence = _log_sum(score.ravel()) - math.log(score.size)
    log_density = _log_sum(score, axis=0)
    mass = np.exp(log_density - log_density.max())
    mass /= mass.sum()
    mean = float(mass @ bearing)
    # half way to the principal axis, which errs otherwise: strong readings only, and no lobe's shape at all
    axis = (_principal_axis_deg(slices, noise_db) - mean + 180.0) % 360.0 - 180.0
    mean += 0.5 * min(max(axis, -AXIS_WITHIN_DEG), AXIS_WITHIN_DEG)
    sigma = math.hypot(math.sqrt(float(mass @ (bearing - mean) ** 2)), STEP_DEG / math.sqrt(12.0))
    return OtherAntenna(float(evidence - known), mean % 360.0, sigma, bearing - mean, log_density)


def _principal_axis_deg(slices: _Slices, noise_db: float | None) -> float:
    """First principal component of the linear powers as vectors, not centred, towards their sum."""
    top_db = float(slices.power_db.max())
    noise = 0.0 if noise_db is None else 10.0 ** ((noise_db - top_db) / 10.0)
    power = np.maximum(10.0 ** ((slices.power_db - top_db) / 10.0) - noise, 0.0)
    heading = np.radians(slices.heading_deg)
    vectors = power[:, None] * np.column_stack([np.sin(heading), np.cos(heading)])
    axis = np.linalg.eigh(vectors.T @ vectors)[1][:, -1]
    east, north = axis if float(vectors.sum(axis=0) @ axis) >= 0.0 else -axis
    return math.degrees(math.atan2(east, north)) % 360.0


def _slices(binned: BinnedSweep, bin_db: NDArray[np.float64]) -> _Slices:
    filled = binned.filled
    if int(filled.sum()) <= SLICES:
        return _Slices(binned.heading_deg[filled], bin_db[filled], smooth=False)
    owner = np.arange(BINS)[filled] // _PER_SLICE
    count = np.bincount(owner, minlength=SLICES)
    kept = count > 0
    heading = np.bincount(owner, binned.heading_deg[filled], SLICES)[kept] / count[kept]
    return _Slices(heading, np.bincount(owner, bin_db[filled], SLICES)[kept] / count[kept], smooth=True)


def _known(
    alternatives: Alternatives, slices: _Slices, near_deg: float, level_db: float, noise_db: float | None
) -> float:
    """Log evidence of the pattern's likeliest kind of shape."""
    power = alternatives.power * 10.0 ** (level_db / 10.0)
    total = power if noise_db is None else power + 10.0 ** (noise_db / 10.0)
    db, share = 10.0 * np.log10(total), power / total
    if slices.smooth:
        db, share = _box(db), _box(share)
    bearing: NDArray[np.float64] = near_deg + BIN_DEG * np.arange(
        -KNOWN_REACH_DEG // BIN_DEG, KNOWN_REACH_DEG // BIN_DEG + 1
    )
    count = slices.heading_deg.size
    squares = np.empty((db.shape[0], bearing.size))
    norm = np.empty_like(squares)
    for j, b in enumerate(bearing):
        at = ((b - slices.heading_deg) % 360.0) / BIN_DEG
        low = np.floor(at).astype(np.int64) % BINS
        part = at - np.floor(at)
        high = (low + 1) % BINS
        residual = slices.power_db - (db[:, low] * (1.0 - part) + db[:, high] * part)
        by = share[:, low] * (1.0 - part) + share[:, high] * part
        norm[:, j] = np.sum(by**2, axis=1)
        # the level profiled out: |r|^2 - (s' r)^2 / |s|^2
        squares[:, j] = np.sum(residual**2, axis=1) - np.sum(by * residual, axis=1) ** 2 / norm[:, j]
    log_likelihood = _log_sum(
        -squares[..., None] / (2.0 * _NOISE_DB**2) - (count - 1) * np.log(_NOISE_DB) + _LOG_NOISE_PRIOR, axis=-1
    ) - 0.5 * np.log(norm / count)
    kinds = [log_likelihood[alternatives.kind == kind] for kind in np.unique(alternatives.kind)]
    best = max(_log_sum(part.ravel()) - math.log(len(part)) - math.log(bearing.size) for part in kinds)
    return float(best)


def _with_deviation(
    slices: _Slices,
    bearing_deg: NDArray[np.float64],
    lobe_db: NDArray[np.float64],
    level_db: float,
    noise_db: float | None,
) -> NDArray[np.float64]:
    """(v, j) log likelihood of the slices for each lobe and bearing, deviation, level and noise integrated out.

    lobe_db: (v, 180) how far below the maximum each lobe is, every 2 degrees.
    """
    place = np.rint((np.subtract.outer(bearing_deg, slices.heading_deg) % 360.0) / BIN_DEG).astype(np.int64) % BINS
    depth = lobe_db[:, place]
    wave = 10.0 ** ((level_db - depth) / 10.0)
    total = wave if noise_db is None else wave + 10.0 ** (noise_db / 10.0)
    share = wave / total
    spread = (LOBE_DB + (BESIDE_DB - LOBE_DB) * np.minimum(depth / DEPTH_DB, 1.0)) * share
    apart = (np.subtract.outer(slices.heading_deg, slices.heading_deg) + 180.0) % 360.0 - 180.0
    kernel = np.exp(-0.5 * (apart / ALIKE_DEG) ** 2)
    variance, axes = np.linalg.eigh(kernel * spread[..., :, None] * spread[..., None, :])
    residual = np.einsum("vjnk,vjn->vjk", axes, slices.power_db - 10.0 * np.log10(total))
    by = np.einsum("vjnk,vjn->vjk", axes, share)
    inverse = 1.0 / (np.maximum(variance, 0.0)[..., None, :] + _NOISE_DB[:, None] ** 2)
    along = np.sum(by[..., None, :] * residual[..., None, :] * inverse, axis=-1)
    norm = np.sum(by[..., None, :] ** 2 * inverse, axis=-1)
    squares = np.sum(residual[..., None, :] ** 2 * inverse, axis=-1) - along**2 / norm
    log_likelihood = -0.5 * squares + 0.5 * np.sum(np.log(inverse), axis=-1)
    return _log_sum(log_likelihood - 0.5 * np.log(norm / place.shape[1]) + _LOG_NOISE_PRIOR, axis=-1)


def _box(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """(k, 180) means over a slice around each place, circular."""
    half = _PER_SLICE // 2
    return np.mean([np.roll(values, shift, axis=1) for shift in range(-half, half + 1)], axis=0)


def _log_sum(values: NDArray[np.float64], axis: int | None = None) -> NDArray[np.float64]:
    """log sum exp along an axis, or of all."""
    top = np.max(values, axis=axis, keepdims=True)
    total = np.log(np.sum(np.exp(values - top), axis=axis, keepdims=True)) + top
    return np.asarray(np.squeeze(total, axis=axis), dtype=np.float64)
