"""Missions before they fly, and what is brought in beside a flight: drafted, edited, checked, given recordings."""

from __future__ import annotations

import asyncio
import logging
from dataclasses import dataclass
from uuid import uuid4

from backend.craft.antenna_check import check_by_hand
from backend.craft.checklist import checklist
from backend.events import AntennaChecked, BeliefUpdated, MissionDrafted, MissionEdited, PreflightChecked, Recorded
from backend.mission.equipment import MissionEquipment
from backend.mission.flights import Flights
from backend.mission.learning import learn_from_check
from backend.mission.records import Records
from backend.names import in_one_line, seen
from backend.reasons.refusals import (
    AlreadyStarted,
    DraftedBefore,
    EditedMeanwhile,
    MissionFlies,
    NotEditable,
    WasDeleted,
)
from backend.reasons.request import FieldInvalid
from backend.search.area import centre_of
from backend.search.band import check_band
from backend.search.errors import MissionConflict, MissionInputError
from backend.search.importing import OF_IMPORTS, Upload, import_facts, imported_before
from backend.search.importing_bearings import bearing_facts
from backend.search.inputs import BearingsArrived, Edited, PreflightDone
from backend.search.never_stop import check_never_stop
from backend.search.task import search_task
from backend.search.told_apart import check_told_apart
from backend.spec import MissionSpec, Place

log = logging.getLogger("crossfix.mission")

SPECIFIED = ("mission_drafted", "mission_edited")
"""The facts that hold a whole specification."""


