"""Where nothing but the crossing angle keeps a claim, the next place is one from which lines cross widely enough."""

from dataclasses import replace

import numpy as np
import pytest

from planner.belief.grid import GridBelief
from planner.belief.joint import JointBelief, joint_prior, update_joint
from planner.belief.verdict import missing_crossing, verdict
from planner.comparison import rules_against
from planner.crossing import Crossing
from planner.options import FIELD
from planner.plan import plan
from planner.policy.actions import action_space
from planner.policy.several import Wanted, plan_several
from planner.reasons import CrossesTooLittle, CrossingAngleTooSmall
from planner.types import Bearing, LinearConstantMotion, LocalizationRule, Problem

AREA = np.array([[0.0, 0.0], [313.0, 0.0], [313.0, 200.0], [0.0, 200.0]])
SIGMA = float(np.deg2rad(4.0))
PROBLEM = Problem(
    (AREA,),
    sigma=SIGMA,
    threshold=50.0,
    measurement_time=30.0,
    motion=LinearConstantMotion(7.0, 11.2),
    flight_area=(AREA,),
    standoff=50.0,
    action_spacing=45.0,
)
RULE = LocalizationRule(threshold=50.0)
TARGET = (300.0, 30.0)
FROM_ONE_SIDE = ((22.5, 20.0), (22.5, 65.0), (67.5, 65.0))
HERE = FROM_ONE_SIDE[-1]


def bearing_from(x: float, y: float) -> Bearing:
    return Bearing(x, y, float(np.arctan2(TARGET[1] - y, TARGET[0] - x)), SIGMA)


BEARINGS = tuple(bearing_from(*place) for place in FROM_ONE_SIDE)


def believed() -> JointBelief:
    belief = joint_prior(PROBLEM)
    for bearing in BEARINGS:
        belief = update_joint(belief, bearing)
    return belief


def waiting() -> tuple[Problem, GridBelief, Crossing]:
    belief = believed()
    crossing = missing_crossing(PROBLEM, RULE, BEARINGS, belief)
    assert crossing is not None
    return replace(PROBLEM, crossing=crossing), belief, crossing


def test_a_claim_waits_for_the_angle_alone() -> None:
    reasons = verdict(PROBLEM, RULE, BEARINGS, believed()).reasons
    assert [type(reason) for reason in reasons] == [CrossingAngleTooSmall]


def test_the_next_place_crosses_widely_enough() -> None:
    problem, belief, crossing = waiting()
    chosen = plan(problem, belief, BEARINGS, HERE, FIELD, threads=1)
    assert crossing.angles(np.array([[chosen.x, chosen.y]]))[0] >= crossing.least
    blind = plan(PROBLEM, belief, BEARINGS, HERE, FIELD, threads=1)
    assert crossing.angles(np.array([[blind.x, blind.y]]))[0] < crossing.least, "the case would show nothing"


def test_of_several_too() -> None:
    problem, belief, crossing = waiting()
    chosen = plan_several([Wanted(problem, belief)] * 2, HERE, FIELD, threads=1)
    assert crossing.angles(np.array([[chosen.x, chosen.y]]))[0] >= crossing.least


def test_a_place_that_crosses_too_little_is_named() -> None:
    problem, belief, _ = waiting()
    found = [rule for rule in rules_against(problem, belief, HERE, by_claim=True) if isinstance(rule, CrossesTooLittle)]
    assert [rule.needed_deg for rule in found] == [pytest.approx(20.0)]
    assert found[0].crossing_deg < 20.0


@pytest.mark.parametrize("standoff", [0.0, 50.0])
def test_a_place_that_crosses_more_widely_than_any_on_the_lattice_breaks_no_rule_about_it(standoff: float) -> None:
    problem, belief, found = waiting()
    crossing = replace(found, least=np.pi / 2)
    asking = replace(problem, crossing=crossing, standoff=standoff, action_spacing=150.0)
    beyond = (crossing.x, crossing.y + 120.0)
    here, *others = crossing.angles(np.vstack([beyond, action_space(asking, belief)]))
    assert here > max(others), "the case would show nothing"
    assert not any(isinstance(rule, CrossesTooLittle) for rule in rules_against(asking, belief, beyond))


def test_a_large_error_asks_for_no_angle() -> None:
    assert missing_crossing(PROBLEM, replace(RULE, threshold=5.0), BEARINGS, believed()) is None


def test_lines_that_cross_ask_for_nothing() -> None:
    across = (*BEARINGS, bearing_from(280.0, 180.0))
    belief = update_joint(believed(), across[-1])
    assert missing_crossing(PROBLEM, RULE, across, belief) is None


def test_where_no_place_crosses_widely_enough_the_widest_are_left() -> None:
    crossing = Crossing(0.0, 0.0, np.array([0.0]), np.deg2rad(20.0))
    places = np.array([[-100.0, 0.0], [-100.0, 10.0], [100.0, -17.0]])
    assert crossing.crossed_from(places).tolist() == [False, False, True]


def widest_alone() -> tuple[Problem, GridBelief, tuple[float, float]]:
    """No place crosses widely enough, and one of them the most widely."""
    problem, belief, crossing = waiting()
    wide = replace(crossing, least=np.pi / 2)
    asking = replace(problem, crossing=wide)
    places = action_space(asking, belief)
    (widest,) = places[wide.crossed_from(places)]
    return asking, belief, (float(widest[0]), float(widest[1]))


def test_where_the_widest_is_refused_the_next_widest_is_flown_to() -> None:
    problem, belief, widest = widest_alone()
    chosen = plan(problem, belief, BEARINGS, HERE, FIELD, threads=1)
    assert (chosen.x, chosen.y) == widest
    refused = [widest]
    for _ in range(3):
        chosen = plan(problem, belief, BEARINGS, HERE, FIELD, threads=1, without=refused)
        assert (chosen.x, chosen.y) not in refused
        refused.append((chosen.x, chosen.y))


def test_where_the_widest_is_out_of_reach_the_widest_in_reach_is_flown_to() -> None:
    problem, belief, (x, y) = widest_alone()
    corners = 20.0 * np.array([(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]) + (x, y)
    moat = tuple(
        np.array([a, b, b + 8.0 * np.sign(b - (x, y)), a + 8.0 * np.sign(a - (x, y))])
        for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True)
    )
    enclosed = replace(problem, no_fly=moat)
    chosen = plan(enclosed, belief, BEARINGS, HERE, FIELD, threads=1)
    assert (chosen.x, chosen.y) != (x, y)


def test_opposite_directions_are_one_line() -> None:
    crossing = Crossing(0.0, 0.0, np.array([0.1]), np.deg2rad(20.0))
    assert crossing.angles(np.array([[10.0 * np.cos(0.1), 10.0 * np.sin(0.1)]]))[0] == pytest.approx(0.0, abs=1e-9)
