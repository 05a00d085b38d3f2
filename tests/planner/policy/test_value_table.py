"""Which of the kept tables serves a problem, and what plans say while none does."""

from dataclasses import replace

import numpy as np
import pytest

from planner.belief.estimate import confidence_region
from planner.belief.grid import fold, prior_belief
from planner.geometry import distance_to_convex
from planner.kernels.value.model import NODES, RATIOS, SCALES, nodes, scales
from planner.options import CROSSFIX
from planner.plan import expected_time_from, plan
from planner.policy import value_table
from planner.policy.dynamic_program import best_places, dynamic_program
from planner.policy.ellipse import ellipse
from planner.policy.simulation import rules_of
from planner.policy.value_table import ProgramTable, keep, key_of, program_for
from planner.reasons import PlannedMeanwhile
from planner.study.scenarios import scenario
from planner.types import Bearing, FullMotion, LinearMotion

PROBLEM = replace(scenario("2").problem, estimator="geometric_median")
START = (150.0, 0.0)


@pytest.fixture(autouse=True)
def nothing_kept(monkeypatch):
    monkeypatch.setattr(value_table, "_kept", {})


def table(problem, at=(1.0, 0.5)):
    """A bearing is worth most at the node nearest `at`, in units of s1: the further away, the more time is left."""
    u = nodes()
    far = np.hypot(u[:, None] - at[0], u[None, :] - at[1]).ravel()
    after = problem.measurement_time + np.log1p(scales())[:, None, None] * 200.0 * far
    return ProgramTable(key_of(problem), np.ascontiguousarray(np.broadcast_to(after, (SCALES, RATIOS, NODES**2))))


def test_the_table_made_for_a_problem_comes_first():
    keep(table(replace(PROBLEM, sigma=PROBLEM.sigma * 1.05)))
    keep(own := table(PROBLEM))
    assert program_for(PROBLEM) is own


def test_a_near_table_serves_and_a_far_one_does_not():
    keep(near := table(replace(PROBLEM, sigma=PROBLEM.sigma * 1.3, measurement_time=13.0)))
    keep(table(replace(PROBLEM, sigma=PROBLEM.sigma * 1.4)))
    assert program_for(PROBLEM) is near
    assert program_for(replace(PROBLEM, sigma=PROBLEM.sigma * 3.0)) is None
    assert program_for(replace(PROBLEM, measurement_time=90.0)) is None


@pytest.mark.parametrize(
    "changes", [{"threshold": 6.0}, {"standoff": 20.0}, {"motion": LinearMotion(6.0)}, {"motion": FullMotion()}]
)
def test_a_table_serves_no_other_threshold_standoff_or_movement(changes):
    keep(table(PROBLEM))
    assert program_for(replace(PROBLEM, **changes)) is None
    assert key_of(replace(PROBLEM, **changes)).name != key_of(PROBLEM).name


def test_a_near_table_is_read_with_the_problems_own_measuring_time():
    kept = table(PROBLEM)
    longer = replace(PROBLEM, measurement_time=14.0)
    assert kept.adapted(longer) == pytest.approx(kept.after + 4.0)


def test_the_program_goes_where_its_table_says():
    keep(table(PROBLEM))
    decision = dynamic_program(PROBLEM, prior_belief(PROBLEM), START)
    # s1 = 40 m lies north-south, the platform in the south: one s1 along it, half across it
    assert decision.y == pytest.approx(150.0 - 40.0, abs=4.0)
    assert abs(decision.x - 150.0) == pytest.approx(20.0, abs=4.0)


def test_places_to_compare_are_allowed_apart_and_best_first():
    keep(kept := table(PROBLEM))
    fenced = replace(PROBLEM, no_fly=(np.array([[100.0, 100.0], [145.0, 100.0], [145.0, 140.0], [100.0, 140.0]]),))
    belief = prior_belief(PROBLEM)
    places, seconds = best_places(PROBLEM, belief, START, kept, 64)
    assert len(places) == 64
    assert (np.diff(seconds) >= 0).all()
    assert ((places >= 0) & (places <= 300)).all()
    gaps = np.hypot(*(places[:, None] - places[None]).transpose(2, 0, 1)) + 1e9 * np.eye(64)
    assert gaps.min() >= 0.11 * 40.0
    forbidden, _ = best_places(fenced, belief, START, kept, 64)
    assert not ((forbidden > 100) & (forbidden < [145, 140])).all(axis=1).any()


def test_what_may_not_be_used_is_left_out_before_places_are_compared():
    """After a turn in vain none of the best few lay a standoff away, and the next turn was made 34 m from it."""
    keep(kept := table(PROBLEM))
    belief = prior_belief(PROBLEM)
    vain = best_places(PROBLEM, belief, START, kept, 1)[0][0]

    def usable(places):
        return places[np.hypot(*(places - vain).T) >= 60.0]

    places, _ = best_places(PROBLEM, belief, START, kept, 8, usable)
    assert len(places) == 8
    assert np.hypot(*(places - vain).T).min() >= 60.0
    without, _ = best_places(PROBLEM, belief, START, kept, 8, lambda some: some[:0])
    assert len(without) == 8, "who is left nothing hears so later"


def test_a_standoff_holds_for_every_place_compared():
    far = replace(PROBLEM, standoff=25.0)
    belief = fold(far, [Bearing(150.0, 0.0, 1.55, far.sigma)])
    places, _ = best_places(far, belief, START, table(far), 64)
    assert distance_to_convex(places, confidence_region(belief)).min() >= 25.0


def test_without_a_table_plans_are_made_meanwhile_and_say_so():
    belief = prior_belief(PROBLEM)
    meanwhile = plan(PROBLEM, belief, (), START, replace(CROSSFIX, budget=400), threads=1)
    usual = plan(PROBLEM, belief, (), START, replace(CROSSFIX, budget=400, base_policy="ellipse"), threads=1)
    assert (meanwhile.x, meanwhile.y) == (usual.x, usual.y)
    assert isinstance(meanwhile.reason, PlannedMeanwhile)
    alone, stand_in = dynamic_program(PROBLEM, belief, START), ellipse(PROBLEM, belief, START)
    assert (alone.x, alone.y) == (stand_in.x, stand_in.y)
    keep(table(PROBLEM))
    assert not isinstance(plan(PROBLEM, belief, (), START, CROSSFIX, threads=1).reason, PlannedMeanwhile)


def test_equal_inputs_get_equal_plans():
    keep(table(PROBLEM))
    belief = prior_belief(PROBLEM)
    first, second = (plan(PROBLEM, belief, (), START, CROSSFIX, threads=threads) for threads in (1, 2))
    assert (first.x, first.y) == (second.x, second.y)
    assert [c.value for c in first.candidates] == [c.value for c in second.candidates]


def test_the_time_by_way_of_a_place_follows_the_program_to_the_end():
    keep(table(PROBLEM))
    found = expected_time_from(PROBLEM, prior_belief(PROBLEM), (), (120.0, 110.0), CROSSFIX, platform_xy=START)
    assert found.localized_share == 1.0
    assert found.mean > 10.0 + np.hypot(30, 110) / 5


def test_rollouts_on_the_program_without_its_table_are_a_mistake():
    with pytest.raises(ValueError, match="table"):
        rules_of(PROBLEM, "dynamic_program", 2)
