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
from backend.craft.listening import Listening
from backend.craft.measuring import Measured, measure
from backend.craft.recent_telemetry import recent
from backend.craft.safety import Limits, Situation, place_vetoes, start_vetoes, turn_vetoes
from backend.events import PlanChosen
from backend.reasons import Reason, carried, safety
from backend.search.planning import next_place, way_to
from backend.search.state import SearchState
from backend.search.task import SearchTask
from backend.spec import Place
from hardware.ports import PlaceRefused, VehicleError
from hardware.reasons.vehicle import PositionLost
from planner.types import PlannerError


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

    async def take_off(self, effect: effects.TakeOff) -> inputs.CraftInput:
        """InTheAir, or WorkVetoed. Raises VehicleError."""
        vehicle, now = self.equipment.vehicle, await recent(self.situation)
        position = now.telemetry.position
        if now.telemetry.in_air and position is not None:
            altitude = self.task.altitude_at(position)
            vetoes = place_vetoes(self.limits, now, position, altitude)
            if vetoes:
                return inputs.WorkVetoed(vetoes)
            await vehicle.goto(position, altitude, self.task.mission.flight.speed_m_s)
        else:
            vetoes = start_vetoes(self.limits, now)
            if vetoes:
                return inputs.WorkVetoed(vetoes)
            await vehicle.take_off(effect.altitude_relative_m)
        heard = vehicle.telemetry()
        return inputs.InTheAir(self._here(), heard.altitude_relative_m or effect.altitude_relative_m)

    async def fly(self, effect: effects.FlyTo) -> inputs.CraftInput:
        """Arrived, or WorkVetoed: asked again before each leg of the way round no-fly zones. Raises VehicleError."""
        began_s, speed = self.equipment.clock.now(), self.task.mission.flight.speed_m_s
        end, altitude = self.task.frame.to_enu(effect.place), self.task.altitude_at(effect.place)
        try:
            way = await asyncio.to_thread(self._way, end)
        except PlannerError as error:
            return inputs.WorkVetoed((carried(error.reason),))
        while way:
            vetoes = place_vetoes(self.limits, await recent(self.situation), effect.place, altitude, way[:-1])
            if vetoes:
                return inputs.WorkVetoed(vetoes)
            (east, north), *way = way
            leg = self.task.frame.to_geo(east, north) if way else effect.place
            try:
                await self.equipment.vehicle.goto(leg, altitude, speed)
            except PlaceRefused as error:
                return inputs.PlaceNotTaken(effect.place, carried(error.reason))
        here = self._here()
        off = math.dist(self.task.frame.to_enu(here), end)
        return inputs.Arrived(here, off, self.equipment.clock.now() - began_s)

    async def measure(self, effect: effects.Measure) -> inputs.CraftInput:
        """SweepTaken, a rejected sweep too, or WorkVetoed. Raises HardwareError."""
        vetoes = turn_vetoes(self.limits, await recent(self.situation))
        if vetoes:
            return inputs.WorkVetoed(vetoes)
        found = await measure(
            self.equipment, self.task.mission, self.mission_id, self.listening, effect.place_number, effect.attempt
        )
        for measured in found:
            self.keep_sweep(measured, effect.place_number, effect.attempt)
        return inputs.SweepTaken(tuple(measured.fact for measured in found))

    async def plan(self, effect: effects.PlanNext) -> inputs.CraftInput:
        """Planned, or NothingToPlan; the planner runs in a thread. Raises VehicleError when the place is unknown."""
        position = (await recent(self.situation)).telemetry.position
        if position is None:
            raise VehicleError(PositionLost())
        try:
            choice = await asyncio.to_thread(self._choose, self.search(), self.task.frame.to_enu(position), effect)
        except PlannerError as error:
            return inputs.NothingToPlan(carried(error.reason))
        await recent(self.situation)
        return inputs.Planned(choice, self.vetoes_against(choice.place))

    def _choose(self, search: SearchState, platform: tuple[float, float], effect: effects.PlanNext) -> PlanChosen:
        """For the first emitter that is not localized; each turn listens to all of them."""
        emitter = (*search.wanted, *search.emitters.values())[0]
        task = self.task.emitters[emitter.emitter_id]
        belief = task.planning_belief(task.planner_bearings(emitter.bearings))
        return next_place(
            task,
            belief,
            emitter.bearings,
            platform,
            effect.place_number,
            effect.avoid,
            self.equipment.threads,
            self.equipment.craft_id,
        )

    def vetoes_against(self, place: Place, way: Sequence[tuple[float, float]] | None = None) -> tuple[Reason, ...]:
        """What safety has against flying to a place from where the vehicle is now. way: points in between (m ENU),
        None: straight, else around what may not be crossed."""
        altitude, now = self.task.altitude_at(place), self.situation()
        straight = place_vetoes(self.limits, now, place, altitude, way or ())
        around = safety.WayLeavesFence | safety.WayCrossesNoFly
        if way is not None or not straight or not all(isinstance(veto, around) for veto in straight):
            return straight
        try:
            found = self._way(self.task.frame.to_enu(place))
        except PlannerError:
            return straight
        return place_vetoes(self.limits, now, place, altitude, found[:-1])

    def _way(self, end: tuple[float, float]) -> list[tuple[float, float]]:
        position = self.situation().telemetry.position
        return [end] if position is None else way_to(self.task.first, self.task.frame.to_enu(position), end)

    def _here(self) -> Place:
        position = self.equipment.vehicle.telemetry().position
        if position is None:
            raise VehicleError(PositionLost())
        return position
