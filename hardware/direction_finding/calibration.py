"""Antenna calibration from a flight around an emitter at a known place, and the pre-flight check against one."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hardware.direction_finding.antenna import AntennaPattern
from hardware.direction_finding.estimate import SparseDirectionFinder, unusable
from hardware.direction_finding.pattern_file import PatternError, make_pattern
from hardware.direction_finding.sweep import bin_sweep
from hardware.frame import LocalFrame
from hardware.readings import Place, PreflightCheck, Sweep
from hardware.reasons.antenna import (
    AntennaAgrees,
    AntennaAskew,
    AntennaDead,
    AntennaReason,
    AntennaUnlikePattern,
    EmitterTooNear,
    TooFewSamples,
)
from hardware.reasons.pattern import PatternReason
from hardware.reasons.sweep import Overdriven, SweepReason
from planner.reason import ReasonedError

STEP_DEG = 5.0
FEWEST_SAMPLES = 72
"""One a step, all the way round."""
NEAREST_M = 15.0
"""Nearer to the emitter its direction is too uncertain (a metre of GPS error is four degrees)."""
POINTING_FLOOR_DEG = 1.0
FEW_SWEEPS_POINTING_DEG = 3.0
"""Fewer than three sweeps do not show by how much each points elsewhere."""
WORN_OFF_DB = 6.0
ALLOWED_OFFSET_DEG = 10.0
DEAD_RANGE_DB = 4.0


class CalibrationError(ReasonedError):
    """The flight gives no pattern."""

    def __init__(self, reason: EmitterTooNear | Overdriven | TooFewSamples | PatternReason) -> None:
        super().__init__(reason)


@dataclass(frozen=True, slots=True)
class Calibration:
    """pattern: with its offset to the nose. residual_db: RMS of the samples about it. sweeps, samples: used."""

    pattern: AntennaPattern
    residual_db: float
    sweeps: int
    samples: int


def true_bearing_deg(place: Place, target: Place) -> tuple[float, float]:
    """(degrees clockwise from true north, distance in metres) from `place` to `target`."""
    east, north = LocalFrame(place).to_enu(target)
    return math.degrees(math.atan2(east, north)) % 360.0, math.hypot(east, north)


def calibrate(sweeps: Sequence[Sweep], emitter: Place, name: str, polarization: str | None = None) -> Calibration:
    """The pattern that the sweeps show, each at its own level (distance). Raises CalibrationError.

    A sample at heading h of an emitter at bearing b shows the gain at b - h right of the nose. Pattern (every 5
    degrees) and levels are fitted in turn by least squares until they settle; the antenna's front is the lobe's middle.
    """
    angles: list[NDArray[np.float64]] = []
    powers: list[NDArray[np.float64]] = []
    for sweep in sweeps:
        bearing, distance = true_bearing_deg(sweep.position, emitter)
        if distance < NEAREST_M:
            raise CalibrationError(EmitterTooNear(distance, NEAREST_M))
        good = np.isfinite(sweep.heading_deg) & np.isfinite(sweep.power_db)
        if sweep.clipped_samples > 0.05 * max(sweep.power_db.size, 1):
            raise CalibrationError(Overdriven(sweep.clipped_samples, sweep.power_db.size))
        angles.append((bearing - sweep.heading_deg[good]) % 360.0)
        powers.append(sweep.power_db[good])
    samples = sum(a.size for a in angles)
    if samples < FEWEST_SAMPLES:
        raise CalibrationError(TooFewSamples(samples, FEWEST_SAMPLES))
    angle, power = np.concatenate(angles), np.concatenate(powers)
    owner = np.repeat(np.arange(len(angles)), [a.size for a in angles])
    cells = round(360.0 / STEP_DEG)
    cell = np.round(angle / STEP_DEG).astype(np.int64) % cells
    count = np.bincount(cell, minlength=cells)
    level = np.array([np.median(p) for p in powers])
    gain = np.zeros(cells)
    for _ in range(50):
        with np.errstate(invalid="ignore"):
            gain = np.bincount(cell, power - level[owner], cells) / count
        update = np.bincount(owner, power - gain[cell]) / np.bincount(owner)
        settled = float(np.max(np.abs(update - level))) < 1e-4
        level = update
        if settled:
            break
    heard = count > 0
    relative: NDArray[np.float64] = np.linspace(0.0, 360.0, cells, endpoint=False)[heard]
    residual = float(np.sqrt(np.mean((power - level[owner] - gain[cell]) ** 2)))
    offset = _front_deg(relative, gain[heard])
    try:
        pattern = make_pattern(
            name,
            (relative - offset) % 360.0,
            gain[heard] - np.max(gain[heard]),
            (offset + 180.0) % 360.0 - 180.0,
            float(np.median([s.frequency_hz for s in sweeps])) or None,
            polarization,
            pointing_sigma_deg=_pointing_sigma_deg(relative, gain[heard], angles, powers),
        )
    except PatternError as error:
        raise CalibrationError(error.reason) from error
    return Calibration(pattern, residual, len(angles), samples)


def _pointing_sigma_deg(
    relative_deg: NDArray[np.float64],
    gain_db: NDArray[np.float64],
    angles_deg: list[NDArray[np.float64]],
    powers_db: list[NDArray[np.float64]],
) -> float:
    """How far the sweeps point beside the pattern they make together, standard deviation: by least squares each."""
    if len(angles_deg) < 3:
        return FEW_SWEEPS_POINTING_DEG
    shift = np.arange(-30.0, 30.1, 0.5)
    beside: list[float] = []
    for angle, power in zip(angles_deg, powers_db, strict=True):
        residual = power - np.interp(np.add.outer(shift, angle), relative_deg, gain_db, period=360.0)
        beside.append(float(shift[int(np.argmin(np.var(residual, axis=1)))]))
    return max(float(np.std(beside, ddof=1)), POINTING_FLOOR_DEG)


def _front_deg(relative_deg: NDArray[np.float64], gain_db: NDArray[np.float64]) -> float:
    """Middle of the main lobe: mean direction of the linear power within 6 dB of the maximum and 60 degrees of it."""
    top = float(relative_deg[int(np.argmax(gain_db))])
    off = (relative_deg - top + 180.0) % 360.0 - 180.0
    lobe = (gain_db > gain_db.max() - WORN_OFF_DB) & (np.abs(off) <= 60.0)
    weight = 10.0 ** (gain_db[lobe] / 10.0)
    return (top + float(off[lobe] @ weight / weight.sum())) % 360.0


def check_antenna(
    sweep: Sweep, pattern: AntennaPattern, emitter: Place, finder: SparseDirectionFinder | None = None
) -> PreflightCheck:
    """One sweep near an emitter at a known place tells whether antenna, pattern and offset belong together."""
    found = _judged(sweep, pattern, emitter, finder or SparseDirectionFinder())
    return PreflightCheck("antenna", isinstance(found, AntennaAgrees), found)


def _judged(
    sweep: Sweep, pattern: AntennaPattern, emitter: Place, finder: SparseDirectionFinder
) -> AntennaReason | SweepReason:
    truth, distance = true_bearing_deg(sweep.position, emitter)
    if distance < NEAREST_M:
        return EmitterTooNear(distance, NEAREST_M)
    binned = bin_sweep(sweep.heading_deg, sweep.power_db, pattern.offset_to_nose_deg)
    unable = unusable(sweep, binned)
    if unable is not None:
        return unable
    db = binned.power_db[binned.filled]
    spread = float(np.percentile(db, 95) - np.percentile(db, 5))
    expected = float(np.ptp(pattern.gain_db))
    if spread < min(DEAD_RANGE_DB, 0.5 * expected):
        return AntennaDead(spread, expected)
    reading = finder.estimate(sweep, pattern)
    if reading.reason is not None:
        return AntennaUnlikePattern(reading.reason)
    error = (truth - reading.bearing_deg + 180.0) % 360.0 - 180.0
    if abs(error) > max(ALLOWED_OFFSET_DEG, 3.0 * reading.sigma_deg):
        right = (pattern.offset_to_nose_deg + error + 180.0) % 360.0 - 180.0
        return AntennaAskew(truth, reading.bearing_deg, right)
    return AntennaAgrees(reading.bearing_deg, truth, reading.quality)
