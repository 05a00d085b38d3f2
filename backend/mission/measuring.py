"""One measurement: turn once on the spot, listen, make a sweep of it, find the direction."""

from __future__ import annotations

import asyncio
import logging
import math
from dataclasses import dataclass
from uuid import uuid4

import numpy as np

from backend.events import BearingMeasured, Peak, SweepRejected
from backend.mission.equipment import Equipment
from backend.mission.listening import Listening
from backend.mission.turning import turn_and_listen
from backend.spec import MissionSpec, Place
from hardware.direction_finding.sweep import SweepError, assemble_sweep, turned_deg
from hardware.ports import ReceiverError, VehicleError
from hardware.readings import BearingReading, Sweep

log = logging.getLogger("crossfix.mission")

PROGRESS_S = 0.2
BINS = 180


@dataclass(frozen=True, slots=True)
class Measured:
    """sweep None: the power could not be made into one. fact: what to record."""

    sweep_id: str
    sweep: Sweep | None
    fact: BearingMeasured | SweepRejected


async def measure(
    equipment: Equipment, mission: MissionSpec, mission_id: str, listening: Listening, place_number: int, attempt: int
) -> Measured:
    """Raises VehicleError when the turn fails, ReceiverError when nothing was heard at all."""
    ordered_s = equipment.clock.now()
    progress = asyncio.create_task(_show_progress(equipment, mission_id, listening, place_number, ordered_s))
    try:
        began_s, ended_s = await turn_and_listen(equipment, mission, listening)
    finally:
        progress.cancel()
        await asyncio.gather(progress, return_exceptions=True)
    samples = listening.between(began_s, ended_s)
    pulsed = mission.emitter.kind == "pulsed"
    if not samples and not (pulsed and listening.state == "ok"):
        raise ReceiverError("the receiver delivered nothing during the turn; check that it is running and tuned")
    sweep_id = str(uuid4())
    telemetry = equipment.vehicle.telemetry()
    altitude_amsl_m = math.nan if telemetry.altitude_amsl_m is None else telemetry.altitude_amsl_m
    try:
        if pulsed and not any(sample.detected for sample in samples):
            raise SweepError(
                "no pulse of the tag was heard in any direction",
                "switch it on, or measure nearer to it",
            )
        sweep = assemble_sweep(
            [sample for sample in samples if sample.detected],
            equipment.vehicle.headings(began_s - 1.0),
            frequency_hz=mission.emitter.frequency_hz,
            altitude_amsl_m=altitude_amsl_m,
            position=None,
            tag=mission.emitter.label,
        )
    except SweepError as error:
        if telemetry.position is None:
            raise VehicleError("the vehicle lost its position during the turn; wait for a GPS fix") from error
        place = Place(lat=telemetry.position.lat_deg, lon=telemetry.position.lon_deg)
        nothing: list[float | None] = [None] * BINS
        fact = _rejected(sweep_id, place_number, attempt, place, 0.0, str(error), nothing, nothing)
        return Measured(sweep_id, None, fact)
    reading = await asyncio.to_thread(equipment.finder.estimate, sweep, equipment.pattern)
    taken_s = equipment.clock.now() - ordered_s
    fact = sweep_fact(mission, sweep_id, sweep, reading, place_number, attempt, taken_s)
    return Measured(sweep_id, sweep, fact)


def sweep_fact(
    mission: MissionSpec,
    sweep_id: str,
    sweep: Sweep,
    reading: BearingReading,
    place_number: int,
    attempt: int,
    measurement_time_s: float | None,
) -> BearingMeasured | SweepRejected:
    """What is recorded of a sweep: its bearing, or why it has none. measurement_time_s None: nobody waited for it."""
    place = Place(lat=sweep.position.lat_deg, lon=sweep.position.lon_deg)
    binned, fitted = _bins(reading.binned_db), _bins(reading.fitted_db)
    wanted = mission.sensor.minimum_quality
    needed = {
        "bearing": reading.bearing_deg,
        "sigma": reading.sigma_deg,
        "quality": reading.quality,
        "altitude": sweep.altitude_amsl_m,
        "drift": sweep.drift_m,
    }
    unknown = [name for name, value in needed.items() if not math.isfinite(value)]
    if unknown:
        reason = f"the {' and the '.join(unknown)} of this sweep cannot be told"
        quality = reading.quality if math.isfinite(reading.quality) else 0.0
        return _rejected(sweep_id, place_number, attempt, place, quality, reason, binned, fitted)
    if not reading.accepted or reading.quality < wanted:
        reason = reading.reason or f"quality {reading.quality:.2f} is below {wanted:.2f}"
        return _rejected(sweep_id, place_number, attempt, place, reading.quality, reason, binned, fitted)
    return BearingMeasured(
        bearing_id=str(uuid4()),
        sweep_id=sweep_id,
        place_number=place_number,
        place=place,
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
    )


def _rejected(
    sweep_id: str,
    place_number: int,
    attempt: int,
    place: Place,
    quality: float,
    reason: str,
    binned_db: list[float | None],
    fitted_db: list[float | None],
) -> SweepRejected:
    return SweepRejected(
        sweep_id=sweep_id,
        place_number=place_number,
        attempt=attempt,
        quality=quality,
        reason=reason,
        place=place,
        binned_db=binned_db,
        fitted_db=fitted_db,
    )


def _bins(values: np.ndarray) -> list[float | None]:
    return [float(v) if math.isfinite(v) else None for v in values]


async def _show_progress(
    equipment: Equipment, mission_id: str, listening: Listening, place_number: int, began_s: float
) -> None:
    """The running sweep to whoever watches: antenna heading and power of the samples so far."""
    offset = equipment.pattern.offset_to_nose_deg
    while True:
        await equipment.clock.sleep(PROGRESS_S)
        await asyncio.sleep(0.05)
        headings = equipment.vehicle.headings(began_s)
        samples = [s for s in listening.between(began_s, equipment.clock.now()) if s.detected]
        if len(headings) < 2 or not samples:
            continue
        nose = np.unwrap(np.array([h.heading_deg for h in headings]), period=360.0)
        at = np.interp([s.at_s for s in samples], [h.at_s for h in headings], nose)
        equipment.publisher.sweep_progress(
            mission_id,
            place_number,
            [float(h) for h in (at + offset) % 360.0],
            [s.power_db for s in samples],
            turned_deg(nose),
        )
