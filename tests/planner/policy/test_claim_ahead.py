"""One bearing ahead on the joint belief: the place that is chosen does lead to a claim."""

from dataclasses import replace

import numpy as np
import pytest

from planner.belief.estimate import estimate
from planner.belief.grid import fold
from planner.belief.joint import joint_prior, update_joint
from planner.belief.source_errors import ErrorPrior
from planner.belief.verdict import verdict
from planner.comparison import difference_between, rules_against
from planner.observation import wrap
from planner.options import FIELD
from planner.plan import expected_time_from, plan
from planner.policy.actions import constrained_actions
from planner.policy.claim_ahead import LATER_CHANCE, ClaimAhead, biased_cells, choice, claim_ahead, drawn
from planner.reasons import BetweenPlaces, ErrorMayBeFarLarger, NearerThanStandoff, QuickestPlace
from planner.study.scenarios import scenario
from planner.types import Bearing, LinearConstantMotion, LocalizationRule, Problem

AREA = np.array([[-156.0, 0.0], [156.0, 0.0], [156.0, 200.0], [-156.0, 200.0]])
OWN = float(np.deg2rad(2.5))
PROBLEM = Problem(
    area=(AREA,),
    sigma=float(np.deg2rad(4.0)),
    threshold=10.0,
    measurement_time=30.0,
    motion=LinearConstantMotion(7.0, 11.2),
    standoff=50.0,
    action_spacing=15.0,
    estimator="geometric_median",
)
RULE = LocalizationRule(threshold=10.0)
TARGET = np.array([30.0, 170.0])
PLACES = ((0.0, 246.0), (112.0, 165.0), (112.0, 150.0))
"""The third stands nearly where the second did: it narrows the belief and leaves the tail."""


UNKNOWN = ErrorPrior(
    scale=np.array([0.5, 1.0, 1.45]),
    scale_weight=np.array([0.15, 0.63, 0.22]),
    rate=np.array([0.003, 0.02, 0.05, 0.1, 0.2]),
    rate_weight=np.array([0.07, 0.18, 0.36, 0.06, 0.33]),
)


def towards(x, y):
    return float(np.arctan2(TARGET[1] - y, TARGET[0] - x))


def taken(count):
    return [Bearing(x, y, towards(x, y), OWN, source="craft") for x, y in PLACES[:count]]


def joint(bearings):
    belief = joint_prior(PROBLEM, otherwise=UNKNOWN)
    for bearing in bearings:
        belief = update_joint(belief, bearing)
    return belief


def ahead_of(belief, places, here, problem=PROBLEM):
    def costs(some):
        return 41.2 + np.hypot(*(some - np.array(here)).T) / 7.0

    return claim_ahead(problem, belief, np.array(here), lambda: places, costs)


def share_claimed(belief, bearings, place, count=24):
    """By drawing where the emitter is, the bias and an error, and by asking the verdict."""
    cells = biased_cells(PROBLEM, belief, estimate(belief, PROBLEM.estimator), belief.errors[0])
    claimed = 0
    draws = drawn(cells.mass, count)
    for cell, noise in zip(draws.cell, draws.noise, strict=True):
        seen = np.arctan2(cells.y[cell] - place[1], cells.x[cell] - place[0]) + cells.bias[cell]
        angle = float(seen + np.sqrt(cells.variance[cell]) * noise)
        further = Bearing(place[0], place[1], angle, OWN, source="craft")
        after = update_joint(belief, further)
        claimed += verdict(PROBLEM, RULE, [*bearings, further], after).localized
    return claimed / count


def test_where_the_tail_stops_the_claim_the_next_bearing_is_taken_where_it_ends_it():
    bearings = taken(3)
    belief = joint(bearings)
    said = verdict(PROBLEM, RULE, bearings, belief)
    assert [type(reason) for reason in said.reasons] == [ErrorMayBeFarLarger]
    decision = plan(PROBLEM, belief, bearings, PLACES[2], replace(FIELD, budget=200), threads=1)
    assert isinstance(decision.reason, QuickestPlace)
    here = share_claimed(belief, bearings, PLACES[2])
    there = share_claimed(belief, bearings, (decision.x, decision.y))
    assert there >= 0.75
    assert there > here + 0.2
    assert decision.times.min() >= 41.2 + np.hypot(decision.x - PLACES[2][0], decision.y - PLACES[2][1]) / 7.0 - 1e-9


