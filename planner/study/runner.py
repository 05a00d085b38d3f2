"""Flies the missions of a cell: here, in several processes, or on a Dask cluster; resumes where it was interrupted."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor, as_completed
from functools import lru_cache, partial
from multiprocessing import get_context
from pathlib import Path
from typing import Any, cast

import pandas as pd

from planner.policy.types import Policy
from planner.study.cell import Cell
from planner.study.errors import StudyError
from planner.study.mission import Mission, Opening, fly, opening
from planner.study.scenarios import Scenario
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
    if scheduler is not None:
        yield from _on_dask(cell, blocks, scheduler)
    elif workers == 1:
        for block in blocks:
            yield fly_block(cell, block)
    else:
        # Spawned, not forked: the kernels' thread pools do not survive a fork.
        with ProcessPoolExecutor(workers, mp_context=get_context("spawn")) as pool:
            jobs = [pool.submit(fly_block, cell, block) for block in blocks]
            try:
                for job in as_completed(jobs):
                    yield job.result()
            finally:
                pool.shutdown(wait=True, cancel_futures=True)


def _on_dask(cell: Cell, blocks: list[list[int]], scheduler: str) -> Iterator[list[Mission]]:
    try:
        from distributed import Client
        from distributed import as_completed as completed
    except ImportError as error:
        raise StudyError("--scheduler needs Dask: install crossfix[study]") from error
    try:
        client: Any = Client(scheduler, timeout=10)  # Dask has no types
    except (OSError, ValueError) as error:
        raise StudyError(f"no Dask scheduler answers at {scheduler}: {error}") from error
    with client:
        if not client.scheduler_info()["workers"]:
            raise StudyError(f"the Dask scheduler at {scheduler} has no workers: start `dask worker {scheduler}`")
        jobs: list[Any] = client.map(partial(fly_block, cell), blocks, pure=False)
        for job in cast(Iterator[Any], completed(jobs)):
            yield job.result()
