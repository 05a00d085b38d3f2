"""A mission room on doubles: a journal and a publisher in memory, one craft or several, time fifty times as fast."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Collection, Sequence
from datetime import UTC, datetime
from typing import TypeVar

from equipment import PATTERN, FlatVehicle, HummingReceiver, PointingFinder

from backend.craft.equipment import CraftEquipment
from backend.events import (
    FIRST_CRAFT,
    BeliefUpdated,
    Event,
    MissionEnded,
    MissionStarted,
    NetsNoted,
    NetsPutBack,
    Phase,
    PhaseChanged,
    Recorded,
)
from backend.mission.equipment import MissionEquipment
from backend.mission.room import MissionRoom, mission_room
from backend.mission.runner import MissionRunner
from backend.mission.state import MissionState, fold
from backend.ports import (
    FactRefused,
    Grounds,
    JournalUnavailable,
    Lessons,
    Listed,
    NoGrounds,
    NoLessons,
    SectorShown,
    Status,
    TrackPoint,
)
from backend.reasons.storage import FactUnfit, NothingStores
from hardware.clock import ScaledClock
from hardware.direction_finding.antenna import AntennaPattern
from hardware.readings import Sweep, Telemetry
from planner.belief.grid import GridBelief

OneFact = TypeVar("OneFact", bound=Event)

AWAY = NothingStores("it is away", "the disk is full")
REFUSED = FactUnfit("journal", "a number is missing")


class MemoryJournal:
    """`away`: the database answers nothing until it is False again. `refuses`: kinds of facts it will never take."""

    def __init__(self, now: ScaledClock) -> None:
        self._clock = now
        self.stored: dict[str, list[Recorded]] = {}
        self.sweeps: list[tuple[str, str, str]] = []
        self.track: list[tuple[str, TrackPoint]] = []
        self.away = False
        self.refuses: set[str] = set()
        self.aside: list[Event] = []

    async def append(self, mission_id: str, events: Sequence[Event]) -> list[Recorded]:
        await asyncio.sleep(0)
        if self.away:
            raise JournalUnavailable(AWAY)
        if any(event.kind in self.refuses for event in events):
            raise FactRefused(REFUSED)
        stored = self.stored.setdefault(mission_id, [])
        at = datetime.fromtimestamp(self._clock.now(), UTC)
        new = [
            Recorded(seq=len(stored) + i, mission_id=mission_id, at_utc=at, event=event)
            for i, event in enumerate(events, 1)
        ]
        stored += new
        return new

    async def keep_aside(self, mission_id: str, events: Sequence[Event], why: str) -> None:
        self.aside += events

    async def read(self, mission_id: str, after: int = 0, most: int | None = None) -> list[Recorded]:
        return self.stored.get(mission_id, [])[after:][:most]

    async def read_kinds(self, mission_id: str, kinds: Collection[str]) -> list[Recorded]:
        return [record for record in self.stored.get(mission_id, []) if record.event.kind in kinds]

    async def append_unread(self, mission_id: str, events: Sequence[Event]) -> list[Recorded]:
        return await self.append(mission_id, events)

    async def listed(self, mission_id: str) -> Listed | None:
        if mission_id not in self.stored:
            return None
        state = self.state(mission_id)
        crafts: dict[str, Phase] = {craft.craft_id: craft.phase for craft in state.engaged}
        return Listed(state.search.started_at_s, state.search.stage == "ended", state.search.deleted, crafts)

    async def save_sweep(
        self,
        mission_id: str,
        sweep_id: str,
        craft_id: str | None,
        emitter_id: str,
        place_number: int,
        attempt: int,
        sweep: Sweep,
    ) -> None:
        self.sweeps.append((mission_id, emitter_id, sweep_id))

    async def save_track(self, mission_id: str, craft_id: str, points: Sequence[TrackPoint]) -> None:
        self.track += [(craft_id, point) for point in points]

    async def of_nets(self) -> list[Recorded]:
        every = (record for stored in self.stored.values() for record in stored)
        return [record for record in every if isinstance(record.event, NetsNoted | NetsPutBack)]

    async def unfinished(self) -> list[str]:
        """As the stored journal's digest has it: not ended, or a craft of it is not down."""

        def open_(recorded: list[Recorded]) -> bool:
            facts = [r.event for r in recorded]
            started = any(isinstance(f, MissionStarted) for f in facts)
            ended = any(isinstance(f, MissionEnded) for f in facts)
            phases = {f.craft_id: f.after for f in facts if isinstance(f, PhaseChanged)}
            return started and (not ended or any(phase != "ground" for phase in phases.values()))

        return [mission_id for mission_id, recorded in self.stored.items() if open_(recorded)]

    def events(self, mission_id: str) -> list[Event]:
        return [r.event for r in self.stored.get(mission_id, [])]

    def of_kind(self, mission_id: str, kind: type[OneFact]) -> list[OneFact]:
        return [event for event in self.events(mission_id) if isinstance(event, kind)]

    def kinds(self, mission_id: str) -> list[str]:
        return [event.kind for event in self.events(mission_id)]

    def state(self, mission_id: str) -> MissionState:
        return fold(self.stored[mission_id])


