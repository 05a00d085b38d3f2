"""Runs one craft of a mission: carries its machine's effects out with its equipment, and says what came of them.

Everything happens on one event loop. `carry_out` is synchronous: by the time it returns, a hold has cancelled the
running work and the vehicle's hold is on its way.
"""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable, Coroutine, Sequence
from functools import partial
from typing import Literal

from backend.commands import ForCraft, Override, Resume
from backend.craft import effects, inputs
from backend.craft.equipment import CraftEquipment
from backend.craft.fly_home import fly_home
from backend.craft.hands import Hands
from backend.craft.listening import Listening, channels_for, channels_of
from backend.craft.measuring import Measured
from backend.craft.safety import Limits, limits_of, resume_vetoes, take_off_battery_vetoes
from backend.craft.state import CraftState
from backend.craft.under_way import UnderWay
from backend.craft.watch.watch import Watch
from backend.craft.work import Work
from backend.ports import TrackPoint
from backend.reasons import Reason
from backend.reasons.flight import WatchBroke
from backend.search.state import SearchState
from backend.search.task import SearchTask
from backend.search.turn_schedule import heard_at_once
from hardware.reasons.vehicle_news import AutopilotSaid

log = logging.getLogger("crossfix.craft")

TRACK_SAVED_S = 2.5
KEEP_ON_S = 1.0
UNDER_WAY_LOOK_S = 0.2


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
        self._search = search
        self._give = give
        self._keep_track = keep_track
        mission, limits = task.mission, limits_of(task)
        self.listening = Listening(
            equipment.receiver,
            equipment.clock,
            channels_of(mission),
            mission.timers.receiver_silent_s,
            first=channels_for(heard_at_once(mission.emitters, mission.sensor.receiver_band_hz)[0]),
        )
        self.watch = Watch(equipment, limits, self.listening, craft, give)
        self.work = Work(equipment, task, limits, mission_id, self.listening, self.watch.situation, search, keep_sweep)
        self._hands = Hands(equipment.vehicle, equipment.clock, craft, give, self.watch.look_at_authority)
        self._background: list[asyncio.Task[None]] = []

    @property
    def limits(self) -> Limits:
        """Of the search area of now: they change with it."""
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
        for task in self._background:
            task.cancel()
        await asyncio.gather(*self._background, return_exceptions=True)
        await self._hands.close()
        self.flush_track()
        await self.listening.stop()

    def adopt(self, task: SearchTask) -> None:
        """Go on in another search area."""
        limits = limits_of(task)
        self.watch.limits = self.work.limits = limits
        self.work.task = task

    def objections(self, command: ForCraft) -> tuple[Reason, ...]:
        """What safety has against an override, or against resuming, right now."""
        telemetry = self.equipment.vehicle.telemetry()
        match command:
            case Override(place=place):
                return self.work.vetoes_against(place)
            case Resume():
                found = resume_vetoes(telemetry)
                if telemetry.in_air is False and not self._search().found:
                    found += take_off_battery_vetoes(self.work.limits_now, self.watch.situation())
                return found
            case _:
                return ()

    def altitude_of(self, command: ForCraft) -> float | None:
        """Metres AMSL at which an override would be flown to."""
        return self.work.altitude_for(command.place) if isinstance(command, Override) else None

    def carry_out(self, effect: effects.CraftEffect) -> None:
        """Begins the work and returns; what comes of it is given to the machine."""
        match effect:
            case effects.TakeOff():
                self._hands.run("command", "take_off", partial(self.work.take_off, effect))
            case effects.FlyTo():
                self._hands.run("command", "fly", partial(self.work.fly, effect))
            case effects.Measure():
                self._hands.run("command", "measure", partial(self.work.measure, effect))
            case effects.PlanNext():
                self._hands.run("planning", "plan", partial(self.work.plan, effect))
            case effects.ReturnHome():
                self._hands.run("command", "return", self._return_home)
            case effects.Record() | effects.Refuse() | effects.LeaveSearch():
                pass
            case _:
                self._hands.carry_out(effect)

    async def _return_home(self) -> inputs.CarriedOut | inputs.AutopilotReturns | None:
        """Around what may not be flown over. It counts as done as soon as the vehicle is seen to fly it."""
        if self._hands.down or self._hands.comes_by_itself:
            return None
        under_way = UnderWay()
        watching = asyncio.create_task(self._tell_under_way(under_way))
        try:
            return await fly_home(self.work, under_way) or inputs.CarriedOut("return")
        finally:
            watching.cancel()

    async def _tell_under_way(self, under_way: UnderWay) -> None:
        while not under_way.look(self.equipment.vehicle.telemetry()):
            await self.equipment.clock.sleep(UNDER_WAY_LOOK_S)
        self._give(inputs.CarriedOut("return"))

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
        async for announcement in self.equipment.vehicle.changes():
            self.watch.look_at_authority()
            if isinstance(announcement.reason, AutopilotSaid):
                self.watch.hear(announcement.reason)

    async def _save_track(self) -> None:
        while True:
            await self.equipment.clock.sleep(TRACK_SAVED_S)
            self.flush_track()

    def flush_track(self) -> None:
        """Hands over what was not kept yet, at once."""
        points = self.watch.track.take()
        if points:
            self._keep_track(points)
