import pytest

from planner.policy.continuous_rollout import ContinuousRollout
from planner.policy.rollout import Rollout
from planner.study import cell
from planner.study.cell import PLANNERS, SELECTION_NAMES, Cell, parse_grid
from planner.study.errors import StudyError


def test_every_planner_and_selection_has_a_policy_and_a_name():
    cells = [Cell(planner=name) for name in PLANNERS]
    cells += [Cell(planner="rollout", selection=name) for name in SELECTION_NAMES]
    assert len({one.name() for one in cells}) == len(cells)
    for one in cells:
        assert callable(one.policy())


def test_settings_that_do_not_matter_do_not_tell_cells_apart():
    assert Cell(planner="base", budget=1).name() == Cell(planner="base", budget=2).name()
    assert Cell(planner="rollout", budget=1).name() != Cell(planner="rollout", budget=2).name()
    assert Cell(seed=1).name() != Cell(seed=2).name()


def test_rollout_takes_its_settings():
    policy = Cell(planner="rollout", selection="uniform", sampling="deterministic", budget=3200).policy()
    assert isinstance(policy, Rollout)
    assert (policy.sampling, policy.budget, policy.base_policy) == ("deterministic", 3200, "ellipse")
    field = Cell(scenario="field", planner="rollout").policy()
    assert isinstance(field, Rollout)
    assert field.base_policy == "fisher"
    assert isinstance(Cell(planner="rollout", selection="sgd").policy(), ContinuousRollout)


def test_planners_on_the_dynamic_program_bring_estimator_and_table_along(monkeypatch):
    asked = []
    monkeypatch.setattr(cell, "ensure", asked.append)
    ours, alone = Cell(planner="crossfix"), Cell(planner="dynamic_program")
    assert ours.case().problem.estimator == alone.case().problem.estimator == "geometric_median"
    assert Cell(planner="crossfix", estimator="map").case().problem.estimator == "map"
    policy = ours.policy()
    assert isinstance(policy, Rollout)
    assert (policy.sampling, policy.budget, policy.base_policy) == ("quasi_random", 2400, "dynamic_program")
    assert callable(alone.policy())
    assert not ours.repeatable()
    assert alone.repeatable()
    Cell(planner="rollout", base_policy="dynamic_program").policy()
    Cell(planner="rollout").policy()
    assert len(asked) == 3


def test_the_dynamic_program_is_no_base_for_a_search_over_all_places():
    with pytest.raises(StudyError, match="sgd"):
        Cell(planner="rollout", selection="sgd", base_policy="dynamic_program")


def test_only_planners_without_chance_repeat_themselves():
    assert Cell(planner="entpp").repeatable()
    assert Cell(planner="rollout", selection="uniform", sampling="deterministic").repeatable()
    assert not Cell(planner="rollout").repeatable()


@pytest.mark.parametrize(
    "wrong",
    [
        {"planner": "best"},
        {"scenario": "9"},
        {"config": "warp"},
        {"selection": "ucb"},
        {"sampling": "sobol"},
        {"estimator": "mode"},
        {"base_policy": "sopt"},
        {"budget": 0},
        {"actions": "20"},
        {"seed": -1},
    ],
)
def test_refuses_what_is_not_there(wrong):
    with pytest.raises(StudyError, match=str(next(iter(wrong.values())))):
        Cell(**wrong)


def test_grids():
    assert parse_grid("20x10") == (20, 10)
    for text in ("x", "20x", "0x4", "-1x4", "2x3x4"):
        with pytest.raises(StudyError, match="20x20"):
            parse_grid(text)
