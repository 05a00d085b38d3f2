"""Runs one mission: gives inputs to its machine, hands effects to the craft and the beliefs, facts to the outbox.

Everything happens on one event loop. `give` is synchronous: when it returns, what moves or stops a vehicle is under
way; the journal follows through the outbox, in order.
"""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Sequence
from functools import partial

from backend.commands import Author, CommandRequest, ForCraft, Override
from backend.craft import inputs as craft_inputs
from backend.craft.equipment import CraftEquipment
from backend.craft.measuring import Measured
from backend.craft.orders import resume_refusal
from backend.craft.runner import CraftRunner
from backend.craft.safety import limits_of, resume_vetoes, staying_vetoes
from backend.craft.state import CraftState
from backend.events import BeliefUpdated, Event, Recorded
from backend.logs import about
from backend.mission.beliefs import Beliefs
from backend.mission.effects import Effect, OfCraft, Reply
from backend.mission.equipment import MissionEquipment
from backend.mission.inputs import Commanded, Context, Input, ToCraft
from backend.mission.machine import transition
from backend.mission.outbox import Outbox
from backend.mission.state import MissionState
from backend.mission.told_forecasts import ToldForecasts
from backend.ports import TrackPoint
from backend.reasons import Reason
from backend.reasons.flight import OtherAntenna
from backend.reasons.refusals import NetsChanging
from backend.search.antenna import antenna_fact
from backend.search.effects import Record, SearchElsewhere, UpdateBelief
from backend.search.inputs import NotStored
from backend.search.state import SearchState
from backend.search.task import SearchTask

log = logging.getLogger("crossfix.mission")


