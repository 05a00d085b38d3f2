"""Planning for a craft that turns at no place."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from planner.belief.joint import joint_prior, update_joint
from planner.legs import far_enough, first_time, flown_by_legs
from planner.options import FIELD
from planner.plan import expected_time_from, plan
from planner.types import Bearing, Legs, LinearConstantMotion, Problem

SQUARE = np.array([[0.0, 0.0], [300.0, 0.0], [300.0, 200.0], [0.0, 200.0]])
LEGS = Legs(least=60.0, sigma=math.radians(20.0), pause=2.0)
TURNING = Problem(
    area=(SQUARE,),
    sigma=math.radians(7.0),
    threshold=10.0,
    measurement_time=30.0,
    motion=LinearConstantMotion(7.0, 11.2),
    action_spacing=15.0,
    standoff=0.0,
)
FLYING_ON = flown_by_legs(replace(TURNING, legs=LEGS))
OPTIONS = replace(FIELD, base_policy="fisher", budget=60)


def test_a_place_costs_its_way_and_no_turn() -> None:
    assert first_time(TURNING) == 30.0
    assert first_time(FLYING_ON) == LEGS.pause
    assert FLYING_ON.sigma == LEGS.sigma
    assert FLYING_ON.measurement_time == pytest.approx(2.0 + 60.0 / 7.0), "later ones at least the shortest leg"
    assert flown_by_legs(TURNING) is TURNING


def test_no_leg_is_shorter_than_tells_anything() -> None:
    places = np.array([[10.0, 0.0], [59.0, 0.0], [61.0, 0.0], [0.0, 100.0]])
    assert far_enough(FLYING_ON, np.zeros(2), places).tolist() == [[61.0, 0.0], [0.0, 100.0]]
    assert far_enough(TURNING, np.zeros(2), places) is places
    near = places[:2]
    assert far_enough(FLYING_ON, np.zeros(2), near).tolist() == near.tolist(), "a small area: the furthest there are"


@pytest.mark.parametrize("bearings", [1, 2])
def test_the_planner_never_stays_where_it_is(bearings: int) -> None:
    """Also where another bearing from here would be the cheapest."""
    belief = joint_prior(FLYING_ON)
    told = [Bearing(20.0, 20.0, math.atan2(100.0, 160.0), math.radians(7.0), source="c")]
    told += [Bearing(250.0, 20.0, math.atan2(100.0, -70.0), math.radians(7.0), source="c")][: bearings - 1]
    for bearing in told:
        belief = update_joint(belief, bearing)
    here = (told[-1].x, told[-1].y)
    decision = plan(FLYING_ON, belief, told, here, OPTIONS, threads=1)
    assert math.dist((decision.x, decision.y), here) >= LEGS.least
    assert all(math.dist((c.x, c.y), here) >= LEGS.least for c in decision.candidates)


def test_the_forecast_of_a_place_shares_its_cost() -> None:
    belief = update_joint(
        joint_prior(FLYING_ON), Bearing(20.0, 20.0, math.atan2(100.0, 160.0), math.radians(7.0), source="c")
    )
    found = expected_time_from(
        FLYING_ON, belief, belief.folded, (150.0, 20.0), OPTIONS, platform_xy=(20.0, 20.0), rollouts=20
    )
    least = 130.0 / 7.0 + 11.2 + LEGS.pause
    assert found.times.min() >= least - 1e-9
