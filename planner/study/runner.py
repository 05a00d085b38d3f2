"""Flies the missions of a cell, and resumes where it was interrupted."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from functools import lru_cache, partial
from pathlib import Path

import pandas as pd

from planner.policy.types import Policy
from planner.study.cell import Cell
from planner.study.errors import StudyError
from planner.study.mission import Mission, Opening, fly, opening
from planner.study.scenarios import Scenario
from planner.study.spread import spread
from planner.study.store import Results

BLOCK_SECONDS = 2.0
"""Work is handed out in blocks of about this length, so that progress shows and little is lost."""

WRITE_EVERY = 10.0
"""s between writes of the results file."""

Progress = Callable[[int], None]
"""Called with how many more missions are done."""

Remark = Callable[[str], None]
"""Called with what the user should know."""


def run_cell(
    cell: Cell,
    runs: int,
    directory: Path,
    *,
    workers: int = 1,
    scheduler: str | None = None,
    progress: Progress = lambda done: None,
    remark: Remark = lambda text: None,
) -> pd.DataFrame:
    """All `runs` missions of the cell, those on disk included, one row each.

    workers: processes on this machine. scheduler: address of a Dask scheduler instead. The rows do not depend on
    either: mission k is decided by the cell and k alone.
    """
    if runs < 1 or workers < 1:
        raise StudyError(f"runs and workers must be 1 or more, got {runs} and {workers}")
    results = Results(directory, cell)
    if results.stale:
        remark(f"{results.path}: {results.stale} missions were flown by another version of the planner, flown again")
    missing = results.missing(runs)
    progress(runs - len(missing))
    waiting: list[Mission] = []
    written = time.monotonic()
    try:
        for block in _flown(cell, missing, workers, scheduler):
            waiting += block
            progress(len(block))
            if time.monotonic() - written > WRITE_EVERY:
                results.add(waiting)
                waiting, written = [], time.monotonic()
    finally:
        if waiting:
            results.add(waiting)
    return results.frame(runs)


def fly_block(cell: Cell, runs: list[int]) -> list[Mission]:
    """The missions with these numbers, flown in this process."""
    case, policy, start = _prepared(cell)
    return [fly(case, policy, start, run, cell.seed) for run in runs]


@lru_cache(maxsize=4)
def _prepared(cell: Cell) -> tuple[Scenario, Policy, Opening]:
    case, policy = cell.case(), cell.policy()
    return case, policy, opening(case, policy, repeatable=cell.repeatable())


def _flown(cell: Cell, missing: list[int], workers: int, scheduler: str | None) -> Iterator[list[Mission]]:
    if not missing:
        return
    fly_block(cell, missing[:1])  # compiles or loads the kernels, and refuses what cannot be flown, before the clock
    started = time.monotonic()
    yield fly_block(cell, missing[:1])
    each = max(time.monotonic() - started, 1e-4)
    rest = missing[1:]
    size = max(1, min(int(BLOCK_SECONDS / each), len(rest) // (2 * workers) or 1))
    blocks = [rest[k : k + size] for k in range(0, len(rest), size)]
    if not blocks:
        return
    yield from spread(partial(fly_block, cell), blocks, workers, scheduler)
