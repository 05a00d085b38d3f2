"""The rollout policy for several emitters that one turn hears at once."""

from dataclasses import replace

import numpy as np
import pytest
from refusals import refusing

from planner.belief.estimate import estimate
from planner.belief.grid import fold
from planner.belief.joint import joint_prior, update_joint
from planner.kernels.model import Tasks
from planner.options import CROSSFIX, FIELD
from planner.plan import plan
from planner.policy.actions import OTHER_ECHOES_M, action_space
from planner.policy.several import FORECAST_PATHS, Wanted, plan_several, standoff_among, telling_beside_bias
from planner.policy.simulation import simulate
from planner.policy.value_table import program_for
from planner.reasons import BudgetTooSmall, EveryPlaceRefused, SoonestTogether
from planner.sampling import random_paths
from planner.study.scenarios import scenario
from planner.types import Bearing, LinearConstantMotion

WORLD = scenario("field")
PROBLEM = WORLD.problem
HOME = WORLD.platform
OPTIONS = replace(FIELD, budget=200)


def wanted(*targets, problem=PROBLEM, places=(HOME,)):
    """Each emitter heard once from each of the places, without error."""
    return [
        Wanted(
            problem, fold(problem, [Bearing(x, y, float(np.arctan2(b - y, a - x)), problem.sigma) for x, y in places])
        )
        for a, b in targets
    ]


def expected_s(one, place, paths=400):
    """Mean time of one emitter by way of a place, from rollouts that share nothing with the policy under test."""
    simulation = simulate(one.problem, one.belief, HOME, base_policy="fisher")
    drawn = random_paths(one.belief, simulation.rules.sigma, paths, simulation.rules.horizon, np.random.default_rng(99))
    tasks = Tasks(np.zeros(paths, dtype=np.int64), np.arange(paths))
    return float(simulation.run(simulation.first_actions(np.array([place])), drawn, tasks).costs.mean())


def test_equal_beliefs_and_an_equal_seed_get_an_equal_decision():
    tags = wanted((60.0, 60.0), (250.0, 70.0))
    first, again = (plan_several(tags, HOME, OPTIONS, threads=threads) for threads in (1, 3))
    assert (first.x, first.y) == (again.x, again.y)
    assert np.array_equal(first.times, again.times)
    assert any(
        (other.x, other.y, other.times.mean()) != (first.x, first.y, first.times.mean())
        for other in (plan_several(tags, HOME, replace(OPTIONS, seed=seed)) for seed in (2, 3))
    )


def test_the_place_serves_all_where_each_alone_would_be_flown_for_elsewhere():
    tags = wanted((60.0, 100.0), (250.0, 100.0), (150.0, 110.0))
    together = plan_several(tags, HOME, replace(FIELD, budget=600))
    alone = [plan(PROBLEM, tag.belief, [None], HOME, replace(FIELD, budget=600)) for tag in tags]  # type: ignore[list-item]
    mean_s = lambda place: np.mean([expected_s(tag, place) for tag in tags])  # noqa: E731
    assert mean_s((together.x, together.y)) < min(mean_s((one.x, one.y)) for one in alone) + 2.0
    assert mean_s((together.x, together.y)) < np.mean([mean_s((one.x, one.y)) for one in alone])


def test_the_reason_counts_the_emitters_and_the_last_takes_longest():
    tags = wanted((60.0, 60.0), (250.0, 70.0))
    decision = plan_several(tags, HOME, OPTIONS)
    assert isinstance(decision.reason, SoonestTogether)
    assert decision.reason.emitters == 2
    assert decision.times.mean() > decision.reason.mean_time_s
    assert decision.rollouts >= 2 * OPTIONS.budget * 0.5
    kept = [c for c in decision.candidates if c.dropped_in_round is None]
    assert [(c.x, c.y) for c in kept] == [(decision.x, decision.y)]


def test_a_bearing_from_too_near_is_worth_nothing():
    """Where the emitters stand is nearly known: what is still missing is not fetched from right beside them."""
    heard_from = (HOME, (70.0, 60.0), (240.0, 60.0))
    kept_off = wanted((156.0, 60.0), (158.0, 62.0), places=heard_from, problem=replace(PROBLEM, threshold=2.0))
    free = [replace(one, problem=replace(one.problem, standoff=0.0)) for one in kept_off]
    apart, beside = (plan_several(tags, HOME, replace(FIELD, budget=600)) for tags in (kept_off, free))
    distances = [float(np.hypot(place.x - 157.0, place.y - 61.0)) for place in (apart, beside)]
    assert distances[0] >= standoff_among(PROBLEM, 112, 2) - 5.0 > distances[1]


