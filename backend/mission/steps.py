"""The steps of a mission as coroutines: each does one thing with the equipment and says how it ended.

Safety is asked again right before every command that moves the vehicle. Errors leave as HardwareError or PlannerError.
"""

from __future__ import annotations

import asyncio
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from backend.events import BearingMeasured, PlanChosen, SweepRejected
from backend.mission import effects, inputs
from backend.mission.equipment import Equipment
from backend.mission.fresh import fresh
from backend.mission.listening import Listening
from backend.mission.localization import Localization
from backend.mission.measuring import Measured, measure
from backend.mission.planning import next_place, way_to
from backend.mission.safety import Situation, Veto, place_vetoes, start_vetoes, turn_vetoes
from backend.spec import Place
from hardware.ports import VehicleError
from hardware.readings import GeoPoint
from planner.belief.grid import GridBelief
from planner.types import PlannerError


@dataclass(slots=True)
class Steps:
    """situation: the vehicle as heard now. keep_sweep: called with every sweep before its fact is given."""

    equipment: Equipment
    task: Localization
    mission_id: str
    listening: Listening
    situation: Callable[[], Situation]
    keep_sweep: Callable[[Measured, int, int], None]
    _belief: tuple[tuple[str, ...], GridBelief] | None = field(default=None)

    def adopt(self, task: Localization) -> None:
        """Go on with another task: what was believed in the old one is no belief of it."""
        self.task, self._belief = task, None

    async def take_off(self, effect: effects.TakeOff) -> inputs.Input:
        vehicle, now = self.equipment.vehicle, await fresh(self.situation)
        position = now.telemetry.position
        if now.telemetry.in_air and position is not None:
            altitude = self.task.limits.home_amsl_m + effect.altitude_relative_m
            vetoes = place_vetoes(self.task.limits, now, position, altitude)
            if vetoes:
                return inputs.WorkVetoed(vetoes)
            await vehicle.goto(position, altitude, self.task.mission.flight.speed_m_s)
        else:
            vetoes = start_vetoes(self.task.limits, now)
            if vetoes:
                return inputs.WorkVetoed(vetoes)
            await vehicle.take_off(effect.altitude_relative_m)
        heard = vehicle.telemetry()
        return inputs.InTheAir(self._here(), heard.altitude_relative_m or effect.altitude_relative_m)

    async def fly(self, effect: effects.FlyTo) -> inputs.Input:
        began_s = self.equipment.clock.now()
        end = self.task.frame.to_enu(GeoPoint(effect.place.lat, effect.place.lon))
        try:
            way = await asyncio.to_thread(self._way, end)
        except PlannerError as error:
            return inputs.WorkVetoed((Veto("no_way", str(error), "choose another place"),))
        while way:
            last = GeoPoint(effect.place.lat, effect.place.lon)
            vetoes = place_vetoes(self.task.limits, await fresh(self.situation), last, effect.altitude_amsl_m, way[:-1])
            if vetoes:
                return inputs.WorkVetoed(vetoes)
            (east, north), *way = way
            leg = self.task.frame.to_geo(east, north) if way else last
            await self.equipment.vehicle.goto(leg, effect.altitude_amsl_m, effect.speed_m_s)
        here = self._here()
        off = math.dist(self.task.frame.to_enu(GeoPoint(here.lat, here.lon)), end)
        return inputs.Arrived(here, off, self.equipment.clock.now() - began_s)

    async def measure(self, effect: effects.Measure) -> inputs.Input:
        vetoes = turn_vetoes(self.task.limits, await fresh(self.situation))
        if vetoes:
            return inputs.WorkVetoed(vetoes)
        found = await measure(
            self.equipment, self.task.mission, self.mission_id, self.listening, effect.place_number, effect.attempt
        )
        self.keep_sweep(found, effect.place_number, effect.attempt)
        match found.fact:
            case BearingMeasured() as bearing:
                return inputs.SweepTaken(bearing)
            case SweepRejected() as sweep:
                return inputs.SweepRefused(sweep)

    async def plan(self, effect: effects.PlanNext, measured: Sequence[BearingMeasured]) -> inputs.Input:
        position = (await fresh(self.situation)).telemetry.position
        if position is None:
            raise VehicleError("the vehicle has no position, so no place can be planned; wait for a GPS fix")
        platform = self.task.frame.to_enu(position)
        _, belief = await self._belief_of(measured)
        try:
            choice = await asyncio.to_thread(self._choose, belief, measured, platform, effect)
        except PlannerError as error:
            return inputs.NothingToPlan(str(error))
        await fresh(self.situation)
        return inputs.Planned(choice, self._choice_vetoes(choice))

    async def belief(self, measured: Sequence[BearingMeasured]) -> inputs.Input:
        ids = tuple(b.bearing_id for b in measured)
        fact, belief = await asyncio.to_thread(self.task.belief_fact, measured)
        self._belief = (ids, belief)
        return inputs.BeliefReady(ids, fact)

    def current_belief(self) -> tuple[tuple[str, ...], GridBelief] | None:
        """The last belief computed, with the ids of its bearings."""
        return self._belief

    async def _belief_of(self, measured: Sequence[BearingMeasured]) -> tuple[tuple[str, ...], GridBelief]:
        ids = tuple(b.bearing_id for b in measured)
        if self._belief is None or self._belief[0] != ids:
            bearings = self.task.planner_bearings(measured)
            self._belief = (ids, await asyncio.to_thread(self.task.planning_belief, bearings))
        return self._belief

    def _choose(
        self,
        belief: GridBelief,
        measured: Sequence[BearingMeasured],
        platform: tuple[float, float],
        effect: effects.PlanNext,
    ) -> PlanChosen:
        threads = self.equipment.threads
        return next_place(self.task, belief, measured, platform, effect.place_number, effect.avoid, threads)

    def _choice_vetoes(self, choice: PlanChosen) -> tuple[Veto, ...]:
        altitude = self.task.limits.home_amsl_m + self.task.mission.flight.altitude_relative_m
        return self.override_vetoes(choice.place, altitude)

    def override_vetoes(self, place: Place, altitude_amsl_m: float) -> tuple[Veto, ...]:
        """What safety has against flying to a place from where the vehicle is now."""
        point = GeoPoint(place.lat, place.lon)
        straight = place_vetoes(self.task.limits, self.situation(), point, altitude_amsl_m)
        if not straight or any(veto.rule not in ("fence", "no_fly") for veto in straight):
            return straight
        try:
            way = self._way(self.task.frame.to_enu(point))
        except PlannerError:
            return straight
        return place_vetoes(self.task.limits, self.situation(), point, altitude_amsl_m, way[:-1])

    def _way(self, end: tuple[float, float]) -> list[tuple[float, float]]:
        position = self.situation().telemetry.position
        if position is None:
            return [end]
        return way_to(self.task, self.task.frame.to_enu(position), end)

    def _here(self) -> Place:
        position = self.equipment.vehicle.telemetry().position
        if position is None:
            raise VehicleError("the vehicle lost its position; wait for a GPS fix")
        return Place(lat=position.lat_deg, lon=position.lon_deg)
