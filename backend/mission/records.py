"""Missions as the journal has them: read, folded, and written to while none of their craft flies."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Collection, Sequence

from backend.beside import beside
from backend.events import Event, Recorded
from backend.mission.effects import Effect
from backend.mission.inputs import Input
from backend.mission.machine import transition
from backend.mission.state import MissionState, fold_on
from backend.ports import Journal, Listed, Publisher
from backend.search.area import corner_of
from backend.search.effects import Record
from backend.search.errors import MissionInputError, MissionNotFound
from backend.search.together import together
from hardware.ports import Clock
from planner.types import PlannerError

log = logging.getLogger("crossfix.mission")

PIECE = 1_000
"""Facts in memory at once."""


class Records:
    """One lock a mission: whoever reads a state to change it holds that."""

    def __init__(self, journal: Journal, publisher: Publisher, clock: Clock) -> None:
        self._journal = journal
        self._publisher = publisher
        self._clock = clock
        self._locks: dict[str, asyncio.Lock] = {}

    def lock(self, mission_id: str) -> asyncio.Lock:
        """The same one for every caller, made at the first call."""
        return self._locks.setdefault(mission_id, asyncio.Lock())

    async def of_kinds(self, mission_id: str, kinds: Collection[str]) -> list[Recorded]:
        """Its facts of these kinds only, in order. Raises MissionNotFound."""
        recorded = await self._journal.read_kinds(mission_id, kinds)
        if not recorded:
            await self.listed(mission_id)
        return recorded

    async def load(self, mission_id: str, known: tuple[MissionState, int] | None = None) -> tuple[MissionState, int]:
        """The state, and the number of the last fact. known: what an earlier call gave; only what came since is read.
        A large mission is folded a piece at a time: the garbage collector stops everything for as long as it looks at
        all its facts at once. Raises MissionNotFound."""
        state, last_seq = (MissionState(), 0) if known is None else known
        while piece := await self._journal.read(mission_id, last_seq, PIECE):
            state = await beside(len(piece), fold_on, state, piece)
            last_seq = piece[-1].seq
            if len(piece) < PIECE:
                break
        if last_seq == 0:
            raise MissionNotFound(mission_id)
        return state, last_seq

    async def give(self, mission_id: str, state: MissionState, given: Input) -> tuple[tuple[Effect, ...], int | None]:
        """A mission that does not fly: only its facts and its answer matter. The last seq, None without a fact."""
        _, asked = transition(state, given, self._clock.now())
        return asked, await self.append(mission_id, [e.event for e in asked if isinstance(e, Record)])

    async def append(self, mission_id: str, events: Sequence[Event]) -> int | None:
        """The last seq, None without an event."""
        if not events:
            return None
        recorded = await self._journal.append(mission_id, events)
        self._publisher.events(recorded)
        return recorded[-1].seq

    async def append_unread(self, mission_id: str, events: Sequence[Event]) -> None:
        """To a mission whose facts cannot be read; see ports.Journal."""
        self._publisher.events(await self._journal.append_unread(mission_id, events))

    async def listed(self, mission_id: str) -> Listed:
        """Raises MissionNotFound."""
        listed = await self._journal.listed(mission_id)
        if listed is None:
            raise MissionNotFound(mission_id)
        return listed

    async def settle_beliefs(self, mission_id: str) -> None:
        """On the ground nobody folds the beliefs when bearings come or go, or the area under them changes."""
        search, tasks = (await self.load(mission_id))[0].search, None
        for emitter in search.emitters.values():
            if emitter.belief_current or not emitter.measured:
                continue
            home = search.home or corner_of(search.mission.area)
            try:
                if tasks is None or emitter.emitter_id not in tasks.emitters:
                    tasks = await asyncio.to_thread(together, search.mission, home, emitter.emitter_id)
                task = tasks.about(search, emitter.emitter_id)
                belief, _ = await asyncio.to_thread(task.belief_fact, emitter.bearings)
            except (MissionInputError, PlannerError) as error:
                log.warning("mission %s: no belief can be made of its bearings: %s", mission_id, error)
                continue
            await self.append(mission_id, [belief])
