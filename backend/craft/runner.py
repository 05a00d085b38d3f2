"""Runs one craft of a mission: carries its machine's effects out with its equipment, and says what came of them.

Everything happens on one event loop. `carry_out` is synchronous: by the time it returns, a hold has cancelled the
running work and the vehicle's hold is on its way.
"""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable, Coroutine, Sequence
from functools import partial
from typing import Literal, assert_never

from backend.commands import ForCraft, Override, Resume
from backend.craft import effects, inputs
from backend.craft.equipment import CraftEquipment
from backend.craft.listening import Listening, channels_of
from backend.craft.measuring import Measured
from backend.craft.safety import Limits, battery_vetoes, limits_of, resume_vetoes
from backend.craft.state import AUTOMATIC, CraftState
from backend.craft.watch.watch import Watch
from backend.craft.work import Work
from backend.ports import TrackPoint
from backend.reasons import Reason, carried
from backend.reasons.flight import StepBroke, StepName, WatchBroke
from backend.search.state import SearchState
from backend.search.task import SearchTask
from hardware.ports import HardwareError, NotInControl
from planner.types import PlannerError

log = logging.getLogger("crossfix.craft")

TRACK_SAVED_S = 2.5
KEEP_ON_S = 1.0

Slot = Literal["command", "planning"]
Doing = Callable[[], Coroutine[None, None, inputs.CraftInput | None]]
"""A piece of work, begun when its turn comes: one that is cancelled before was never begun."""


