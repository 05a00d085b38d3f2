"""What if: the expected time by way of a place, another search area, a mission not flown yet. Nothing is recorded."""

from __future__ import annotations

import asyncio
from collections.abc import Sequence
from dataclasses import dataclass

from backend.craft.checklist import home_of
from backend.craft.inputs import Foretold
from backend.craft.safety import limits_of, standing_vetoes, staying_vetoes
from backend.mission.equipment import MissionEquipment
from backend.mission.flights import Flights
from backend.mission.records import Records
from backend.reasons import Reason
from backend.reasons.refusals import MissionDoesNotFly, MissionOver, NoSuchEmitter
from backend.reasons.search import AskedFromTooFar
from backend.search.advice import Advice, Going, advise, from_area_m
from backend.search.area import centre_of, corner_of
from backend.search.errors import MissionConflict, MissionInputError
from backend.search.forecast import Comparison, Forecast, Preview, compare, forecast, preview
from backend.search.ground_ways import FARTHEST_M
from backend.search.other_area import Outlook, outlook, task_in
from backend.search.planning import needs_program
from backend.search.state import SearchState
from backend.search.task import SearchTask, search_task
from backend.search.together import together
from backend.spec import MissionSpec, Place, SearchArea


@dataclass(frozen=True, slots=True)
class Leg:
    """way: m ENU, from its beginning on. altitude_amsl_m: at which it is flown. objections: safety's."""

    task: SearchTask
    way: list[tuple[float, float]]
    altitude_amsl_m: float
    objections: tuple[Reason, ...]


