"""One cell of a study's table: which planner flies which scenario, in words that fit in a file."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any, TypeVar, get_args

from planner.options import (
    CROSSFIX,
    FIELD,
    STUDY,
    BasePolicy,
    ContinuousSelection,
    DiscreteSelection,
    Estimator,
    Sampling,
)
from planner.policy.continuous_rollout import ContinuousRollout
from planner.policy.dynamic_program import dynamic_program
from planner.policy.ellipse import ellipse
from planner.policy.entropy import entpp, entpp8
from planner.policy.fisher import fisher
from planner.policy.lookahead import Lookahead, lookahead
from planner.policy.rollout import SELECTIONS, Rollout
from planner.policy.sopt import sopt
from planner.policy.tokekar import tokekar_subset, tokekar_tree, tokekar_worst_case
from planner.policy.types import Policy
from planner.policy.vander_hook import vander_hook
from planner.study.errors import StudyError
from planner.study.scenarios import Scenario, scenario
from planner.study.value_cache import ensure

Name = TypeVar("Name", bound=str)

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

TABLED: dict[str, Policy] = {
    "dynamic_program": dynamic_program,
    "crossfix": Rollout(SELECTIONS[CROSSFIX.selection], CROSSFIX.sampling, CROSSFIX.base_policy, CROSSFIX.budget),
}
"""Planners that need a table (`value_cache`): the dynamic program alone, and `rollout` on it."""

CONTINUOUS: tuple[ContinuousSelection, ...] = get_args(ContinuousSelection)
SELECTION_NAMES: tuple[DiscreteSelection | ContinuousSelection, ...] = (*SELECTIONS, *CONTINUOUS)
SAMPLINGS: tuple[Sampling, ...] = get_args(Sampling)
BASE_POLICY_NAMES: tuple[BasePolicy, ...] = get_args(BasePolicy)
ESTIMATORS: tuple[Estimator, ...] = get_args(Estimator)
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
    selection: str = STUDY.selection
    sampling: str = STUDY.sampling
    budget: int = STUDY.budget
    actions: str | None = None
    estimator: str | None = None
    base_policy: str | None = None
    measurement_time: float | None = None
    seed: int = 1

    def __post_init__(self) -> None:
        _one_of("planner", self.planner, (*PLANNERS, *TABLED, "rollout"))
        _one_of("selection", self.selection, SELECTION_NAMES)
        _one_of("sampling", self.sampling, SAMPLINGS)
        if self.base_policy is not None:
            _one_of("base policy", self.base_policy, BASE_POLICY_NAMES)
        if self.base_policy == "dynamic_program" and self.selection in CONTINUOUS:
            raise StudyError(f"dynamic_program names its own places: {self.selection} would search for others")
        if self.budget < 1:
            raise StudyError(f"the budget must be at least one rollout, got {self.budget}")
        if self.seed < 0:
            raise StudyError(f"the seed must be 0 or more, got {self.seed}")
        self.case()

    def case(self) -> Scenario:
        """The scenario with what this cell changes about it. StudyError for names that do not exist."""
        grid = None if self.actions is None else parse_grid(self.actions)
        return scenario(
            self.scenario,
            self.config,
            estimator=self._estimator(),
            action_grid=grid,
            measurement_time=self.measurement_time,
            likelihood="resolved" if self.planner in TABLED else "centre",
        )

    def _estimator(self) -> Estimator | None:
        """None: the scenario's own; planners with a table bring theirs along."""
        if self.estimator is not None:
            own: Estimator = _one_of("estimator", self.estimator, ESTIMATORS)
            return own
        return CROSSFIX.estimator if self.planner in TABLED else None

    def policy(self) -> Policy:
        """The planner with its settings; the dynamic program's table is computed when this machine has none."""
        if self.planner in TABLED or (self.planner == "rollout" and self.base_policy == "dynamic_program"):
            ensure(self.case().problem)
        if self.planner in TABLED:
            return TABLED[self.planner]
        if self.planner != "rollout":
            return PLANNERS[self.planner]
        usual = FIELD if self.scenario == "field" else STUDY
        base: BasePolicy = _one_of("base policy", self.base_policy or usual.base_policy, BASE_POLICY_NAMES)
        sampling: Sampling = _one_of("sampling", self.sampling, SAMPLINGS)
        selection: DiscreteSelection | ContinuousSelection = _one_of("selection", self.selection, SELECTION_NAMES)
        if selection == "uniform" or selection == "sequential_halving":
            return Rollout(SELECTIONS[selection], sampling, base, self.budget)
        return ContinuousRollout(selection, sampling, base, self.budget)

    def repeatable(self) -> bool:
        """Whether the planner uses no chance, so that equal beliefs get equal decisions."""
        if self.planner != "rollout":
            return self.planner != "crossfix"
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
        raise StudyError(f'"{text}" is no action grid: write columns x rows, for instance 20x20')
    return int(parts[0]), int(parts[1])


def _one_of(what: str, value: str, known: tuple[Name, ...]) -> Name:
    for name in known:
        if value == name:
            return name
    raise StudyError(f"there is no {what} {value!r}: choose one of {', '.join(known)}")
