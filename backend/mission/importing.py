"""Recorded sweeps brought into a mission that is not flying: the facts that a flown sweep would have left.

Pure, apart from the time it takes: call it off the event loop. Nothing is stored here, so nothing is half-imported.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from uuid import NAMESPACE_URL, uuid5

from backend.events import BearingMeasured, Event, Recorded, RecordingImported, SweepStarted
from backend.mission.antenna import antenna_fact
from backend.mission.area import centre_of, corner_of
from backend.mission.errors import MissionInputError
from backend.mission.localization import localization
from backend.mission.measuring import sweep_fact
from backend.mission.state import MissionState, evolve
from backend.spec import MissionSpec, Place
from hardware.direction_finding.antenna import AntennaPattern
from hardware.direction_finding.recordings import RecordedSweep, Recording, mounted
from hardware.frame import LocalFrame
from hardware.ports import DirectionFinder
from hardware.readings import GeoPoint, Sweep

FAR_M = 50_000.0
"""A sweep taken further from the area belongs to another mission."""
MOST_SWEEPS = 200
CLOCK_S = 1e8
"""Times from here on are UTC epoch seconds; smaller ones count from somewhere in the recording."""
OTHER_FREQUENCY = 0.01


@dataclass(frozen=True, slots=True)
class Upload:
    """recording_id: tells whether the same was imported before. place, at_s: as the operator names them, before the
    file's own; at_s UTC epoch seconds of the first sample. offset_deg: of the antenna to the nose."""

    recording_id: str
    filename: str
    recording: Recording
    place: Place | None = None
    at_s: float | None = None
    offset_deg: float | None = None


@dataclass(frozen=True, slots=True)
class KeptSweep:
    """Raw samples to store beside the facts."""

    sweep_id: str
    place_number: int
    sweep: Sweep


@dataclass(frozen=True, slots=True)
class Import:
    """facts: to append together. sweeps: to store before them; storing one twice changes nothing."""

    facts: tuple[Event, ...]
    sweeps: tuple[KeptSweep, ...]


def imported_before(recorded: Sequence[Recorded], recording_id: str) -> list[Recorded]:
    """The import of the same recording and the facts of its sweeps; empty when there was none."""
    for record in recorded:
        if isinstance(record.event, RecordingImported) and record.event.recording_id == recording_id:
            ours = set(record.event.sweep_ids)
            return [record, *(r for r in recorded if getattr(r.event, "sweep_id", None) in ours)]
    return []


def import_facts(
    mission_id: str, state: MissionState, upload: Upload, finder: DirectionFinder, pattern: AntennaPattern, by: str
) -> Import:
    """Bearing or rejection of every sweep, and the belief after each bearing. Raises MissionInputError."""
    mission, recording = state.mission, upload.recording
    if len(recording.sweeps) > MOST_SWEEPS:
        raise MissionInputError(
            f"the recording holds {len(recording.sweeps)} sweeps", f"import at most {MOST_SWEEPS} at once", "file"
        )
    remarks = list(recording.remarks)
    first_s = float(recording.sweeps[0].sweep.at_s[0])
    began_s = upload.at_s if upload.at_s is not None else (first_s if first_s >= CLOCK_S else None)
    shift_s = 0.0 if began_s is None else began_s - first_s
    prepared = [_prepared(recorded, mission, upload, shift_s, remarks) for recorded in recording.sweeps]
    sweep_ids = [str(uuid5(NAMESPACE_URL, f"{mission_id}/{upload.recording_id}/{k}")) for k in range(len(prepared))]
    facts: list[Event] = [
        RecordingImported(
            recording_id=upload.recording_id,
            filename=upload.filename,
            by=by,
            recorded_at_utc=None if began_s is None else datetime.fromtimestamp(began_s, UTC),
            sweep_ids=sweep_ids,
            remarks=remarks,
            antenna=antenna_fact(mounted(pattern, recording.sweeps[0], upload.offset_deg)),
        )
    ]
    task = localization(mission, state.home or corner_of(mission.area), state.home_amsl_m)
    kept: list[KeptSweep] = []
    number = max([state.place_number, *(b.place_number for b in state.measured)])
    for sweep_id, recorded, sweep in zip(sweep_ids, recording.sweeps, prepared, strict=True):
        number += 1
        kept.append(KeptSweep(sweep_id, number, sweep))
        reading = finder.estimate(sweep, mounted(pattern, recorded, upload.offset_deg))
        fact = sweep_fact(mission, sweep_id, sweep, reading, number, attempt=1, measurement_time_s=None)
        facts += [SweepStarted(place_number=number, attempt=1), fact]
        state = evolve(state, fact, began_s or 0.0)
        if isinstance(fact, BearingMeasured):
            belief, _ = task.belief_fact(state.bearings)
            facts.append(belief)
    return Import(tuple(facts), tuple(kept))


def _prepared(
    recorded: RecordedSweep, mission: MissionSpec, upload: Upload, shift_s: float, remarks: list[str]
) -> Sweep:
    """The sweep with place, time and frequency as they are to be stored."""
    sweep = recorded.sweep
    if upload.place is not None:
        place = GeoPoint(upload.place.lat, upload.place.lon)
        if recorded.place_known:
            remarks.append(f"{upload.filename}: the place that was named replaces the file's own")
    elif recorded.place_known:
        place = sweep.position
    else:
        raise MissionInputError(
            f"{upload.filename} does not tell where it was recorded", "name the place beside it", "lat"
        )
    _refuse_far(place, mission)
    if sweep.frequency_hz > 0 and abs(sweep.frequency_hz / mission.emitter.frequency_hz - 1.0) > OTHER_FREQUENCY:
        remarks.append(
            f"{upload.filename}: was recorded at {sweep.frequency_hz / 1e6:.4f} MHz; the mission looks for "
            f"{mission.emitter.frequency_hz / 1e6:.4f} MHz"
        )
    altitude = sweep.altitude_amsl_m if math.isfinite(sweep.altitude_amsl_m) else 0.0
    if altitude == 0.0:
        remarks.append(f"{upload.filename}: does not tell its altitude; 0 m AMSL is noted")
    return replace(
        sweep,
        position=place,
        at_s=sweep.at_s + shift_s,
        altitude_amsl_m=altitude,
        frequency_hz=sweep.frequency_hz or mission.emitter.frequency_hz,
    )


def _refuse_far(place: GeoPoint, mission: MissionSpec) -> None:
    east, north = LocalFrame(centre_of(mission.area)).to_enu(place)
    away_m = math.hypot(east, north)
    if not away_m <= FAR_M:
        raise MissionInputError(
            f"the recording was taken {away_m / 1000.0:,.0f} km from the mission's area",
            "import it into a mission whose area is around it, or name the right place",
            "lat",
        )