@dataclass(slots=True)
class Questions:
    """Heavy answers are computed in threads; a mission that flies goes on meanwhile."""

    equipment: MissionEquipment
    records: Records
    flights: Flights

    async def expected_time(
        self, mission_id: str, place: Place, instead_of: Place | None = None
    ) -> tuple[Forecast, Comparison | None]:
        """The expected time to localization when a craft measured at this place next, and how it compares with another
        place when one is named. Raises MissionNotFound."""
        runner = self.flights.running(mission_id)
        search = (runner.state if runner else (await self.records.load(mission_id))[0]).search
        task = runner.task if runner else await self._task_on_ground(search)
        craft = next(iter(runner.crafts.values())) if runner else None
        start = task.home if craft is None else craft.equipment.vehicle.telemetry().position or task.home

        def vetoes(where: Place, way: Sequence[tuple[float, float]]) -> tuple[Reason, ...]:
            if craft is not None:
                return craft.work.vetoes_against(where, way)
            return standing_vetoes(limits_of(task), where, task.altitude_at(where))

        emitters = search.sought if search.wanted else search.sought[:1]
        names = [one.emitter_id for one in emitters]
        now_s = self.equipment.clock.now()
        about = [task.together.about(search, one.emitter_id).turning_for(names).asked(now_s) for one in emitters]
        wanted = [(task, one.bearings) for task, one in zip(about, emitters, strict=True)]
        ranks = [search.rank(one.emitter_id) for one in emitters]
        found = await asyncio.to_thread(forecast, *wanted[0], start, place, vetoes)
        if runner is not None and found.mean_s is not None:
            runner.told.keep(search, place, Foretold(found.mean_s, found.p90_s, found.rollouts))
        if instead_of is None:
            return found, None
        state = runner.state.crafts.get(craft.equipment.craft_id) if runner and craft else None
        avoid = () if state is None else state.shunned
        return found, await asyncio.to_thread(compare, wanted, start, place, instead_of, ranks, avoid)

    async def advise(
        self, mission_id: str, here: Place, going: Going, emitter_id: str | None
    ) -> tuple[str, int, Advice | None]:
        """The emitter, the bearings that count, and where to listen for it next; None once it is localized.

        Raises MissionNotFound, MissionConflict once the search has ended, MissionInputError, PlannerError.
        """
        runner = self.flights.running(mission_id)
        search = (runner.state if runner else (await self.records.load(mission_id))[0]).search
        if search.stage == "ended":
            raise MissionConflict(MissionOver())
        emitter = search.sought[0] if emitter_id is None else search.emitters.get(emitter_id)
        if emitter is None:
            raise MissionInputError(NoSuchEmitter(emitter_id or ""), "emitter_id")
        if emitter.localized and not search.follows:
            return emitter.emitter_id, len(emitter.bearings), None
        home = search.home or corner_of(search.mission.area)
        tasks = await asyncio.to_thread(together, search.mission, home, emitter.emitter_id)
        task = tasks.about(search, emitter.emitter_id).asked(self.equipment.clock.now())
        if (off_m := from_area_m(task, here)) > FARTHEST_M:
            raise MissionInputError(AskedFromTooFar(off_m), "place")
        return (
            emitter.emitter_id,
            len(emitter.bearings),
            await asyncio.to_thread(advise, task, emitter.bearings, here, going),
        )

    async def outlook(self, mission_id: str, area: SearchArea) -> tuple[Outlook, tuple[Reason, ...]]:
        """What to expect of another search area now, and what forbids to change to it.

        Raises MissionNotFound, MissionConflict unless the mission flies, MissionInputError.
        """
        runner = self.flights.running(mission_id)
        if runner is None:
            await self.records.load(mission_id)
            raise MissionConflict(MissionDoesNotFly())
        search, crafts = runner.state.search, tuple(runner.crafts.values())
        task = await asyncio.to_thread(task_in, search, area, runner.task.ground.terrain)
        limits = limits_of(task)
        vetoes = tuple(veto for craft in crafts for veto in staying_vetoes(limits, craft.watch.situation()))
        positions = [craft.equipment.vehicle.telemetry().position for craft in crafts]
        here = next((position for position in positions if position is not None), task.home)
        return await asyncio.to_thread(outlook, search, task, here, self.equipment.threads), vetoes

    async def leg(self, mission_id: str, place: Place) -> Leg:
        """The way from where the vehicle is now to a place. Raises MissionNotFound, MissionInputError."""
        runner = self.flights.running(mission_id)
        if runner is None:
            search = (await self.records.load(mission_id))[0].search
            task = await self._task_on_ground(search)
            way = [(0.0, 0.0), task.frame.to_enu(place)]
            altitude = task.level_altitude(way)
            return Leg(task, way, altitude, await asyncio.to_thread(standing_vetoes, limits_of(task), place, altitude))
        craft, task = next(iter(runner.crafts.values())), runner.task
        here = craft.equipment.vehicle.telemetry().position or task.home
        way = [task.frame.to_enu(here), *await asyncio.to_thread(craft.work.way_points, place)]
        objections = await asyncio.to_thread(craft.work.vetoes_against, place)
        return Leg(task, way, task.level_altitude(way), objections)

    async def _task_on_ground(self, search: SearchState) -> SearchTask:
        """Of a mission that does not fly: over the ground that it flew over, else over what is known now."""
        if search.home is None:
            home, amsl = self._home_for(search.mission)
            terrain = await self.equipment.grounds.around(home)
            return await asyncio.to_thread(search_task, search.mission, home, amsl, terrain)
        kept = None if search.ground is None else await self.equipment.grounds.kept(search.ground.digest)
        return await asyncio.to_thread(search_task, search.mission, search.home, search.home_amsl_m, kept)

    async def preview(self, spec: MissionSpec) -> Preview:
        """Plan the first place of a mission that is not flown yet. Raises MissionInputError, PlannerError."""
        spec = await self.equipment.knowing(spec)
        home, home_amsl_m = self._home_for(spec)
        terrain = await self.equipment.grounds.around(home)
        task = await asyncio.to_thread(search_task, spec, home, home_amsl_m, terrain)
        start = self.equipment.first.vehicle.telemetry().position or task.home
        if needs_program(spec):
            self.equipment.prepare_planner(task.first.problem)
        return await asyncio.to_thread(preview, task.first, start, self.equipment.threads)

    def _home_for(self, spec: MissionSpec) -> tuple[Place, float]:
        home, amsl = home_of(self.equipment.first.vehicle.telemetry())
        return home or centre_of(spec.area), amsl or 0.0
