"""What a craft's receiver heard while it flew from place to place, and what its nose does meanwhile."""

from __future__ import annotations

import asyncio
from collections.abc import Iterable
from functools import partial

from shapely import Point

from backend.craft.equipment import CraftEquipment
from backend.craft.listening import Listening
from backend.craft.safety import Limits
from backend.events import BearingSource, CraftSource, HeardOnTheWay
from backend.search.ground import Way
from backend.search.sector import expected_here
from backend.search.state import SearchState
from backend.search.swings import swing_plan
from backend.search.task import SearchTask
from backend.search.way_facts import Leg, way_fact
from backend.spec import EmitterSpec, MissionSpec, Place
from hardware.reasons.on_the_way import NoseSwung
from hardware.yaw_swings import Swinging, Swings


def listened_to(mission: MissionSpec) -> tuple[EmitterSpec, ...]:
    """The emitters of which legs count: those that stand still, where errors are joint."""
    if not mission.sensor.listen_on_the_way or mission.sensor.bearing_errors != "joint":
        return ()
    return tuple(emitter for emitter in mission.emitters if emitter.movement.kind == "still")


async def heard_on_leg(
    equipment: CraftEquipment,
    mission: MissionSpec,
    listening: Listening,
    search: SearchState,
    place_number: int,
    begin: Place | None,
    began_s: float,
    nose: tuple[NoseSwung, ...] = (),
) -> tuple[HeardOnTheWay, ...]:
    """One fact an emitter, of a leg that just ended where the craft will turn. begin None: nobody knows from where.
    nose: what it did meanwhile, where it swung.

    Sends nothing, waits for nothing: samples that are still to come were heard beside that place, where they would not
    count.
    """
    wanted = listened_to(mission)
    telemetry = equipment.vehicle.telemetry()
    if not wanted or begin is None or telemetry.position is None:
        return ()
    source = CraftSource(craft_id=equipment.craft_id)
    leg = Leg(source, place_number, begin, (*turned_at(search, source), telemetry.position), nose)
    # headings of a clock that runs oddly cannot be dated
    headings = equipment.vehicle.headings(began_s) if telemetry.odd_clock_rate is None else []
    ended_s = equipment.clock.now()
    return tuple(
        [
            await asyncio.to_thread(
                way_fact,
                leg,
                emitter.emitter_id,
                mission.sensor,
                equipment.pattern,
                listening.of(emitter, began_s, ended_s),
                headings,
            )
            for emitter in wanted
            if listening.hears(emitter)
        ]
    )


def swings_of(
    task: SearchTask, search: SearchState, limits: Limits, offset_to_nose_deg: float, leg: Way, facing_deg: float | None
) -> Swinging | None:
    """What the nose does on one leg (its two ends, m ENU); None: it stays as it is. facing_deg: at the end. Heavy."""
    mission = task.mission
    listened = {emitter.emitter_id for emitter in listened_to(mission)}
    sought = next((one for one in search.sought if one.emitter_id in listened), None)
    if not mission.sensor.swing_on_the_way or sought is None:
        return None
    (x0, y0), (x1, y1) = leg
    middle = (0.5 * (x0 + x1), 0.5 * (y0 + y1))
    found = task.together.about(search, sought.emitter_id)
    belief = found.planning_belief(found.planner_bearings(sought.bearings))
    expected = expected_here(found, belief, sought.bearings, middle)
    plan = swing_plan(expected, offset_to_nose_deg, mission.sensor.turn_rate_deg_s, facing_deg)
    return Swinging(plan, partial(clear_m, limits))


def clear_m(limits: Limits, place: Place) -> float:
    """From a place to the nearest where the craft may not be; 0 where it may not be itself."""
    at = Point(limits.frame.to_enu(place))
    if not limits.fence.covers(at):
        return 0.0
    return min([limits.fence.boundary.distance(at), *(zone.distance(at) for zone in limits.no_fly)])


def nose_swung(swings: Swings) -> NoseSwung:
    """In words, once it is over."""
    plan, end = swings.plan, swings.end or "not_ours"
    return NoseSwung(swings.swung, plan.amplitude_deg, swings.rate_deg_s, swings.lag_deg, end)


def turned_at(search: SearchState, source: BearingSource) -> tuple[Place, ...]:
    """Where this source's turns told something."""
    told: Iterable[Place] = (
        fact.place
        for emitter in search.emitters.values()
        for fact in (*emitter.measured, *emitter.silences)
        if fact.source == source
    )
    return tuple(dict.fromkeys(told))