def test_the_choice_is_the_least_value_and_its_times_have_that_mean():
    belief = joint(taken(3))
    places = constrained_actions(PROBLEM, belief)
    ahead = ahead_of(belief, places, PLACES[2])
    assert ahead is not None
    decision = choice(ahead)
    best = int(np.argmin(ahead.values))
    assert (decision.x, decision.y) == tuple(ahead.places[best])
    chance = ahead.chance[best]
    whole = ahead.costs[best] + ahead.again * (1.0 - chance) / ahead.later(chance)
    assert decision.times.mean() == pytest.approx(whole, rel=0.03)
    assert {(c.x, c.y) for c in decision.candidates} <= {(x, y) for x, y in places.tolist()}


def by_hand(*costs_and_chances):
    costs, chances = np.array(costs_and_chances).T
    return ClaimAhead(np.zeros((len(costs), 2)), costs, chances, lambda some: some[:, 0])


@pytest.mark.parametrize("chance", [0.0, 0.2, 0.4, 0.8])
def test_a_bearing_that_fails_is_followed_by_the_more_the_less_it_told(chance):
    """1 / P as many, as once reckoned, foretold 127 s where 64 followed."""
    ahead = by_hand((30.0, chance), (50.0, 0.8))
    later = 0.8 + (LATER_CHANCE - 0.8) * chance / 0.8
    times = ahead.times(30.0, chance, 4096)
    assert times.mean() == pytest.approx(30.0 + (1.0 - chance) * 40.0 / later, rel=1e-3)
    assert times.mean() == pytest.approx(ahead.values[0], rel=1e-3)
    assert np.mean(times == 30.0) == pytest.approx(chance, abs=1e-3)
    assert (ahead.times(30.0, chance + 0.1, 4096) <= times).all()


def test_a_near_place_that_tells_nothing_is_not_chosen():
    ahead = by_hand((16.0, 0.03), (30.0, 0.4), (28.0, 0.35), (26.0, 0.1))
    assert ahead.best == 1


