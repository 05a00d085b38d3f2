"""What `crossfix bench` measures, and the first plan of a fresh process, as a record (figures 1, 2 and 23).

python -m tests.benchmarks.planner_speed --repeats 5
"""

from __future__ import annotations

import argparse
import json
import statistics
import subprocess
import sys
from typing import Any

from backend.cli.bench import measured
from tests.benchmarks.figures.circumstances import ROOT, begin
from tests.benchmarks.figures.record import Figure
from tests.benchmarks.figures.writer import add_out, plain, wanted, write

FIRST_PLAN = """
import time
began = time.perf_counter()
from dataclasses import replace
from planner.belief.grid import prior_belief
from planner.options import STUDY
from planner.plan import plan
from planner.study.scenarios import scenario
imported = time.perf_counter()
case = scenario("2")
options = replace(STUDY, budget=1000)
plan(case.problem, prior_belief(case.problem), (), case.platform, options, threads=2)
print(imported - began, time.perf_counter() - imported)
"""


def first_plan_s(repeats: int) -> tuple[float, float]:
    """Medians of (imports, first plan) in fresh processes, after one that fills the kernel's cache."""

    def once() -> tuple[float, float]:
        command = [sys.executable, "-c", FIRST_PLAN]
        told = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout.split()
        return float(told[0]), float(told[1])

    once()
    imports, plans = zip(*(once() for _ in range(repeats)), strict=True)
    return statistics.median(imports), statistics.median(plans)


def figures(found: dict[str, Any], imports_s: float, plan_s: float) -> list[Figure]:
    rollout_us, plan_ms = found["rollout_us"], dict(found["plan_ms"])
    one, two = rollout_us["compiled_1_thread"], rollout_us["compiled_2_threads"]
    return [
        wanted("rollout", round(one, 2)),
        wanted("rollout_ratio", round(found["ratio"])),
        wanted("rollout_two_threads", round(one / two, 2)),
        wanted("plan_1000", round(plan_ms.pop("1000"), 1)),
        wanted("plan_3600", round(plan_ms.pop("3600"), 1)),
        wanted("first_plan", round(imports_s + plan_s, 2), note=f"{imports_s:.2f} + {plan_s:.2f} s"),
        plain("a rollout, numpy reference", round(rollout_us["reference"]), "us"),
        plain("a rollout, two threads", round(two, 2), "us"),
        *(plain(f"a plan, N = {budget}, two threads", round(taken, 1), "ms") for budget, taken in plan_ms.items()),
    ]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--repeats", type=int, default=5, help="each figure is the median of this many runs")
    add_out(parser)
    given = parser.parse_args()
    begun = begin(__file__)
    found, (imports_s, plan_s) = measured(given.repeats), first_plan_s(given.repeats)
    print(json.dumps(found | {"first_plan_s": {"imports": imports_s, "plan": plan_s}}, indent=2))
    title, made = "Speed of a plan", figures(found, imports_s, plan_s)
    write(given.out, "planner_speed", title, begun, made, page="kernel.md#speed-of-a-plan")


if __name__ == "__main__":
    main()
