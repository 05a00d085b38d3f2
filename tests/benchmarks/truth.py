"""What the claims of a search are worth, in worlds whose errors know nothing of the belief's model.

    python -m tests.benchmarks.truth --missions 1000 --out docs/measurements        (or: make truth)

Every row is `crossfix study truth --row ROW`; the independent model flies the same missions for comparison. Several
tags share what they tell of the compass, as in new missions. Rows of the record that are not flown again (`--only`)
stay in it.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass, replace
from itertools import count
from pathlib import Path
from typing import Any

from backend.cli.truth import known_model, row_claims
from planner.study.error_worlds import ROWS
from planner.study.moving import SPEEDS
from planner.study.tags import TAGS
from planner.study.truth import TOLD, UNKNOWN, Claim, Model, Truth, truth_of
from tests.benchmarks.figures.circumstances import begin
from tests.benchmarks.figures.pages import markdown
from tests.benchmarks.figures.reader import read
from tests.benchmarks.figures.record import Cell, Column, Figure, Record, Table
from tests.benchmarks.figures.writer import add_out, plain, wanted, write

JUDGED = ("independent", "bias5", "bias10", "bias5_outliers8", "bias5_outliers20", "walls", "walls_bias5")
"""The rows of which something is wanted; a compass that is right may be better than its prior."""
LEARNED = ("right", "bias5", "bias5_outliers8")
"""The rows that are flown again after flights have taught, and told the true errors."""

SEVERAL = {"tags_4": "four_tags", "tags_8": "eight_tags"}
"""The rows of which a time is wanted, by the key of the figure."""

PIECE, FEW = 100, 10
"""Missions that are kept together; of rows that take long, fewer."""

COLUMNS = (
    Column(name="row"),
    Column(name="errors believed"),
    Column(name="known before"),
    Column(name="missions"),
    Column(name="claimed, %", decimals=1),
    Column(name="truth in C95, %", decimals=1),
    Column(name="beyond 3 x stated, %", decimals=1),
    Column(name="as the beliefs say, %", decimals=1),
    Column(name="beyond 3 x RMS, %", decimals=1),
    Column(name="time, s", decimals=0),
    Column(name="bearings", decimals=2),
    Column(name="error, m", decimals=1),
    Column(name="stated, m", decimals=1),
    Column(name="bias within 2 sigma, %", decimals=0),
)


def row(found: Truth) -> tuple[Cell, ...]:
    """The cells under `COLUMNS`; empty where no mission told."""
    said = found.as_json()
    half = 50.0 * (found.in_c95_high - found.in_c95_low)
    inside: Cell = None if said["in_c95"] is None else (100.0 * said["in_c95"], half)
    beyond: Cell = None if said["beyond_3x"] is None else (100.0 * said["beyond_3x"], beyond_half(found))
    names = ("beyond_believed", "beyond_3rms", "bias_inside")
    believed, beyond_rms, bias = (None if said[name] is None else 100.0 * said[name] for name in names)
    return (
        found.row,
        f"{found.model}, shared" if found.shared else found.model,
        found.prior,
        found.missions,
        100.0 * found.claimed,
        inside,
        beyond,
        believed,
        beyond_rms,
        found.mean_s,
        found.bearings_mean,
        said["error_mean_m"],
        said["stated_mean_m"],
        bias,
    )


def beyond_half(found: Truth) -> float:
    """%, half of Wilson's 95 % interval of the share beyond."""
    return 50.0 * (found.beyond_high - found.beyond_low)


def figures(found: Sequence[Truth]) -> list[Figure]:
    """Of the joint model; something is wanted of the rows in `JUDGED`, and of the time that flights have taught."""
    made: list[Figure] = []
    for one in found:
        if one.model != "joint" or one.prior != UNKNOWN or not one.claimed:
            continue
        note, half = f"{one.missions} missions", round(50.0 * (one.in_c95_high - one.in_c95_low), 1)
        inside, beyond = round(100.0 * one.in_c95, 1), round(100.0 * one.beyond_3x, 2)
        if one.row in JUDGED:
            made.append(wanted("truth", inside, of=one.row, ci95=half, note=note))
            told = f"{note}; the beliefs themselves say {100.0 * one.beyond_believed:.1f} %"
            made.append(wanted("truth_beyond", beyond, of=one.row, ci95=round(beyond_half(one), 2), note=told))
            made.append(wanted("truth_claimed", round(100.0 * one.claimed, 1), of=one.row, note=note))
        elif one.row in SPEEDS:
            made.append(wanted("moving", inside, of=one.row, ci95=half, note=note))
        else:
            made.append(plain(f"truth in C95, {one.row}", inside, "%", ci95=half, note=note))
        if one.row in SEVERAL:
            made.append(wanted(SEVERAL[one.row], round(one.mean_s), of="field scenario", note=note))
        else:
            made.append(plain(f"time until the claim, {one.row}", round(one.mean_s), "s", note=note))
    return [*made, *_lessons(found)]


def _lessons(found: Sequence[Truth]) -> Iterator[Figure]:
    """What learning from flights costs against a search that was told the true errors; the demo's compass is right."""
    told = {one.row: one for one in found if one.prior == TOLD}
    for one in found:
        if not one.prior.endswith("flights") or one.row not in told:
            continue
        known, note = told[one.row], f"{one.missions} and {told[one.row].missions} missions"
        slower = round(100.0 * (one.mean_s / known.mean_s - 1.0), 1)
        yield wanted("truth_learned", slower, of=f"{one.row}, {one.prior}", note=note)
        if one.row == "right":
            yield wanted("truth_right", round(one.mean_s), of=one.prior, note=note)


