"""Computes the ellipse policy's table PLI(s1 / s2); `python -m planner.policy.ellipse_table` writes it again.

For s2 = 1 and each s1 the distance r from the estimate, perpendicular to the major axis, with the least expected RMSE
after one more bearing: the average over target positions and over bearings, binned to 1 degree (4.3.2). The problem
has no length scale, so r / s2 depends on s1 / s2 and sigma alone; the thesis' sigma is 4 degrees.
"""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np

from planner.observation import gaussian_likelihood
from planner.types import FloatArray

TABLE = Path(__file__).with_name("ellipse_table.json")
RATIOS = (1.0, 1.25, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 7.0, 10.0)
SIGMAS_DEG = (2.0, 4.0, 7.0, 10.0, 15.0)
BIN = np.deg2rad(1.0)
CELLS_PER_SIGMA = 10
REACH = 3.5


def expected_rmse_after(r: float, s1: float, sigma: float) -> float:
    """Mean expected RMSE (3.58) about the posterior's mode after a bearing from (0, -r); belief N(0, diag(s1^2, 1))."""
    x, y = (a.ravel() for a in np.meshgrid(_axis(s1), _axis(1.0)))
    prior = np.exp(-0.5 * ((x / s1) ** 2 + y**2))
    direction = np.arctan2(y + r, x)
    centres = np.arange(-180, 180)[:, None] * BIN
    joint = prior * gaussian_likelihood(centres - direction, sigma)
    evidence = joint.sum(axis=1)
    joint, heard = joint[evidence > 1e-9 * evidence.max()], evidence.sum()
    mode = joint.argmax(axis=1)
    return float((joint * np.hypot(x - x[mode][:, None], y - y[mode][:, None])).sum() / heard)


def best_distance(s1: float, sigma: float) -> float:
    """r with the least expected RMSE for s2 = 1: a parabola in log r through the best of a scan and its neighbours.

    The scan keeps outside the ellipse's core (r >= 1), where the mode of the posterior is a matter of chance.
    """
    r = np.geomspace(1.0, 3.0 * s1 + 3.0, 25)
    values = np.array([expected_rmse_after(float(v), s1, sigma) for v in r])
    near = np.abs(np.log(r / r[np.argmin(values)])) <= 0.35
    curve = np.polynomial.Polynomial.fit(np.log(r[near]), values[near], 2).convert().coef
    return float(np.exp(-curve[1] / (2.0 * curve[2])))


def compute() -> dict[str, list[float] | dict[str, list[float]]]:
    """{"ratios": [...], "distances": {sigma in degrees: [...]}}."""
    distances = {f"{s:g}": [round(best_distance(r, np.deg2rad(s)), 4) for r in RATIOS] for s in SIGMAS_DEG}
    return {"ratios": list(RATIOS), "distances": distances}


def _axis(s: float) -> FloatArray:
    half = int(REACH * CELLS_PER_SIGMA)
    return np.linspace(-half, half, 2 * half + 1, dtype=np.float64) * (s / CELLS_PER_SIGMA)


if __name__ == "__main__":
    TABLE.write_text(json.dumps(compute(), indent=1) + "\n")
