"""Keeps the dynamic program's tables on disk, as compiled code is kept: what is missing is computed, once a machine.

A file is named after its key and the sources that compute it; an unreadable one counts as missing. Equal keys give
equal tables bit for bit on one machine, whether fresh or from the disk.
"""

from __future__ import annotations

import hashlib
import os
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

_one_at_a_time = threading.Lock()
_under_way: dict[ProgramKey, threading.Thread] = {}


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


def prepare(problem: Problem, make: Maker = compute) -> threading.Thread:
    """`ensure` in a thread that nobody needs to wait for, and that holds up no exit; one a key."""
    key = key_of(problem)
    known = _under_way.get(key)
    if known is None or not known.is_alive():
        _under_way[key] = known = threading.Thread(target=ensure, args=(problem, make), daemon=True, name="value-table")
        known.start()
    return known


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
