"""Missions of a planner study in pieces, each kept as soon as it was flown: what was broken off goes on on another day,
whatever has changed in the planner's sources since (the missions of `crossfix study run` are flown again then)."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict
from itertools import count
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import pandas as pd

from planner.study import runner
from planner.study.cell import Cell
from planner.study.mission import Mission
from planner.study.store import COLUMNS

PIECE = 100
"""Missions that are kept together."""


def missions_of(cell: Cell, runs: int, kept: Path, commit: str, workers: int = 1) -> tuple[pd.DataFrame, set[str]]:
    """Missions 0 to `runs` - 1, and those of the whole pieces after them as far as they are kept without a gap, one row
    each; and the commits that flew them. What is kept is not flown again."""
    pieces = list(_pieces(cell, runs, kept))
    missing = [piece for piece in pieces if not _path(cell, piece, kept).exists()]
    kept.mkdir(parents=True, exist_ok=True)
    for piece, missions in zip(missing, _flown(cell, missing, workers), strict=True):
        _keep(_path(cell, piece, kept), commit, missions)
        print(f"{cell.name()}: missions {piece[0]} to {piece[-1]}", file=sys.stderr, flush=True)
    told: list[dict[str, Any]] = [json.loads(_path(cell, piece, kept).read_text()) for piece in pieces]
    rows = [mission for piece in told for mission in piece["missions"]]
    return pd.DataFrame(rows, columns=COLUMNS), {piece["commit"] for piece in told}


def _pieces(cell: Cell, runs: int, kept: Path) -> Iterator[range]:
    for first in count(0, PIECE):
        piece = range(first, min(first + PIECE, runs) if first < runs else first + PIECE)
        if first >= runs and (runs % PIECE or not _path(cell, piece, kept).exists()):
            return
        yield piece


def _flown(cell: Cell, pieces: Sequence[range], workers: int) -> Iterator[list[Mission]]:
    """In the order of the pieces."""
    runs = [list(piece) for piece in pieces]
    if workers == 1 or len(pieces) < 2:
        yield from (runner.fly_block(cell, piece) for piece in runs)
        return
    cell.policy()  # has the table computed once, not by every process
    with ProcessPoolExecutor(workers, mp_context=get_context("spawn")) as pool:
        try:
            yield from pool.map(runner.fly_block, [cell] * len(runs), runs)
        finally:
            pool.shutdown(wait=True, cancel_futures=True)


def _path(cell: Cell, piece: range, kept: Path) -> Path:
    return kept / f"{cell.name()}-{piece[0]}-{piece[-1]}.json"


def _keep(path: Path, commit: str, missions: Sequence[Mission]) -> None:
    """Whole or not at all."""
    partial = path.with_suffix(".partial")
    partial.write_text(json.dumps({"commit": commit, "missions": [asdict(mission) for mission in missions]}))
    partial.replace(path)
