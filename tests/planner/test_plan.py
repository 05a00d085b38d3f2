"""The planner's front door: decisions, expected times, refusals."""

from dataclasses import replace
from typing import Any, cast

import numpy as np
import pytest
from refusals import refusing

from planner.belief.estimate import confidence_region
from planner.belief.grid import fold, prior_belief
from planner.geometry import contains, distance_to_convex
from planner.options import PlannerOptions
from planner.plan import expected_time_from, plan, warm_up
from planner.reasons import BeliefOutOfStep, LongestLead, NoPlaceToFly, QuickestPlace, UnusableNumber
from planner.types import Bearing, FullMotion, LinearConstantMotion, PlannerError, Problem


def rectangle(x0, y0, x1, y1):
    return np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]], dtype=float)


FIELD = Problem(
    area=(rectangle(0, 0, 313, 120),),
    sigma=np.deg2rad(7),
    threshold=10.0,
    measurement_time=30.0,
    motion=LinearConstantMotion(7.0, 11.2),
    flight_area=(rectangle(-60, -60, 373, 180),),
    standoff=50.0,
    action_spacing=15.0,
)
TARGET = (200.0, 80.0)
FIRST = [Bearing(0.0, 0.0, float(np.arctan2(80, 200)) + 0.05, np.deg2rad(7), 0.05)]


def test_a_field_mission_converges_on_the_target():
    rng = np.random.default_rng(8)
    here, bearings = (0.0, 0.0), list(FIRST)
    for _ in range(5):
        belief = fold(FIELD, bearings)
        decision = plan(FIELD, belief, bearings, here, PlannerOptions(budget=400))
        here = (decision.x, decision.y)
        angle = np.arctan2(TARGET[1] - here[1], TARGET[0] - here[0]) + rng.normal(0, FIELD.sigma)
        bearings.append(Bearing(*here, float(angle), FIELD.sigma, 0.05))
    hull = confidence_region(fold(FIELD, bearings))
    assert distance_to_convex(np.array([TARGET]), hull)[0] < 10.0
    assert np.ptp(hull, axis=0).max() < 120.0


def test_the_place_keeps_its_distance_and_stays_inside():
    belief = fold(FIELD, FIRST)
    decision = plan(FIELD, belief, FIRST, (0.0, 0.0), PlannerOptions(budget=400))
    place = np.array([[decision.x, decision.y]])
    assert FIELD.flight_area is not None
    assert contains(FIELD.flight_area, place)[0]
    assert distance_to_convex(place, confidence_region(belief))[0] >= 50.0


def test_the_reason_has_the_time_and_the_choice():
    decision = plan(FIELD, fold(FIELD, FIRST), FIRST, (0.0, 0.0), PlannerOptions(budget=400))
    assert isinstance(decision.reason, QuickestPlace | LongestLead)
    assert decision.reason.places == sum(candidate.rollouts > 0 for candidate in decision.candidates)
    assert decision.reason.expected_time_s == pytest.approx(decision.times.mean())


def test_expected_times_agree_with_the_decision_that_was_made():
    belief = fold(FIELD, FIRST)
    decision = plan(FIELD, belief, FIRST, (0.0, 0.0), PlannerOptions(budget=2000))
    there = expected_time_from(FIELD, belief, FIRST, (decision.x, decision.y), platform_xy=(0.0, 0.0), rollouts=800)
    assert there.mean == pytest.approx(decision.times.mean(), rel=0.15)
    assert there.median <= there.p90
    assert there.localized_share == 1.0
    assert there.bearings >= 1.0


def test_hovering_there_already_saves_exactly_the_flight():
    belief = fold(FIELD, FIRST)
    spot = (100.0, 150.0)
    flown = expected_time_from(FIELD, belief, FIRST, spot, platform_xy=(0.0, 0.0))
    there = expected_time_from(FIELD, belief, FIRST, spot)
    assert flown.mean - there.mean == pytest.approx(np.hypot(*spot) / 7.0 + 11.2)


