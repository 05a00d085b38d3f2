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
from shapely import GEOSException

from backend.reasons.work import FileTooHeavy, ReadersBusy
from planner.reason import ReasonedError

log = logging.getLogger("crossfix.workers")

P = ParamSpec("P")
T = TypeVar("T")

TIME_S = 20.0
MEMORY_BYTES = 170 * 2**20
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
    the process holds when it begins with it. Closed with the server."""

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
            bounded = (self.memory_bytes, work, *args)
            return await asyncio.wrap_future(pool.schedule(_bounded, bounded, kwargs, timeout=self.time_s))
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
                max_workers=1, initializer=os.nice, initargs=(NICER_BY,), context=multiprocessing.get_context("spawn")
            )
        return self._pool


def _bounded(memory_bytes: int, work: Callable[..., T], *args: Any, **kwargs: Any) -> T:
    """The result of `work`, which may take so much memory more than this process holds."""
    _allow(memory_bytes)
    try:
        return work(*args, **kwargs)
    except MemoryError:
        pass  # with it go the frames that hold what was read
    except GEOSException as error:
        if "bad_alloc" not in str(error):
            raise
    finally:
        _give_back()
        _allow(None)  # the answer is yet to be packed
    raise MemoryError


def _allow(memory_bytes: int | None) -> None:
    """None: as much as the system gives."""
    statm = Path("/proc/self/statm")
    if not statm.exists():  # elsewhere the limit of time alone must do
        return
    _, hard = resource.getrlimit(resource.RLIMIT_DATA)
    held_bytes = int(statm.read_text().split()[5]) * resource.getpagesize()
    most = hard if memory_bytes is None else held_bytes + memory_bytes
    resource.setrlimit(resource.RLIMIT_DATA, (most if hard == resource.RLIM_INFINITY else min(most, hard), hard))


def _give_back() -> None:
    """What the allocator keeps of freed memory goes back to the system."""
    gc.collect()
    trim = getattr(ctypes.CDLL(None), "malloc_trim", None)  # glibc's
    if trim is not None:
        trim(0)
