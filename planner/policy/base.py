"""The base policies by name: what rollouts follow after their first action, and what may decide alone."""

from __future__ import annotations

from collections.abc import Mapping

from planner.options import BasePolicy
from planner.policy.dynamic_program import dynamic_program
from planner.policy.ellipse import ellipse
from planner.policy.fisher import fisher
from planner.policy.types import DeterministicPolicy

BASE_POLICIES: Mapping[BasePolicy, DeterministicPolicy] = {
    "ellipse": ellipse,
    "fisher": fisher,
    "dynamic_program": dynamic_program,
}
