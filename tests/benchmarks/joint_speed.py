"""What a joint belief costs beside an independent one, on the same bearings in the same run (figure 23).

python -m tests.benchmarks.joint_speed --repeats 5
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from dataclasses import replace
from statistics import median
from typing import Any

import numpy as np

from backend.api.suggestion import suggested_mission
from backend.cli.truth import HOME
from backend.search.localization import localization
from planner.belief import evidence
from planner.belief.grid import GridBelief, fold
from planner.belief.joint import joint_prior, update_joint
from planner.observation import wrap
from planner.plan import plan
from planner.types import Bearing
from tests.benchmarks.figures.circumstances import begin
from tests.benchmarks.figures.record import Figure
from tests.benchmarks.figures.writer import add_out, plain, wanted, write

TARGET = (60.0, 120.0)
PLACES = ((0.0, -40.0), (140.0, 60.0), (0.0, 190.0), (-60.0, 60.0), (120.0, 200.0), (60.0, -40.0))
OWN = np.deg2rad(5.3)
FOOT = 1e-3
BUDGET = 1000


def bearings() -> list[Bearing]:
    """Six from all sides, turned by 4 degrees."""
    errors = np.deg2rad(4.0 + np.array([3.0, -4.0, 1.0, 5.0, -2.0, 0.0]))
    directions = [np.arctan2(TARGET[1] - y, TARGET[0] - x) for x, y in PLACES]
    return [
        Bearing(x, y, float(direction + error), float(OWN), source="craft")
        for (x, y), direction, error in zip(PLACES, directions, errors, strict=True)
    ]


def of_sweep(bearing: Bearing) -> Bearing:
    """With a whole sweep's likelihood that says the same, and an even foot."""
    off = wrap(np.deg2rad(np.arange(360.0)) - bearing.angle) / bearing.sigma
    return replace(bearing, profile=tuple(np.log(np.exp(-0.5 * off**2) + FOOT).tolist()))


def milliseconds(repeats: int, work: Callable[[], Any]) -> float:
    """Median; the first call, which may compile, is not counted."""
    work()
    taken: list[float] = []
    for _ in range(repeats):
        began = time.perf_counter()
        work()
        taken.append(1e3 * (time.perf_counter() - began))
    return median(taken)


def over_plain(joint_ms: float, plain_ms: float, count: int) -> Figure:
    """After `count` bearings. More rollouts would only make the plain plan dearer: the joint one draws bearings."""
    note = f"N = {BUDGET}; the joint belief looks one bearing ahead and needs no rollouts here"
    return wanted("joint_plan_3600", round(joint_ms / plain_ms, 2), of=f"bearing {count}", note=note)


def figures(repeats: int) -> list[Figure]:
    """Of the belief's last update and of a plan from it, at three and six bearings."""
    task = localization(suggested_mission(HOME), HOME)
    problem, options = task.problem, task.mission.planner.options
    made: list[Figure] = []
    for count in (3, 6):
        seen = bearings()[:count]
        alone = [replace(b, sigma=float(np.hypot(b.sigma, np.deg2rad(4.0))), outlier_probability=0.1) for b in seen]
        before = before_whole = joint_prior(problem)
        for bearing in seen[:-1]:
            before = update_joint(before, bearing)
            before_whole = update_joint(before_whole, of_sweep(bearing))
        after, last_whole = update_joint(before, seen[-1]), of_sweep(seen[-1])
        after_whole = update_joint(before_whole, last_whole)
        independent = fold(problem, alone)

        def planned(
            belief: GridBelief, taken: list[Bearing] = seen, here: tuple[float, float] = PLACES[count - 1]
        ) -> float:
            return milliseconds(repeats, lambda: plan(problem, belief, taken, here, replace(options, budget=BUDGET)))

        def grown(belief: Any = before, last: Bearing = seen[-1], **more: Any) -> float:
            return milliseconds(repeats, lambda: update_joint(belief, last, **more))

        joint_ms, plain_ms = round(planned(after), 1), round(planned(independent), 1)
        made += [
            plain(f"joint belief, bearing {count}", round(grown(), 1), "ms", note=f"{after.density.size} cells"),
            plain(f"the same, numpy reference, bearing {count}", round(grown(weighing=evidence.Weigher), 1), "ms"),
            plain(
                f"joint belief of whole sweeps, bearing {count}",
                round(grown(before_whole, last_whole), 1),
                "ms",
                note=f"{after_whole.density.size} cells",
            ),
            plain(
                f"independent belief, all {count} bearings",
                round(milliseconds(repeats, lambda a=alone: fold(problem, a)), 1),
                "ms",
            ),
            plain(f"plan from the joint belief, N = {BUDGET}, bearing {count}", joint_ms, "ms"),
            plain(
                f"plan from the joint belief of whole sweeps, N = {BUDGET}, bearing {count}",
                round(planned(after_whole, [of_sweep(b) for b in seen]), 1),
                "ms",
            ),
            plain(f"plan from the independent belief, N = {BUDGET}, bearing {count}", plain_ms, "ms"),
            over_plain(joint_ms, plain_ms, count),
        ]
    return made


def main() -> None:
    parser = argparse.ArgumentParser(description="Time a joint belief beside an independent one.")
    parser.add_argument("--repeats", type=int, default=5)
    add_out(parser)
    arguments = parser.parse_args()
    begun = begin(__file__)
    made = figures(arguments.repeats)
    for figure in made:
        print(f"{figure.name}: {figure.value} {figure.unit} {figure.note}")
    write(arguments.out, "joint_speed", "The joint belief's price", begun, made, page="truth.md")


if __name__ == "__main__":
    main()
