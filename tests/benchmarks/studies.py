"""The planner studies as records: tables beside the thesis, times to localization, speed (figures 4, 5 and 24).

    python -m tests.benchmarks.studies table_4_2 times speed
    python -m tests.benchmarks.studies selection --runs 20        a short look
    python -m tests.benchmarks.studies times --pieces FOLDER --only slow --runs 500        a part of it

The missions are those of `crossfix study run`, and so are their results: a study that was broken off goes on. With
`--pieces` it goes on whatever has changed in the planner since, and can be flown cell by cell, on several days.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from planner.study.cell import Cell as Planned
from planner.study.runner import run_cell
from planner.study.store import Results
from planner.study.table import Summary, label, summarize
from planner.types import FloatArray
from tests.benchmarks.figures.circumstances import begin
from tests.benchmarks.figures.pages import markdown
from tests.benchmarks.figures.record import Cell, Column, Figure, Table
from tests.benchmarks.figures.writer import add_out, plain, wanted, write
from tests.benchmarks.study_cells import STUDIES
from tests.benchmarks.study_pieces import PIECE, missions_of

PAGE = "planner-studies.md"
INTERPRETED = ("base", "entpp")
"""Planners whose difference to the thesis a reading explains that was flown (docs/planner-studies.md)."""
COLUMNS = (
    *(Column(name=name) for name in ("scenario", "config", "planner")),
    *(Column(name=name, decimals=2) for name in ("mean, s", "thesis, s", "difference")),
    Column(name="outside the joint interval"),
    *(Column(name=name, decimals=3) for name in ("bearings", "thesis", "truth in C95")),
    Column(name="error at the end, m", decimals=2),
    Column(name="rollouts a bearing", decimals=0),
    Column(name="runs"),
)


def row(summary: Summary, missions: pd.DataFrame) -> tuple[Cell, ...]:
    """The cells under `COLUMNS`."""
    shown, cell, thesis = summary.json(), summary.cell, summary.thesis
    printed: Cell = shown["thesis_mean_s"]
    if shown["thesis_ci95_s"] is not None:
        printed = (shown["thesis_mean_s"], shown["thesis_ci95_s"])
    rollouts = _column(missions, "planning_rollouts").sum() / summary.bearings_mean / summary.runs
    return (
        *(cell.scenario, cell.config, label(cell.fields())),
        summary.mean_s if shown["ci95_s"] is None else (summary.mean_s, summary.ci95_s),
        *(printed, None if thesis is None else summary.mean_s - thesis.mean),
        "*" if summary.within is False else None,
        summary.bearings_mean,
        None if thesis is None or thesis.bearings != thesis.bearings else thesis.bearings,
        *(summary.in_c95, summary.error_m, float(rollouts) if cell.planner == "rollout" else None, summary.runs),
    )


def by_target(flown: Sequence[tuple[Summary, pd.DataFrame]]) -> Table:
    """Scenario 1: mean seconds for each of its targets, by their y."""
    heights = np.unique(np.concatenate([_column(missions, "target_y") for _, missions in flown]))
    columns = (Column(name="planner"), *(Column(name=f"{height:g}", decimals=0) for height in heights))
    rows = []
    for summary, missions in flown:
        y, seconds = _column(missions, "target_y"), _column(missions, "time")
        means = (float(seconds[y == height].mean()) for height in heights)
        rows.append((label(summary.cell.fields()), *means))
    return Table(name="targets", columns=columns, rows=tuple(rows))


def _column(missions: pd.DataFrame, name: str) -> FloatArray:
    return missions[name].to_numpy(dtype=float)


def figures(name: str, flown: Sequence[tuple[Summary, pd.DataFrame]], minutes: float, workers: int) -> list[Figure]:
    study, summaries = STUDIES[name], [summary for summary, _ in flown]
    if name == "speed":
        runs = summaries[0].runs
        took = round(minutes * study.cells[0][1] / runs, 2)
        return [wanted("study", took, note=f"from {runs:,} missions by {workers} processes"), *times(summaries)]
    if name == "table_4_2":
        outside = [summary.cell.planner for summary in summaries if summary.within is False]
        unexplained = sum(planner not in INTERPRETED for planner in outside)
        note = f"{len(outside)} of {len(summaries)} cells differ"
        return [wanted("table_4_2", unexplained, note=note), *times(summaries)]
    if study.keys:
        keys = dict(zip((cell for cell, _ in study.cells), study.keys, strict=True))
        return [
            wanted(
                keys[s.cell], round(s.mean_s, 2), ci95=interval(s), note=f"{label(s.cell.fields())}; {s.runs:,} runs"
            )
            for s in summaries
        ]
    return times(summaries)


def times(summaries: Sequence[Summary]) -> list[Figure]:
    return [
        plain(f"{label(s.cell.fields())}, {s.cell.config}", round(s.mean_s, 2), "s", ci95=interval(s))
        for s in summaries
    ]


def interval(summary: Summary) -> float | None:
    return round(summary.ci95_s, 2) if summary.runs > 1 else None


def flown_in_pieces(
    runs_of: Mapping[Planned, int], only: Sequence[str], kept: Path, commit: str, workers: int
) -> tuple[list[tuple[Summary, pd.DataFrame]], str]:
    """The cells with one of the words in their names flown, the others with what is kept of them, without those of
    which nothing is; and a remark about who flew them."""
    flown, commits = list[tuple[Summary, pd.DataFrame]](), set[str]()
    for cell, runs in runs_of.items():
        wanted_now = any(word in cell.name() for word in only)
        missions, flew = missions_of(cell, runs if wanted_now else 0, kept, commit, workers)
        if len(missions):
            flown.append((summarize(cell, missions), missions))
            commits |= flew
    return flown, "" if commits <= {commit} else f"flown by {', '.join(sorted(commits))}"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("studies", nargs="+", choices=STUDIES, metavar="STUDY", help=", ".join(STUDIES))
    parser.add_argument("--runs", type=int, help="missions for each cell; default: what the study says")
    parser.add_argument("--workers", type=int, default=2, help="processes on this machine")
    parser.add_argument("--results", type=Path, default=Path("study-results"), help="where missions are kept")
    parser.add_argument(
        "--pieces",
        type=Path,
        help=f"instead: folder that keeps every {PIECE} missions as soon as they were flown; all that is kept counts",
    )
    parser.add_argument("--only", default="", help="of --pieces: fly cells whose name contains one of these parts")
    add_out(parser)
    given = parser.parse_args()
    if given.pieces is None and given.only:
        parser.error("--only goes with --pieces, which keep the other cells")
    for name in given.studies:
        study, begun, started = STUDIES[name], begin(__file__), time.monotonic()
        runs_of = {cell: given.runs or usual for cell, usual in study.cells}
        if name == "speed" and given.pieces is not None:
            parser.error("the speed of a study is that of one run: leave --pieces out")
        if name == "speed" and any(Results(given.results, cell).missing(1) == [] for cell in runs_of):
            parser.exit(1, f"{given.results} holds missions of this study; its speed needs an empty --results\n")
        flown, remark = list[tuple[Summary, pd.DataFrame]](), ""
        if given.pieces is not None:
            commit, only = begun.commit or "none", given.only.split(",")
            flown, remark = flown_in_pieces(runs_of, only, given.pieces, commit, given.workers)
        else:
            for cell, runs in runs_of.items():
                print(f"{name}: {cell.name()}", file=sys.stderr, flush=True)
                missions = run_cell(cell, runs, given.results, workers=given.workers)
                flown.append((summarize(cell, missions), missions))
        minutes = (time.monotonic() - started) / 60.0
        tables = [Table(name="cells", columns=COLUMNS, rows=tuple(row(*one) for one in flown))]
        if name == "scenario_1":
            tables.append(by_target(flown))
        for table in tables:
            print(markdown(table))
        made = figures(name, flown, minutes, given.workers)
        write(given.out, f"study_{name}", study.title, begun, made, tables=tables, page=PAGE, remark=remark)


if __name__ == "__main__":
    main()
