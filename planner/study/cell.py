"""One cell of a study's table: which planner flies which scenario, in words that fit in a file."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

from planner.policy.continuous_rollout import ContinuousRollout
from planner.policy.ellipse import ellipse
from planner.policy.entropy import entpp, entpp8
from planner.policy.fisher import fisher
from planner.policy.lookahead import Lookahead, lookahead
from planner.policy.rollout import Rollout
from planner.policy.sopt import sopt
from planner.policy.tokekar import tokekar_subset, tokekar_tree, tokekar_worst_case
from planner.policy.types import Policy
from planner.policy.vander_hook import vander_hook
from planner.selection.sequential_halving import sequential_halving
from planner.selection.uniform import uniform
from planner.study.scenarios import Scenario, scenario
from planner.types import PlannerError

PLANNERS: dict[str, Policy] = {
    "base": ellipse,
    "fisher": fisher,
    "entpp": entpp,
    "entpp8": entpp8,
    "sopt": sopt,
    "vander_hook": vander_hook,
    "tokekar_subset": tokekar_subset,
    "tokekar_worst_case": tokekar_worst_case,
    "tokekar_tree": tokekar_tree,
    "lookahead": lookahead,
    "lookahead_myopic": Lookahead(steps=1),
}
"""Planners without settings; `rollout` is the one with."""

DISCRETE = {"uniform": uniform, "sequential_halving": sequential_halving}
CONTINUOUS = ("quadrant", "sgd", "bfgs")
SELECTIONS = (*DISCRETE, *CONTINUOUS)
SAMPLINGS = ("deterministic", "crn", "pmc")
BASE_POLICIES = ("ellipse", "fisher")
ESTIMATORS = ("map", "expected_value", "geometric_median")
ROLLOUT_ONLY = ("selection", "sampling", "budget", "base_policy")


@dataclass(frozen=True, slots=True)
class Cell:
    """Everything that decides a mission but its number. actions: "20x20". measurement_time: s, None: the config's.

    estimator, actions, base_policy: None means the scenario's own (the field system follows the Fisher policy, the
    others the ellipse policy). selection, sampling, budget and base_policy matter to planner `rollout` only.
    """

    scenario: str = "2"
    config: str = "medium"
    planner: str = "base"
    selection: str = "sequential_halving"
    sampling: str = "crn"
    budget: int = 3600
    actions: str | None = None
    estimator: str | None = None
    base_policy: str | None = None
    measurement_time: float | None = None
    seed: int = 1

    def __post_init__(self) -> None:
        _one_of("planner", self.planner, (*PLANNERS, "rollout"))
        _one_of("selection", self.selection, SELECTIONS)
        _one_of("sampling", self.sampling, SAMPLINGS)
        if self.estimator is not None:
            _one_of("estimator", self.estimator, ESTIMATORS)
        if self.base_policy is not None:
            _one_of("base policy", self.base_policy, BASE_POLICIES)
        if self.budget < 1:
            raise PlannerError(f"the budget must be at least one rollout, got {self.budget}")
        if self.seed < 0:
            raise PlannerError(f"the seed must be 0 or more, got {self.seed}")
        self.case()

    def case(self) -> Scenario:
        grid = None if self.actions is None else parse_grid(self.actions)
        return scenario(
            self.scenario,
            self.config,
            estimator=self.estimator,  # type: ignore[arg-type]
            action_grid=grid,
            measurement_time=self.measurement_time,
        )

    def policy(self) -> Policy:
        if self.planner != "rollout":
            return PLANNERS[self.planner]
        base = self.base_policy or ("fisher" if self.scenario == "field" else "ellipse")
        shared: dict[str, Any] = {"sampling": self.sampling, "base_policy": base, "budget": self.budget, "threads": 1}
        if self.selection in DISCRETE:
            return Rollout(selection=DISCRETE[self.selection], **shared)
        return ContinuousRollout(selection=self.selection, **shared)  # type: ignore[arg-type]

    def repeatable(self) -> bool:
        """Whether the planner uses no chance, so that equal beliefs get equal decisions."""
        if self.planner != "rollout":
            return True
        return self.selection == "bfgs" or (self.sampling == "deterministic" and self.selection != "sgd")

    def fields(self) -> dict[str, Any]:
        """The settings that matter, for tables and file names; those that do not are None."""
        fields = asdict(self)
        if self.planner != "rollout":
            fields.update(dict.fromkeys(ROLLOUT_ONLY))
        return fields

    def name(self) -> str:
        """A file name that tells cells apart and people what is in it."""
        parts = [f"scenario{self.scenario}", self.config, self.planner]
        for key, value in self.fields().items():
            if key not in ("scenario", "config", "planner", "seed") and value is not None:
                parts.append(f"{key}-{value}")
        return "_".join([*parts, f"seed{self.seed}"])


def parse_grid(text: str) -> tuple[int, int]:
    """ "20x20" as (20, 20)."""
    parts = text.lower().split("x")
    if len(parts) != 2 or not all(part.isdecimal() and int(part) >= 1 for part in parts):
        raise PlannerError(f'"{text}" is no action grid: write columns x rows, for instance 20x20')
    return int(parts[0]), int(parts[1])


def _one_of(what: str, value: str, allowed: tuple[str, ...]) -> None:
    if value not in allowed:
        raise PlannerError(f"there is no {what} {value!r}: choose one of {', '.join(allowed)}")
