"""Which cells each planner study flies, and how many missions each."""

from __future__ import annotations

from dataclasses import dataclass, replace

from planner.study.cell import Cell as Planned

CONFIGS = ("fast", "medium", "slow")
HALVING = Planned(planner="rollout")
PRINTED_ROLLOUT = Planned(planner="rollout", selection="uniform", sampling="deterministic", budget=3200)


@dataclass(frozen=True, slots=True)
class Study:
    """cells: each with its number of missions. keys: of `WANTED`, one a cell, for the mean times."""

    title: str
    cells: tuple[tuple[Planned, int], ...]
    keys: tuple[str, ...] = ()


def _in_all(cell: Planned, runs: int) -> tuple[tuple[Planned, int], ...]:
    return tuple((replace(cell, config=config), runs) for config in CONFIGS)


def _medium(runs: int, *cells: Planned) -> tuple[tuple[Planned, int], ...]:
    return tuple((cell, runs) for cell in cells)


def _budgets(cell: Planned, *budgets: int) -> tuple[Planned, ...]:
    return tuple(replace(cell, budget=budget) for budget in budgets)


TENS = replace(HALVING, actions="10x10")
UNIFORM = replace(HALVING, selection="uniform")
QUADRANT, SGD = replace(HALVING, selection="quadrant"), replace(HALVING, selection="sgd")
BFGS = replace(HALVING, selection="bfgs", sampling="deterministic")
OTHERS = ("vander_hook", "entpp8", "fisher", "entpp", "tokekar_subset", "tokekar_tree", "tokekar_worst_case")
STUDIES = {
    "table_4_2": Study(
        "Table 4.2",
        (
            *_in_all(Planned(planner="base"), 5000),
            *_in_all(Planned(planner="entpp"), 1000),
            *_in_all(Planned(planner="entpp8"), 1000),
            *_in_all(PRINTED_ROLLOUT, 1000),
            *_in_all(Planned(planner="sopt"), 2000),
        ),
    ),
    "sequential_halving": Study(
        "Sequential halving",
        _medium(
            1000,
            *_budgets(TENS, 700, 1400, 2100),
            *_budgets(HALVING, 3600, 7200, 10800),
            replace(PRINTED_ROLLOUT, estimator="expected_value"),
        ),
    ),
    "selection": Study(
        "Which selection for which budget",
        _medium(
            1000,
            *_budgets(SGD, 400, 3600),
            *_budgets(BFGS, 400, 3600),
            *_budgets(QUADRANT, 400, 1600, 3600, 7200, 10800),
            replace(TENS, budget=400),
            replace(UNIFORM, actions="10x10", budget=400),
            *_budgets(UNIFORM, 7200, 10800),
        ),
    ),
    "planners": Study(
        "Other planners, Scenario 2",
        (*_medium(1000, HALVING, *(Planned(planner=name) for name in OTHERS)), (Planned(planner="sopt"), 2000)),
    ),
    "scenario_1": Study(
        "Scenario 1",
        _medium(1100, *(Planned("1", planner=name) for name in ("rollout", "entpp", "vander_hook", "base"))),
    ),
    "times": Study(
        "Time to localization",
        (
            *_in_all(Planned(planner="crossfix"), 1000),
            (Planned("3", planner="crossfix"), 1000),
            (Planned("field", planner="crossfix"), 1000),
        ),
        ("s2_fast", "s2_medium", "s2_slow", "s3_medium", "field_medium"),
    ),
    "speed": Study("Speed of a study", ((replace(HALVING, seed=2), 20_000),)),
}
