"""How much wider the wedges of bearings that count each by itself must be to claim as truly as they say.

    python -m tests.benchmarks.field_widening --missions 40 --seed 80000 --compass 0,8 --pieces FOLDER

Whole turns and independent bearings, as before errors were estimated with the place, every sigma multiplied by one
factor. A logistic curve of its logarithm through whether C95 held the truth at each claim says where that is so in 95 %
of the claims; the row `widened` of field_world is flown with what is recorded of it. Seeds are others than those on
which rows are compared.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from backend.cli.field_missions import LATE_S, FieldMission
from backend.cli.field_summary import summary
from tests.benchmarks.field_world import WIDENING, Setting, flown, settings_of
from tests.benchmarks.figures.circumstances import begin
from tests.benchmarks.figures.pages import markdown
from tests.benchmarks.figures.record import Cell, Column, Figure, Table
from tests.benchmarks.figures.writer import add_out, plain, write

WANTED = 0.95
WIDEST = 4.0
"""A factor beyond this is none: a bearing of 28 degrees says nothing."""
RIDGE = 0.05
"""Of the slope's square: claims that are all true below some factor and all wrong above it have no steepest curve."""
COLUMNS = (
    Column(name="compass off, degrees"),
    Column(name="antenna"),
    Column(name="sigma times", decimals=2),
    Column(name="missions"),
    Column(name="time, s", decimals=0),
    Column(name=f"localized in {LATE_S:.0f} s, %", decimals=0),
    Column(name="truth in C95 at the claim, %", decimals=0),
    Column(name="its 95 % interval"),
    Column(name="beyond 3 x stated, %", decimals=1),
)


def widening(held: Mapping[float, Sequence[bool]], wanted: float = WANTED) -> float:
    """The factor at which C95 holds the truth so often, no less than the narrowest that was flown. held: of each
    factor's claims whether it did. inf: at none, since it holds no more often the wider the wedge is.

    Maximum likelihood of P(held) = 1 / (1 + exp(-a - b log f)) by Newton's method.
    """
    log_f = np.array([math.log(f) for f, claims in held.items() for _ in claims])
    true = np.array([float(one) for claims in held.values() for one in claims])
    rows = np.column_stack([np.ones_like(log_f), log_f])
    found, ridge = np.zeros(2), np.array([1e-6, RIDGE])
    for _ in range(50):
        p = 1.0 / (1.0 + np.exp(-rows @ found))
        curvature = (rows * (p * (1.0 - p))[:, None]).T @ rows + np.diag(ridge)
        found = found + np.linalg.solve(curvature, rows.T @ (true - p) - ridge * found)
    if found[1] <= 0.0:
        return math.inf
    return max(float(np.exp((math.log(wanted / (1.0 - wanted)) - found[0]) / found[1])), min(held))


def row(setting: Setting, factor: float, missions: Sequence[FieldMission]) -> tuple[Cell, ...]:
    """The cells under `COLUMNS`."""
    told = summary(setting.options(_name(factor)), missions)
    claimed = not math.isnan(told.in_c95)
    return (
        "sd 4" if setting.compass_deg is None else f"{setting.compass_deg:g}",
        setting.antenna,
        factor,
        told.missions,
        (told.time_s, told.time_ci95_s),
        100.0 * told.localized_in_time,
        100.0 * told.in_c95 if claimed else None,
        f"{100.0 * told.in_c95_low:.0f} to {100.0 * told.in_c95_high:.0f}" if claimed else None,
        100.0 * told.false_claims if claimed else None,
    )


def _name(factor: float) -> str:
    return f"wedge*{factor:g}"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--missions", type=int, default=40, help="with each factor; at least 2")
    parser.add_argument("--seed", type=int, default=80000, help="of the first mission")
    parser.add_argument("--factors", default="1,1.5,2.2", help="with commas between")
    parser.add_argument("--compass", default="0,8", help="how far it is off, degrees, or sd: 4 in the mean square")
    parser.add_argument("--antennas", default="yagi,wide", help="yagi, wide")
    parser.add_argument("--pieces", type=Path, help="folder that keeps each mission, to go on from")
    parser.add_argument("--told", action="store_true", help="fly nothing")
    add_out(parser)
    arguments = parser.parse_args()
    begun = begin(__file__)
    seeds = range(arguments.seed, arguments.seed + arguments.missions)
    factors = [float(one) for one in arguments.factors.split(",")]
    settings = settings_of(arguments.compass, arguments.antennas)
    found = flown([_name(f) for f in factors], settings, seeds, arguments.pieces, arguments.told)
    rows, figures = list[tuple[Cell, ...]](), list[Figure]()
    for setting, missions in found.items():
        of = {f: list(missions[_name(f)].values()) for f in factors if _name(f) in missions}
        rows.extend(row(setting, f, some) for f, some in of.items())
        wide = widening({f: [m.in_c95 for m in some if m.localized] for f, some in of.items()})
        print(f"{setting.name}: sigma times {wide:.2f}")
        if wide < WIDEST:
            figures.append(plain(f"{WIDENING}{setting.name}", round(wide, 2), "", note=f"{WANTED:.0%} of the claims"))
    table = Table(name="rows", columns=COLUMNS, rows=tuple(rows))
    print(markdown(table))
    title = "A wedge as wide as true"
    write(arguments.out, "study_field_widening", title, begun, figures, tables=[table], page="planner-studies.md")


if __name__ == "__main__":
    main()
