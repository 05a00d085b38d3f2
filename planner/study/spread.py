"""Blocks of missions flown here, in several processes, or on a Dask cluster."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from multiprocessing import get_context
from typing import Any, TypeVar, cast

from planner.study.errors import StudyError

Flown = TypeVar("Flown")


def spread(
    fly: Callable[[list[int]], Flown], blocks: Sequence[list[int]], workers: int, scheduler: str | None
) -> Iterator[Flown]:
    """What `fly` makes of each block of missions, in the order in which they end.

    workers: processes on this machine; more than one needs a `fly` that can be pickled. scheduler: address of a Dask
    scheduler instead, whose workers have this package installed. Raises StudyError when it cannot be used.
    """
    if scheduler is not None:
        yield from _on_dask(fly, blocks, scheduler)
    elif workers == 1:
        yield from map(fly, blocks)
    else:
        # Spawned, not forked: the kernels' thread pools do not survive a fork.
        with ProcessPoolExecutor(workers, mp_context=get_context("spawn")) as pool:
            jobs = [pool.submit(fly, block) for block in blocks]
            try:
                for job in as_completed(jobs):
                    yield job.result()
            finally:
                pool.shutdown(wait=True, cancel_futures=True)


def _on_dask(fly: Callable[[list[int]], Flown], blocks: Sequence[list[int]], scheduler: str) -> Iterator[Flown]:
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
        jobs: list[Any] = client.map(fly, blocks, pure=False)
        for job in cast(Iterator[Any], completed(jobs)):
            yield job.result()
