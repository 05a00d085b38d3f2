"""What is recorded of a sweep, whoever took it: its bearing, or why it has none."""

from __future__ import annotations

import math
from dataclasses import dataclass
from uuid import uuid4

import numpy as np

from backend.events import BearingMeasured, BearingSource, Peak, SilenceFact, SweepRejected, TurnFact
from backend.reasons import Reason
from backend.reasons.search import QualityTooLow, SweepIncomplete, SweepValue
from backend.spec import Place, SensorSpec
from hardware.readings import BearingReading, Sweep
from hardware.reasons.sweep import NothingAboveNoise

BINS = 180
DB_DIGITS = 2
"""Of the powers kept beside a bearing: far below what a receiver resolves. The samples keep all their digits."""


@dataclass(frozen=True, slots=True)
class Taken:
    """Which sweep it is. place_number counts places from 1, attempt the turns at one. turn: None: once all the way
    round."""

    emitter_id: str
    source: BearingSource
    sweep_id: str
    place_number: int
    attempt: int
    turn: TurnFact | None = None


def sweep_fact(
    taken: Taken,
    sensor: SensorSpec,
    sweep: Sweep,
    reading: BearingReading,
    measurement_time_s: float | None,
    taken_at_s: float | None = None,
    silence: SilenceFact | None = None,
) -> BearingMeasured | SweepRejected:
    """measurement_time_s None: nobody waited for it. taken_at_s: UTC epoch seconds of the middle of the turn. silence:
    what it tells if nothing was above the noise."""
    binned, fitted = _bins(reading.binned_db), _bins(reading.fitted_db)
    needed: tuple[tuple[SweepValue, float], ...] = (
        ("bearing", reading.bearing_deg),
        ("sigma", reading.sigma_deg),
        ("quality", reading.quality),
        ("altitude", sweep.altitude_amsl_m),
        ("drift", sweep.drift_m),
    )
    unknown: tuple[SweepValue, ...] = tuple(name for name, value in needed if not math.isfinite(value))
    if unknown:
        quality = reading.quality if math.isfinite(reading.quality) else 0.0
        return rejected(taken, sweep.position, quality, SweepIncomplete(unknown), binned, fitted)
    if not reading.accepted or reading.quality < sensor.minimum_quality:
        low = QualityTooLow(reading.quality, sensor.minimum_quality)
        reason = low if reading.reason is None else reading.reason
        told = silence if isinstance(reading.reason, NothingAboveNoise) else None
        return rejected(taken, sweep.position, reading.quality, reason, binned, fitted, reading.likelihood, told)
    return BearingMeasured(
        emitter_id=taken.emitter_id,
        source=taken.source,
        bearing_id=str(uuid4()),
        sweep_id=taken.sweep_id,
        place_number=taken.place_number,
        place=sweep.position,
        altitude_amsl_m=sweep.altitude_amsl_m,
        bearing_deg=reading.bearing_deg,
        sigma_deg=reading.sigma_deg,
        quality=reading.quality,
        peaks=[Peak(bearing_deg=p.bearing_deg, weight=p.weight) for p in reading.peaks],
        snr_db=reading.snr_db,
        drift_m=sweep.drift_m,
        binned_db=binned,
        fitted_db=fitted,
        measurement_time_s=measurement_time_s,
        heading_sigma_deg=reading.heading_sigma_deg,
        pattern_sigma_deg=reading.pattern_sigma_deg,
        remarks=list(reading.remarks),
        likelihood=reading.likelihood,
        samples_without_heading=sweep.samples_without_heading,
        taken_at_s=taken_at_s,
        turn=taken.turn,
    )


def rejected(
    taken: Taken,
    place: Place,
    quality: float,
    reason: Reason,
    binned_db: list[float | None] | None = None,
    fitted_db: list[float | None] | None = None,
    likelihood: str | None = None,
    silence: SilenceFact | None = None,
) -> SweepRejected:
    """binned_db, fitted_db: (180,) dB, None for a sweep that never got that far. likelihood: packed."""
    nothing: list[float | None] = [None] * BINS
    return SweepRejected(
        emitter_id=taken.emitter_id,
        source=taken.source,
        sweep_id=taken.sweep_id,
        place_number=taken.place_number,
        attempt=taken.attempt,
        quality=quality,
        reason=reason,
        place=place,
        binned_db=nothing if binned_db is None else binned_db,
        fitted_db=nothing if fitted_db is None else fitted_db,
        likelihood=likelihood,
        silence=silence,
        turn=taken.turn,
    )


def _bins(values: np.ndarray) -> list[float | None]:
    return [round(float(v), DB_DIGITS) if math.isfinite(v) else None for v in values]
