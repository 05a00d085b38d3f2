"""Seeded decisions kept as JSON: a change of the numbers must be meant.

`CROSSFIX_WRITE_GOLDEN=1 pytest tests/planner/test_golden.py` rewrites them.
"""

import json
import os
from pathlib import Path

import numpy as np
import pytest

from planner.belief.estimate import confidence_region, estimate
from planner.belief.grid import fold
from planner.geometry import signed_area
from planner.options import PlannerOptions
from planner.plan import plan
from planner.types import Bearing, GaussianPrior, LinearConstantMotion, LinearMotion, Problem, RingPrior

GOLDEN = Path(__file__).parents[1] / "golden" / "decisions.json"


def rectangle(x0, y0, x1, y1):
    return np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]], dtype=float)


SCENARIO_2 = Problem(
    area=(rectangle(0, 0, 300, 300),),
    sigma=np.deg2rad(4),
    threshold=5.0,
    measurement_time=10.0,
    motion=LinearMotion(5.0),
    prior=GaussianPrior(150.0, 150.0, np.diag([100.0, 1600.0])),
)
SCENARIO_3 = Problem(
    area=(rectangle(-300, -300, 300, 300),),
    sigma=np.deg2rad(4),
    threshold=5.0,
    measurement_time=10.0,
    motion=LinearMotion(5.0),
    estimator="expected_value",
    prior=RingPrior(0.0, 0.0, 30.0, 300.0),
)
FIELD = Problem(
    area=(rectangle(0, 0, 313, 120),),
    sigma=np.deg2rad(7),
    threshold=10.0,
    measurement_time=30.0,
    motion=LinearConstantMotion(7.0, 11.2),
    flight_area=(rectangle(-60, -60, 373, 180),),
    no_fly=(rectangle(100, -20, 130, 60),),
    standoff=50.0,
    action_spacing=15.0,
)
ONE = (Bearing(0.0, 0.0, 0.45, np.deg2rad(7), 0.05),)
TWO = (*ONE, Bearing(200.0, 170.0, -1.7, np.deg2rad(7), 0.05))

CASES = {
    "scenario 2, sequential halving, crn": (SCENARIO_2, (), (150.0, 0.0), {"base_policy": "ellipse", "budget": 3600}),
    "scenario 2, uniform, deterministic": (
        SCENARIO_2,
        (),
        (130.0, 0.0),  # off the prior's axis: on it places come in pairs, and the last bit of a processor would choose
        {"base_policy": "ellipse", "selection": "uniform", "sampling": "deterministic", "budget": 3200},
    ),
    "scenario 2, sequential halving, pmc": (
        SCENARIO_2,
        (),
        (150.0, 0.0),
        {"base_policy": "ellipse", "sampling": "pmc", "budget": 3600},
    ),
    "scenario 3 after its first bearing": (
        SCENARIO_3,
        (Bearing(0.0, 0.0, 0.8, np.deg2rad(4)),),
        (0.0, 0.0),
        {"base_policy": "ellipse", "budget": 3600},
    ),
    "field after one bearing": (FIELD, ONE, (0.0, 0.0), {}),
    "field after two bearings": (FIELD, TWO, (200.0, 170.0), {}),
}


def decided(name):
    problem, bearings, platform, options = CASES[name]
    belief = fold(problem, bearings)
    decision = plan(problem, belief, bearings, platform, PlannerOptions(**options))
    look = estimate(belief, problem.estimator)
    return {
        "place": [decision.x, decision.y],
        "rollouts": decision.rollouts,
        "mean_time_s": float(decision.times.mean()),
        "estimate": [look.x, look.y],
        "expected_rmse_m": look.expected_rmse,
        "c95_m2": signed_area(confidence_region(belief)),
        "grid": [belief.nx, belief.ny, belief.h],
    }


def test_the_golden_file_holds_every_case():
    if os.environ.get("CROSSFIX_WRITE_GOLDEN"):
        GOLDEN.write_text(json.dumps({name: decided(name) for name in CASES}, indent=1) + "\n")
    assert json.loads(GOLDEN.read_text()).keys() == CASES.keys()


@pytest.mark.parametrize("name", CASES)
def test_the_decision_is_the_golden_one(name):
    golden = json.loads(GOLDEN.read_text())[name]
    for key, value in decided(name).items():
        assert value == pytest.approx(golden[key], rel=1e-9, abs=1e-9), key
