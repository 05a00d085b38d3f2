"""What was heard between places: off unless asked for, folded with the bearings, left out like them, and replayed."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest
from facts import OWN, PERSON, bearing, belief
from ground import AREA, FRAME, HOME, towards
from legs import TARGET, way
from search_walk import SearchWalk, facts_of, refusal

from backend import commands
from backend.craft.on_the_way import listened_to, turned_at
from backend.events import BearingExcluded, HeardOnTheWay
from backend.reasons import refusals
from backend.search.effects import UpdateBelief
from backend.search.inputs import BeliefReady
from backend.search.localization import Localization, localization
from backend.search.way_facts import stretches_of
from backend.spec import FIRST_EMITTER, EmitterSpec, MissionSpec, MovementSpec, SensorSpec
from hardware.reasons.on_the_way import ReadingsLeftOut
from planner.belief.grid import digest
from planner.belief.joint import JointBelief


def task(**sensor: object) -> Localization:
    return localization(MissionSpec(name="m", area=AREA, sensor=SensorSpec.model_validate(sensor)), HOME)


def test_it_is_off_unless_a_mission_asks_for_it() -> None:
    stored = MissionSpec.model_validate({"name": "m", "area": AREA.model_dump(mode="json")})
    assert not stored.sensor.listen_on_the_way
    assert listened_to(stored) == ()


def test_only_what_stands_still_is_listened_to_and_only_where_errors_are_joint() -> None:
    moving = EmitterSpec(emitter_id="emitter-2", frequency_hz=869.5e6, movement=MovementSpec(kind="walking"))
    mission = MissionSpec(name="m", area=AREA, emitters=[EmitterSpec(), moving])
    joint = SensorSpec(bearing_errors="joint", listen_on_the_way=True)
    wanted = listened_to(mission.model_copy(update={"sensor": joint}))
    assert [emitter.emitter_id for emitter in wanted] == [FIRST_EMITTER]
    independent = joint.model_copy(update={"bearing_errors": "independent"})
    assert listened_to(mission.model_copy(update={"sensor": independent})) == ()


def test_a_leg_is_a_short_fact_that_says_where_it_listened() -> None:
    fact = way()
    assert fact.tells
    assert len(fact.stretches) == 4
    assert all(30.0 < one.turned_deg < 110.0 for one in fact.stretches)
    assert len(fact.model_dump_json()) < 4_000
    assert ReadingsLeftOut("beside_a_turn", 25) in [r for r in fact.left_out if isinstance(r, ReadingsLeftOut)]
    assert HeardOnTheWay.model_validate_json(fact.model_dump_json()) == fact


def test_its_stretches_point_as_the_antenna_did() -> None:
    stretches = stretches_of(way(), FRAME, "craft:craft-1")
    first = stretches[0]
    at = (np.array(first.x) - 0.0) / 8.0
    assert np.array(first.front) == pytest.approx(math.pi / 2 - np.radians(30.0 * at), abs=0.05)
    assert np.array(first.y) == pytest.approx(0.0, abs=0.1)


def test_a_leg_brings_the_belief_nearer_to_the_emitter_and_bearings_still_count() -> None:
    bare = task(bearing_errors="joint")
    after = bare.after((), [way()])
    assert isinstance(bare.prior, JointBelief)

    def density_at_target(belief: object) -> float:
        assert isinstance(belief, JointBelief)
        i, j = int((TARGET[0] - belief.x0) / belief.h), int((TARGET[1] - belief.y0) / belief.h)
        return float(belief.density[j, i]) / belief.h**2

    assert density_at_target(after.belief(())) > 1.3 * density_at_target(bare.prior)
    bearings = [towards(60.0, -40.0, TARGET, sigma=7.0), towards(200.0, 100.0, TARGET, sigma=7.0)]
    without, _ = bare.belief_fact(bearings)
    fact, found = after.belief_fact(bearings)
    assert fact.estimate is not None
    assert without.estimate is not None
    assert fact.estimate.expected_rmse_m < without.estimate.expected_rmse_m
    assert digest(found) == digest(bare.after((), [way()]).belief_fact(bearings)[1]), "the same from the facts alone"


def test_it_tells_nothing_to_independent_errors_and_nothing_when_it_is_damaged() -> None:
    independent, joint = task(), task(bearing_errors="joint")
    assert independent.after((), [way()]) is independent
    damaged = way().model_copy(update={"readings": "damaged"})
    assert joint.after((), [damaged]).stretches == ()
    straight = way(turn_deg_s=0.0)
    assert not straight.tells
    assert straight.stretches == []
    assert joint.after((), [straight]).belief(()) is joint.prior


def test_a_leg_outruns_the_belief_and_is_left_out_like_a_bearing() -> None:
    walk = SearchWalk().to("open")
    walk.arrive(bearing(1, source=PERSON))
    walk.believe(localized=True)
    walk.fold(way(turn_deg_s=0.0, leg_id="straight"))
    assert walk.state.localized, "a leg that tells nothing changes nothing"
    walk.fold(way())
    emitter = walk.state.emitters[FIRST_EMITTER]
    assert (emitter.bearing_ids, emitter.localized) == (("b1", "leg-1"), False)
    assert not facts_of(walk.give(BeliefReady(("b1",), belief(1)))), "a belief without it is no longer current"
    walk.believe(localized=True)
    assert walk.order(commands.ExcludeBearing(bearing_id="leg-1"))[-1] == UpdateBelief(FIRST_EMITTER)
    assert walk.state.emitters[FIRST_EMITTER].legs == ()
    (left_out,) = [fact for fact in walk.recorded if isinstance(fact, BearingExcluded)]
    assert (left_out.heard, left_out.on_the_way) == (False, True)
    again = walk.order(commands.ExcludeBearing(bearing_id="leg-1"))
    assert refusal(again) == refusals.BearingExcludedAlready()
    assert walk.order(commands.IncludeBearing(bearing_id="leg-1"))[-1] == UpdateBelief(FIRST_EMITTER)
    assert len(walk.state.emitters[FIRST_EMITTER].legs) == 1


def test_a_muted_source_is_muted_on_the_way_too() -> None:
    walk = SearchWalk().to("open")
    walk.fold(way())
    muted = dataclasses.replace(walk.state.emitters[FIRST_EMITTER], muted=frozenset((OWN,)))
    assert muted.legs == ()


def test_where_the_craft_has_turned_is_known_from_the_facts() -> None:
    walk = SearchWalk().to("open")
    walk.arrive(bearing(1, source=PERSON))
    walk.fold(bearing(2, source=OWN))
    assert turned_at(walk.state, OWN) == (bearing(2).place,)
    assert turned_at(walk.state, PERSON) == (bearing(1).place,), "of each source its own"