@dataclass(slots=True)
class Drafts:
    """Every change is a fact in the journal before the call returns."""

    equipment: MissionEquipment
    records: Records
    flights: Flights

    async def create(self, spec: MissionSpec, by: str, mission_id: str | None = None) -> str:
        """Draft a mission. mission_id: the caller's own, so that a request whose answer was lost drafts nothing twice.
        Raises MissionInputError when the specification makes no sense, MissionConflict when the id is taken."""
        spec = await self.equipment.knowing(spec)
        await asyncio.to_thread(_check_spec, spec)
        mission_id = mission_id or str(uuid4())
        async with self.records.lock(mission_id):
            if await self.equipment.journal.listed(mission_id) is not None:
                raise MissionConflict(DraftedBefore(mission_id))
            await self.records.append(mission_id, [MissionDrafted(spec=spec)])
        log.info("mission %s drafted by %s", mission_id, by)
        return mission_id

    async def edit(self, mission_id: str, spec: MissionSpec, by: str, from_seq: int | None = None) -> None:
        """from_seq: of the specification that was opened; what is stored already is not stored again. Raises
        MissionNotFound, MissionConflict once it has started, was deleted, or was edited since, MissionInputError."""
        spec = await self.equipment.knowing(spec)
        await asyncio.to_thread(_check_spec, spec)
        async with self.records.lock(mission_id):
            state, _ = await self.records.load(mission_id)
            if state.search.deleted:
                raise MissionConflict(WasDeleted())
            if state.search.stage not in ("draft", "ready"):
                raise MissionConflict(NotEditable())
            if from_seq is not None:
                if spec == state.search.mission:
                    return
                last = (await self.records.of_kinds(mission_id, SPECIFIED))[-1]
                if last.seq != from_seq:
                    who = last.event.by if isinstance(last.event, MissionEdited) else None
                    raise MissionConflict(EditedMeanwhile(who or "?", last.seq))
            await self.records.give(mission_id, state, Edited(spec, by))
            await self.records.settle_beliefs(mission_id)
        log.info("mission %s edited by %s", mission_id, by)

    async def preflight(self, mission_id: str, craft_id: str | None = None) -> PreflightChecked:
        """Run the checklist of a craft and record it. Raises MissionNotFound, KeyError for an unknown craft."""
        craft = self.equipment.first if craft_id is None else self.equipment.crafts[craft_id]
        async with self.records.lock(mission_id):
            runner = self.flights.running(mission_id)
            search = (runner.state if runner else (await self.records.load(mission_id))[0]).search
            listening = self.flights.listening(craft.craft_id)
            checks, _ = await checklist(
                search.mission, craft, listening, search.antenna, self.equipment.grounds, search
            )
            await self.flights.give(mission_id, PreflightDone(checks))
        return PreflightChecked(passed=all(c.ok or not c.blocking for c in checks), checks=list(checks))

    async def check_antenna(self, mission_id: str, emitter: Place | float, wait_s: float, by: str) -> AntennaChecked:
        """Turn the vehicle by hand before an emitter at a known place or bearing; the result stays in the checklist.

        Raises MissionNotFound, MissionConflict while anything flies, MissionInputError.
        """
        async with self.flights.starting:
            if self.flights.active is not None:
                raise MissionConflict(MissionFlies())
            state, _ = await self.records.load(mission_id)
            if state.search.stage not in ("draft", "ready"):
                raise MissionConflict(AlreadyStarted())
            checked = await check_by_hand(self.equipment.first, state.search.mission, emitter, wait_s, by)
            async with self.records.lock(mission_id):
                await self.records.append(mission_id, [checked])
        await learn_from_check(self.equipment, mission_id, state.search.mission.sensor, checked)
        return checked

    async def import_recording(self, mission_id: str, upload: Upload, by: str) -> tuple[list[Recorded], bool]:
        """Bring recorded sweeps into a mission, in flight too: its facts about them, and whether they were there
        before.

        All or nothing. Raises MissionNotFound, MissionInputError, MissionConflict when the mission was deleted.
        """
        equipment, craft = self.equipment, self.equipment.first
        async with self.records.lock(mission_id):
            recorded = await self.records.of_kinds(mission_id, OF_IMPORTS)
            before = imported_before(mission_id, recorded, upload)
            if before:
                return before, True
            runner = self.flights.running(mission_id)
            search = (runner.state if runner else (await self.records.load(mission_id))[0]).search
            if search.deleted:
                raise MissionConflict(WasDeleted())
            if upload.recording.bearings:
                alone = runner is None  # in flight its runner makes the belief
                found = await asyncio.to_thread(bearing_facts, mission_id, search, upload, by, believed=alone)
            else:
                found = await asyncio.to_thread(
                    import_facts, mission_id, search, upload, craft.finder, craft.pattern, by
                )
            for kept in found.sweeps:
                await equipment.journal.save_sweep(
                    mission_id, kept.sweep_id, None, kept.emitter_id, kept.place_number, 1, kept.sweep
                )
            if runner is None:
                await self.records.append(mission_id, found.facts)
                await self.records.settle_beliefs(mission_id)
            else:
                bearings = tuple(fact for fact in found.facts if not isinstance(fact, BeliefUpdated))
                await self.flights.give(mission_id, BearingsArrived(bearings))
            recorded = await self.records.of_kinds(mission_id, OF_IMPORTS)
            new = imported_before(mission_id, recorded, upload)
        log.info("mission %s: %s imported by %s", mission_id, upload.filename, by)
        return new, False


def _check_spec(spec: MissionSpec) -> None:
    """Raises MissionInputError when a name would be shown as something else, the altitude lies outside its band, or
    when the areas make no sense, wherever the vehicle is: a mission may be planned far from it, or hold recordings
    only. Preflight refuses to fly it there."""
    _check_names(spec)
    check_band(spec.flight)
    check_never_stop(spec)
    check_told_apart(spec.emitters)
    search_task(spec, centre_of(spec.area), 0.0)


def _check_names(spec: MissionSpec) -> None:
    """By the rule of labels; here and not in the specification, since those of before are read with whatever they are
    called. Raises MissionInputError."""
    field = "name"
    try:
        seen(spec.name)
        for number, emitter in enumerate(spec.emitters):
            field = f"emitters.{number}.label"
            in_one_line(emitter.label)
    except ValueError as error:
        raise MissionInputError(FieldInvalid(str(error)), field) from error