@dataclass(frozen=True, slots=True)
class Series:
    """Missions of one row that are summed up together."""

    row: str
    model: Model
    flights: int = 0
    told: bool = False

    @property
    def shared(self) -> bool:
        """Whether what one tag's bearings tell of the compass counts for all, as in new missions."""
        return self.row in TAGS and self.model == "joint"

    @property
    def piece(self) -> int:
        """How many missions are kept together."""
        return FEW if self.row in TAGS or self.row in SPEEDS else PIECE

    def flown(self, seeds: range, kept: Path | None, commit: str) -> dict[str, Any]:
        """Claims, what was known before and the commit that flew, of these seeds; not flown again where it is kept."""
        path = self._path(seeds, kept)
        if path is not None and path.exists():
            return json.loads(path.read_text())
        print(f"{self.row}, {self.model}: seeds {seeds[0]} to {seeds[-1]}", file=sys.stderr, flush=True)
        claims, knows = row_claims(self.row, seeds, self.model, self.flights, self.told, shared=self.shared)
        piece = {"commit": commit, "known": knows, "claims": [asdict(claim) for claim in claims]}
        if path is not None:
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(json.dumps(piece))
        return piece

    def pieces(self, missions: int, kept: Path | None, commit: str) -> Iterator[dict[str, Any]]:
        """Of seeds 1 to `missions`, and of the whole pieces after them as far as they are kept without a gap."""
        for first in count(1, self.piece):
            last = min(first + self.piece - 1, missions) if first <= missions else first + self.piece - 1
            seeds = range(first, last + 1)
            path = self._path(seeds, kept)
            if first > missions and (missions % self.piece or path is None or not path.exists()):
                return
            yield self.flown(seeds, kept, commit)

    def _path(self, seeds: range, kept: Path | None) -> Path | None:
        known = "told" if self.told else str(self.flights)
        return None if kept is None else kept / f"{self.row}-{self.model}-{known}-{seeds[0]}-{seeds[-1]}.json"


def summed_up(series: Series, missions: int, kept: Path | None, commit: str) -> tuple[Truth, set[str]]:
    """The row, and the commits that flew it."""
    pieces = list(series.pieces(missions, kept, commit))
    claims = [Claim(**claim) for piece in pieces for claim in piece["claims"]]
    found = replace(truth_of(series.row, series.model, claims, pieces[0]["known"]), shared=series.shared)
    return found, {piece["commit"] for piece in pieces}


def merged(before: Record | None, found: Sequence[Truth]) -> tuple[list[Figure], Table, str]:
    """Figures, table and a remark: of these rows, and of those of the record before that were not flown again."""
    made, rows, remark = figures(found), {cells[:3]: cells for cells in (row(one) for one in found)}, ""
    if before is not None:
        names = [column.name for column in before.tables[0].columns]
        old = [dict(zip(names, cells, strict=True)) for cells in before.tables[0].rows]
        taken_over = [tuple(cells.get(column.name) for column in COLUMNS) for cells in old]
        again = {figure.name: figure for figure in made}
        kept = [again.pop(figure.name, figure) for figure in before.figures]
        made = [*kept, *again.values()]
        left = {cells[:3]: cells for cells in taken_over if cells[:3] not in rows}
        rows = {cells[:3]: rows.get(cells[:3], cells) for cells in taken_over} | rows
        if left:
            remark = f"{len(left)} rows are of {before.date}, commit {before.commit}"
    return made, Table(name="truth", columns=COLUMNS, rows=tuple(rows.values())), remark


def chosen(names: Sequence[str], parts: Sequence[str]) -> list[str]:
    """The names that are one of the parts, or contain one that is no name itself."""
    return [name for name in names if any(part == name or (part not in names and part in name) for part in parts)]


def main() -> None:
    parser = argparse.ArgumentParser(description="Count what the claims of simulated searches are worth.")
    parser.add_argument("--missions", type=int, default=1000)
    parser.add_argument("--only", default="", help="rows of these names, or whose name contains one of these parts")
    parser.add_argument("--models", default="joint,independent", help="what is believed of the errors")
    parser.add_argument("--flights", type=int, default=30, help="that teach the rows of LEARNED; 0: no such rows")
    parser.add_argument(
        "--pieces",
        type=Path,
        help=f"folder that keeps every {PIECE} missions ({FEW} of tags, of movers) as soon as they were flown; "
        "all that is kept of a row counts",
    )
    add_out(parser)
    arguments = parser.parse_args()
    begun = begin(__file__)
    models: list[Model] = [known_model(name) for name in arguments.models.split(",")]
    names = chosen((*ROWS.by_name, *SPEEDS, *TAGS), arguments.only.split(","))
    series = [Series(name, model) for name in names for model in models]
    for name in (name for name in LEARNED if name in names and arguments.flights):
        series += [Series(name, "joint", flights=arguments.flights), Series(name, "joint", told=True)]
    commit = begun.commit or "none"
    flown = [summed_up(one, arguments.missions, arguments.pieces, commit) for one in series]
    found, commits = [truth for truth, _ in flown], sorted(set[str]().union(*(flew for _, flew in flown)))
    record = None if arguments.out is None else arguments.out / "truth.json"
    made, table, remark = merged(read(record) if record is not None and record.exists() else None, found)
    print(markdown(table))
    if commits != [commit]:
        remark = "; ".join(filter(None, [f"flown by {', '.join(commits)}", remark]))
    write(arguments.out, "truth", "Truth at the claim", begun, made, tables=[table], page="truth.md", remark=remark)


if __name__ == "__main__":
    main()
