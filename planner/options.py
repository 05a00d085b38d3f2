"""What may be chosen about the planner, by name, and the defaults of the field system and of the studies."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

Method = Literal["rollout", "base_policy"]
"""Policy rollout on top of the base policy (thesis 4.3.3), or the base policy alone."""

BasePolicy = Literal["ellipse", "fisher", "dynamic_program"]
"""What rollouts follow after their first action: thesis 4.3.2, 6.2.2, or the Gaussian dynamic program
(`planner.policy.value_table`), which also closes them after two bearings and names the places to compare."""

DiscreteSelection = Literal["uniform", "sequential_halving"]
"""How a budget is shared out among finitely many first actions (thesis ch. 5)."""

ContinuousSelection = Literal["quadrant", "sgd", "bfgs"]
"""How a first action is searched for in a rectangle (thesis ch. 5)."""

Sampling = Literal["deterministic", "crn", "pmc", "quasi_random"]
"""Where sample paths come from: equal-mass points, common random numbers, independent draws, common quasi-random
points (`planner.sampling`)."""

Estimator = Literal["map", "expected_value", "geometric_median"]
"""Point estimate of a belief (`planner.belief.estimate`)."""

CellLikelihood = Literal["centre", "resolved"]
"""What a cell's likelihood is: that of its centre, as in the thesis, or of a wedge no narrower than cells can show
(`planner.observation.resolved_likelihood`). Near the sensor a wedge is narrower than a cell; the centres' belief is too
sure there, and a planner that knows it measures from there."""


@dataclass(frozen=True, slots=True)
class PlannerOptions:
    """Which planner decides, and with how much work. Defaults: the field system's (thesis ch. 6).

    budget: rollouts a decision. seed: equal inputs and an equal seed give an equal decision.
    """

    method: Method = "rollout"
    base_policy: BasePolicy = "fisher"
    selection: DiscreteSelection = "sequential_halving"
    sampling: Sampling = "crn"
    estimator: Estimator = "map"
    budget: int = 1000
    seed: int = 1


FIELD = PlannerOptions()
STUDY = PlannerOptions(base_policy="ellipse", budget=3600)
"""What the simulation studies of the thesis use (ch. 4 and 5)."""

CROSSFIX = PlannerOptions(
    base_policy="dynamic_program", sampling="quasi_random", estimator="geometric_median", budget=2400
)
"""Ours (docs/decisions/0032): `crossfix` in studies, and what the suggested mission names. The specification's own
defaults stay FIELD: a stored mission that names no planner was flown with it."""
