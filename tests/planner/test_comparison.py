"""The planner's place beside another: on equal luck, and with the rule that forbids the quicker one."""

from __future__ import annotations

from dataclasses import replace
from itertools import product

import numpy as np
import pytest

from planner.belief.grid import prior_belief, update
from planner.belief.joint import joint_prior, update_joint
from planner.comparison import between_places, difference_between, difference_together, rules_against
from planner.options import FIELD
from planner.plan import plan
from planner.policy.several import Wanted, times_together
from planner.reasons import BetweenPlaces, EchoesHeardBefore, NearerThanStandoff, TellsLittleOfBias
from planner.types import Bearing, LinearConstantMotion, Problem

AREA = np.array([[0.0, 0.0], [300.0, 0.0], [300.0, 120.0], [0.0, 120.0]])
FLIGHT = np.array([[-60.0, -60.0], [360.0, -60.0], [360.0, 180.0], [-60.0, 180.0]])
HERE = (0.0, -20.0)
PROBLEM = Problem(
    (AREA,),
    sigma=np.deg2rad(7.0),
    threshold=10.0,
    measurement_time=30.0,
    motion=LinearConstantMotion(7.0, 11.2),
    flight_area=(FLIGHT,),
    standoff=50.0,
    action_spacing=15.0,
)
SEEN = Bearing(*HERE, float(np.arctan2(100.0, 200.0)), PROBLEM.sigma)
BELIEF = update(prior_belief(PROBLEM), SEEN)


def test_a_place_compared_with_itself_makes_no_difference() -> None:
    same = difference_between(PROBLEM, BELIEF, [SEEN], HERE, (150.0, -30.0), (150.0, -30.0), FIELD)
    assert (same.mean, same.std_error) == (0.0, 0.0)


def test_no_place_that_the_rules_allow_beats_the_planners_by_much() -> None:
    """As an operator tries them: places all over the fence. What is quicker by more than chance breaks a rule."""
    chosen = plan(PROBLEM, BELIEF, [SEEN], HERE, FIELD, threads=1)
    quicker = []
    for x, y in [(x, y) for x in range(-40, 360, 50) for y in range(-40, 170, 50)]:
        found = difference_between(PROBLEM, BELIEF, [SEEN], HERE, (x, y), (chosen.x, chosen.y), FIELD, paths=128)
        if found.mean < -3.0 * found.std_error:
            quicker.append(rules_against(PROBLEM, BELIEF, (x, y)))
    assert len(quicker) >= 10
    assert all(isinstance(rule, NearerThanStandoff) and rule.clearance_m < 50.0 for (rule,) in quicker)


def test_pairs_tell_places_apart_that_their_own_errors_do_not() -> None:
    chosen = plan(PROBLEM, BELIEF, [SEEN], HERE, FIELD, threads=1)
    near = (chosen.x + 5.0, chosen.y)
    found = difference_between(PROBLEM, BELIEF, [SEEN], HERE, near, (chosen.x, chosen.y), FIELD)
    assert found.std_error < 2.0


@pytest.mark.parametrize("standoff", [0.0, 5.0])
def test_a_clear_place_breaks_no_rule_but_stands_between_the_compared_ones(standoff: float) -> None:
    assert rules_against(replace(PROBLEM, standoff=standoff), BELIEF, (350.0, -55.0)) == (BetweenPlaces(15.0),)


def test_a_standoff_that_cannot_be_kept_forbids_no_more_than_it_does_the_planner() -> None:
    vast = replace(PROBLEM, standoff=5000.0)
    chosen = plan(vast, BELIEF, [SEEN], HERE, FIELD, threads=1)
    assert rules_against(vast, BELIEF, (chosen.x, chosen.y)) == (BetweenPlaces(15.0),)


def test_a_place_beside_an_earlier_turn_is_named() -> None:
    turned = replace(PROBLEM, turned_at=((350.0, -45.0),))
    assert rules_against(turned, BELIEF, (350.0, -55.0)) == (EchoesHeardBefore(10.0, 25.0),)
    assert rules_against(turned, BELIEF, (350.0, -20.0)) == (BetweenPlaces(15.0),)


def test_where_all_places_are_near_turns_the_farthest_breaks_no_rule() -> None:
    beside = tuple((x, y) for x in range(-60, 361, 30) for y in range(-60, 181, 30))
    turned = replace(PROBLEM, standoff=0.0, turned_at=beside)
    chosen = plan(turned, BELIEF, [SEEN], HERE, FIELD, threads=1)
    assert rules_against(turned, BELIEF, (chosen.x, chosen.y)) == (BetweenPlaces(15.0),)
    (rule,) = rules_against(turned, BELIEF, (chosen.x + 12.0, chosen.y))
    assert isinstance(rule, EchoesHeardBefore)
    assert rule.away_m < rule.apart_m < 25.0


def test_where_the_other_places_are_refused_the_one_that_is_left_breaks_no_rule() -> None:
    turned = replace(PROBLEM, turned_at=((150.0, -30.0), (250.0, 150.0)))
    here, x, y = (150.0, -15.0), range(-52, 361, 15), range(-52, 181, 15)
    refused = tuple(place for place in product(x, y) if np.hypot(place[0] - here[0], place[1] - here[1]) > 15.0)
    chosen = plan(turned, BELIEF, [SEEN], HERE, FIELD, threads=1, without=refused)
    asked = (chosen.x, chosen.y)
    assert EchoesHeardBefore in [type(rule) for rule in rules_against(turned, BELIEF, asked)]
    assert rules_against(turned, BELIEF, asked, without=refused) == (BetweenPlaces(15.0),)


def test_with_an_open_compass_a_place_that_says_little_of_it_is_named() -> None:
    joint = update_joint(joint_prior(PROBLEM), replace(SEEN, source="craft"))
    rules = [type(rule) for rule in rules_against(PROBLEM, joint, (-50.0, -50.0))]
    assert TellsLittleOfBias in rules


def test_several_emitters_are_compared_by_the_mean_of_their_times() -> None:
    wanted = [Wanted(PROBLEM, BELIEF), Wanted(PROBLEM, BELIEF)]
    far = difference_together(wanted, HERE, (-50.0, 170.0), (150.0, -30.0), FIELD, paths=64)
    assert far.mean > 2.0 * far.std_error > 0.0


def test_what_a_place_tells_of_several_emitters_does_not_hang_on_the_place_it_is_compared_with() -> None:
    """With an open compass a bearing beside the last one repeats its error, whatever else was asked about."""
    joint = update_joint(joint_prior(PROBLEM), replace(SEEN, source="craft"))
    wanted = [Wanted(PROBLEM, joint), Wanted(PROBLEM, joint)]
    again, elsewhere, beside = (HERE[0] - 5.0, HERE[1] - 5.0), (150.0, -30.0), (HERE[0] + 5.0, HERE[1] - 5.0)
    by_way = [
        times_together(wanted, HERE, np.array([again, other]), FIELD, 64)[0].mean() for other in (elsewhere, beside)
    ]
    assert by_way[0] == by_way[1]


def test_what_is_quicker_for_several_stands_between_the_places_that_are_compared() -> None:
    assert between_places(PROBLEM) == (BetweenPlaces(15.0),)
    assert between_places(replace(PROBLEM, action_spacing=None)) == ()
