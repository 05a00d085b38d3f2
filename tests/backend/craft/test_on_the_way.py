"""A leg's readings become its facts when the craft arrives, and are recorded before it measures."""

from __future__ import annotations

import math
from dataclasses import replace

from craft_walk import CraftWalk
from equipment import FRAME, HOME, spec
from facts import OWN
from stage import Stage

from backend.craft import effects, inputs
from backend.craft.listening import Listening, channels_of
from backend.craft.on_the_way import heard_on_leg
from backend.events import HeardOnTheWay, PlaceReached
from backend.search.state import SearchState
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
