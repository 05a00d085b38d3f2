"""Study results on disk: one tidy Parquet file a cell, one row a mission, rewritten whole so that it is never torn."""

from __future__ import annotations

import os
from collections.abc import Iterable
from dataclasses import asdict, fields
from pathlib import Path

import numpy as np
import pandas as pd

from planner.study.cell import Cell
from planner.study.errors import StudyError
from planner.study.fingerprint import fingerprint
from planner.study.mission import Mission
from planner.types import BoolArray

CODE = "code"
"""Column with the fingerprint of the planner that flew the mission."""

COLUMNS = [field.name for field in fields(Mission)]


class Results:
    """The missions of one cell flown so far. A study that was interrupted goes on with those that are missing.

    stale: missions on disk that another version of the planner flew; they do not count and go with the next write.
    """

    def __init__(self, directory: Path, cell: Cell) -> None:
        self.path = directory / f"{cell.name()}.parquet"
        self._cell = cell
        try:
            directory.mkdir(parents=True, exist_ok=True)
            frame = pd.read_parquet(self.path) if self.path.exists() else pd.DataFrame(columns=[*COLUMNS, CODE])
        except (OSError, ValueError) as error:
            raise StudyError(f"{self.path}: cannot hold results ({error}); choose another directory") from error
        if missing := sorted({*COLUMNS, CODE} - set(frame.columns)):
            raise StudyError(f"{self.path}: lacks the columns {', '.join(missing)}; move it away to start afresh")
        current: BoolArray = frame[CODE].to_numpy(dtype=object) == fingerprint()
        self.stale = int(np.count_nonzero(~current))
        self._frame: pd.DataFrame = frame.loc[current]

    def missing(self, runs: int) -> list[int]:
        """Run numbers 0 .. runs - 1 that have not been flown."""
        have: set[int] = set(self._frame["run"].to_numpy(dtype=int).tolist())
        return [run for run in range(runs) if run not in have]

    def add(self, missions: Iterable[Mission]) -> None:
        """Add rows and write the file."""
        rows = pd.DataFrame([asdict(mission) for mission in missions], columns=COLUMNS)
        rows[CODE] = fingerprint()
        for key, value in self._cell.fields().items():
            rows[key] = value
        known = [self._frame] if len(self._frame) else []
        self._frame = pd.concat([*known, rows], ignore_index=True).sort_values("run", ignore_index=True)
        partial = self.path.with_suffix(f".{os.getpid()}.partial")
        self._frame.to_parquet(partial, index=False)
        partial.replace(self.path)

    def frame(self, runs: int) -> pd.DataFrame:
        """The rows of the first `runs` runs, by run number."""
        return self._frame.loc[self._frame["run"] < runs].reset_index(drop=True)


def read_results(directory: Path) -> pd.DataFrame:
    """All cells in a directory, one row a mission. StudyError when there are none."""
    files = sorted(directory.glob("*.parquet"))
    if not files:
        raise StudyError(f"{directory}: holds no study results; make some with `crossfix study run`")
    try:
        return pd.concat([_labelled(file) for file in files], ignore_index=True)
    except (OSError, ValueError, KeyError) as error:
        raise StudyError(f"{directory}: a results file cannot be read ({error})") from error


def _labelled(file: Path) -> pd.DataFrame:
    frame = pd.read_parquet(file)
    return frame.astype({"scenario": str}).assign(cell=file.stem)
