"""Everything that stored results can show: the table, and the figures for which there is data."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pandas as pd

from planner.study.cell import Cell
from planner.study.errors import StudyError
from planner.study.figures import FIGURES
from planner.study.store import read_results
from planner.study.table import Summary, summarize

_SETTINGS = tuple(Cell.__dataclass_fields__)


def report(
    directory: Path, figures: Path, remark: Callable[[str], None], paths: int = 1000
) -> tuple[list[Summary], list[Path]]:
    """Summaries of all cells in `directory`, and the PNG files drawn into `figures`.

    remark: called for each figure that is left out, with what it needs. paths: on how many sample paths first actions
    are valued.
    """
    if paths < 2:
        raise StudyError(f"first actions are valued on 2 sample paths or more, got {paths}")
    results = read_results(directory)
    summaries = [summarize(cell_of(missions), missions) for _, missions in results.groupby("cell", sort=True)]
    try:
        figures.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise StudyError(f"{figures}: cannot hold figures ({error.strerror}); choose another directory") from error
    drawn: list[Path] = []
    for name, (draw, needs) in FIGURES.items():
        figure = draw(results, summaries, paths)
        if figure is None:
            remark(f"no {name}.png: it needs {needs}")
            continue
        path = figures / f"{name}.png"
        figure.savefig(path, dpi=110, bbox_inches="tight")  # pyright: ignore[reportUnknownMemberType]
        drawn.append(path)
    return summaries, drawn


def cell_of(missions: pd.DataFrame) -> Cell:
    """The cell that these rows belong to."""
    first = missions.iloc[0]
    settings: dict[str, Any] = {key: first[key] for key in _SETTINGS if not pd.isna(first[key])}
    for key in ("budget", "seed"):
        if key in settings:
            settings[key] = int(settings[key])
    return Cell(**settings)
