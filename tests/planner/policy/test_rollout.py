"""The rollout policy and its sampler."""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pytest
from refusals import refusing

from planner.belief.grid import FIRST_CELLS, prior_belief
from planner.kernels.model import CLOSED_FEATURES
from planner.policy.actions import SAME_PLACE_M
from planner.policy.rollout import Rollout, RolloutSampler
from planner.policy.simulation import simulate
from planner.reasons import BudgetTooSmall, EveryPlaceRefused, FixedSamplePaths, UnusableNumber
from planner.selection.sequential_halving import sequential_halving
from planner.selection.uniform import uniform
from planner.types import GaussianPrior, Legs, LinearMotion, Problem


def rectangle(x0, y0, x1, y1):
    return np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]], dtype=float)


PROBLEM = Problem(
    (rectangle(0, 0, 300, 300),),
    np.deg2rad(4),
    5.0,
    10.0,
    LinearMotion(5.0),
    action_grid=(8, 8),
    prior=GaussianPrior(150.0, 150.0, np.diag([100.0, 1600.0])),
)
HOME = (150.0, 0.0)


def sampler(sampling, seed=1, **options):
    belief = prior_belief(PROBLEM)
    simulation = simulate(PROBLEM, belief, HOME, base_policy="ellipse", **options)
    places = np.array([[90.0, 150.0], [210.0, 150.0], [150.0, 20.0]])
    return RolloutSampler(simulation, belief, sampling, np.random.default_rng(seed), places)


def rollout(rng_seed=1, problem=PROBLEM, **options):
    usual = {"selection": sequential_halving, "sampling": "crn", "base_policy": "ellipse", "budget": 600}
    policy = Rollout(**usual | options)
    return policy(problem, prior_belief(problem), HOME, np.random.default_rng(rng_seed))


def test_a_common_path_is_the_same_whoever_asks_first():
    one, two = sampler("crn"), sampler("crn")
    whole = one.sample(np.arange(3), 0, 150)
    pieces = [two.sample(np.array([k]), a, b) for a, b in ((0, 20), (20, 150)) for k in (2, 0, 1)]
    for k, order in enumerate((1, 2, 0)):
        assert (np.concatenate([pieces[order][0], pieces[order + 3][0]]) == whole[k]).all()


def test_rollouts_begin_with_the_belief_on_no_more_cells_than_the_thesis_has():
    problem = replace(PROBLEM, likelihood="resolved")
    belief = prior_belief(problem)
    start = simulate(problem, belief, HOME, base_policy="ellipse").start
    assert belief.nx > start.density.shape[1] == FIRST_CELLS
    assert start.density.sum() == pytest.approx(1.0)


def test_independent_paths_are_drawn_afresh():
    some = sampler("pmc")
    assert (some.sample(np.array([0]), 0, 50) != some.sample(np.array([0]), 0, 50)).any()


def test_common_paths_make_mirrored_places_comparable():
    """Places left and right of the prior's axis differ by luck only; common luck shrinks the difference's spread."""
    common, independent = sampler("crn").sample(np.arange(2), 0, 400), sampler("pmc").sample(np.arange(2), 0, 400)
    assert np.std(common[0] - common[1]) < np.std(independent[0] - independent[1])


def test_every_cost_is_flight_and_measurement_at_least():
    costs = sampler("crn").sample(np.arange(3), 0, 100)
    places = sampler("crn").places
    least = np.hypot(*(places - np.array(HOME)).T) / 5.0 + 10.0
    assert (costs >= least[:, None] - 1e-9).all()


def test_places_and_actions_ask_the_same_paths():
    one, two = sampler("crn"), sampler("crn")
    assert (one.sample(np.arange(3), 0, 30) == two.sample_places(two.places, 0, 30)).all()


def test_threads_share_the_work_and_change_nothing():
    """Also when several plans want them at once, as in a server with several missions."""
    alone = sampler("crn").sample(np.arange(3), 0, 100)
    with ThreadPoolExecutor(4) as plans:
        found = list(plans.map(lambda n: sampler("crn", threads=n).sample(np.arange(3), 0, 100), (2, 3, 2, 3, 2)))
    assert all((costs == alone).all() for costs in found)


def test_a_cut_rollout_is_closed_by_the_terminal_value():
    seen = []

    def value(ends):
        seen.append(ends)
        return np.full(len(ends), 1000.0)

    plain = sampler("crn", horizon=1).sample(np.arange(3), 0, 40)
    closed = sampler("crn", horizon=1, terminal=value).sample(np.arange(3), 0, 40)
    ends = np.concatenate(seen)
    assert ends.shape[1] == CLOSED_FEATURES
    assert (ends[:, 7] >= PROBLEM.threshold).all()
    assert np.count_nonzero(closed - plain > 999.0) == len(ends) > 0


def test_the_decision_lists_every_candidate_with_its_fate():
    decision = rollout()
    assert len(decision.candidates) == 64
    survivors = [c for c in decision.candidates if c.dropped_in_round is None]
    assert [(c.x, c.y) for c in survivors] == [(decision.x, decision.y)]
    assert sum(c.rollouts for c in decision.candidates) == decision.rollouts <= 600
    assert survivors[0].rollouts == len(decision.times)
    assert survivors[0].value == pytest.approx(decision.times.mean())


