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
from hardware.direction_finding.bent_lobes import BentLobes, log_evidence, waves_of
from hardware.direction_finding.shape_fit import BearingGrid, Templates, box
from hardware.direction_finding.slices import (
    LOG_NOISE_PRIOR,
    NOISE_DB,
    PER_SLICE,
    Slices,
    log_sum,
    slices_of,
)
from hardware.direction_finding.sweep import BIN_DEG, BINS, BinnedSweep

WIDTHS_DEG = (50.0, 70.0, 95.0, 125.0)
DEPTH_DB = 14.0
LOBE_DB = 0.7
BESIDE_DB = 4.0
ALIKE_DEG = 20.0
REACH_DEG = 60.0
STEP_DEG = 5.0
KNOWN_REACH_DEG = 40.0
AXIS_WITHIN_DEG = 10.0
_OFF_DEG = (BIN_DEG * np.arange(BINS) + 180.0) % 360.0 - 180.0
_LOBES_DB = DEPTH_DB * (1.0 - np.exp(-12.0 * (_OFF_DEG / np.array(WIDTHS_DEG)[:, None]) ** 2 / DEPTH_DB))
# exp(-(d / a)^2 / 2) has the Fourier coefficients exp(-(n a)^2 / 2)
_WAVES = waves_of(np.exp(-0.5 * (np.arange(BINS // 2) * math.radians(ALIKE_DEG)) ** 2))


def _bent(depth_db: NDArray[np.float64]) -> BentLobes:
    """depth_db: (v, 180) how far below the maximum each lobe is, every 2 degrees."""
    return BentLobes(-depth_db, LOBE_DB + (BESIDE_DB - LOBE_DB) * np.minimum(depth_db / DEPTH_DB, 1.0), _WAVES)


_OTHERS = _bent(_LOBES_DB)


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


def left_over_db(slices: Slices, binned: BinnedSweep, fitted_db: NDArray[np.float64]) -> float:
    """Root mean square of what fitted_db (180,), the pattern's likeliest shape, leaves of the binned sweep's slices."""
    return float(np.sqrt(np.mean((slices.power_db - slices_of(binned, fitted_db).power_db) ** 2)))


def known_antenna(
    alternatives: Alternatives, slices: Slices, near_deg: float, level_db: float, noise_db: float | None
) -> float:
    """Log evidence of the pattern's antenna, whatever its shape, a little disturbed or not.

    near_deg: the bearing found with the pattern. level_db: the wave's power there at the antenna's maximum.
    """
    reach: NDArray[np.float64] = np.arange(-KNOWN_REACH_DEG, KNOWN_REACH_DEG + 0.1, STEP_DEG)
    own = alternatives.power[:1]
    own_db = -10.0 * np.log10(box(own, PER_SLICE) if slices.smooth else own)
    disturbed = log_evidence(_bent(own_db), slices, near_deg + reach, level_db, noise_db)
    return float(
        np.logaddexp(
            _known(alternatives, slices, near_deg, level_db, noise_db),
            log_sum(disturbed.ravel()) - math.log(disturbed.size),
        )
    )


def other_antenna(slices: Slices, level_db: float, noise_db: float | None, known: float) -> OtherAntenna:
    """known: log evidence of the pattern's antenna. level_db: as there."""
    strongest = float(slices.heading_deg[int(np.argmax(slices.power_db))])
    bearing = strongest + np.arange(-REACH_DEG, REACH_DEG + 0.1, STEP_DEG)
    score = log_evidence(_OTHERS, slices, bearing, level_db, noise_db)
    evidence = log_sum(score.ravel()) - math.log(score.size)
    log_density = log_sum(score, axis=0)
    mass = np.exp(log_density - log_density.max())
    mass /= mass.sum()
    mean = float(mass @ bearing)
    # half way to the principal axis, which errs otherwise: strong readings only, and no lobe's shape at all
    axis = (_principal_axis_deg(slices, noise_db) - mean + 180.0) % 360.0 - 180.0
    mean += 0.5 * min(max(axis, -AXIS_WITHIN_DEG), AXIS_WITHIN_DEG)
    sigma = math.hypot(math.sqrt(float(mass @ (bearing - mean) ** 2)), STEP_DEG / math.sqrt(12.0))
    return OtherAntenna(float(evidence - known), mean % 360.0, sigma, bearing - mean, log_density)


def _principal_axis_deg(slices: Slices, noise_db: float | None) -> float:
    """First principal component of the linear powers as vectors, not centred, towards their sum."""
    top_db = float(slices.power_db.max())
    noise = 0.0 if noise_db is None else 10.0 ** ((noise_db - top_db) / 10.0)
    power = np.maximum(10.0 ** ((slices.power_db - top_db) / 10.0) - noise, 0.0)
    heading = np.radians(slices.heading_deg)
    vectors = power[:, None] * np.column_stack([np.sin(heading), np.cos(heading)])
    axis = np.linalg.eigh(vectors.T @ vectors)[1][:, -1]
    east, north = axis if float(vectors.sum(axis=0) @ axis) >= 0.0 else -axis
    return math.degrees(math.atan2(east, north)) % 360.0


def _known(
    alternatives: Alternatives, slices: Slices, near_deg: float, level_db: float, noise_db: float | None
) -> float:
    """Log evidence of the pattern's likeliest kind of shape."""
    templates = Templates(alternatives, level_db, noise_db)
    if slices.smooth:
        templates = templates.smoothed(PER_SLICE)
    bearing: NDArray[np.float64] = near_deg + BIN_DEG * np.arange(
        -KNOWN_REACH_DEG // BIN_DEG, KNOWN_REACH_DEG // BIN_DEG + 1
    )
    grid = BearingGrid(bearing, slices.heading_deg, slices.power_db)
    even, count = np.ones(grid.size), grid.size
    squares, norm = grid.cost(templates, even), grid.norm(templates, even)
    log_likelihood = log_sum(
        -squares[..., None] / (2.0 * NOISE_DB**2) - (count - 1) * np.log(NOISE_DB) + LOG_NOISE_PRIOR, axis=-1
    ) - 0.5 * np.log(norm / count)
    weighed = log_likelihood + alternatives.log_prior[:, None]
    kinds = [alternatives.kind == kind for kind in np.unique(alternatives.kind)]
    best = max(log_sum(weighed[own].ravel()) - log_sum(alternatives.log_prior[own]) for own in kinds)
    return float(best) - math.log(bearing.size)
