"""Files from outside are read in a process of its own with limits of time and memory.

Whatever is in them, the event loop, and with it an abort, never waits for them, and they can end that process only.
"""

from __future__ import annotations

import asyncio
import ctypes
import gc
import logging
import multiprocessing
import os
import resource
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, ParamSpec, TypeVar

from pebble import ProcessExpired, ProcessPool

from backend.reasons.work import FileTooHeavy, ReadersBusy
from planner.reason import ReasonedError

log = logging.getLogger("crossfix.workers")

P = ParamSpec("P")
T = TypeVar("T")

TIME_S = 20.0
MEMORY_BYTES = 2**30
MOST_WAITING = 8
NICER_BY = 10
"""The flight's own process goes first on a busy machine."""


class WorkStopped(ReasonedError):
    """A file needed more time or memory than any sound one does."""

    def __init__(self, reason: FileTooHeavy) -> None:
        super().__init__(reason)


class WorkersBusy(ReasonedError):
    """As many files as may wait are waiting."""

    def __init__(self, reason: ReadersBusy) -> None:
        super().__init__(reason)


@dataclass(slots=True)
class Workers:
    """One process, started with the first file. time_s, memory_bytes: what one file may take, the latter on top of what
    the process needs by itself. Closed with the server."""

    time_s: float = TIME_S
    memory_bytes: int = MEMORY_BYTES
    _pool: ProcessPool | None = None
    _waiting: int = field(default=0)

    async def run(self, work: Callable[P, T], *args: P.args, **kwargs: P.kwargs) -> T:
        """The result of `work`, a function of a module, whose arguments and result can be pickled.

        Raises WorkStopped, WorkersBusy, and what `work` raises. A caller that is cancelled ends the work.
        """
        if self._waiting >= MOST_WAITING:
            raise WorkersBusy(ReadersBusy(self._waiting))
        pool = self._opened()
        self._waiting += 1
        try:
            return await asyncio.wrap_future(pool.schedule(_tidied, (work, *args), kwargs, timeout=self.time_s))
        except TimeoutError as error:
            raise WorkStopped(FileTooHeavy("time", self.time_s, self.memory_bytes)) from error
        except MemoryError as error:
            raise WorkStopped(FileTooHeavy("memory", self.time_s, self.memory_bytes)) from error
        except RecursionError as error:
            raise WorkStopped(FileTooHeavy("depth", self.time_s, self.memory_bytes)) from error
        except ProcessExpired as error:
            log.warning("the process that reads files ended: %s", error)
            raise WorkStopped(FileTooHeavy("process", self.time_s, self.memory_bytes)) from error
        finally:
            self._waiting -= 1

    async def close(self) -> None:
        """End the process, whatever it does."""
        pool, self._pool = self._pool, None
        if pool is not None:
            pool.stop()
            await asyncio.to_thread(pool.join)

    def _opened(self) -> ProcessPool:
        if self._pool is None:
            # spawned, not forked: the server has threads, and its memory is not the file's to look at
            self._pool = ProcessPool(
                max_workers=1,
                initializer=_confine,
                initargs=(self.memory_bytes,),
                context=multiprocessing.get_context("spawn"),
            )
        return self._pool


def _tidied(work: Callable[..., T], *args: Any, **kwargs: Any) -> T:
    """The result of `work`; what the allocator keeps of its memory is given back to the system."""
    try:
        return work(*args, **kwargs)
    finally:
        gc.collect()
        trim = getattr(ctypes.CDLL(None), "malloc_trim", None)  # glibc's
        if trim is not None:
            trim(0)


def _confine(memory_bytes: int) -> None:
    """In the new process, before its first work."""
    os.nice(NICER_BY)
    statm = Path("/proc/self/statm")
    if statm.exists():  # elsewhere the limit of time alone must do
        now_bytes = int(statm.read_text().split()[0]) * resource.getpagesize()
        most = now_bytes + memory_bytes
        resource.setrlimit(resource.RLIMIT_AS, (most, most))
