"""Recorded sweeps brought into a mission: the facts that a flown sweep would have left.

Pure, apart from the time it takes: call it off the event loop. Nothing is stored here, so nothing is half-imported.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from uuid import NAMESPACE_URL, uuid5

from backend.events import (
    AntennaFact,
    BearingMeasured,
    Event,
    ImportSource,
    Recorded,
    RecordingImported,
    SweepRejected,
)
from backend.reasons import Reason
from backend.reasons import search as reasons
from backend.reasons.refusals import NoSuchEmitter
from backend.search.antenna import antenna_fact
from backend.search.area import centre_of, corner_of
from backend.search.errors import MissionInputError
from backend.search.reported import SAME_CHANNEL_HZ
from backend.search.state import SearchState, evolve
from backend.search.sweep_facts import Taken, sweep_fact
from backend.search.together import together
from backend.spec import EmitterSpec, MissionSpec
from hardware.direction_finding.antenna import AntennaPattern
from hardware.direction_finding.bearings_file import LATEST_S
from hardware.direction_finding.recordings import RecordedSweep, Recording, mounted
from hardware.direction_finding.table_file import some_of
from hardware.direction_finding.table_tags import frequency_hz
from hardware.frame import LocalFrame
from hardware.ports import DirectionFinder
from hardware.readings import Place, Sweep
from hardware.reasons.table import OneTagOnly, PlaceNotStated

FAR_M = 50_000.0
"""A sweep taken further from the area belongs to another mission."""
MOST_SWEEPS = 200
CLOCK_S = 1e8
"""Times from here on, to 2100, are UTC epoch seconds; others count from somewhere in the recording."""


@dataclass(frozen=True, slots=True)
class Upload:
    """recording_id: tells whether the same was imported before. place, at_s: as the operator names them, before the
    file's own; at_s UTC epoch seconds of the first sample. offset_deg: of the antenna to the nose. emitter_id
    None: see emitter_heard. pattern: of the antenna that took the sweeps, None: ours did."""

    recording_id: str
    filename: str
    recording: Recording
    place: Place | None = None
    at_s: float | None = None
    offset_deg: float | None = None
    emitter_id: str | None = None
    pattern: AntennaPattern | None = None


@dataclass(frozen=True, slots=True)
class KeptSweep:
    """Raw samples to store beside the facts."""

    sweep_id: str
    emitter_id: str
    place_number: int
    sweep: Sweep


@dataclass(frozen=True, slots=True)
class Import:
    """facts: to append together. sweeps: to store before them; storing one twice changes nothing."""

    facts: tuple[Event, ...]
    sweeps: tuple[KeptSweep, ...]


OF_IMPORTS = ("recording_imported", "bearing_measured", "sweep_rejected", "heard_on_the_way", "source_mute_changed")
"""The facts that may name a recording as their source, and what says that one was imported."""


def bearing_id(mission_id: str, recording_id: str, line: int) -> str:
    """Of the bearing in that line of a file: the same when it is imported again."""
    return str(uuid5(NAMESPACE_URL, f"{mission_id}/{recording_id}/line {line}"))


def imported_before(mission_id: str, recorded: Sequence[Recorded], upload: Upload) -> list[Recorded]:
    """The import of the same recording and the facts of its sweeps or bearings; empty when there was none."""
    for record in recorded:
        if isinstance(record.event, RecordingImported) and record.event.recording_id == upload.recording_id:
            source = ImportSource(recording_id=upload.recording_id)
            bearings = upload.recording.bearings
            ids = {bearing_id(mission_id, upload.recording_id, one.line) for one in bearings}
            ids |= {one.live_id for one in bearings if one.live_id is not None}
            return [record, *(r for r in recorded if _of(r.event, source, ids))]
    return []


def _of(event: Event, source: ImportSource, bearing_ids: Collection[str]) -> bool:
    return getattr(event, "source", None) == source or getattr(event, "bearing_id", None) in bearing_ids


def must_be_few(pieces: int) -> None:
    """Sweeps or bearings of one recording. Raises MissionInputError."""
    if pieces > MOST_SWEEPS:
        raise MissionInputError(reasons.RecordingTooLong(pieces, MOST_SWEEPS), "file")


def begun(state: SearchState, upload: Upload, pieces: int) -> tuple[EmitterSpec, list[Reason], int]:
    """Whose recording it is, what was remarked when it was read, and the number of the last place before it. pieces:
    its sweeps or bearings. Raises MissionInputError for too many, and for an emitter that is not sought."""
    must_be_few(pieces)
    remarks: list[Reason] = list(upload.recording.remarks)
    last = max([state.place_number, *(bearing.place_number for bearing in state.measured)])
    return _emitter_of(state.mission, upload.emitter_id), remarks, last


def import_fact(
    upload: Upload,
    emitter: EmitterSpec,
    by: str,
    began_s: float | None,
    remarks: list[Reason],
    sweep_ids: list[str],
    antenna: AntennaFact | None,
) -> RecordingImported:
    """The fact that stands before those of the sweeps or bearings. began_s: UTC epoch seconds of the first, None when
    nobody knows. antenna: that of the sweeps, None for bearings."""
    return RecordingImported(
        emitter_id=emitter.emitter_id,
        recording_id=upload.recording_id,
        filename=upload.filename,
        by=by,
        recorded_at_utc=None if began_s is None else datetime.fromtimestamp(began_s, UTC),
        sweep_ids=sweep_ids,
        remarks=remarks,
        antenna=antenna,
    )


def import_facts(
    mission_id: str, state: SearchState, upload: Upload, finder: DirectionFinder, ours: AntennaPattern, by: str
) -> Import:
    """Bearing or rejection of every sweep, and the belief after each bearing. Raises MissionInputError."""
    mission, recording = state.mission, upload.recording
    tags = {tag.casefold(): tag for recorded in recording.sweeps if (tag := recorded.sweep.tag)}
    if len(tags) > 1 and not _of_one_channel([recorded.sweep for recorded in recording.sweeps]):
        raise MissionInputError(OneTagOnly(upload.filename, some_of(tags.values())), "tag")
    heard_hz = [recorded.sweep.frequency_hz or None for recorded in recording.sweeps]
    upload = replace(upload, emitter_id=emitter_heard(mission, upload.emitter_id, heard_hz))
    emitter, remarks, number = begun(state, upload, len(recording.sweeps))
    pattern = ours if upload.pattern is None else upload.pattern
    mismatch = None if upload.pattern is None else pattern.other_frequency(emitter.frequency_hz)
    if mismatch is not None:
        raise MissionInputError(mismatch, "antenna")
    first_s = float(recording.sweeps[0].sweep.at_s[0])
    began_s = upload.at_s if upload.at_s is not None else (first_s if CLOCK_S <= first_s < LATEST_S else None)
    shift_s = 0.0 if began_s is None else began_s - first_s
    prepared = [_prepared(recorded, mission, emitter, upload, shift_s, remarks) for recorded in recording.sweeps]
    sweep_ids = [str(uuid5(NAMESPACE_URL, f"{mission_id}/{upload.recording_id}/{k}")) for k in range(len(prepared))]
    antenna = antenna_fact(mounted(pattern, recording.sweeps[0], upload.offset_deg))
    source = ImportSource(recording_id=upload.recording_id)
    kept: list[KeptSweep] = []
    heard: list[BearingMeasured | SweepRejected] = []
    for sweep_id, recorded, sweep in zip(sweep_ids, recording.sweeps, prepared, strict=True):
        number += 1
        kept.append(KeptSweep(sweep_id, emitter.emitter_id, number, sweep))
        reading = finder.estimate(sweep, mounted(pattern, recorded, upload.offset_deg))
        taken = Taken(emitter.emitter_id, source, sweep_id, number, attempt=1)
        middle_s = None if began_s is None else float(sweep.at_s[0] + sweep.at_s[-1]) / 2.0
        heard.append(sweep_fact(taken, mission.sensor, sweep, reading, None, middle_s))
    begins = import_fact(upload, emitter, by, began_s, remarks, sweep_ids, antenna)
    return Import((begins, *with_beliefs(state, emitter.emitter_id, heard, began_s, each=True)), tuple(kept))


def with_beliefs(
    state: SearchState,
    emitter_id: str,
    heard: Sequence[BearingMeasured | SweepRejected],
    began_s: float | None,
    *,
    each: bool,
) -> list[Event]:
    """What was heard of an emitter, and the belief after each bearing, or after the last fact alone. began_s: as in
    import_fact."""
    tasks = together(state.mission, state.home or corner_of(state.mission.area), emitter_id)
    facts: list[Event] = []
    for fact in heard:
        facts.append(fact)
        state = evolve(state, fact, began_s or 0.0)
        if isinstance(fact, BearingMeasured) and (each or fact is heard[-1]):
            belief, _ = tasks.about(state, emitter_id).belief_fact(state.emitters[emitter_id].bearings)
            facts.append(belief)
    return facts


def emitter_heard(mission: MissionSpec, named: str | None, heard_hz: Sequence[float | None]) -> str | None:
    """Who is named, else the only one on a frequency that the file tells; None where there is one at all. heard_hz: of
    each sweep or bearing, None: not told. Raises MissionInputError."""
    emitters = mission.emitters
    if named is not None or len(emitters) == 1:
        return named
    told = [hz for hz in heard_hz if hz is not None]
    heard = [one.emitter_id for one in emitters if any(same_channel(one, hz) for hz in told)]
    if len(heard) == 1:
        return heard[0]
    if heard or len(told) < len(heard_hz):
        raise MissionInputError(reasons.WhichEmitter(len(emitters)), "emitter_id")
    raise MissionInputError(reasons.HeardElsewhere(told[0]), "files")


def _of_one_channel(sweeps: Sequence[Sweep]) -> bool:
    """Whether the tags are no more than what a receiver was tuned to, a little beside one emitter's frequency."""
    heard = [sweep.frequency_hz for sweep in sweeps]
    named = [frequency_hz("", sweep.tag or "") or math.inf for sweep in sweeps]
    as_heard = all(abs(one - hz) <= SAME_CHANNEL_HZ for one, hz in zip(named, heard, strict=True))
    return as_heard and max(heard) - min(heard) <= SAME_CHANNEL_HZ


