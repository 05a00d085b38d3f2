"""One sample path after another."""

from __future__ import annotations

import numpy as np

from planner.kernels.model import DYNAMIC_PROGRAM, Actions, Outcomes, Paths, Rules, Start, Tasks
from planner.kernels.reference.belief import Belief, estimate, measure
from planner.kernels.reference.policy import base_policy, flight_time
from planner.types import FloatArray


def rollouts(start: Start, rules: Rules, actions: Actions, paths: Paths, tasks: Tasks, out: Outcomes) -> None:
    """Run every task and fill `out`."""
    for t in range(len(tasks.action)):
        a, p = tasks.action[t], tasks.path[t]
        cost, bearings, end = rollout(start, rules, actions, int(a), paths.targets[p], paths.noise[p])
        out.costs[t], out.bearings[t], out.ends[t] = cost, bearings, end


def rollout(
    start: Start, rules: Rules, actions: Actions, action: int, target: FloatArray, noise: FloatArray
) -> tuple[float, int, FloatArray]:
    """Cost (s), bearings taken, and the end (see CLOSED_FEATURES) of one sample path."""
    columns = np.arange(int(start.density.shape[1]))
    live = (columns >= start.low[:, None]) & (columns < start.high[:, None])
    weight = np.where(live, start.density, 0.0)
    belief = Belief(weight, start.x0, start.y0, start.h, start.hull, start.bearings, doubled=False)
    place, heading = actions.places[action], float(actions.headings[action])
    lattice, cost = int(actions.lattice[action]), float(actions.costs[action])
    step = 0
    while True:
        belief = measure(belief, rules, place, target, float(noise[step]))
        step += 1
        estimated = estimate(belief, rules.estimator, start.flat, rules.threshold)
        localized = estimated.expected_rmse < rules.threshold  # (4.11)
        last = step == rules.horizon
        if localized or (last and rules.policy != DYNAMIC_PROGRAM):
            break
        following, next_lattice, after = base_policy(belief, estimated, rules, place, lattice)
        flight = following - place
        distance = float(np.hypot(*flight))
        if lattice >= 0 and next_lattice >= 0 and len(rules.travel):
            distance = float(rules.travel[lattice, next_lattice])
        direction = float(np.arctan2(flight[1], flight[0])) if distance > 0 else heading
        cost += flight_time(rules, distance, direction - heading)  # (4.5)
        if last:
            cost += after  # what is cut off, by the dynamic program's value
            break
        cost += rules.measurement_time
        place, heading, lattice = following, direction, next_lattice
    left_over = rules.threshold if localized else estimated.expected_rmse
    end = [
        *place,
        estimated.x,
        estimated.y,
        estimated.xx,
        estimated.xy,
        estimated.yy,
        left_over,
        belief.bearings,
        localized,
    ]
    return cost, step, np.array(end, dtype=float)
