"""The hands of a craft: one piece of work a slot, the newest wins; timers; and hold, return and landing on its vehicle.

Synchronous to the outside: when `carry_out` returns, a hold has cancelled the running work and is on its way.
"""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable, Coroutine
from typing import Literal

from backend.craft import effects, inputs
from backend.craft.state import AUTOMATIC, CraftState
from backend.reasons import Reason
from backend.reasons.flight import StepBroke, StepName
from hardware.ports import Clock, HardwareError, NotInControl, Vehicle
from planner.types import PlannerError

log = logging.getLogger("crossfix.craft")

Slot = Literal["command", "planning"]
Doing = Callable[[], Coroutine[None, None, inputs.CraftInput | None]]
"""A piece of work, begun when its turn comes: one that is cancelled before was never begun."""
Simple = (
    effects.CancelWork
    | effects.HoldVehicle
    | effects.ReturnHome
    | effects.Land
    | effects.TakeControl
    | effects.StartTimer
    | effects.CancelTimer
)
"""What needs nothing but the vehicle and the clock."""


class Hands:
    """craft: what it does now. give: takes the machine's inputs. look: at who flies, before a refusal is judged."""

    def __init__(
        self,
        vehicle: Vehicle,
        clock: Clock,
        craft: Callable[[], CraftState],
        give: Callable[[inputs.CraftInput], object],
        look: Callable[[], None],
    ) -> None:
        self._vehicle = vehicle
        self._clock = clock
        self._craft = craft
        self._give = give
        self._look = look
        self._slots: dict[Slot, asyncio.Task[None]] = {}
        self._timers: dict[effects.TimerName, asyncio.Task[None]] = {}

    async def close(self) -> None:
        """Stop everything. Sends nothing."""
        tasks = [*self._slots.values(), *self._timers.values()]
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)

    @property
    def down(self) -> bool:
        """Certainly on the ground and disarmed."""
        telemetry = self._vehicle.telemetry()
        return telemetry.in_air is False and telemetry.armed is False

    def carry_out(self, effect: Simple) -> None:
        """Begins it and returns; what comes of it is given to the machine."""
        match effect:
            case effects.CancelWork():
                self.cancel_work()
            case effects.HoldVehicle():
                self.run("command", "hold", self._hold)
            case effects.ReturnHome():
                self.run("command", "return", self._autopilots_return)
            case effects.Land():
                self.run("command", "land", self._land)
            case effects.TakeControl():
                self._vehicle.take_control()
            case effects.StartTimer(name=name, seconds=seconds):
                self.stop_timer(name)
                self._timers[name] = asyncio.create_task(self._expire(name, seconds))
            case effects.CancelTimer(name=name):
                self.stop_timer(name)

    async def _hold(self) -> inputs.CarriedOut:
        await self._vehicle.hold()
        return inputs.CarriedOut("hold")

    async def _autopilots_return(self) -> inputs.CarriedOut | None:
        """All there is for a craft without a mission: nobody knows what it may fly over."""
        if self.down or self.comes_by_itself:
            return None
        await self._vehicle.return_home()
        return inputs.CarriedOut("return")

    async def _land(self) -> inputs.CarriedOut | None:
        if self.down or self.comes_by_itself:
            return None
        await self._vehicle.land()
        return inputs.CarriedOut("land")

    @property
    def comes_by_itself(self) -> bool:
        """The autopilot's failsafe brings the vehicle home or down."""
        return self._vehicle.telemetry().authority.who == "failsafe"

    def cancel_work(self) -> None:
        """Its result is never given."""
        self._cancel("command")
        self._cancel("planning")

    def _cancel(self, slot: Slot) -> None:
        running = self._slots.pop(slot, None)
        if running is not None and running is not asyncio.current_task():
            running.cancel()

    def run(self, slot: Slot, name: StepName, work: Doing) -> None:
        """Instead of what runs in this slot; the result of cancelled work is never given."""
        self._cancel(slot)
        self._slots[slot] = asyncio.create_task(self._finish(slot, name, work))

    async def _finish(self, slot: Slot, name: StepName, work: Doing) -> None:
        task = asyncio.current_task()
        try:
            result = await work()
        except NotInControl as error:
            self._look()
            unnoticed = self._craft().phase in AUTOMATIC
            result = self._failure(name, error.reason) if unnoticed else None
        except (HardwareError, PlannerError) as error:
            result = self._failure(name, error.reason)
        except Exception:
            log.exception("%s: %s failed", self._craft().craft_id, name)
            result = self._failure(name, StepBroke(name))
        if result is not None and self._slots.get(slot) is task:
            del self._slots[slot]
            try:
                self._give(result)
            except Exception:
                log.exception("%s: the result of %s could not be taken", self._craft().craft_id, name)
                self._give(self._failure(name, StepBroke(name)))

    def _failure(self, name: StepName, because: Reason) -> inputs.WorkFailed:
        telemetry = self._vehicle.telemetry()
        may_rise = telemetry.in_air is False and telemetry.armed is not False
        return inputs.WorkFailed(name, because, None if may_rise else telemetry.in_air)

    def stop_timer(self, name: effects.TimerName) -> None:
        """One that does not run is no matter."""
        timer = self._timers.pop(name, None)
        if timer is not None and timer is not asyncio.current_task():
            timer.cancel()

    async def _expire(self, name: effects.TimerName, seconds: float) -> None:
        """Consoles and the people before them live in wall time, however fast a simulation runs."""
        if name in ("landing", "order", "battery_return"):
            await self._clock.sleep(seconds)
        else:
            await asyncio.sleep(seconds)
        self._give(inputs.TimerExpired(name))
