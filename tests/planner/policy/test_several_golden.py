"""Seeded decisions for several emitters, kept as JSON: a change of the numbers must be meant.

`CROSSFIX_WRITE_GOLDEN=1 pytest tests/planner/policy/test_several_golden.py` rewrites them.
"""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from planner.belief.joint import joint_prior, update_joint
from planner.options import CROSSFIX, FIELD
from planner.policy.several import Wanted, plan_several, times_together
from planner.reasons import SoonestTogether
from planner.study.scenarios import scenario
from planner.types import Bearing, LinearConstantMotion

GOLDEN = Path(__file__).parents[2] / "golden" / "several.json"
WORLD = scenario("field")
TAGS = ((60.0, 60.0), (250.0, 70.0), (150.0, 110.0), (90.0, 10.0))
PROBLEM = replace(WORLD.problem, motion=LinearConstantMotion(7.0, 11.2), estimator="geometric_median")


def believed(places: Sequence[tuple[float, float]]) -> list[Wanted]:
    """Of each tag by a sensor whose bias nobody knows, heard without error from each of the places."""
    found = list[Wanted]()
    for a, b in TAGS:
        belief = joint_prior(PROBLEM)
        for x, y in places:
            belief = update_joint(belief, Bearing(x, y, float(np.arctan2(b - y, a - x)), PROBLEM.sigma))
        found.append(Wanted(PROBLEM, belief))
    return found


CASES = {
    "once": ([WORLD.platform], replace(CROSSFIX, budget=600)),
    "twice": ([WORLD.platform, (150.0, 10.0)], replace(CROSSFIX, budget=600)),
    "field": ([WORLD.platform], replace(FIELD, budget=200)),
    "uniform": ([WORLD.platform], replace(FIELD, selection="uniform", sampling="deterministic", budget=230)),
}


def decided(name: str) -> dict[str, Any]:
    places, options = CASES[name]
    tags = believed(places)
    chosen = plan_several(tags, places[-1], options)
    assert isinstance(chosen.reason, SoonestTogether)
    beside = times_together(tags, places[-1], np.array([(chosen.x, chosen.y), (30.0, 30.0)]), options, 8)
    return {
        "place": [chosen.x, chosen.y],
        "mean_time_s": chosen.reason.mean_time_s,
        "last_s": float(chosen.times.mean()),
        "values_s": [c.value for c in chosen.candidates if c.rollouts],
        "rollouts": chosen.rollouts,
        "together_s": beside.mean(axis=1).tolist(),
    }


@pytest.mark.parametrize("name", CASES)
def test_emitters_that_are_alike_get_the_golden_decision(name: str) -> None:
    now = decided(name)
    if os.environ.get("CROSSFIX_WRITE_GOLDEN"):
        kept = json.loads(GOLDEN.read_text()) if GOLDEN.exists() else {}
        GOLDEN.write_text(json.dumps(kept | {name: now}, indent=1) + "\n")
    golden = json.loads(GOLDEN.read_text())[name]
    assert (now["place"], now["rollouts"]) == (golden["place"], golden["rollouts"])
    for figure in ("mean_time_s", "last_s", "values_s", "together_s"):
        assert now[figure] == pytest.approx(golden[figure], rel=1e-9)