def same_channel(emitter: EmitterSpec, frequency_hz: float) -> bool:
    """Whether what was heard at this frequency may be the emitter."""
    return abs(frequency_hz - emitter.frequency_hz) <= SAME_CHANNEL_HZ


def _emitter_of(mission: MissionSpec, emitter_id: str | None) -> EmitterSpec:
    """None: the first. Raises MissionInputError."""
    try:
        return mission.emitters[0] if emitter_id is None else mission.emitter(emitter_id)
    except KeyError as error:
        raise MissionInputError(NoSuchEmitter(emitter_id or ""), "emitter_id") from error


def _prepared(
    recorded: RecordedSweep,
    mission: MissionSpec,
    emitter: EmitterSpec,
    upload: Upload,
    shift_s: float,
    remarks: list[Reason],
) -> Sweep:
    """The sweep with place, time and frequency as they are to be stored."""
    sweep = recorded.sweep
    if upload.place is not None:
        place = upload.place
        if recorded.place_known:
            remarks.append(reasons.ImportRemark(upload.filename, "place_replaced"))
    elif recorded.place_known:
        place = sweep.position
    else:
        raise MissionInputError(PlaceNotStated(upload.filename), "lat")
    refuse_far(place, mission)
    if sweep.frequency_hz > 0 and not same_channel(emitter, sweep.frequency_hz):
        remarks.append(reasons.OtherFrequency(upload.filename, sweep.frequency_hz, emitter.frequency_hz))
    altitude = sweep.altitude_amsl_m if math.isfinite(sweep.altitude_amsl_m) else 0.0
    if altitude == 0.0:
        remarks.append(reasons.ImportRemark(upload.filename, "altitude_unknown"))
    return replace(
        sweep,
        position=place,
        at_s=sweep.at_s + shift_s,
        altitude_amsl_m=altitude,
        frequency_hz=sweep.frequency_hz or emitter.frequency_hz,
    )


def refuse_far(place: Place, mission: MissionSpec) -> None:
    """Raises MissionInputError for a place of another mission."""
    east, north = LocalFrame(centre_of(mission.area)).to_enu(place)
    away_m = math.hypot(east, north)
    if not away_m <= FAR_M:
        raise MissionInputError(reasons.RecordingTooFar(away_m), "lat")
