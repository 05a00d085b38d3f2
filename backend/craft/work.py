"""The work of a craft as coroutines: each does one thing with the equipment and says how it ended.

Safety is asked again right before every command that moves the vehicle. Errors leave as HardwareError or PlannerError.
"""

from __future__ import annotations

import asyncio
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from backend.craft import effects, inputs
from backend.craft.equipment import CraftEquipment
from backend.craft.first_turn import Onward, first_turn, limits_with
from backend.craft.listening import Listening
from backend.craft.measuring import Measured, measure
from backend.craft.on_the_way import heard_on_leg, nose_swung, swings_of
from backend.craft.recent_telemetry import recent
from backend.craft.safety import Limits, Situation, place_vetoes, start_vetoes, turn_vetoes
from backend.reasons import Reason, safety
from backend.search.choosing import choose_place
from backend.search.closed_by_ground import closed_by_ground
from backend.search.planning import way_to
from backend.search.sector import TurnPlan, expected_here, must_be_whole, planned_turn, whole_turn
from backend.search.state import SearchState
from backend.search.task import SearchTask
from backend.spec import Place
from hardware.ports import PlaceRefused, VehicleError
from hardware.reasons.vehicle import PositionLost
from hardware.yaw_swings import Swinging, Swings
from planner.types import PlannerError

LEVEL_M = 1.0
"""A vehicle that is within this of an altitude is at it; well within what a level way is given."""
CLIMB_FIRST_M = 3.0
"""Over unknown ground, a vehicle that is this far below its flight altitude (after a pilot or a landing) first climbs
straight up."""

PLACES_TRIED = 5
"""The planner knows only roughly where the ground leaves no room: what is not allowed after all is chosen again."""


