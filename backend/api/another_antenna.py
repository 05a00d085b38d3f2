"""The stored sweeps of a flown mission, heard through another antenna: another pattern, or another mounting."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from backend.api.services import Services
from backend.events import (
    BearingMeasured,
    BearingSource,
    CraftSource,
    ImportSource,
    MissionDrafted,
    MissionEdited,
    MissionStarted,
    Recorded,
    Supposition,
    SweepRejected,
)
from backend.reasons.refusals import NoSuchEmitter
from backend.reasons.request import SamplesNotStored
from backend.search.antenna import antennas, corrected
from backend.search.errors import MissionConflict, MissionInputError
from backend.search.sweep_facts import Taken, sweep_fact
from backend.spec import MissionSpec
from backend.store.entries import SweepEntry
from backend.wire.resources import PatternUpload, SweepFact, WhatIfAntenna
from hardware.direction_finding.antenna import AntennaPattern
from hardware.direction_finding.pattern_file import PatternError, parse_pattern
from hardware.ports import DirectionFinder


@dataclass(frozen=True, slots=True)
class AnotherAntenna:
    """pattern: of what a craft of the mission turned. of: by source, of those that have another one; what came with a
    recording has no correction of the mission in it. sweeps: the stored ones by their id."""

    finder: DirectionFinder
    pattern: AntennaPattern
    of: Mapping[BearingSource, AntennaPattern]
    sweeps: Mapping[str, SweepEntry]

    @property
    def named(self) -> WhatIfAntenna:
        """As the answer names it: a what-if is never taken for the mission's own antenna."""
        return WhatIfAntenna(name=self.pattern.name, offset_to_nose_deg=self.pattern.offset_to_nose_deg)

    def heard(self, mission: MissionSpec, flown: SweepFact) -> SweepFact:
        """What the sweep would have told. Raises MissionConflict when a bearing's samples were not stored."""
        entry = None if flown.sweep_id is None else self.sweeps.get(flown.sweep_id)
        if entry is None and flown.kind == "sweep_rejected":
            return flown  # of power that could not be made into a sweep
        if entry is None:
            raise MissionConflict(SamplesNotStored(flown.place_number))
        sweep = replace(entry.sweep(), partial=flown.turn is not None and flown.turn.partial)
        reading = self.finder.estimate(sweep, self.of.get(flown.source, self.pattern))
        taken = Taken(flown.emitter_id, flown.source, entry.sweep_id, flown.place_number, entry.attempt, flown.turn)
        heard = sweep_fact(taken, mission.sensor, sweep, reading, None)
        if isinstance(heard, BearingMeasured) and isinstance(flown, BearingMeasured):
            return heard.model_copy(update={"bearing_id": flown.bearing_id})
        return heard


async def another_antenna(
    services: Services, mission_id: str, recorded: Sequence[Recorded], wanted: Supposition
) -> AnotherAntenna | None:
    """None when the antenna is to stay as flown. Another mounting alone: of the antenna that flew and of those that
    recordings came with, in the place of their files' and the mission's correction together. Another pattern: for all,
    with the mission's correction where a craft flew.

    Raises MissionInputError for a pattern that cannot be used.
    """
    if wanted.pattern is None and wanted.offset_to_nose_deg is None:
        return None
    heard = [r.event for r in recorded if isinstance(r.event, BearingMeasured | SweepRejected)]
    of: dict[BearingSource, AntennaPattern]
    if wanted.pattern is None:
        of = antennas(recorded)
        flew = [one for source, one in of.items() if isinstance(source, CraftSource)]
        pattern = [services.pattern, *of.values(), *flew][-1]
    else:
        measured = _pattern(wanted.pattern, _frequency_hz(recorded, wanted.emitter_id))
        pattern = corrected(measured, _taken_off_deg(recorded))
        of = {fact.source: measured for fact in heard if isinstance(fact.source, ImportSource)}
    if wanted.offset_to_nose_deg is not None:
        pattern = replace(pattern, offset_to_nose_deg=wanted.offset_to_nose_deg)
        of = {source: replace(one, offset_to_nose_deg=wanted.offset_to_nose_deg) for source, one in of.items()}
    ids = [fact.sweep_id for fact in heard if fact.sweep_id is not None]
    stored = {sweep_id: await services.journal.sweep(mission_id, sweep_id) for sweep_id in ids}
    kept = {id_: entry for id_, entry in stored.items() if entry is not None}
    return AnotherAntenna(services.finder, pattern, of, kept)


def _taken_off_deg(recorded: Sequence[Recorded]) -> float:
    """Of the bearings of a craft, clockwise; nothing where none flew."""
    flown = any(isinstance(record.event, MissionStarted) for record in recorded)
    specs = [r.event.spec for r in recorded if isinstance(r.event, MissionDrafted | MissionEdited)]
    return specs[-1].sensor.bearing_offset_deg if flown and specs else 0.0


def _pattern(upload: PatternUpload, frequency_hz: float) -> AntennaPattern:
    try:
        pattern = parse_pattern(upload.filename, upload.text)
    except PatternError as error:
        raise MissionInputError(error.reason, "pattern") from error
    mismatch = pattern.other_frequency(frequency_hz)
    if mismatch is not None:
        raise MissionInputError(mismatch, "pattern")
    return pattern


def _frequency_hz(recorded: Sequence[Recorded], emitter_id: str | None) -> float:
    """emitter_id None: of the first emitter. Raises MissionInputError for one that is not looked for."""
    specs = [r.event.spec for r in recorded if isinstance(r.event, MissionDrafted | MissionEdited)]
    try:
        emitter = specs[-1].emitters[0] if emitter_id is None else specs[-1].emitter(emitter_id)
    except KeyError as error:
        raise MissionInputError(NoSuchEmitter(emitter_id or ""), "emitter_id") from error
    return emitter.frequency_hz
