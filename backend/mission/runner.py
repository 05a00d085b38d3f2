"""Runs one mission: gives inputs to the machine and carries its effects out with the equipment.

Everything happens on one event loop. `give` is synchronous: by the time it returns, a hold has cancelled the running
step and the vehicle's hold is on its way; the journal follows through the outbox, in order.
"""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable, Coroutine
from typing import Literal, assert_never

from backend.commands import ChangeArea, Command, Override, Resume
from backend.events import BeliefUpdated, Event
from backend.mission import effects, inputs
from backend.mission.equipment import Equipment
from backend.mission.listening import Listening, expected_pulses
from backend.mission.localization import Localization
from backend.mission.machine import transition
from backend.mission.measuring import Measured
from backend.mission.outbox import Outbox
from backend.mission.safety import Veto, battery_vetoes, resume_vetoes, staying_vetoes
from backend.mission.state import AUTOMATIC, TERMINAL, MissionState
from backend.mission.steps import Steps
from backend.mission.watch import Watch
from hardware.ports import HardwareError, PilotHasControl
from planner.types import PlannerError

log = logging.getLogger("crossfix.mission")

TRACK_SAVED_S = 2.5
KEEP_ON_S = 1.0
DOWN_AFTER_ABORT_S = 1.0
LOOK = "look at the vehicle and resume, or order the return"

Slot = Literal["command", "thinking", "belief"]


