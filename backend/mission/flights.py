"""The missions in the air: started, commanded, brought back after a restart, let go when their craft are down.

A craft flies for one mission at a time. Commands are idempotent by their id, across restarts too: the answers are
facts.
"""

from __future__ import annotations

import asyncio
import logging
import time
from collections.abc import Callable
from dataclasses import dataclass, field

from backend import commands
from backend.commands import Author, CommandReply, CommandRequest, CraftRequest
from backend.craft.checklist import checklist
from backend.craft.equipment import CraftEquipment
from backend.craft.ground_check import ground_fact
from backend.craft.inputs import Abandoned, StartFacts
from backend.craft.listening import Listening
from backend.craft.loose import LooseCraft
from backend.craft.runner import CraftRunner
from backend.craft.safety import resume_vetoes
from backend.craft.state import CraftState
from backend.events import GroundFact, Phase
from backend.mission import control
from backend.mission.effects import Effect
from backend.mission.elsewhere import Elsewhere
from backend.mission.equipment import MissionEquipment
from backend.mission.inputs import Commanded, Context, Input, ServerCameBack, ToCraft
from backend.mission.learning import learn
from backend.mission.nets import NetsKeeper
from backend.mission.presses import Presses
from backend.mission.records import Records
from backend.mission.replies import refusal, reply
from backend.mission.runner import MissionRunner
from backend.mission.state import MissionState
from backend.reasons import Interrupted, Reason
from backend.reasons.refusals import AnotherMissionFlies, LaterOrderCounts, MissionOver, ServerIsEnding, WasDeleted
from backend.reasons.safety import AlreadyInAir
from backend.reasons.terrain import GroundNotKept
from backend.search.antenna import antenna_fact
from backend.search.errors import MissionInputError
from backend.search.inputs import SearchOver
from backend.search.planning import lay_out_ways, needs_program
from backend.search.state import SearchState
from backend.search.task import SearchTask, search_task
from backend.terrain import Terrain, unknown_terrain
from hardware.authority import NOBODY, Who

log = logging.getLogger("crossfix.mission")


Operates = Callable[[str], bool]
"""Of an account's id: may it give commands now?"""


def everybody(_person: str) -> bool:
    """Where nobody is ever shut out."""
    return True


ANSWERED_S = 3.0
"""For so long an answer waits for a disk on which nothing can be stored."""
PARTING_S = 20.0
"""And for so long a server that ends."""
WHILE_ENDING = (commands.Hold, commands.Return, commands.Land, commands.Abort, commands.AcknowledgeAlert)


@dataclass(frozen=True, slots=True)
class LeftFlying:
    """A craft in the air when the server ends. confirmed: it does what its phase says; False: it has not confirmed
    what it was ordered, and its autopilot's failsafe has to act."""

    craft_id: str
    phase: Phase
    who: Who
    confirmed: bool