def test_so_many_emitters_that_no_place_is_far_from_all_shrink_the_standoff():
    roomy = replace(PROBLEM, action_spacing=60.0)
    assert standoff_among(roomy, 112, 2) == PROBLEM.standoff == 50.0
    crowded = standoff_among(PROBLEM, 112, 8)
    assert 8 * np.pi * crowded**2 == pytest.approx(0.5 * 112 * 15.0**2)
    assert crowded < standoff_among(PROBLEM, 112, 4) < PROBLEM.standoff


def test_places_that_the_operator_refused_are_left_out():
    tags = wanted((60.0, 60.0), (250.0, 70.0))
    first = plan_several(tags, HOME, OPTIONS)
    second = plan_several(tags, HOME, OPTIONS, without=[(first.x, first.y)])
    assert np.hypot(second.x - first.x, second.y - first.y) >= 7.5
    every = [(x, y) for x in np.arange(50.0, 265.0, 5.0) for y in np.arange(0.0, 121.0, 5.0)]
    with refusing(EveryPlaceRefused):
        plan_several(tags, HOME, OPTIONS, without=every)


@pytest.mark.parametrize("sampling", ["deterministic", "crn", "pmc"])
@pytest.mark.parametrize("selection", ["uniform", "sequential_halving"])
def test_every_selection_and_sampling_decides(selection, sampling):
    options = replace(FIELD, selection=selection, sampling=sampling, budget=230)
    decision = plan_several(wanted((60.0, 60.0), (250.0, 70.0)), HOME, options)
    assert np.isfinite(decision.times).all()


def test_deterministic_paths_need_a_budget_for_every_place():
    with refusing(BudgetTooSmall):
        plan_several(wanted((60.0, 60.0), (250.0, 70.0)), HOME, replace(FIELD, sampling="deterministic", budget=20))


def test_rollouts_closed_by_the_program_still_tell_the_times_to_the_end():
    options = replace(CROSSFIX, budget=250)
    problem = replace(PROBLEM, motion=LinearConstantMotion(7.0, 11.2), estimator="geometric_median")
    assert program_for(problem) is not None
    tags = wanted((60.0, 60.0), (250.0, 70.0), problem=problem)
    decision = plan_several(tags, HOME, options)
    assert len(decision.times) == FORECAST_PATHS
    least = 11.2 + PROBLEM.measurement_time + np.hypot(decision.x - HOME[0], decision.y - HOME[1]) / 7.0
    assert (decision.times >= least).all()
    each = np.mean([expected_s(tag, (decision.x, decision.y)) for tag in tags])
    assert isinstance(decision.reason, SoonestTogether)
    assert decision.reason.mean_time_s == pytest.approx(each, rel=0.25)


def test_what_tells_nothing_of_an_emitter_is_not_simulated():
    tags = [Wanted(one.problem, joint(one)) for one in wanted((60.0, 60.0), (250.0, 70.0))]
    places = action_space(PROBLEM, tags[0].belief)
    telling = [telling_beside_bias(PROBLEM, tag.belief, places) for tag in tags]
    assert not all(some.all() for some in telling)
    decision = plan_several(tags, HOME, OPTIONS)
    values = 2 * sum(candidate.rollouts for candidate in decision.candidates)
    assert 0 < decision.rollouts < values


def joint(one):
    """Heard twice, by a sensor whose bias nobody knows."""
    target = estimate(one.belief, "expected_value")
    belief = joint_prior(PROBLEM)
    for x, y in (HOME, (20.0, 10.0)):
        belief = update_joint(belief, Bearing(x, y, float(np.arctan2(target.y - y, target.x - x)), PROBLEM.sigma))
    return belief


def test_each_emitter_has_its_own_echoes_whichever_is_named_first():
    """One turn heard both, another only the second: there the first has nothing to hear again."""
    both, second = HOME, (250.0, 60.0)
    (one,) = wanted((60.0, 100.0), problem=replace(PROBLEM, turned_at=(both,)), places=(both,))
    (other,) = wanted((200.0, 100.0), problem=replace(PROBLEM, turned_at=(both, second)), places=(both, second))
    places = action_space(PROBLEM, one.belief)
    of_one, of_other = (telling_beside_bias(w.problem, w.belief, places) for w in (one, other))
    near_both, near_second = (np.hypot(*(places - at).T) < OTHER_ECHOES_M for at in (both, second))
    assert not (of_one & near_both).any()
    assert (of_one & near_second).any()
    assert not (of_other & (near_both | near_second)).any()
    for some in ((one, other), (other, one)):
        compared = plan_several(some, HOME, OPTIONS).candidates
        assert min(np.hypot(c.x - both[0], c.y - both[1]) for c in compared) >= OTHER_ECHOES_M
        assert any(np.hypot(c.x - second[0], c.y - second[1]) < OTHER_ECHOES_M for c in compared)
