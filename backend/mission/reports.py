"""Bearings that people and other stations report to a search, whether it flies or not; each may be taken back."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from backend.commands import ExcludeBearing, IncludeBearing, MuteSource
from backend.events import BearingExcluded, BearingMeasured, Event, PersonSource, Recorded, SourceMuteChanged
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

        Raises MissionNotFound, MissionInputError, MissionConflict once the search has ended or was deleted.
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

    async def restore(self, mission_id: str, bearing_id: str, by: str) -> None:
        """What the same person took back counts again; a second time changes nothing. Raises as `take_back`, also for
        a bearing that somebody else left out: that is theirs, or the controller's, to undo."""
        async with self.records.lock(mission_id):
            search = await self._search(mission_id)
            found = search.bearing(bearing_id)
            if found is None or not isinstance(found[1].source, PersonSource):
                raise MissionInputError(refusals.NoSuchBearing(), "bearing_id")
            if bearing_id not in found[0].excluded:
                return

            def left_out(event: Event) -> str | None:
                return event.by if isinstance(event, BearingExcluded) and event.bearing_id == bearing_id else None

            await self._by_the_same(mission_id, left_out, by, "bearing_id")
            await self._give(mission_id, SearchOrdered(by, IncludeBearing(bearing_id=bearing_id)))

    async def mute(self, mission_id: str, name: str, muted: bool) -> None:
        """A reporter's own bearings, those to come too; the same once more changes nothing. Raises as `restore`."""
        source = PersonSource(name=name)
        async with self.records.lock(mission_id):
            search = await self._search(mission_id)
            if (source in search.muted) == muted:
                return
            if all(bearing.source != source for bearing in search.measured):
                raise MissionInputError(refusals.NoSuchSource(), "by")

            def mute(event: Event) -> str | None:
                return event.by if isinstance(event, SourceMuteChanged) and event.source == source else None

            if not muted:
                await self._by_the_same(mission_id, mute, name, "by")
            await self._give(mission_id, SearchOrdered(name, MuteSource(of="person", name=name, muted=muted)))

    async def _by_the_same(self, mission_id: str, whose: Callable[[Event], str | None], by: str, field: str) -> None:
        """Raises MissionInputError when the newest such fact is somebody else's."""
        told = await self.records.of_kinds(mission_id, ("bearing_excluded", "source_mute_changed"))
        named = [who for recorded in told if (who := whose(recorded.event)) is not None]
        if named and named[-1] != by:
            raise MissionInputError(refusals.LeftOutByAnother(named[-1]), field)

    async def _search(self, mission_id: str) -> SearchState:
        """Raises MissionConflict once it has ended, and when it was deleted."""
        runner = self.flights.running(mission_id)
        search = (runner.state if runner else (await self.records.load(mission_id))[0]).search
        if search.stage == "ended":
            raise MissionConflict(refusals.MissionOver())
        if search.deleted:
            raise MissionConflict(refusals.WasDeleted())
        return search

    async def _give(self, mission_id: str, given: BearingsArrived | SearchOrdered) -> None:
        await self.flights.give(mission_id, given)
        if self.flights.running(mission_id) is None:
            await self.records.settle_beliefs(mission_id)

    async def _stored(self, mission_id: str, bearing_id: str) -> Recorded | None:
        for recorded in await self.records.of_kinds(mission_id, ("bearing_measured",)):
            if isinstance(recorded.event, BearingMeasured) and recorded.event.bearing_id == bearing_id:
                return recorded
        return None