def test_it_beats_its_base_policy_from_the_start():
    """The ellipse policy flies abreast of the prior first; the rollout measures on the way (Table 4.2)."""
    decision = rollout(budget=3000)
    assert 0 < decision.y < 200
    assert 90 < decision.x < 210
    assert 45 < decision.times.mean() < 75


def test_the_same_seed_gives_the_same_decision():
    one, two = rollout(), rollout()
    assert (one.x, one.y) == (two.x, two.y)
    assert [c.value for c in one.candidates] == [c.value for c in two.candidates]
    assert (one.times == two.times).all()


def test_both_kernels_decide_alike():
    fast, readable = rollout(budget=200), rollout(budget=200, kernel="reference")
    assert (fast.x, fast.y) == (readable.x, readable.y)
    assert [c.value for c in fast.candidates] == pytest.approx([c.value for c in readable.candidates], nan_ok=True)


def test_deterministic_sampling_gives_each_action_a_power_of_two_of_paths():
    decision = rollout(selection=uniform, sampling="deterministic", budget=64 * 11)
    assert {c.rollouts for c in decision.candidates if c.dropped_in_round is None} == {8}
    assert len(decision.times) == 8


def test_a_refused_place_is_not_offered_again():
    first = rollout()
    second = rollout(without=((first.x, first.y),))
    assert (second.x, second.y) != (first.x, first.y)
    assert len(second.candidates) == 63


def test_on_a_fine_lattice_the_places_beside_a_refused_one_are_not_offered_either():
    fine = replace(PROBLEM, flight_area=(rectangle(0, 0, 60, 60),), action_spacing=2.0)
    first = rollout(problem=fine, budget=2_000)
    second = rollout(problem=fine, budget=2_000, without=((first.x, first.y),))
    away = [np.hypot(c.x - first.x, c.y - first.y) for c in second.candidates]
    assert min(away) >= SAME_PLACE_M
    assert min(away) < SAME_PLACE_M + 2.0


def test_places_without_a_way_are_no_candidates():
    wall = replace(
        PROBLEM, flight_area=(rectangle(0, -50, 300, 300),), no_fly=(rectangle(-10, 100, 310, 120),), action_grid=(5, 7)
    )
    decision = rollout(problem=wall)
    assert max(c.y for c in decision.candidates) < 100


def test_a_place_that_shares_echoes_is_better_than_none():
    """A no-fly area cuts the flight area in two: all that can be reached lies close to where a turn was made."""
    strip, wall = rectangle(0, 0, 300, 40), rectangle(60, -10, 100, 50)
    cut = replace(
        PROBLEM, flight_area=(strip,), no_fly=(wall,), action_spacing=10.0, turned_at=((20.0, 20.0), (40.0, 20.0))
    )
    decision = Rollout(sequential_halving, "crn", "ellipse", 200)(
        cut, prior_belief(cut), (40.0, 20.0), np.random.default_rng(1)
    )
    assert (decision.x, decision.y) in {(5.0, 5.0), (5.0, 35.0), (55.0, 5.0), (55.0, 35.0)}, "the farthest of these"


def test_a_craft_that_does_not_stop_has_a_leg_to_fly_where_all_places_share_echoes():
    legs = Legs(least=20.0, sigma=np.deg2rad(6.0), pause=2.0)
    small = replace(
        PROBLEM, flight_area=(rectangle(0, 0, 30, 30),), action_spacing=10.0, legs=legs, turned_at=((6.0, 6.0),)
    )
    here = (25.0, 25.0)  # the farthest from the turn, and where the last leg led to
    decision = Rollout(sequential_halving, "crn", "ellipse", 200)(
        small, prior_belief(small), here, np.random.default_rng(1)
    )
    assert np.hypot(decision.x - here[0], decision.y - here[1]) >= legs.least


def test_what_cannot_be_planned_is_said():
    with refusing(BudgetTooSmall):
        rollout(selection=uniform, sampling="deterministic", budget=10)
    with refusing(FixedSamplePaths):
        rollout(selection=sequential_halving, sampling="deterministic", budget=3600)
    with refusing(UnusableNumber("budget", "at_least_one", "0")):
        rollout(budget=0)
    with refusing(EveryPlaceRefused()):
        rollout(problem=replace(PROBLEM, action_grid=(1, 1)), without=((150.0, 150.0),))


@pytest.mark.parametrize("sampling", ["deterministic", "crn"])
@pytest.mark.parametrize("seed", range(6))
def test_giving_up_hopeless_places_changes_no_decision(sampling, seed):
    """Against uniform allocation that knows no lower bound."""

    def whole(sample, n_actions, budget, rng):
        return uniform(sample, n_actions, budget, rng)

    problem = replace(PROBLEM, prior=GaussianPrior(100.0 + 20 * seed, 150.0, np.diag([100.0, 200.0 * (1 + seed)])))
    spared, full = (
        rollout(seed, problem, selection=selection, sampling=sampling, budget=512) for selection in (uniform, whole)
    )
    assert (spared.x, spared.y) == (full.x, full.y)
    assert (spared.times == full.times).all()
    assert spared.rollouts < full.rollouts == 512
    assert sum(candidate.rollouts for candidate in spared.candidates) == spared.rollouts
    given_up = [c for c in spared.candidates if c.dropped_in_round is not None]
    assert given_up
    assert all(c.rollouts < 8 and c.value > spared.times.mean() for c in given_up)
