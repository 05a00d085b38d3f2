"""What the claims of a search are worth, in worlds whose errors know nothing of the belief's model.

    python -m tests.benchmarks.truth --missions 1000 --out docs/measurements        (or: make truth)

Every row is `crossfix study truth --row ROW`; the independent model flies the same missions for comparison.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence

from backend.cli.truth import study_row
from planner.study.error_worlds import ROWS
from planner.study.truth import Truth
from tests.benchmarks.figures.circumstances import begin
from tests.benchmarks.figures.pages import markdown
from tests.benchmarks.figures.record import Cell, Column, Figure, Table
from tests.benchmarks.figures.writer import add_out, plain, wanted, write

JUDGED = ("independent", "bias5", "bias10", "bias5_outliers8", "bias5_outliers20", "walls", "walls_bias5")
"""The rows of which something is wanted; a compass that is right may be better than its prior."""

COLUMNS = (
    Column(name="row"),
    Column(name="errors believed"),
    Column(name="missions"),
    Column(name="claimed, %", decimals=1),
    Column(name="truth in C95, %", decimals=1),
    Column(name="beyond 3 x stated, %", decimals=1),
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
    shares = {name: None if said[name] is None else 100.0 * said[name] for name in ("beyond_3x", "bias_inside")}
    return (
        found.row,
        found.model,
        found.missions,
        100.0 * found.claimed,
        inside,
        shares["beyond_3x"],
        found.mean_s,
        found.bearings_mean,
        said["error_mean_m"],
        said["stated_mean_m"],
        shares["bias_inside"],
    )


def figures(found: Sequence[Truth]) -> list[Figure]:
    """Of the joint model; something is wanted of the rows in `JUDGED`."""
    made: list[Figure] = []
    for one in found:
        if one.model != "joint" or not one.claimed:
            continue
        note, half = f"{one.missions} missions", round(50.0 * (one.in_c95_high - one.in_c95_low), 1)
        inside, beyond = round(100.0 * one.in_c95, 1), round(100.0 * one.beyond_3x, 2)
        if one.row in JUDGED:
            made.append(wanted("truth", inside, of=one.row, ci95=half, note=note))
            made.append(wanted("truth_beyond", beyond, of=one.row, note=note))
            made.append(wanted("truth_claimed", round(100.0 * one.claimed, 1), of=one.row, note=note))
        else:
            made.append(plain(f"truth in C95, {one.row}", inside, "%", ci95=half, note=note))
        made.append(plain(f"time until the claim, {one.row}", round(one.mean_s), "s", note=note))
    return made


def main() -> None:
    parser = argparse.ArgumentParser(description="Count what the claims of simulated searches are worth.")
    parser.add_argument("--missions", type=int, default=1000)
    parser.add_argument("--only", default="", help="rows whose name contains this")
    parser.add_argument("--models", default="joint,independent", help="what is believed of the errors")
    add_out(parser)
    arguments = parser.parse_args()
    begun = begin(__file__)
    found: list[Truth] = []
    for name in (name for name in ROWS.by_name if arguments.only in name):
        for model in arguments.models.split(","):
            print(name, model, file=sys.stderr, flush=True)
            found.append(study_row(name, arguments.missions, model))
    table = Table(name="truth", columns=COLUMNS, rows=tuple(row(one) for one in found))
    print(markdown(table))
    write(arguments.out, "truth", "Truth at the claim", begun, figures(found), tables=[table], page="truth.md")


if __name__ == "__main__":
    main()
