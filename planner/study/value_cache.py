"""Keeps the dynamic program's tables on disk, as compiled code is kept: what is missing is computed, once a machine.

A file is named after its key and the sources that compute it; an unreadable one counts as missing. Equal keys give
equal tables bit for bit on one machine, whether fresh or from the disk.
"""

from __future__ import annotations

import hashlib
import logging
import os
import sys
import tempfile
import threading
from collections.abc import Callable
from pathlib import Path

import numpy as np

from planner.kernels.value.model import NODES, RATIOS, SCALES
from planner.policy.value_table import ProgramKey, ProgramTable, compute, keep, key_of, program_for
from planner.sources import digest
from planner.types import Problem

MADE_BY = ("kernels/value/*.py", "policy/value_table.py", "sampling.py", "compiling.py")

Maker = Callable[[ProgramKey], ProgramTable]

log = logging.getLogger("crossfix.planner")

_one_at_a_time = threading.Lock()
_asking = threading.Lock()
_asked: list[tuple[Problem, Maker]] = []
_worker: threading.Thread | None = None


def cache_directory() -> Path:
    """$CROSSFIX_CACHE_DIR, else crossfix/ in the user's cache directory."""
    chosen = os.environ.get("CROSSFIX_CACHE_DIR")
    if chosen:
        return Path(chosen)
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "crossfix"


def ensure(problem: Problem, make: Maker = compute) -> ProgramTable:
    """The table for exactly this problem, kept for all plans to come: from memory, from the disk, else computed."""
    key = key_of(problem)
    with _one_at_a_time:
        table = program_for(problem)
        if table is None or table.key != key:
            table = load(key) or _made(key, make)
            keep(table)
    return table


def prepare(problem: Problem, make: Maker = compute) -> threading.Thread | None:
    """Has the table for this problem kept: at once where it is at hand or on the disk, else by a thread that nobody
    needs to wait for, that gives way to everything else, and that holds up no exit.

    Of several that are asked for while one is computed only the newest is computed after it.
    """
    global _worker
    key = key_of(problem)
    with _asking:
        table = program_for(problem)
        if table is not None and table.key == key:
            return None
        found = load(key)
        if found is not None:
            keep(found)
            return None
        _asked.clear()
        _asked.append((problem, make))
        if _worker is None:
            _worker = threading.Thread(target=_work, daemon=True, name="value-table")
            _worker.start()
        return _worker


def _work() -> None:
    global _worker
    _give_way()
    while True:
        with _asking:
            if not _asked:
                _worker = None
                return
            problem, make = _asked.pop()
        try:
            ensure(problem, make)
        except Exception:
            log.exception("the dynamic program's table could not be computed; plans go on without it")


def _give_way() -> None:
    """On Linux each thread has a priority of its own."""
    if sys.platform == "linux":
        os.setpriority(os.PRIO_PROCESS, threading.get_native_id(), 10)


def load(key: ProgramKey) -> ProgramTable | None:
    """From the disk, None if it is not there or not whole."""
    try:
        after = np.load(_path(key), allow_pickle=False)
    except (OSError, ValueError, EOFError):
        return None
    if after.shape != (SCALES, RATIOS, NODES * NODES) or after.dtype != np.float32 or not np.isfinite(after).all():
        return None
    return ProgramTable(key, after.astype(np.float64))


def _made(key: ProgramKey, make: Maker) -> ProgramTable:
    table = make(key)
    path = _path(key)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.NamedTemporaryFile(dir=path.parent, suffix=".part", delete=False) as part:
            np.save(part, table.after.astype(np.float32))
        os.replace(part.name, path)
    except OSError:
        pass  # a full or read-only disk costs the next start its time, nothing else
    return table


def _path(key: ProgramKey) -> Path:
    made_by = digest(MADE_BY)[:12]
    return cache_directory() / f"values-{hashlib.sha256(f'{key.name} {made_by}'.encode()).hexdigest()[:24]}.npy"