def test_an_operators_place_is_judged_as_the_planners_places_are():
    bearings = taken(3)
    belief, here, options = joint(bearings), PLACES[2], replace(FIELD, budget=200)
    chosen = plan(PROBLEM, belief, bearings, here, options, threads=1)
    said = {(c.x, c.y): c.value for c in chosen.candidates}
    best = (chosen.x, chosen.y)
    assert said[best] == pytest.approx(chosen.times.mean())
    assert said[best] == min(said.values())
    same = difference_between(PROBLEM, belief, bearings, here, best, best, options)
    assert (same.mean, same.std_error) == (0.0, 0.0)
    for place in list(said)[:: len(said) // 4]:
        there = expected_time_from(PROBLEM, belief, bearings, place, options, platform_xy=here)
        assert there.mean == pytest.approx(said[place], abs=1.5)
        found = difference_between(PROBLEM, belief, bearings, here, place, best, options)
        assert found.mean == pytest.approx(said[place] - said[best], abs=1.0)
        assert there.times.min() >= 41.2


def test_no_allowed_place_is_said_to_be_quicker_than_the_planners():
    """As an operator tries them: all around. Rollouts, which expect a claim of any bearing, would prefer many."""
    bearings = taken(3)
    belief, here, options = joint(bearings), PLACES[2], replace(FIELD, budget=200)
    chosen = plan(PROBLEM, belief, bearings, here, options, threads=1)
    for place in [(x, y) for x in (-140.0, -75.0, -10.0, 55.0, 112.0) for y in (15.0, 80.0, 145.0, 210.0)]:
        found = difference_between(PROBLEM, belief, bearings, here, place, (chosen.x, chosen.y), options)
        rules = rules_against(PROBLEM, belief, place, by_claim=found.by_claim)
        assert found.by_claim
        assert {type(rule) for rule in rules} <= {NearerThanStandoff, BetweenPlaces}
        assert found.mean >= -2.0 * found.std_error or isinstance(rules[0], NearerThanStandoff)


def test_base_policies_look_no_bearing_ahead_and_neither_does_their_comparison():
    bearings, options = taken(3), replace(FIELD, method="base_policy")
    found = difference_between(PROBLEM, joint(bearings), bearings, PLACES[2], PLACES[0], PLACES[1], options, paths=16)
    assert not found.by_claim


def test_rollouts_decide_while_a_claim_is_more_than_one_bearing_away():
    belief, places = joint(taken(1)), constrained_actions(PROBLEM, joint(taken(1)))
    assert ahead_of(belief, places, PLACES[0]) is None
    independent = fold(PROBLEM, [replace(b, outlier_probability=0.1) for b in taken(3)])
    assert ahead_of(independent, places, PLACES[0]) is None
    two = replace(PROBLEM, threshold=0.5)
    assert ahead_of(joint(taken(3)), places, PLACES[2], two) is None


def test_places_without_a_way_are_not_chosen():
    belief = joint(taken(3))
    places = constrained_actions(PROBLEM, belief)
    usual = ahead_of(belief, places, PLACES[2])
    assert usual is not None
    chosen = choice(usual)

    def costs(some):
        return np.where(some[:, 0] == chosen.x, np.inf, 60.0)

    ahead = claim_ahead(PROBLEM, belief, np.array(PLACES[2]), lambda: places, costs)
    assert ahead is not None
    assert (ahead.places[:, 0] != chosen.x).all()
    nowhere = claim_ahead(PROBLEM, belief, np.array(PLACES[2]), lambda: places, lambda some: np.full(len(some), np.inf))
    assert nowhere is None


def test_of_two_sources_nobody_knows_which_bias_comes_next():
    *own, last = taken(3)
    belief = joint([*own, replace(last, source="somebody else")])
    places = constrained_actions(PROBLEM, belief)
    assert ahead_of(belief, places, PLACES[2]) is None


def test_the_bias_of_whoever_measured_before_is_not_drawn_for_another_source():
    belief = joint(taken(3))
    places = constrained_actions(PROBLEM, belief)
    assert ahead_of(belief, places, PLACES[2], replace(PROBLEM, next_source="craft")) is not None
    assert ahead_of(belief, places, PLACES[2], replace(PROBLEM, next_source="somebody else")) is None


def test_refused_places_are_not_chosen():
    bearings = taken(3)
    belief, options = joint(bearings), replace(FIELD, budget=200)
    first = plan(PROBLEM, belief, bearings, PLACES[2], options, threads=1)
    second = plan(PROBLEM, belief, bearings, PLACES[2], options, threads=1, without=[(first.x, first.y)])
    assert (second.x, second.y) != (first.x, first.y)
    assert all((c.x, c.y) != (first.x, first.y) for c in second.candidates)


def test_cells_together_hold_the_belief():
    belief = joint(taken(3))
    now = estimate(belief, "expected_value")
    cells = biased_cells(PROBLEM, belief, now, belief.errors[0])
    assert cells.mass.sum() == pytest.approx(1.0)
    assert (cells.mass @ cells.x, cells.mass @ cells.y) == pytest.approx((now.x, now.y), abs=0.3)
    assert cells.mass @ cells.bias == pytest.approx(belief.errors[0].bias, abs=np.deg2rad(0.1))
    spread = cells.mass @ ((cells.x - now.x) ** 2 + (cells.y - now.y) ** 2 + 2.0 * cells.blur)
    assert spread == pytest.approx(np.trace(now.covariance), rel=0.06)
    assert len(cells.x) < 1000


@pytest.mark.parametrize("seed", [2, 5, 6])
def test_an_emitter_beside_a_place_of_measurement_is_claimed_in_the_end(seed):
    """The tail stood against it, hardly any bearing led to a claim, and the nearest place was chosen up to 25 times."""
    world = scenario("field")
    rng = np.random.default_rng(seed)
    angle, beside_m = rng.uniform(0.0, np.pi), rng.uniform(1.0, 6.0)
    target = np.array(world.platform) + beside_m * np.array([np.cos(angle), np.sin(angle)])
    rng = np.random.default_rng([seed, 5])
    bias, belief, here, bearings = (
        np.deg2rad(5.3) * rng.standard_normal(),
        joint_prior(world.problem),
        world.platform,
        [],
    )
    while len(bearings) < 16:
        off = np.arctan2(target[1] - here[1], target[0] - here[0]) + bias
        bearings.append(
            Bearing(*here, float(wrap(off + world.problem.sigma * rng.standard_normal())), world.problem.sigma)
        )
        belief = update_joint(belief, bearings[-1])
        if verdict(world.problem, RULE, bearings, belief).localized:
            break
        chosen = plan(world.problem, belief, bearings, here, replace(FIELD, budget=250), threads=1)
        here = (chosen.x, chosen.y)
    else:
        pytest.fail(f"not claimed after {len(bearings)} bearings")