class MissionRunner:
    """Lives from the start (or a restart) of a mission until all its craft are down."""

    def __init__(
        self, mission_id: str, state: MissionState, last_seq: int, task: SearchTask, equipment: MissionEquipment
    ) -> None:
        self.mission_id = mission_id
        self.task = task
        self._state = state
        self._equipment = equipment
        self._next_task: SearchTask | None = None
        self.outbox = Outbox(
            mission_id,
            equipment.journal,
            equipment.publisher,
            last_seq,
            lambda detail: self.give(NotStored(detail)),
        )
        self._beliefs = Beliefs(task, self.give)
        self.crafts: dict[str, CraftRunner] = {}
        self.finished = asyncio.Event()
        self.told = ToldForecasts()

    @property
    def state(self) -> MissionState:
        """Folded from all facts so far, stored already or still on their way to the journal."""
        return self._state

    def join(self, craft: CraftEquipment) -> CraftRunner:
        """A craft flies for this mission from now on; its receiver listens at once."""
        craft_id = craft.craft_id
        flying = {one.craft_id: one.antenna for one in self._state.engaged}
        craft = craft.flown_with(self.task.mission.sensor, flying.get(craft_id))
        runner = self.crafts[craft_id] = CraftRunner(
            self.mission_id,
            craft,
            self.task,
            lambda: self._state.crafts.get(craft_id, CraftState(craft_id)),
            self._search,
            lambda given: self.give(ToCraft(craft_id, given)),
            partial(self._keep_track, craft_id),
            partial(self._keep_sweep, craft_id),
        )
        with about(self.mission_id, craft_id, command=None):
            runner.listening.start()
        return runner

    def begin(self) -> None:
        """Start watching."""
        for craft_id, craft in self.crafts.items():
            with about(self.mission_id, craft_id, command=None):
                craft.begin()

    async def close(self, patience_s: float | None = None) -> None:
        """Stop everything of this mission; what is recorded reaches the journal first, unless nothing can be stored for
        patience_s. Sends nothing."""
        for craft in self.crafts.values():
            await craft.close()
        await self._beliefs.close()
        await self.outbox.close(patience_s)

    def give(self, given: Input) -> tuple[Effect, ...]:
        """One input through the machine; its effects are under way when this returns."""
        self._state, asked = transition(self._state, given, self._equipment.clock.now())
        facts: list[Event] = []
        for effect in asked:
            match effect:
                case Record(event=event):
                    facts.append(event)
                case OfCraft(craft_id=craft_id, effect=wanted):
                    if craft_id in self.crafts:
                        with about(self.mission_id, craft_id):
                            self.crafts[craft_id].carry_out(wanted)
                case UpdateBelief(emitter_id=emitter_id):
                    self._beliefs.update(self._state.search, emitter_id)
                case SearchElsewhere():
                    self._adopt()
                case Reply():
                    pass
        belief_moved = any(isinstance(fact, BeliefUpdated) for fact in facts)
        self.outbox.record(facts, self._show_beliefs if belief_moved else None)
        if not self._state.engaged and self._state.search.started_at_s is not None:
            self.finished.set()
        return asked

    def command(self, request: CommandRequest, author: Author, holder_gone: bool = False) -> tuple[Effect, ...]:
        """An operator's command; who flies and what safety has against it are found first: an order may take a vehicle
        from its failsafe, never from a pilot who has just taken it."""
        for craft in self.crafts.values():
            craft.watch.look_at_authority()
        command, contexts = request.command, dict[str, Context]()
        if isinstance(command, ForCraft):
            contexts = {
                craft_id: Context(
                    craft.objections(command),
                    on_ground=craft.equipment.vehicle.telemetry().in_air is False,
                    altitude_amsl_m=craft.altitude_of(command),
                    foretold=self.told.of(self._state.search, command.place) if isinstance(command, Override) else None,
                )
                for craft_id, craft in self.crafts.items()
            }
        given = Commanded(
            str(request.command_id), author, command, contexts, fence=request.fence, holder_gone=holder_gone
        )
        return self.give(given)

    def change_area(self, request: CommandRequest, author: Author, task: SearchTask | Reason) -> tuple[Effect, ...]:
        """`task`: of the new area, or why there is none; it takes a thread's time to make."""

        def commanded(search: Context) -> Commanded:
            return Commanded(str(request.command_id), author, request.command, search=search, fence=request.fence)

        if not isinstance(task, SearchTask):
            return self.give(commanded(Context((task,))))
        self._next_task = task
        limits = limits_of(task)
        objections = tuple(
            veto for craft in self.crafts.values() for veto in staying_vetoes(limits, craft.watch.situation())
        )
        return self.give(commanded(Context(objections)))

    def waits_for_nets(self, craft_id: str) -> bool:
        """Nothing else keeps the craft from being resumed: a pilot who flies is not fenced in."""
        craft, telemetry = self._state.crafts[craft_id], self.crafts[craft_id].equipment.vehicle.telemetry()
        waits = craft.nets_wait and self._state.search.stage != "ended"
        only_nets = resume_refusal(craft, self._state.search) in (None, NetsChanging())
        return waits and only_nets and telemetry.connected and not resume_vetoes(telemetry)

    def recover(self) -> None:
        """After a restart: each craft of ours in hold, unless somebody else flies it or it has come down as ordered."""
        for craft in self.crafts.values():
            telemetry = craft.equipment.vehicle.telemetry()
            on_ground = telemetry.connected and telemetry.in_air is False and telemetry.armed is False
            other_antenna = self._other_antenna(craft.equipment)
            back = craft_inputs.Restarted(telemetry.authority, on_ground, other_antenna)
            self.give(ToCraft(craft.equipment.craft_id, back))

    def _other_antenna(self, flown: CraftEquipment) -> OtherAntenna | None:
        """None: the server was given the same one, to the last value."""
        given = self._equipment.crafts[flown.craft_id].flown_with(self.task.mission.sensor).pattern
        same = antenna_fact(given) == antenna_fact(flown.pattern)
        return None if same else OtherAntenna(flown.pattern.name, given.name)

    def leave(self) -> None:
        """The server is about to end: what only flies on with it is held, a return by our own way points too."""
        for craft_id, craft in self.crafts.items():
            homeward = craft.equipment.vehicle.telemetry().authority.homeward
            self.give(ToCraft(craft_id, craft_inputs.Leaving(homeward)))

    def _adopt(self) -> None:
        task = self._next_task
        # the order of importance may have changed while the task was made; the task does not know it
        mission = self._state.search.mission
        if task is None or task.mission.in_order(mission.priorities) != mission:
            raise RuntimeError("the search area changed without its task")
        self.task = task
        self._beliefs.adopt(task)
        for craft in self.crafts.values():
            craft.adopt(task)

    def _search(self) -> SearchState:
        return self._state.search

    def _keep_track(self, craft_id: str, points: Sequence[TrackPoint]) -> None:
        async def save() -> None:
            await self._equipment.journal.save_track(self.mission_id, craft_id, points)

        self.outbox.after(save)

    def _keep_sweep(self, craft_id: str, found: Measured, place_number: int, attempt: int) -> None:
        sweep, emitter_id = found.sweep, found.fact.emitter_id
        if sweep is None:
            return

        async def save() -> None:
            await self._equipment.journal.save_sweep(
                self.mission_id, found.sweep_id, craft_id, emitter_id, place_number, attempt, sweep
            )

        self.outbox.after(save)

    def _show_beliefs(self, recorded: Sequence[Recorded]) -> None:
        """The belief of a BeliefUpdated as soon as that has its number."""
        for record in recorded:
            if not isinstance(record.event, BeliefUpdated):
                continue
            newest = self._beliefs.newest(record.event.emitter_id)
            if newest is not None:
                self._equipment.publisher.belief(
                    self.mission_id, record.event.emitter_id, record.seq, record.event.bearings, *newest
                )