class CraftRunner:
    """Lives from the start (or a restart) of a mission until its vehicle is down.

    craft, search: what the mission knows now. give: takes the machine's inputs. keep_track, keep_sweep: to the journal.
    """

    def __init__(
        self,
        mission_id: str,
        equipment: CraftEquipment,
        task: SearchTask,
        craft: Callable[[], CraftState],
        search: Callable[[], SearchState],
        give: Callable[[inputs.CraftInput], object],
        keep_track: Callable[[Sequence[TrackPoint]], None],
        keep_sweep: Callable[[Measured, int, int], None],
    ) -> None:
        self.equipment = equipment
        self._craft = craft
        self._search = search
        self._give = give
        self._keep_track = keep_track
        mission, limits = task.mission, limits_of(task)
        self.listening = Listening(
            equipment.receiver, equipment.clock, channels_of(mission), mission.timers.receiver_silent_s
        )
        self.watch = Watch(equipment, limits, self.listening, craft, give)
        self.work = Work(equipment, task, limits, mission_id, self.listening, self.watch.situation, search, keep_sweep)
        self._slots: dict[Slot, asyncio.Task[None]] = {}
        self._timers: dict[effects.TimerName, asyncio.Task[None]] = {}
        self._background: list[asyncio.Task[None]] = []

    @property
    def limits(self) -> Limits:
        return self.work.limits

    def begin(self) -> None:
        """Start watching."""
        self._background = [
            asyncio.create_task(self._keep_on("vehicle", self.watch.run)),
            asyncio.create_task(self._keep_on("changes", self._changes)),
            asyncio.create_task(self._keep_on("track", self._save_track)),
        ]

    async def close(self) -> None:
        """Stop everything; the track so far is handed over. Sends nothing."""
        tasks = [*self._background, *self._slots.values(), *self._timers.values()]
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)
        self.flush_track()
        await self.listening.stop()

    def adopt(self, task: SearchTask) -> None:
        """Go on in another search area."""
        limits = limits_of(task)
        self.watch.limits = self.work.limits = limits
        self.work.task = task

    @property
    def down(self) -> bool:
        """Certainly on the ground and disarmed."""
        telemetry = self.equipment.vehicle.telemetry()
        return telemetry.in_air is False and telemetry.armed is False

    def objections(self, command: ForCraft) -> tuple[Reason, ...]:
        """What safety has against an override, or against resuming, right now."""
        telemetry = self.equipment.vehicle.telemetry()
        match command:
            case Override(place=place):
                return self.work.vetoes_against(place)
            case Resume():
                found = resume_vetoes(telemetry)
                if telemetry.in_air is False and not self._search().localized:
                    found += battery_vetoes(self.limits, self.watch.situation(), self.limits.measurement_time_s)
                return found
            case _:
                return ()

    def altitude_of(self, command: ForCraft) -> float | None:
        """Metres AMSL at which an override would be flown to."""
        return self.work.altitude_for(command.place) if isinstance(command, Override) else None

    def carry_out(self, effect: effects.CraftEffect) -> None:
        vehicle = self.equipment.vehicle
        match effect:
            case effects.CancelWork():
                self._cancel("command")
                self._cancel("planning")
            case effects.TakeOff():
                self._run("command", "take_off", partial(self.work.take_off, effect))
            case effects.FlyTo():
                self._run("command", "fly", partial(self.work.fly, effect))
            case effects.Measure():
                self._run("command", "measure", partial(self.work.measure, effect))
            case effects.HoldVehicle():
                self._run("command", "hold", self._hold)
            case effects.ReturnHome(hold_first=hold_first):
                self._run("command", "return", partial(self._return_home, hold_first))
            case effects.Land():
                self._run("command", "land", self._land)
            case effects.PlanNext():
                self._run("planning", "plan", partial(self.work.plan, effect))
            case effects.TakeControl():
                vehicle.take_control()
            case effects.StartTimer(name=name, seconds=seconds):
                self._stop_timer(name)
                self._timers[name] = asyncio.create_task(self._expire(name, seconds))
            case effects.CancelTimer(name=name):
                self._stop_timer(name)
            case effects.Record() | effects.Refuse() | effects.LeaveSearch():
                pass
            case _:
                assert_never(effect)

    async def _hold(self) -> None:
        await self.equipment.vehicle.hold()

    async def _land(self) -> None:
        if not (self.down or self._comes_by_itself):
            await self.equipment.vehicle.land()

    @property
    def _comes_by_itself(self) -> bool:
        return self.equipment.vehicle.telemetry().authority.who == "failsafe"

    async def _return_home(self, hold_first: bool) -> None:
        vehicle = self.equipment.vehicle
        if self.down or self._comes_by_itself:
            return
        if hold_first:
            try:
                await vehicle.hold()
            except NotInControl:
                raise
            except HardwareError as error:
                log.warning("%s: no hold before the return: %s", self.equipment.craft_id, error)
        try:
            await self.work.level_off_for_home()
        except NotInControl:
            raise
        except HardwareError as error:
            log.warning("%s: no climb before the return: %s", self.equipment.craft_id, error)
        if self._comes_by_itself:
            return
        await vehicle.return_home()

    # Work: one a slot, the newest wins; the result of a cancelled one is never given

    def _cancel(self, slot: Slot) -> None:
        running = self._slots.pop(slot, None)
        if running is not None and running is not asyncio.current_task():
            running.cancel()

    def _run(self, slot: Slot, name: StepName, work: Doing) -> None:
        self._cancel(slot)
        self._slots[slot] = asyncio.create_task(self._finish(slot, name, work))

    async def _finish(self, slot: Slot, name: StepName, work: Doing) -> None:
        task = asyncio.current_task()
        try:
            result = await work()
        except NotInControl as error:
            self.watch.look_at_authority()
            unnoticed = self._craft().phase in AUTOMATIC
            result = self._failure(name, carried(error.reason)) if unnoticed else None
        except (HardwareError, PlannerError) as error:
            result = self._failure(name, carried(error.reason))
        except Exception:
            log.exception("%s: %s failed", self.equipment.craft_id, name)
            result = self._failure(name, StepBroke(name))
        if result is not None and self._slots.get(slot) is task:
            del self._slots[slot]
            try:
                self._give(result)
            except Exception:
                log.exception("%s: the result of %s could not be taken", self.equipment.craft_id, name)
                self._give(self._failure(name, StepBroke(name)))

    def _failure(self, name: StepName, because: Reason) -> inputs.WorkFailed:
        telemetry = self.equipment.vehicle.telemetry()
        may_rise = telemetry.in_air is False and telemetry.armed is not False
        return inputs.WorkFailed(name, because, None if may_rise else telemetry.in_air)

    def _stop_timer(self, name: effects.TimerName) -> None:
        timer = self._timers.pop(name, None)
        if timer is not None and timer is not asyncio.current_task():
            timer.cancel()

    async def _expire(self, name: effects.TimerName, seconds: float) -> None:
        """Consoles and the people before them live in the wall's time, however fast a simulation runs."""
        if name == "landing":
            await self.equipment.clock.sleep(seconds)
        else:
            await asyncio.sleep(seconds)
        self._give(inputs.TimerExpired(name))

    # What goes on beside the work

    async def _keep_on(
        self, what: Literal["vehicle", "changes", "track"], task: Callable[[], Coroutine[None, None, None]]
    ) -> None:
        """In flight these must not end: a fault of ours holds the mission, and they begin again."""
        while True:
            try:
                await task()
                return
            except Exception:
                log.exception("%s: %s failed", self.equipment.craft_id, what)
                self._give(inputs.Broke(WatchBroke(what)))
                await asyncio.sleep(KEEP_ON_S)

    async def _changes(self) -> None:
        async for _ in self.equipment.vehicle.changes():
            self.watch.look_at_authority()

    async def _save_track(self) -> None:
        while True:
            await self.equipment.clock.sleep(TRACK_SAVED_S)
            self.flush_track()

    def flush_track(self) -> None:
        points = self.watch.track.take()
        if points:
            self._keep_track(points)