class Runner:
    """Lives from the start (or a restart) of a mission until its vehicle is down."""

    def __init__(
        self, mission_id: str, state: MissionState, last_seq: int, task: Localization, equipment: Equipment
    ) -> None:
        self.mission_id = mission_id
        self.task = task
        self._state = state
        self._equipment = equipment
        mission = state.mission
        self.listening = Listening(
            equipment.receiver,
            equipment.clock,
            mission.emitter.frequency_hz,
            mission.timers.receiver_silent_s,
            expected_pulses(mission.emitter),
        )
        self.outbox = Outbox(
            mission_id,
            equipment.journal,
            equipment.publisher,
            last_seq,
            lambda detail: self.give(inputs.NotStored(detail)),
        )
        self.watch = Watch(equipment, task.limits, self.listening, lambda: self._state, self.give)
        self.steps = Steps(equipment, task, mission_id, self.listening, self.watch.situation, self._keep_sweep)
        self._slots: dict[Slot, asyncio.Task[None]] = {}
        self._timers: dict[inputs.TimerName, asyncio.Task[None]] = {}
        self._background: list[asyncio.Task[None]] = []
        self._task_elsewhere: Localization | None = None
        self.finished = asyncio.Event()

    @property
    def state(self) -> MissionState:
        return self._state

    def begin(self) -> None:
        """Start watching."""
        self._background = [
            asyncio.create_task(self._keep_on("watching the vehicle", self.watch.run)),
            asyncio.create_task(self._keep_on("listening to the vehicle", self._changes)),
            asyncio.create_task(self._keep_on("keeping the track", self._save_track)),
        ]

    async def close(self) -> None:
        """Stop everything of this mission; what is recorded reaches the journal first. Sends nothing."""
        tasks = [*self._background, *self._slots.values(), *self._timers.values()]
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)
        self._flush_track()
        await self.outbox.close()
        await self.listening.stop()

    def give(self, given: inputs.Input) -> tuple[effects.Effect, ...]:
        """One input through the machine; its effects are under way when this returns."""
        now = self._equipment.clock.now()
        self._state, asked = transition(self._state, given, now)
        facts: list[Event] = [e.event for e in asked if isinstance(e, effects.Record)]
        for effect in asked:
            if not isinstance(effect, effects.Record | effects.Reply):
                self._carry_out(effect)
        self.outbox.record(facts)
        for fact in facts:
            if isinstance(fact, BeliefUpdated):
                self._show_belief(fact)
        if self._state.phase in ("done", "failed"):
            self.finished.set()
        return asked

    def command(self, command_id: str, by: str, command: Command) -> tuple[effects.Effect, ...]:
        """An operator's command; safety's objections to an override or to resuming are found first."""
        telemetry = self._equipment.vehicle.telemetry()
        on_ground = telemetry.in_air is False
        objections: tuple[Veto, ...] = ()
        if isinstance(command, Override):
            altitude = self.task.limits.home_amsl_m + self.task.mission.flight.altitude_relative_m
            objections = self.steps.override_vetoes(command.place, altitude)
        elif isinstance(command, Resume):
            objections = resume_vetoes(telemetry, self.watch.tolerated_mode)
            if on_ground and not self._state.localized:
                limits = self.task.limits
                objections += battery_vetoes(limits, self.watch.situation(), limits.measurement_time_s)
        failsafe_flies = self.watch.failsafe_flies
        given = inputs.Commanded(
            command_id, by, command, objections, on_ground=on_ground, failsafe_flies=failsafe_flies
        )
        return self.give(given)

    def change_area(
        self, command_id: str, by: str, command: ChangeArea, task: Localization | Veto
    ) -> tuple[effects.Effect, ...]:
        """`task`: of the new area, or why there is none; it takes a thread's time to make."""
        if isinstance(task, Veto):
            return self.give(inputs.Commanded(command_id, by, command, (task,)))
        self._task_elsewhere = task
        objections = staying_vetoes(task.limits, self.watch.situation())
        return self.give(inputs.Commanded(command_id, by, command, objections))

    def _adopt(self, task: Localization | None) -> None:
        if task is None or task.mission != self._state.mission:
            raise RuntimeError("the search area changed without its task")
        self.task = task
        self.watch.limits = task.limits
        self.steps.adopt(task)

    def _carry_out(self, effect: effects.Effect) -> None:
        vehicle = self._equipment.vehicle
        match effect:
            case effects.CancelWork():
                self._cancel("command")
                self._cancel("thinking")
            case effects.TakeOff():
                self._run("command", "take_off", self.steps.take_off(effect))
            case effects.FlyTo():
                self._run("command", "fly", self.steps.fly(effect))
            case effects.Measure():
                self._run("command", "measure", self.steps.measure(effect))
            case effects.HoldVehicle():
                self._run("command", "hold", _silently(vehicle.hold()))
            case effects.ReturnHome(hold_first=hold_first):
                self._run("command", "return", self._return_home(hold_first))
            case effects.Land():
                self._run("command", "land", self._land())
            case effects.PlanNext():
                self._run("thinking", "plan", self.steps.plan(effect, self._state.bearings))
            case effects.SearchElsewhere():
                self._adopt(self._task_elsewhere)
            case effects.UpdateBelief():
                self._run("belief", "belief", self.steps.belief(self._state.bearings))
            case effects.ReleasePilotLatch():
                vehicle.release_pilot_latch()
            case effects.StartTimer(name=name, seconds=seconds):
                self._stop_timer(name)
                self._timers[name] = asyncio.create_task(self._expire(name, seconds))
            case effects.CancelTimer(name=name):
                self._stop_timer(name)
            case effects.Record() | effects.Reply():
                pass
            case _:
                assert_never(effect)

    async def _land(self) -> None:
        if not (self._down or self.watch.failsafe_flies):
            await self._equipment.vehicle.land()

    @property
    def _down(self) -> bool:
        telemetry = self._equipment.vehicle.telemetry()
        return telemetry.in_air is False and telemetry.armed is False

    async def _return_home(self, hold_first: bool) -> None:
        vehicle = self._equipment.vehicle
        if self._down or self.watch.failsafe_flies:
            return
        if hold_first:
            try:
                await vehicle.hold()
            except PilotHasControl:
                raise
            except HardwareError as error:
                log.warning("mission %s: no hold before the return: %s", self.mission_id, error)
        await vehicle.return_home()

    # Steps: one a slot, the newest wins; the result of a cancelled one is never given

    def _cancel(self, slot: Slot) -> None:
        running = self._slots.pop(slot, None)
        if running is not None and running is not asyncio.current_task():
            running.cancel()

    def _run(self, slot: Slot, name: inputs.StepName, step: Coroutine[None, None, inputs.Input | None]) -> None:
        self._cancel(slot)
        self._slots[slot] = asyncio.create_task(self._finish(slot, name, step))

    async def _finish(
        self, slot: Slot, name: inputs.StepName, step: Coroutine[None, None, inputs.Input | None]
    ) -> None:
        task = asyncio.current_task()
        try:
            result = await step
        except PilotHasControl as error:
            self.watch.notice_pilot(str(error))
            unnoticed = self._state.phase in AUTOMATIC
            result = self._failure(name, str(error), LOOK) if unnoticed else None
        except (HardwareError, PlannerError) as error:
            result = self._failure(name, str(error), LOOK)
        except Exception:
            log.exception("mission %s: the step %s failed", self.mission_id, name)
            result = self._failure(name, f"the step {name!r} failed inside Crossfix", "resume, or order the return")
        if result is not None and self._slots.get(slot) is task:
            del self._slots[slot]
            try:
                self.give(result)
            except Exception:
                log.exception("mission %s: the result of the step %s could not be taken", self.mission_id, name)
                self.give(
                    self._failure(name, f"the step {name!r} failed inside Crossfix", "resume, or order the return")
                )

    def _failure(self, name: inputs.StepName, detail: str, remedy: str) -> inputs.WorkFailed:
        telemetry = self._equipment.vehicle.telemetry()
        may_rise = telemetry.in_air is False and telemetry.armed is not False
        return inputs.WorkFailed(name, detail, remedy, None if may_rise else telemetry.in_air)

    def _stop_timer(self, name: inputs.TimerName) -> None:
        timer = self._timers.pop(name, None)
        if timer is not None and timer is not asyncio.current_task():
            timer.cancel()

    async def _expire(self, name: inputs.TimerName, seconds: float) -> None:
        """Consoles and the people before them live in the wall's time, however fast a simulation runs."""
        if name == "landing":
            await self._equipment.clock.sleep(seconds)
        else:
            await asyncio.sleep(seconds)
        self.give(inputs.TimerExpired(name))

    # What goes on beside the steps

    async def _keep_on(self, what: str, work: Callable[[], Coroutine[None, None, None]]) -> None:
        """In flight these must not end: a fault of ours holds the mission, and they begin anew."""
        while True:
            try:
                await work()
                return
            except Exception:
                log.exception("mission %s: %s failed", self.mission_id, what)
                self.give(self._failure("hold", f"{what} failed inside Crossfix", "resume, or order the return"))
                await asyncio.sleep(KEEP_ON_S)

    async def _changes(self) -> None:
        async for line in self._equipment.vehicle.changes():
            self.watch.notice_pilot(line)

    async def _save_track(self) -> None:
        on_ground_s = 0.0
        while True:
            await self._equipment.clock.sleep(TRACK_SAVED_S)
            self._flush_track()
            on_ground_s = on_ground_s + TRACK_SAVED_S if self._state.phase in TERMINAL and self._down else 0.0
            if on_ground_s > DOWN_AFTER_ABORT_S:
                self.finished.set()

    def _flush_track(self) -> None:
        points, self.watch.track = self.watch.track, []
        if points:

            async def save() -> None:
                await self._equipment.journal.save_track(self.mission_id, points)

            self.outbox.after(save)

    def _keep_sweep(self, found: Measured, place_number: int, attempt: int) -> None:
        sweep = found.sweep
        if sweep is not None:

            async def save() -> None:
                await self._equipment.journal.save_sweep(self.mission_id, found.sweep_id, place_number, attempt, sweep)

            self.outbox.after(save)

    def _show_belief(self, fact: BeliefUpdated) -> None:
        current = self.steps.current_belief()
        if current is None:
            return
        _, belief = current
        corners = self.task.corners_lon_lat(belief)

        async def show() -> None:
            self._equipment.publisher.belief(self.mission_id, fact.bearings, belief, corners)

        self.outbox.after(show)


async def _silently(command: Coroutine[None, None, None]) -> None:
    """A command whose success is no news."""
    await command
