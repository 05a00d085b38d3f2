"""Where the planners compared with go, in three situations: planners.json holds their answers.

A change here is a change of behaviour: say why in the commit. CROSSFIX_WRITE_GOLDEN=1 rewrites the file.
"""

from __future__ import annotations

import json
import os
from pathlib import Path

import numpy as np
import pytest

from planner.belief.grid import GridBelief, fold
from planner.study.cell import PLANNERS
from planner.study.scenarios import scenario
from planner.types import Bearing, Problem

FILE = Path(__file__).with_name("planners.json")
GOLDEN: dict[str, dict[str, list[float]]] = json.loads(FILE.read_text()) if FILE.exists() else {}


def situation(name: str) -> tuple[Problem, GridBelief, tuple[float, float]]:
    """Scenario 2 on the prior, Scenario 2 after a bearing from the west, Scenario 3 after its first bearing."""
    case = scenario(name[0])
    sigma = case.problem.sigma
    bearings = {
        "2 prior": [],
        "2 bearing": [Bearing(70.0, 130.0, 0.3, sigma)],
        "3 bearing": [Bearing(300.0, 300.0, 2.0, sigma)],
    }[name]
    platform = (bearings[-1].x, bearings[-1].y) if bearings else case.platform
    return case.problem, fold(case.problem, bearings), platform


SITUATIONS = ("2 prior", "2 bearing", "3 bearing")


@pytest.mark.parametrize("planner", PLANNERS)
def test_decisions_are_those_on_record(planner):
    answers = {}
    for name in SITUATIONS:
        decision = PLANNERS[planner](*situation(name), np.random.default_rng(0))
        answers[name] = [round(decision.x, 3), round(decision.y, 3)]
    if os.environ.get("CROSSFIX_WRITE_GOLDEN"):
        GOLDEN[planner] = answers
        FILE.write_text(json.dumps(GOLDEN, indent=1, sort_keys=True) + "\n")
    for name, place in answers.items():
        assert place == pytest.approx(GOLDEN[planner][name], abs=0.01)
