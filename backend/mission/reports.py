"""Bearings that people and other stations report to a search, whether it flies or not; each may be taken back."""

from __future__ import annotations

from dataclasses import dataclass

from backend.commands import ExcludeBearing
from backend.events import BearingMeasured, PersonSource, Recorded
from backend.mission.flights import Flights
from backend.mission.records import Records
from backend.reasons import refusals
from backend.search.errors import MissionConflict, MissionInputError
from backend.search.inputs import BearingsArrived, SearchOrdered
from backend.search.reported import ReportedBearing, reported_fact
from backend.search.state import SearchState
from hardware.ports import Clock

TAKEN_BACK = "taken back"


@dataclass(slots=True)
class Reports:
    """clock: the mission's."""

    records: Records
    flights: Flights
    clock: Clock

    async def add(self, mission_id: str, report: ReportedBearing) -> tuple[Recorded, bool]:
        """The fact, and whether the same bearing was there before: sent twice, it counts once.

        Raises MissionNotFound, MissionInputError, MissionConflict once the search has ended.
        """
        async with self.records.lock(mission_id):
            before = await self._stored(mission_id, report.bearing_id)
            if before is not None:
                return before, True
            search = await self._search(mission_id)
            await self._give(mission_id, BearingsArrived((reported_fact(search, report, self.clock.now()),)))
            stored = await self._stored(mission_id, report.bearing_id)
        if stored is None:
            raise MissionConflict(refusals.MissionOver())
        return stored, False

    async def take_back(self, mission_id: str, bearing_id: str, by: str, of_anybody: bool) -> None:
        """One's own, or a person's whoever it was; a second time changes nothing. Raises as `add`."""
        async with self.records.lock(mission_id):
            search = await self._search(mission_id)
            found = search.bearing(bearing_id)
            if found is None or not isinstance(found[1].source, PersonSource):
                raise MissionInputError(refusals.NoSuchBearing(), "bearing_id")
            emitter, bearing = found
            if not of_anybody and bearing.source != PersonSource(name=by):
                raise MissionInputError(refusals.BearingOfAnother(), "bearing_id")
            if bearing_id not in emitter.excluded:
                order = ExcludeBearing(bearing_id=bearing_id, reason=TAKEN_BACK)
                await self._give(mission_id, SearchOrdered(by, order))

    async def _search(self, mission_id: str) -> SearchState:
        """Raises MissionConflict once it has ended."""
        runner = self.flights.running(mission_id)
        search = (runner.state if runner else (await self.records.load(mission_id))[0]).search
        if search.stage == "ended":
            raise MissionConflict(refusals.MissionOver())
        return search

    async def _give(self, mission_id: str, given: BearingsArrived | SearchOrdered) -> None:
        await self.flights.give(mission_id, given)
        if self.flights.running(mission_id) is None:
            await self.records.settle_beliefs(mission_id)

    async def _stored(self, mission_id: str, bearing_id: str) -> Recorded | None:
        for recorded in await self.records.read(mission_id):
            if isinstance(recorded.event, BearingMeasured) and recorded.event.bearing_id == bearing_id:
                return recorded
        return None
