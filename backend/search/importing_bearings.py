"""Bearings out of a file as facts of a mission: one source, with errors of its own. Pure."""

from __future__ import annotations

from datetime import UTC, datetime
from uuid import NAMESPACE_URL, uuid5

from backend.events import BearingMeasured, Event, ImportSource, RecordingImported
from backend.reasons import Reason, carried
from backend.reasons import search as reasons
from backend.search.area import corner_of
from backend.search.errors import MissionInputError
from backend.search.importing import MOST_SWEEPS, Import, Upload, emitter_of, refuse_far
from backend.search.localization import localization
from backend.search.reported import COMPASS_SHARE, COMPASS_SIGMA_DEG, SAME_CHANNEL_HZ
from backend.search.state import SearchState, evolve
from backend.spec import EmitterSpec, MissionSpec
from hardware.direction_finding.bearings_file import RecordedBearing

LEAST_SIGMA_DEG, MOST_SIGMA_DEG = 1.0, 60.0


def bearing_facts(mission_id: str, state: SearchState, upload: Upload, by: str) -> Import:
    """Every bearing of the emitter, and the belief after the last. Raises MissionInputError."""
    mission, recording = state.mission, upload.recording
    if len(recording.bearings) > MOST_SWEEPS:
        raise MissionInputError(reasons.RecordingTooLong(len(recording.bearings), MOST_SWEEPS), "file")
    emitter = _emitter(mission, upload)
    heard = [one for one in recording.bearings if _of(emitter, one)]
    if not heard:
        raise MissionInputError(reasons.HeardElsewhere(recording.bearings[0].frequency_hz or 0.0), "files")
    remarks: list[Reason] = [carried(remark) for remark in recording.remarks]
    if upload.place is not None or upload.offset_deg is not None:
        remarks.append(reasons.ImportRemark(upload.filename, "bearings_stand"))
    others = (one.frequency_hz for one in recording.bearings if not _of(emitter, one))
    elsewhere = sorted({hz for hz in others if hz is not None})
    remarks += [reasons.OtherFrequency(upload.filename, hz, emitter.frequency_hz) for hz in elsewhere]
    times = [upload.at_s if upload.at_s is not None else one.at_s for one in heard]
    first_s = min((at_s for at_s in times if at_s is not None), default=None)
    facts: list[Event] = [
        RecordingImported(
            emitter_id=emitter.emitter_id,
            recording_id=upload.recording_id,
            filename=upload.filename,
            by=by,
            recorded_at_utc=None if first_s is None else datetime.fromtimestamp(first_s, UTC),
            sweep_ids=[],
            remarks=remarks,
        )
    ]
    number = max([state.place_number, *(b.place_number for b in state.measured)])
    for one, at_s in zip(heard, times, strict=True):
        refuse_far(one.place, mission)
        number += 1
        fact = _fact(mission_id, state, upload, emitter, one, number, at_s)
        facts.append(fact)
        state = evolve(state, fact, first_s or 0.0)
    known = state.emitters[emitter.emitter_id]
    task = localization(mission, state.home or corner_of(mission.area), emitter.emitter_id)
    belief, _ = task.after(known.unheard).belief_fact(known.bearings)
    return Import((*facts, belief), ())


def _emitter(mission: MissionSpec, upload: Upload) -> EmitterSpec:
    """Who is named, else the only one, else the only one on a frequency that the file tells."""
    bearings = upload.recording.bearings
    if upload.emitter_id is None and len(mission.emitters) > 1:
        told = [one for one in bearings if one.frequency_hz is not None]
        heard = [emitter for emitter in mission.emitters if any(_of(emitter, one) for one in told)]
        if len(heard) == 1:
            return heard[0]
        if heard or len(told) < len(bearings):
            raise MissionInputError(reasons.WhichEmitter(len(mission.emitters)), "emitter_id")
    return emitter_of(mission, upload.emitter_id)


def _of(emitter: EmitterSpec, one: RecordedBearing) -> bool:
    return one.frequency_hz is None or abs(one.frequency_hz - emitter.frequency_hz) <= SAME_CHANNEL_HZ


def _fact(
    mission_id: str,
    state: SearchState,
    upload: Upload,
    emitter: EmitterSpec,
    one: RecordedBearing,
    number: int,
    at_s: float | None,
) -> BearingMeasured:
    sigma_deg = min(max(one.sigma_deg, LEAST_SIGMA_DEG), MOST_SIGMA_DEG)
    return BearingMeasured(
        emitter_id=emitter.emitter_id,
        source=ImportSource(recording_id=upload.recording_id),
        bearing_id=str(uuid5(NAMESPACE_URL, f"{mission_id}/{upload.recording_id}/line {one.line}")),
        sweep_id=None,
        place_number=number,
        place=one.place,
        altitude_amsl_m=state.home_amsl_m,
        bearing_deg=one.bearing_deg % 360.0,
        sigma_deg=sigma_deg,
        quality=1.0,
        peaks=[],
        snr_db=None,
        drift_m=0.0,
        binned_db=[],
        fitted_db=[],
        heading_sigma_deg=min(COMPASS_SIGMA_DEG, COMPASS_SHARE * sigma_deg),
        taken_at_s=at_s,
    )