@dataclass(slots=True)
class Flights:
    """active: the mission in the air, None when all craft are down. starting: held while one is started, or while
    something needs that none is. loose: every craft, for the time that it flies for no mission."""

    equipment: MissionEquipment
    records: Records
    nets: NetsKeeper
    active: MissionRunner | None = None
    starting: asyncio.Lock = field(default_factory=asyncio.Lock)
    loose: dict[str, LooseCraft] = field(init=False)
    elsewhere: Elsewhere = field(init=False)
    ending: bool = False
    presses: Presses = field(default_factory=Presses)
    _tasks: list[asyncio.Task[None]] = field(default_factory=list[asyncio.Task[None]])

    def __post_init__(self) -> None:
        def loose(craft: CraftEquipment) -> LooseCraft:
            return LooseCraft(craft, lambda: self.craft(craft.craft_id) is not None)

        self.loose = {craft_id: loose(craft) for craft_id, craft in self.equipment.crafts.items()}
        self.elsewhere = Elsewhere(self.nets)

    def running(self, mission_id: str) -> MissionRunner | None:
        """The runner of this mission, None when it does not fly."""
        runner = self.active
        if runner is None or runner.mission_id != mission_id or runner.state.search.started_at_s is None:
            return None
        return runner

    def craft(self, craft_id: str) -> CraftRunner | None:
        """The runner of this craft, None when it flies for no mission."""
        return None if self.active is None else self.active.crafts.get(craft_id)

    def listening(self, craft_id: str) -> Listening | None:
        """None while the craft does not fly: then nobody drains its receiver."""
        craft = self.craft(craft_id)
        return None if craft is None else craft.listening

    async def give(self, mission_id: str, given: Input) -> int | None:
        """To a mission, whether it flies or not. The last seq, None without a fact. Raises MissionNotFound."""
        runner = self.running(mission_id)
        if runner is not None:
            runner.give(given)
            await runner.outbox.flushed()
            return runner.outbox.last_seq
        state, _ = await self.records.load(mission_id)
        _, seq = await self.records.give(mission_id, state, given)
        return seq

    # Commands

    async def command(
        self, mission_id: str, request: CommandRequest, author: Author, operates: Operates = everybody
    ) -> CommandReply:
        """Carry out or refuse. The same command id gets the same answer. operates: may this person still operate?

        Raises MissionNotFound.
        """
        runner = self.running(mission_id)
        if self.ending and not isinstance(request.command, WHILE_ENDING):
            return reply(request, ServerIsEnding())
        if runner is not None and isinstance(request.command, commands.ChangeArea):
            changed = await self.elsewhere.change(lambda: self.running(mission_id), request, request.command, author)
            if changed is not None:
                return await _answered(changed[0], request, changed[1])
            runner = None
        if runner is not None:
            return await self._in_flight(runner, request, author, operates)
        async with self.records.lock(mission_id):
            runner = self.running(mission_id)
            if runner is not None:
                return await self._in_flight(runner, request, author, operates)
            return await self._on_the_ground(mission_id, request, author, operates)

    async def command_craft(self, craft_id: str, request: CraftRequest, author: Author) -> CommandReply:
        """To a craft in the air, whether it flies for a mission or not. Raises KeyError for an unknown craft."""
        loose, runner, command_id = self.loose[craft_id], self.active, request.command_id
        if runner is not None and craft_id in runner.crafts:
            named = request.command.model_copy(update={"craft_id": craft_id})
            in_mission = CommandRequest(command_id=command_id, command=named, fence=request.fence, press=request.press)
            return await self._in_flight(runner, in_mission, author, everybody)
        if self.presses.is_late(request.press, request.command, [craft_id]) and not loose.answered(str(command_id)):
            return reply(request, LaterOrderCounts())
        refused = loose.order(str(command_id), author.name, request.command)
        if refused is None:
            self.presses.accepted(request.press, request.command, [craft_id])
        return reply(request, refused)

    async def _in_flight(
        self, runner: MissionRunner, request: CommandRequest, author: Author, operates: Operates
    ) -> CommandReply:
        """At once: what moves or stops the vehicle is under way before the journal is waited for, and is answered for
        where nothing can be stored."""
        command, press = request.command, request.press
        named = command.craft_id if isinstance(command, commands.CraftCommand) else None
        crafts = list(runner.crafts) if named is None else [named]
        known = str(request.command_id) in runner.state.answered
        if self.presses.is_late(press, command, crafts) and not known:
            return reply(request, LaterOrderCounts())
        asked = runner.command(request, author, holder_gone(runner.state, operates))
        if refusal(asked) is None:
            self.presses.accepted(press, command, crafts)
        return await _answered(runner, request, asked)

    async def _on_the_ground(
        self, mission_id: str, request: CommandRequest, author: Author, operates: Operates
    ) -> CommandReply:
        state, last_seq = await self.records.load(mission_id)
        command_id = str(request.command_id)
        match request.command:
            case commands.Start() as start if state.search.stage in ("draft", "ready"):
                in_control = control.objection(state.control, author, request.fence, start) is None
                if command_id not in state.answered and in_control:
                    return await self._start(mission_id, state, last_seq, request, start, author)
            case _:
                pass
        over = (MissionOver(),) if state.search.stage == "ended" else ()
        contexts = {craft_id: Context(over) for craft_id in state.crafts}
        gone = holder_gone(state, operates)
        given = Commanded(command_id, author, request.command, contexts, fence=request.fence, holder_gone=gone)
        asked, seq = await self.records.give(mission_id, state, given)
        if isinstance(request.command, commands.ExcludeBearing | commands.IncludeBearing | commands.MuteSource):
            await self.records.settle_beliefs(mission_id)
        return reply(request, refusal(asked), seq or last_seq)

    async def _start(
        self,
        mission_id: str,
        state: MissionState,
        last_seq: int,
        request: CommandRequest,
        command: commands.Start,
        author: Author,
    ) -> CommandReply:
        def commanded(contexts: dict[str, Context]) -> Commanded:
            return Commanded(str(request.command_id), author, command, contexts, fence=request.fence)

        craft = self.equipment.crafts.get(command.craft_id or self.equipment.first.craft_id)
        if craft is None:
            asked, seq = await self.records.give(mission_id, state, commanded({}))
            return reply(request, refusal(asked), seq or last_seq)
        async with self.starting:
            known = await self.equipment.knowing(state.search.mission, craft)
            objections: tuple[Reason, ...] = ()
            if self.active is not None:
                objections = (AnotherMissionFlies(self.active.state.search.mission.name),)
            elif craft.vehicle.telemetry().in_air:
                objections = (AlreadyInAir(),)
            elif state.search.deleted:
                objections = (WasDeleted(),)
            listening, grounds = self.listening(craft.craft_id), self.equipment.grounds
            checks, task = await checklist(known, craft, listening, state.search.antenna, grounds, state.search)
            home, home_amsl_m = (None, None) if task is None else (task.home, task.home_amsl_m)
            software, antenna = self.equipment.software, antenna_fact(craft.flown_with(known.sensor).pattern)
            ground, not_kept = await self._keep_ground(task)
            objections += not_kept
            learned = known.sensor.learned
            start = StartFacts(() if objections else checks, home, home_amsl_m, software, antenna, ground, learned)
            objections += resume_vetoes(craft.vehicle.telemetry())
            if task is not None and not objections and all(check.ok or not check.blocking for check in checks):
                trouble = await self.nets.put_up(mission_id, craft, task)
                objections = () if trouble is None else (trouble,)
                state, last_seq = await self.records.load(mission_id)
            given = commanded({craft.craft_id: Context(objections, start)})
            if task is None or objections:
                asked, seq = await self.records.give(mission_id, state, given)
                return reply(request, refusal(asked), seq or last_seq)
            runner = MissionRunner(mission_id, state, last_seq, task, self.equipment)
            self.active = runner
            runner.join(craft)
            asked = runner.give(given)
            if runner.state.search.started_at_s is None:
                self.active = None
                await runner.close()
            else:
                self._fly(runner)
                await runner.outbox.flushed(ANSWERED_S)
            return reply(request, refusal(asked), runner.outbox.last_seq)

    async def _keep_ground(self, task: SearchTask | None) -> tuple[GroundFact | None, tuple[Reason, ...]]:
        """What is flown over, stored before anything flies, and what forbids the start when it cannot be."""
        if task is None or task.ground.terrain is None:
            return None, ()
        try:
            await self.equipment.grounds.keep(task.ground.terrain)
        except OSError as error:
            return None, (GroundNotKept(error.strerror or str(error)),)
        return ground_fact(task), ()

    async def _ground_of(self, search: SearchState) -> Terrain | None:
        """The same ground as at the start; when it is lost, one that nothing is known of."""
        if search.ground is None or search.home is None:
            return None
        kept = await self.equipment.grounds.kept(search.ground.digest)
        if kept is None:
            log.error("the ground that a mission was started over is lost: %s", search.ground.digest)
        return unknown_terrain(search.home) if kept is None else kept

    def _fly(self, runner: MissionRunner) -> None:
        if needs_program(runner.state.search.mission):
            self.equipment.prepare_planner(runner.task.first.problem)
        runner.begin()
        self._tasks.append(asyncio.create_task(self._let_go(runner)))

    async def _let_go(self, runner: MissionRunner) -> None:
        """When a mission's craft are down, the next may start."""
        await runner.finished.wait()
        await runner.close()
        if self.active is runner:
            self.active = None
        await learn(self.equipment, runner)
        async with self.starting:
            if self.active is None:
                await self.nets.settle()

    # Life

    async def recover(self) -> None:
        """Bring back what was in the air when the server went away: in hold, unless somebody else flies it."""
        await self.nets.recall()
        self._tasks.append(asyncio.create_task(self.nets.run(self.starting, lambda: self.active is not None)))
        self._tasks.append(asyncio.create_task(self.elsewhere.run(lambda: self.active)))
        unfinished = await self.equipment.journal.unfinished()
        for mission_id in unfinished:
            try:
                if mission_id == unfinished[-1]:
                    await self._recover(mission_id)
                else:
                    await self._close_interrupted(mission_id, Interrupted("later_mission"))
            except ValueError as error:  # damaged, or facts of which no mission can be made
                log.error("mission %s does not come back, and its craft fly for none: %s", mission_id, error)
        for craft_id, craft in self.equipment.crafts.items():
            if self.craft(craft_id) is None:
                craft.vehicle.restore(NOBODY)  # its failsafe may be acting on the silence before this server
            self._tasks.append(asyncio.create_task(self.loose[craft_id].run()))

    async def _recover(self, mission_id: str) -> None:
        state, last_seq = await self.records.load(mission_id)
        search = state.search
        if search.home is None or not state.engaged:
            return
        try:
            task = search_task(search.mission, search.home, search.home_amsl_m, await self._ground_of(search))
        except MissionInputError as error:
            log.error("mission %s: %s", mission_id, error)
            await self._close_interrupted(mission_id, Interrupted("unreadable"))
            return
        runner = self.active = MissionRunner(mission_id, state, last_seq, task, self.equipment)
        for craft in state.engaged:
            known: CraftEquipment | None = self.equipment.crafts.get(craft.craft_id)
            if known is not None:
                known.vehicle.restore(craft.authority)
                runner.join(known)
        runner.give(ServerCameBack())
        runner.recover()
        await asyncio.to_thread(lay_out_ways, task.first)  # the first look at the way home would do it on this thread
        self._fly(runner)
        log.warning("mission %s is back, in %s", mission_id, runner.state.phase)

    async def _close_interrupted(self, mission_id: str, why: Interrupted) -> None:
        """What no craft of ours flies any more is over, and says so in the list of missions."""
        state, _ = await self.records.load(mission_id)
        for craft in state.engaged:
            await self.give(mission_id, ToCraft(craft.craft_id, Abandoned(why)))
        await self.give(mission_id, SearchOver(why, "failed"))
        log.error("mission %s is closed as interrupted: %s", mission_id, why.because)

    async def leave(self, patience_s: float) -> list[LeftFlying]:
        """Hold what flies by itself before this server ends, and say how each craft in the air is left.

        One that does not confirm it in time (seconds of wall time) is handed to its autopilot's failsafe: its link is
        closed at once, so that nothing of ours keeps that from acting.
        """
        self.ending, runner = True, self.active
        if runner is not None:
            runner.leave()
        for loose in self.loose.values():
            loose.leave()
        until = time.monotonic() + patience_s

        def flying() -> list[CraftState]:
            engaged = () if runner is None else runner.state.engaged
            return [*engaged, *(loose.state for loose in self.loose.values() if loose.state is not None)]

        def under_way(craft: CraftState) -> bool:
            return craft.ladder is not None and craft.ladder.stage != "done"

        while any(map(under_way, flying())) and time.monotonic() < until:  # noqa: ASYNC110 (a few seconds)
            await asyncio.sleep(0.02)
        left = [LeftFlying(c.craft_id, c.phase, c.authority.who, not under_way(c)) for c in flying()]
        for craft in left:
            if not craft.confirmed and craft.craft_id in self.equipment.crafts:
                await self.equipment.crafts[craft.craft_id].vehicle.close()
        return left

    async def close(self) -> None:
        """Stops watching; each vehicle goes on with what it was ordered, and its own failsafe acts."""
        for task in self._tasks:
            task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)
        if self.active is not None:
            await self.active.close(PARTING_S)
            self.active = None


def holder_gone(state: MissionState, operates: Operates) -> bool:
    """Who holds the lease may no longer operate: nobody needs to wait for their answer."""
    holder = state.control.holder
    return holder is not None and not operates(holder.person)


async def _answered(runner: MissionRunner, request: CommandRequest, asked: tuple[Effect, ...]) -> CommandReply:
    await runner.outbox.flushed(ANSWERED_S)
    return reply(request, refusal(asked), runner.outbox.last_seq)
