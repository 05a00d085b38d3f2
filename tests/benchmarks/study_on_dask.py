"""A study on a Dask scheduler with one worker and with several (figure 5): is it as many times as fast?

    python -m tests.benchmarks.study_on_dask --workers 2 --runs 1500 --rounds 3 --out docs/measurements

Scheduler and workers are processes of this machine, one thread each; the study is `crossfix study run --scheduler`, a
process of its own that starts again each time. One worker and several take turns; each has flown a short study before.
"""

from __future__ import annotations

import argparse
import json
import statistics
import subprocess
import sys
import tempfile
import time
from typing import Any

from distributed import LocalCluster

from tests.benchmarks.figures.circumstances import begin
from tests.benchmarks.figures.writer import add_out, plain, wanted, write

STUDY = ("--scenario", "2", "--config", "medium", "--planner", "rollout", "--selection", "sequential_halving")
SETTING = ("--sampling", "crn", "--budget", "3600", "--actions", "20x20", "--estimator", "map", "--seed", "2", "--json")
WARM_UP = 20


def flown(scheduler: str, runs: int) -> tuple[float, dict[str, Any]]:
    """Seconds of the whole command, and the row that it printed. What was flown before would be taken as it is."""
    command = [sys.executable, "-c", "from backend.cli.main import app; app()", "study", "run", *STUDY, *SETTING]
    with tempfile.TemporaryDirectory(prefix="crossfix-dask-") as folder:
        given = ["--runs", str(runs), "--scheduler", scheduler, "--results", folder]
        began = time.monotonic()
        told = subprocess.run([*command, *given], check=True, capture_output=True, text=True)
        return time.monotonic() - began, json.loads(told.stdout)


def measured(workers: int, runs: int) -> tuple[float, dict[str, Any]]:
    """On a cluster of its own."""
    local: Any = LocalCluster
    with local(n_workers=workers, threads_per_worker=1, processes=True, dashboard_address=None) as cluster:
        flown(cluster.scheduler_address, WARM_UP * workers)
        return flown(cluster.scheduler_address, runs)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--runs", type=int, default=1500)
    parser.add_argument("--rounds", type=int, default=3)
    add_out(parser)
    given = parser.parse_args()
    begun = begin(__file__)
    took: dict[int, list[float]] = {1: [], given.workers: []}
    rows: list[dict[str, Any]] = []
    for _ in range(given.rounds):
        for workers, seconds in took.items():
            second, row = measured(workers, given.runs)
            seconds.append(second)
            rows.append(row)
            print(workers, round(second, 1), "s", flush=True)
    one, several = (statistics.median(seconds) for seconds in took.values())
    note = f"{given.workers} workers, {given.runs:,} missions, medians of {given.rounds}"
    figures = [
        wanted("study_on_dask", round(one / several / given.workers, 2), note=note),
        plain("a study on one Dask worker", round(one, 1), "s", note=f"{given.runs:,} missions"),
        plain(f"a study on {given.workers} Dask workers", round(several, 1), "s", note=f"{given.runs:,} missions"),
    ]
    page = "planner-studies.md#speed-of-a-study"
    write(given.out, "study_on_dask", "A study on Dask workers", begun, figures, page=page)
    sys.exit(any(row != rows[0] for row in rows))


if __name__ == "__main__":
    main()