@dataclass(slots=True)
class Work:
    """situation: the vehicle as heard now. search: what is known now. keep_sweep: called with every sweep before its
    fact is given."""

    equipment: CraftEquipment
    task: SearchTask
    limits: Limits
    mission_id: str
    listening: Listening
    situation: Callable[[], Situation]
    search: Callable[[], SearchState]
    keep_sweep: Callable[[Measured, int, int], None]

    @property
    def limits_now(self) -> Limits:
        """As the mission allows, with the turn that is made for what is still looked for."""
        return limits_with(self.limits, self.task.mission, self.search())

    async def take_off(self, effect: effects.TakeOff) -> inputs.CraftInput:
        """InTheAir, or WorkVetoed. Raises VehicleError."""
        vehicle, now = self.equipment.vehicle, await recent(self.situation)
        position = now.telemetry.position
        if now.telemetry.in_air and position is not None:
            altitude = self.task.altitude_at(position)
            vetoes = place_vetoes(self.limits_now, now, position, altitude)
            if vetoes:
                return inputs.WorkVetoed(vetoes)
            await vehicle.goto(position, altitude, self.task.mission.flight.speed_m_s)
        else:
            vetoes = start_vetoes(self.limits_now, now) or (await self._beyond_battery(effect) if effect.again else ())
            if vetoes:
                return inputs.WorkVetoed(vetoes, on_ground=now.telemetry.in_air is False)
            await vehicle.take_off(self._take_off_height(effect.altitude_relative_m))
        heard = vehicle.telemetry()
        return inputs.InTheAir(self._here(), heard.altitude_relative_m or effect.altitude_relative_m)

    async def _beyond_battery(self, effect: effects.TakeOff) -> tuple[Reason, ...]:
        """Whether it would come home before its first turn."""
        onward = Onward(effect.chosen, effect.avoid, self.equipment.craft_id)
        now, threads = self.situation(), self.equipment.threads
        found = await asyncio.to_thread(first_turn, self.task, self.search(), self.limits, now, threads, onward)
        return () if found.refusal is None else (found.refusal,)

    async def fly(self, effect: effects.FlyTo) -> inputs.CraftInput:
        """Arrived, or WorkVetoed: asked again before each leg of the way round no-fly zones. Raises VehicleError."""
        began_s, speed = self.equipment.clock.now(), self.task.mission.flight.speed_m_s
        begin = self.equipment.vehicle.telemetry().position
        end = self.task.frame.to_enu(effect.place)
        plan = await asyncio.to_thread(self._turn_at, end, 1)
        facing_deg = None if plan is None or plan.begin_deg is None else self._nose_deg(plan.begin_deg)
        try:
            way: list[tuple[float, float]] = await asyncio.to_thread(self._way, end)
        except PlannerError as error:
            return inputs.WorkVetoed((error.reason,))
        await recent(self.situation)
        altitude, levelled, swung = self.level_altitude(way), False, list[Swings]()
        while way:
            facing = facing_deg if len(way) == 1 else None
            swinging = await asyncio.to_thread(self._swings, way[0], facing)
            vetoes = place_vetoes(self.limits_now, await recent(self.situation), effect.place, altitude, way[:-1])
            if vetoes:
                return inputs.WorkVetoed(vetoes)
            if not levelled:
                levelled = True
                if await self.level_off(altitude):
                    continue
            (east, north), *way = way
            leg = self.task.frame.to_geo(east, north) if way else effect.place
            try:
                await self.equipment.vehicle.goto(leg, altitude, speed, facing, swinging)
            except PlaceRefused as error:
                return inputs.PlaceNotTaken(effect.place, error.reason)
            if swinging is not None and swinging.swings.swinging_s > 0.0:
                swung.append(swinging.swings)
        here = self._here()
        off = math.dist(self.task.frame.to_enu(here), end)
        flown_s = self.equipment.clock.now() - began_s
        mission, search, nose = self.task.mission, self.search(), tuple(map(nose_swung, swung))
        heard = await heard_on_leg(
            self.equipment, mission, self.listening, search, effect.place_number, begin, began_s, nose
        )
        return inputs.Arrived(here, off, flown_s, heard)

    async def measure(self, effect: effects.Measure) -> inputs.CraftInput:
        """SweepTaken, a rejected sweep too, or WorkVetoed. Raises HardwareError."""
        here = self.task.frame.to_enu(self._here())
        plan = await asyncio.to_thread(self._turn_at, here, effect.attempt)
        vetoes = turn_vetoes(self.limits_now, await recent(self.situation))
        if vetoes:
            return inputs.WorkVetoed(vetoes)
        found = await measure(
            self.equipment,
            self.task.mission,
            self.mission_id,
            self.listening,
            effect.place_number,
            effect.attempt,
            wanted=[emitter.emitter_id for emitter in self.search().sought],
            plan=plan,
        )
        for measured in found:
            self.keep_sweep(measured, effect.place_number, effect.attempt)
        return inputs.SweepTaken(tuple(measured.fact for measured in found))

    def _turn_at(self, place: tuple[float, float], attempt: int) -> TurnPlan | None:
        """The turn at a place (m ENU), from what turns told until now; None: this mission turns once around everywhere.

        What was heard on the way is not waited for.
        """
        mission, search = self.task.mission, self.search()
        if not mission.sensor.turns_in_sectors:
            return None
        because = must_be_whole(mission, search.measured, attempt)
        if because is not None:
            return whole_turn(because)
        (emitter,) = search.emitters.values()
        task = self.task.emitters[emitter.emitter_id].asked(self.equipment.clock.now())
        bearings = task.planner_bearings(emitter.bearings)
        if task.belief(bearings) is None:
            return whole_turn("unsure")
        return planned_turn(expected_here(task, task.planning_belief(bearings), emitter.bearings, place))

    def _swings(self, end: tuple[float, float], facing_deg: float | None) -> Swinging | None:
        """Of the nose on the way to `end` (m ENU), by what is known now."""
        position = self.situation().telemetry.position
        if position is None or not self.task.mission.sensor.swing_on_the_way:
            return None
        leg = [self.task.frame.to_enu(position), end]
        offset_deg = self.equipment.pattern.offset_to_nose_deg
        return swings_of(self.task, self.search(), self.limits, offset_deg, leg, facing_deg)

    def _nose_deg(self, antenna_deg: float) -> float:
        return (antenna_deg - self.equipment.pattern.offset_to_nose_deg) % 360.0

    async def plan(self, effect: effects.PlanNext) -> inputs.CraftInput:
        """Planned, or NothingToPlan; the planner runs in a thread. Raises VehicleError when the place is unknown."""
        position = (await recent(self.situation)).telemetry.position
        if position is None:
            raise VehicleError(PositionLost())
        here, avoid, closed = self.task.frame.to_enu(position), effect.avoid, None
        tried = 0
        while True:
            try:
                choice = await asyncio.to_thread(
                    choose_place,
                    self.task,
                    self.search(),
                    here,
                    effect.place_number,
                    self.equipment.clock.now(),
                    self.equipment.threads,
                    self.equipment.craft_id,
                    avoid,
                    closed,
                )
            except PlannerError as error:
                return inputs.NothingToPlan(error.reason)
            await recent(self.situation)
            vetoes = self.vetoes_against(choice.place)
            tried += 1
            if tried == PLACES_TRIED or not vetoes or not all(isinstance(veto, safety.GROUND) for veto in vetoes):
                break
            task, avoid = self.task, (*avoid, choice.place)
            closed = await asyncio.to_thread(closed_by_ground, task.ground, task.mission.flight, task.fence, here)
        foreseen = choice.model_copy(update={"altitude_amsl_m": self.altitude_for(choice.place)})
        return inputs.Planned(foreseen, vetoes)

    def vetoes_against(self, place: Place, way: Sequence[tuple[float, float]] | None = None) -> tuple[Reason, ...]:
        """What safety has against flying to a place from where the vehicle is now. way: points in between (m ENU),
        None: straight, else around what may not be crossed."""
        end, now = self.task.frame.to_enu(place), self.situation()
        points = [*(way or ()), end]
        limits = self.limits_now
        straight = place_vetoes(limits, now, place, self._level_altitude(now, points), way or ())
        around = safety.WayLeavesFence | safety.WayCrossesNoFly
        if self.task.ground.terrain is not None:
            around |= safety.ClearanceShort | safety.TooHighAboveGround | safety.AltitudeOutside
        if way is not None or not straight or not all(isinstance(veto, around) for veto in straight):
            return straight
        try:
            found = self._way(end)
        except PlannerError:
            return straight
        return place_vetoes(limits, now, place, self._level_altitude(now, found), found[:-1])

    def level_altitude(self, way: Sequence[tuple[float, float]]) -> float:
        """Metres AMSL at which a way (m ENU) is flown from where the vehicle is now."""
        return self._level_altitude(self.situation(), way)

    def _level_altitude(self, now: Situation, way: Sequence[tuple[float, float]]) -> float:
        position = now.telemetry.position
        before = [] if position is None else [self.task.frame.to_enu(position)]
        return self.task.level_altitude([*before, *way])

    def way_points(self, place: Place) -> list[tuple[float, float]]:
        """Of the flight to a place, m ENU: straight, or around what may not be crossed when there is such a way."""
        end = self.task.frame.to_enu(place)
        try:
            return self._way(end)
        except PlannerError:
            return [end]

    def altitude_for(self, place: Place) -> float:
        """Metres AMSL of the flight to a place, as foreseen."""
        return self.level_altitude(self.way_points(place))

    async def level_off(self, altitude_amsl_m: float) -> bool:
        """Climb or sink on the spot before a level way over known ground; over ground that nobody knows, climb where it
        is far below. False when nothing is to be done."""
        telemetry = self.situation().telemetry
        here, now = telemetry.position, telemetry.altitude_amsl_m
        if here is None or now is None:
            return False
        known = self.task.ground.terrain is not None
        if abs(now - altitude_amsl_m) <= LEVEL_M if known else altitude_amsl_m - now <= CLIMB_FIRST_M:
            return False
        await self.equipment.vehicle.goto(here, altitude_amsl_m, self.task.mission.flight.speed_m_s)
        return True

    async def level_off_for_home(self) -> None:
        """The way home keeps clearance and ceiling too: the autopilot's own return looks at no ground."""
        telemetry = self.situation().telemetry
        here, now = telemetry.position, telemetry.altitude_amsl_m
        if here is not None and now is not None:
            way = [self.task.frame.to_enu(here), (0.0, 0.0)]
            await self.level_off(self.task.level_altitude(way, now))

    def _take_off_height(self, wanted_relative_m: float) -> float:
        """Metres above home."""
        position = self.situation().telemetry.position
        if self.task.ground.terrain is None or position is None:
            return wanted_relative_m
        return self.task.altitude_at(position) - self.task.home_amsl_m

    def _way(self, end: tuple[float, float]) -> list[tuple[float, float]]:
        position = self.situation().telemetry.position
        return [end] if position is None else way_to(self.task.first, self.task.frame.to_enu(position), end)

    def _here(self) -> Place:
        position = self.equipment.vehicle.telemetry().position
        if position is None:
            raise VehicleError(PositionLost())
        return position
