"""Three direction finders on simulated sweeps of known bearing, beside the Cramer-Rao bound (figure 3).

    python -m tests.benchmarks.direction_finders --sweeps 2000 --reliability docs/images/sigma_reliability.svg

Prints the tables of docs/direction-finding.md (or: make compare-direction-finders).
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from dataclasses import replace

from hardware.direction_finding.comparison import CONDITIONS, Compared, Condition, compare, cramer_rao_deg, reliability
from tests.benchmarks.figures.circumstances import begin
from tests.benchmarks.figures.pages import markdown
from tests.benchmarks.figures.record import Cell, Column, Figure, Table
from tests.benchmarks.figures.writer import add_out, plain, wanted, write

REFERENCE = CONDITIONS[0]
COLUMNS = (
    Column(name="condition"),
    Column(name="bound", decimals=2),
    Column(name="finder"),
    Column(name="RMS", decimals=2),
    Column(name="minus least squares (± its standard error)", decimals=3),
    Column(name="bias", decimals=2),
    *(Column(name=name, decimals=1) for name in ("outliers, %", "rejected, %")),
    *(Column(name=name, decimals=2) for name in ("error/sigma", "in 1", "in 2")),
)
RELIABILITY = (
    Column(name="stated sigma", decimals=2),
    Column(name="RMS error", decimals=2),
    Column(name="sweeps"),
)


def bound_deg(condition: Condition) -> float:
    return cramer_rao_deg(replace(condition, echo_db=None))


def row(condition: Condition, name: str, compared: Compared) -> tuple[Cell, ...]:
    """The cells under `COLUMNS`."""
    s = compared.score
    return (
        *(condition.name, bound_deg(condition), name, s.rms_deg),
        None if name == "least squares" else compared.paired,
        *(s.bias_deg, s.outlier_percent, s.rejected_percent, s.normalized_rms, s.within_one, s.within_two),
    )


def figures(found: dict[Condition, dict[str, Compared]]) -> list[Figure]:
    """The worst condition stands for "never worse than least squares"; its standard error is doubled for 95 %."""
    worst = max(found, key=lambda condition: found[condition]["sparse"].paired[0])
    difference, error = found[worst]["sparse"].paired
    made = [
        wanted(
            "least_squares", round(difference, 3), of="measurement model", ci95=round(2.0 * error, 3), note=worst.name
        )
    ]
    for condition, compared in found.items():
        ratio = round(compared["sparse"].score.rms_deg / bound_deg(condition), 2)
        if condition == REFERENCE:
            made.append(wanted("bearing_rms", ratio))
        else:
            made.append(plain(f"bearing RMS over the bound, {condition.name}", ratio, "times"))
    return made


def plot_reliability(classes: Sequence[tuple[float, float, int]], path: str) -> None:
    """Stated sigma against the error really made, with the diagonal."""
    from matplotlib.figure import Figure as Drawing

    drawing = Drawing(figsize=(4.2, 4.0), layout="constrained")
    axes = drawing.add_subplot()
    stated, made = [c[0] for c in classes], [c[1] for c in classes]
    top = 1.05 * max(*stated, *made)
    axes.plot([0, top], [0, top], color="0.6", linewidth=1, label="true")
    axes.plot(stated, made, "o-", color="tab:blue", label="simulated sweeps")
    axes.set(xlabel="stated sigma in degrees", ylabel="RMS error in degrees", xlim=(0, top), ylim=(0, top))
    axes.legend(frameon=False)
    drawing.savefig(path)


def main() -> None:
    parser = argparse.ArgumentParser(description="Compare the direction finders on simulated sweeps.")
    parser.add_argument("--sweeps", type=int, default=2000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", default="", help="conditions whose name contains this")
    parser.add_argument("--reliability", metavar="FILE", help="draw the reliability of sigma into this file (SVG, PNG)")
    add_out(parser)
    arguments = parser.parse_args()
    begun, found = begin(__file__), dict[Condition, dict[str, Compared]]()
    for condition in (c for c in CONDITIONS if arguments.only in c.name):
        print(condition.name, file=sys.stderr, flush=True)
        found[condition] = compare(condition, arguments.sweeps, arguments.seed)
    rows = tuple(row(condition, *one) for condition, compared in found.items() for one in compared.items())
    tables = [Table(name="conditions", columns=COLUMNS, rows=rows)]
    if arguments.reliability:
        classes = reliability(max(arguments.sweeps // 5, 20), arguments.seed)
        tables.append(Table(name="reliability", columns=RELIABILITY, rows=tuple(classes)))
        plot_reliability(classes, arguments.reliability)
    for table in tables:
        print(markdown(table))
    title, page = "Direction finders", "direction-finding.md#how-good-it-is"
    write(arguments.out, "direction_finders", title, begun, figures(found), tables=tables, page=page)


if __name__ == "__main__":
    main()
