import numpy as np
import pytest

from planner.study.errors import StudyError
from planner.study.scenarios import MEASUREMENT_TIMES, SERIES, scenario


@pytest.mark.parametrize("config", MEASUREMENT_TIMES)
def test_parameters_of_table_4_1(config):
    problem = scenario("2", config).problem
    assert problem.sigma == pytest.approx(np.deg2rad(4))
    assert (problem.threshold, problem.measurement_time) == (5.0, {"fast": 2, "medium": 10, "slow": 40}[config])


def test_scenario_1_walks_through_its_series():
    case = scenario("1")
    rng = np.random.default_rng(0)
    targets = [case.target(run, rng) for run in range(22)]
    np.testing.assert_array_equal(targets, np.vstack([SERIES, SERIES]))
    assert [case.index(run) for run in range(12)] == [*range(11), 0]


def test_scenario_2_targets_follow_the_prior_within_3_sigma():
    case = scenario("2")
    rng = np.random.default_rng(0)
    targets = np.array([case.target(run, rng) for run in range(4000)])
    standard = (targets - 150.0) / (10.0, 40.0)
    assert (standard**2).sum(axis=1).max() <= 9.0
    np.testing.assert_allclose(standard.std(axis=0), 1.0, atol=0.05)


def test_scenario_3_targets_are_uniform_in_area_on_the_ring():
    case = scenario("3")
    rng = np.random.default_rng(0)
    radii = np.array([np.hypot(*(case.target(run, rng) - case.platform)) for run in range(4000)])
    assert radii.min() >= 30.0
    assert radii.max() <= 300.0
    share = (radii**2 - 30**2) / (300**2 - 30**2)
    assert np.abs(np.sort(share) - np.linspace(0, 1, 4000)).max() < 0.03


def test_the_field_system_has_112_actions():
    from planner.airspace import may_fly
    from planner.policy.actions import lattice

    problem = scenario("field").problem
    assert may_fly(problem, lattice(problem)).sum() == 112


@pytest.mark.parametrize(
    ("name", "changes"), [("4", {}), ("2", {"config": "quick"}), ("2", {"measurement_time": -1.0})]
)
def test_refuses_what_is_not_there(name, changes):
    with pytest.raises(StudyError):
        scenario(name, **changes)
