"""Files of bearings from elsewhere, answered by `crossfix localize`: how often the truth is where it says.

    python -m tests.benchmarks.bearing_files --files 400 --jobs 2

Places and emitter are drawn evenly from a square. Each bearing has an error of its own, those of a file one in common,
and some point anywhere. The command gets the range, and sigmas where the file states them, nothing else.
"""

from __future__ import annotations

import argparse
import json
import math
import sys
import tempfile
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import typer
from shapely.geometry import Point, shape
from typer.testing import CliRunner

from backend.cli.localize import localize
from hardware.frame import LocalFrame
from hardware.readings import Place
from tests.benchmarks.figures.circumstances import begin
from tests.benchmarks.figures.pages import markdown
from tests.benchmarks.figures.record import Column, Table
from tests.benchmarks.figures.writer import add_out, plain, write

APP = typer.Typer(rich_markup_mode=None)
APP.command()(localize)
FRAME = LocalFrame(Place(46.5, 8.0))
RANGE_BY_SQUARE = 1.6
COLUMNS = (
    Column(name="files"),
    Column(name="bearings"),
    Column(name="stated sigma, deg"),
    *(Column(name=name, decimals=1) for name in ("in C95, %", "beyond 3x, %")),
    *(Column(name=name, decimals=0) for name in ("error (median), m", "stated (median), m")),
)


@dataclass(frozen=True, slots=True)
class Kind:
    """half_m: half the side of the square. own_deg, common_deg: standard deviations. stated_deg: None: no column."""

    name: str
    bearings: int
    half_m: float
    own_deg: float
    common_deg: float = 0.0
    outliers: float = 0.0
    stated_deg: float | None = None


KINDS = (
    Kind("errors of their own, 10 km", 12, 5000.0, 2.0, stated_deg=2.0),
    Kind("errors of their own, 500 m", 12, 250.0, 2.0, stated_deg=2.0),
    Kind("half of the variance in common", 12, 5000.0, math.sqrt(2.0), math.sqrt(2.0), stated_deg=2.0),
    Kind("5 degrees in common that nobody stated", 12, 5000.0, 2.0, 5.0, stated_deg=2.0),
    Kind("one in ten wrong", 12, 5000.0, 2.0, outliers=0.1, stated_deg=2.0),
    Kind("five, errors of their own", 5, 5000.0, 6.0, stated_deg=6.0),
    Kind("four, errors of their own", 4, 5000.0, 1.5, stated_deg=1.5),
    Kind("nothing stated, errors of their own", 12, 5000.0, 4.0),
    Kind("nothing stated, 5.3 degrees in common, 8 % wrong", 5, 250.0, 5.3, 5.3, 0.08),
    Kind("nothing stated, hand-held, three", 3, 300.0, 18.0, 5.0, 0.06),
    Kind("nothing stated, hand-held, five", 5, 300.0, 18.0, 5.0, 0.06),
)


@dataclass(frozen=True, slots=True)
class Answer:
    """error_m, stated_m: infinite where there is no answer."""

    error_m: float
    stated_m: float
    held: bool


def drawn(kind: Kind, rng: np.random.Generator) -> tuple[str, tuple[float, float]]:
    """The file, and where the emitter is, m ENU."""
    places = rng.uniform(-kind.half_m, kind.half_m, (kind.bearings, 2))
    east, north = rng.uniform(-kind.half_m, kind.half_m, 2)
    truth = np.degrees(np.arctan2(east - places[:, 0], north - places[:, 1]))
    error = rng.normal(0.0, kind.own_deg, kind.bearings) + rng.normal(0.0, kind.common_deg)
    wrong = rng.random(kind.bearings) < kind.outliers
    bearings = np.where(wrong, rng.uniform(0.0, 360.0, kind.bearings), truth + error) % 360.0
    stated = kind.stated_deg
    lines = ["lat,lon,bearing_deg" + ("" if stated is None else ",sigma_deg")]
    for (x, y), bearing in zip(places, bearings, strict=True):
        place = FRAME.to_geo(float(x), float(y))
        lines.append(f"{place.lat:.7f},{place.lon:.7f},{bearing:.1f}" + ("" if stated is None else f",{stated}"))
    return "\n".join(lines) + "\n", (float(east), float(north))


def answered(kind: Kind, seed: int, number: int, *options: str) -> Answer:
    """options: of the command, besides --json and --range."""
    content, (east, north) = drawn(kind, np.random.default_rng([seed, number]))
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "bearings.csv"
        path.write_text(content)
        ranged = ["--range", f"{RANGE_BY_SQUARE * kind.half_m:g}"]
        told = json.loads(CliRunner().invoke(APP, [str(path), "--json", *ranged, *options]).stdout)
    if told["estimate"] is None:
        return Answer(math.inf, math.inf, held=False)
    found = FRAME.to_enu(Place(told["estimate"]["lat"], told["estimate"]["lon"]))
    truth = FRAME.to_geo(east, north)
    held = bool(shape(told["c95"]).contains(Point(truth.lon, truth.lat)))
    return Answer(math.dist(found, (east, north)), told["expected_rmse_m"], held)


def row(kind: Kind, answers: list[Answer]) -> tuple[str, int, str, float, float, float, float]:
    """The cells under `COLUMNS`; a file without an answer counts as one that is not held, and as beyond."""
    error, stated = np.array([one.error_m for one in answers]), np.array([one.stated_m for one in answers])
    beyond = ~(error <= 3.0 * stated) | np.isinf(error)
    return (
        *(kind.name, kind.bearings, "none" if kind.stated_deg is None else f"{kind.stated_deg:g}"),
        *(100.0 * float(np.mean([one.held for one in answers])), 100.0 * float(beyond.mean())),
        *(float(np.median(error)), float(np.median(stated))),
    )


def main() -> None:
    parser = argparse.ArgumentParser(description="Files of bearings from elsewhere.")
    parser.add_argument("--files", type=int, default=400)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=1)
    add_out(parser)
    arguments = parser.parse_args()
    begun, rows = begin(__file__), list[tuple[str, int, str, float, float, float, float]]()
    numbers = range(arguments.files)
    with ProcessPoolExecutor(arguments.jobs) as pool:
        for kind in KINDS:
            every = pool.map(answered, [kind] * len(numbers), [arguments.seed] * len(numbers), numbers, chunksize=10)
            rows.append(row(kind, list(every)))
            print(*rows[-1], file=sys.stderr, flush=True)
    table = Table(name="files", columns=COLUMNS, rows=tuple(rows))
    print(markdown(table))
    least, most = min(rows, key=lambda cells: cells[3]), max(rows, key=lambda cells: cells[4])
    figures = [
        plain("truth in C95, at least", round(least[3], 1), "%", note=least[0]),
        plain("error beyond three times stated, at most", round(most[4], 1), "%", note=most[0]),
    ]
    title, page = "Files of bearings from elsewhere", "direction-finding.md#files-of-bearings"
    write(arguments.out, "bearing_files", title, begun, figures, tables=[table], page=page)


if __name__ == "__main__":
    main()
