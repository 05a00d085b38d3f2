"""A leg's readings become its facts when the craft arrives, and are recorded before it measures."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from craft_walk import CraftWalk
from equipment import FRAME, HOME, spec
from facts import OWN
from stage import Stage

from backend.craft import effects, inputs
from backend.craft.listening import Listening, channels_of
from backend.craft.on_the_way import clear_m, heard_on_leg, swings_of
from backend.craft.safety import Limits, limits_of
from backend.events import HeardOnTheWay, PlaceReached
from backend.search.emitter import EmitterState
from backend.search.state import SearchState
from backend.search.task import search_task
from backend.spec import FIRST_EMITTER, EmitterSpec, MissionSpec
from hardware.readings import HeadingSample, Place, PowerSample
from hardware.reasons.on_the_way import ReadingsLeftOut

LENGTH_M, SPEED_M_S = 100.0, 8.0


def listening_mission() -> MissionSpec:
    mission = spec()
    joint = mission.sensor.model_copy(update={"bearing_errors": "joint", "listen_on_the_way": True})
    return mission.model_copy(update={"sensor": joint})


async def flown(mission: MissionSpec, odd_clock_rate: float | None = None, begin: Place | None = HOME):
    """A leg eastward on which the nose turned by 30 degrees a second; the receiver heard all of it."""
    stage = Stage()
    listening = Listening(stage.receiver, stage.clock, channels_of(mission), 5.0)
    now_s = stage.clock.now()
    began_s = now_s - LENGTH_M / SPEED_M_S
    times = [began_s + 0.1 * k for k in range(int(10 * LENGTH_M / SPEED_M_S))]
    for at_s in times:
        power_db = -60.0 + 5.0 * math.cos(math.radians(30.0 * (at_s - began_s)))
        listening._take(PowerSample(at_s, EmitterSpec().frequency_hz, power_db, -120.0))
    stage.vehicle.headings_heard = [
        HeadingSample(at_s, 30.0 * (at_s - began_s) % 360.0, FRAME.to_geo(SPEED_M_S * (at_s - began_s), 0.0))
        for at_s in times
    ]
    there = FRAME.to_geo(LENGTH_M, 0.0)
    stage.vehicle.state = replace(stage.vehicle.state, position=there, odd_clock_rate=odd_clock_rate)
    return await heard_on_leg(stage.craft(), mission, listening, SearchState(), 2, begin, began_s)


async def test_a_leg_becomes_one_fact_an_emitter() -> None:
    (fact,) = await flown(listening_mission())
    assert (fact.emitter_id, fact.source, fact.place_number) == (FIRST_EMITTER, OWN, 2)
    assert len(fact.stretches) == 4
    assert fact.tells


def swings(mission: MissionSpec, limits: Limits):
    task = search_task(mission, HOME, 100.0)
    search = replace(SearchState(), spec=mission, emitters={FIRST_EMITTER: EmitterState(FIRST_EMITTER)}, home=HOME)
    return swings_of(task, search, limits, 30.0, [(0.0, 0.0), (60.0, 0.0)], 200.0)


def test_the_nose_swings_only_where_a_mission_asks_for_it_and_listens() -> None:
    mission = listening_mission()
    limits = limits_of(search_task(mission, HOME, 100.0))
    assert swings(mission, limits) is None
    asked = mission.model_copy(update={"sensor": mission.sensor.model_copy(update={"swing_on_the_way": True})})
    deaf = asked.model_copy(update={"sensor": asked.sensor.model_copy(update={"listen_on_the_way": False})})
    assert swings(deaf, limits) is None
    found = swings(asked, limits)
    assert found is not None
    assert found.plan.facing_deg == 200.0
    assert found.plan.rate_deg_s == mission.sensor.turn_rate_deg_s
    assert 60.0 <= found.plan.amplitude_deg <= 120.0


def test_what_is_clear_ends_at_the_fence_and_at_what_may_not_be_flown() -> None:
    limits = limits_of(search_task(listening_mission(), HOME, 100.0))
    inside = limits.fence.representative_point()
    place = FRAME.to_geo(inside.x, inside.y)
    free = clear_m(limits, place)
    assert free == pytest.approx(limits.fence.boundary.distance(inside), abs=0.01)
    zone = inside.buffer(free / 4.0).boundary.buffer(1.0)
    assert clear_m(replace(limits, no_fly=(zone,)), place) == pytest.approx(free / 4.0 - 1.0, abs=0.2)
    west, south, *_ = limits.fence.bounds
    assert clear_m(limits, FRAME.to_geo(west - 5.0, south - 5.0)) == 0.0


async def test_a_mission_that_does_not_ask_for_it_hears_nothing_on_the_way() -> None:
    assert await flown(spec()) == ()


async def test_headings_of_an_odd_clock_make_readings_worthless_and_never_wrong() -> None:
    (fact,) = await flown(listening_mission(), odd_clock_rate=0.9)
    assert not fact.tells
    (why,) = fact.left_out
    assert isinstance(why, ReadingsLeftOut)
    assert why.why == "heading_unknown"


async def test_nothing_is_made_of_a_leg_that_began_nobody_knows_where() -> None:
    assert await flown(listening_mission(), begin=None) == ()


async def test_what_was_heard_is_recorded_before_the_turn() -> None:
    heard = await flown(listening_mission())
    walk = CraftWalk().to("flying")
    asked = walk.give(inputs.Arrived(HOME, 0.3, 9.0, heard))
    recorded = [effect.event for effect in asked if isinstance(effect, effects.Record)]
    kinds = [type(event) for event in recorded]
    assert kinds.index(HeardOnTheWay) == kinds.index(PlaceReached) + 1
    assert isinstance(asked[-1], effects.Measure)
    assert walk.craft.phase == "measuring"