class MemoryPublisher:
    """`journal`: what is shown must be stored there already."""

    def __init__(self, journal: MemoryJournal) -> None:
        self._journal = journal
        self.shown: list[Recorded] = []
        self.beliefs: list[tuple[str, int]] = []
        self.statuses: list[Status] = []
        self.progress: list[tuple[str, float]] = []
        self.sectors: list[SectorShown | None] = []
        self.telemetries: list[str] = []
        self.consoles = 0

    def events(self, recorded: Sequence[Recorded]) -> None:
        for record in recorded:
            assert record in self._journal.stored[record.mission_id], "shown before it was durable"
            self.shown.append(record)

    def telemetry(self, craft_id: str, telemetry: Telemetry, now_s: float) -> None:
        self.telemetries.append(craft_id)

    def sweep_progress(
        self,
        mission_id: str,
        craft_id: str,
        emitter_id: str,
        place_number: int,
        heading_deg: list[float],
        power_db: list[float],
        turned_deg: float,
        sector: SectorShown | None = None,
    ) -> None:
        self.sectors.append(sector)
        assert len(heading_deg) == len(power_db)
        self.progress.append((emitter_id, turned_deg))

    def belief(
        self,
        mission_id: str,
        emitter_id: str,
        seq: int,
        bearings: int,
        belief: GridBelief,
        corners_lon_lat: list[tuple[float, float]],
    ) -> None:
        (fact,) = [record.event for record in self.shown if (record.mission_id, record.seq) == (mission_id, seq)]
        assert isinstance(fact, BeliefUpdated), "a belief belongs to the event that says what it is"
        assert (fact.emitter_id, fact.bearings) == (emitter_id, bearings)
        self.beliefs.append((emitter_id, bearings))

    def status(self, status: Status) -> None:
        self.statuses.append(status)

    def watchers(self) -> int:
        return self.consoles


class Stage:
    """One craft; `vehicle`, `receiver`, `finder` are its."""

    def __init__(
        self,
        target: tuple[float, float] = (30.0, 60.0),
        rejected: int = 0,
        factor: float = 50.0,
        others: dict[float, tuple[float, float]] | None = None,
    ) -> None:
        self.clock = ScaledClock(factor=factor)
        self.vehicle = FlatVehicle(self.clock)
        self.receiver = HummingReceiver(self.clock)
        self.finder = PointingFinder(target, rejected, others)
        self.journal = MemoryJournal(self.clock)
        self.publisher = MemoryPublisher(self.journal)
        self.grounds: Grounds = NoGrounds()
        self.lessons: Lessons = NoLessons()
        self.room = self.new_room()

    def craft(self, pattern: AntennaPattern = PATTERN) -> CraftEquipment:
        return CraftEquipment(
            craft_id=FIRST_CRAFT,
            vehicle=self.vehicle,
            receiver=self.receiver,
            finder=self.finder,
            pattern=pattern,
            clock=self.clock,
            publisher=self.publisher,
            threads=1,
        )

    def new_room(self, pattern: AntennaPattern = PATTERN) -> MissionRoom:
        craft = self.craft(pattern)
        return mission_room(
            MissionEquipment(
                crafts={craft.craft_id: craft},
                journal=self.journal,
                publisher=self.publisher,
                clock=self.clock,
                software="test",
                threads=1,
                grounds=self.grounds,
                lessons=self.lessons,
            )
        )

    async def restart(self) -> None:
        """The server goes away and comes back; the vehicle flies on."""
        await self.room.shut_down()
        self.room = self.new_room()
        await self.room.start_up()

    @property
    def active(self) -> MissionRunner:
        """Of the mission that flies."""
        runner = self.room.flights.active
        assert runner is not None
        return runner

    async def until(self, mission_id: str, kind: str, count: int = 1, wall_s: float = 60.0) -> Event:
        """The n-th event of a kind, once it is stored."""
        async with asyncio.timeout(wall_s):
            while True:
                found = [e for e in self.journal.events(mission_id) if e.kind == kind]
                if len(found) >= count:
                    return found[count - 1]
                await asyncio.sleep(0.005)

    async def until_true(self, happened: Callable[[], bool], wall_s: float = 60.0) -> None:
        async with asyncio.timeout(wall_s):
            while True:
                if happened():
                    return
                await asyncio.sleep(0)

    async def until_phase(self, mission_id: str, phase: str, wall_s: float = 60.0) -> None:
        """Of the craft."""
        async with asyncio.timeout(wall_s):
            while True:
                changes = self.journal.of_kind(mission_id, PhaseChanged)
                if changes and changes[-1].after == phase:
                    return
                await asyncio.sleep(0.005)

    async def until_mission(self, mission_id: str, phase: str, wall_s: float = 60.0) -> None:
        """The mission's phase, and no craft of it flies any more."""
        async with asyncio.timeout(wall_s):
            while True:
                state = self.journal.state(mission_id)
                if state.phase == phase and not state.engaged:
                    return
                await asyncio.sleep(0.005)