def test_a_detour_costs_what_it_takes():
    belief = fold(FIELD, FIRST)
    blocked = replace(FIELD, no_fly=(rectangle(40, 50, 60, 200),))
    free = expected_time_from(FIELD, belief, FIRST, (100.0, 150.0), platform_xy=(0.0, 150.0))
    around = expected_time_from(blocked, belief, FIRST, (100.0, 150.0), platform_xy=(0.0, 150.0))
    assert around.mean > free.mean + 5.0


def test_the_full_motion_model_prefers_not_to_turn():
    turning = replace(FIELD, motion=FullMotion(turn_rate=0.05))
    belief = fold(FIELD, FIRST)
    ahead = expected_time_from(turning, belief, FIRST, (100.0, 0.0), platform_xy=(0.0, 0.0), heading=0.0)
    behind = expected_time_from(turning, belief, FIRST, (100.0, 0.0), platform_xy=(0.0, 0.0), heading=np.pi)
    assert behind.mean - ahead.mean == pytest.approx(np.pi / 0.05, rel=1e-6)


def test_a_very_wide_sensor_and_a_hypothesis_far_away_can_be_planned_with():
    wide = replace(FIELD, sigma=np.deg2rad(40.0))
    two = [replace(FIRST[0], sigma=wide.sigma), Bearing(300.0, -40.0, 0.3, wide.sigma, 0.3)]
    decision = plan(wide, fold(wide, two), two, (0.0, 0.0), PlannerOptions(budget=300))
    assert np.isfinite([decision.x, decision.y]).all()


@pytest.mark.parametrize("selection", ["sequential_halving", "uniform"])
@pytest.mark.parametrize("sampling", ["crn", "pmc"])
@pytest.mark.parametrize("base_policy", ["fisher", "ellipse"])
def test_every_combination_decides(selection, sampling, base_policy):
    coarse = replace(FIELD, action_spacing=60.0)
    belief = fold(coarse, FIRST)
    decision = plan(
        coarse,
        belief,
        FIRST,
        (0.0, 0.0),
        PlannerOptions(selection=selection, sampling=sampling, base_policy=base_policy, budget=200),
    )
    assert (decision.x, decision.y) in {(c.x, c.y) for c in decision.candidates}


@pytest.mark.parametrize(
    ("changes", "options", "reason"),
    [
        ({"sigma": np.nan}, {}, UnusableNumber("sigma", "positive", "nan")),
        ({"threshold": 0.0}, {}, UnusableNumber("threshold", "positive", "0")),
        ({"measurement_time": -1.0}, {}, UnusableNumber("measurement_time", "not_negative", "-1")),
        ({}, {"options": PlannerOptions(budget=0)}, UnusableNumber("budget", "at_least_one", "0")),
        ({}, {"threads": 0}, UnusableNumber("threads", "at_least_one", "0")),
        ({"no_fly": (rectangle(-100, -100, 400, 300),)}, {}, NoPlaceToFly()),
        ({"motion": LinearConstantMotion(0.0, 1.0)}, {}, UnusableNumber("speed", "positive", "0")),
    ],
)
def test_what_cannot_be_planned_is_refused_with_the_reason(changes, options, reason):
    belief = fold(FIELD, FIRST)
    with refusing(reason, PlannerError):
        plan(replace(FIELD, **changes), belief, FIRST, (0.0, 0.0), **options)


def test_a_belief_of_other_bearings_is_refused():
    with refusing(BeliefOutOfStep(folded=0, given=1)):
        plan(FIELD, prior_belief(FIELD), FIRST, (0.0, 0.0))


def test_a_platform_that_is_nowhere_is_refused():
    with refusing(UnusableNumber("platform_position", "finite", "(nan, 0.0)")):
        plan(FIELD, fold(FIELD, FIRST), FIRST, (np.nan, 0.0))


def test_warming_up_leaves_nothing_to_compile():
    from planner.kernels import compiled

    warm_up()
    before = len(cast(Any, compiled.rollouts).signatures)
    plan(FIELD, fold(FIELD, FIRST), FIRST, (0.0, 0.0), PlannerOptions(budget=300))
    assert len(cast(Any, compiled.rollouts).signatures) == before == 1
