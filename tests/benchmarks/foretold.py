"""What plans say of the time until localized, and what follows, in the field world.

    python -m tests.benchmarks.foretold --missions 80 --seed 1 --compass sd --antennas yagi --pieces FOLDER

FOLDER: as tests.benchmarks.field_world keeps it; only missions that it lacks are flown. Those that localized count; of
several plans with as many bearings the first.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterable
from pathlib import Path
from statistics import fmean

from backend.cli.field_missions import FieldMission
from tests.benchmarks.field_world import NEW, Setting, flown, settings_of
from tests.benchmarks.figures.circumstances import begin
from tests.benchmarks.figures.pages import markdown
from tests.benchmarks.figures.record import Cell, Column, Figure, Table
from tests.benchmarks.figures.writer import add_out, plain, write

MOST_BEARINGS = 3
COLUMNS = (
    Column(name="compass off, degrees"),
    Column(name="antenna"),
    Column(name="row"),
    Column(name="bearings so far"),
    Column(name="plans"),
    Column(name="said, s", decimals=0),
    Column(name="followed, s", decimals=0),
    Column(name="followed/said", decimals=2),
    Column(name="apart, s", decimals=0),
    Column(name="within the 90 % time, %", decimals=0),
)


def rows_of(setting: Setting, name: str, missions: Iterable[FieldMission]) -> list[tuple[Cell, ...]]:
    """The cells under `COLUMNS`, a row for each number of bearings; apart: |said - followed| in the mean."""
    of: dict[int, list[tuple[float, float, float]]] = {}
    for mission in missions:
        plans = {bearings: plan for bearings, *plan in reversed(mission.foretold)} if mission.localized else {}
        for bearings, (at_s, mean_s, in_90_s) in plans.items():
            of.setdefault(bearings, []).append((mean_s, mission.time_s - at_s, in_90_s))
    told = list[tuple[Cell, ...]]()
    for bearings in range(MOST_BEARINGS + 1):
        if (some := of.get(bearings)) is None:
            continue
        said, followed = fmean(one[0] for one in some), fmean(one[1] for one in some)
        apart = fmean(abs(mean - after) for mean, after, _ in some)
        within = 100.0 * fmean(after <= in_90 for _, after, in_90 in some)
        compass = "sd 4" if setting.compass_deg is None else f"{setting.compass_deg:g}"
        counts = (bearings, len(some), said, followed, followed / said, apart, within)
        told.append((compass, setting.antenna, name, *counts))
    return told


def figures(rows: Iterable[tuple[Cell, ...]]) -> list[Figure]:
    """Of new missions."""
    found = list[Figure]()
    for compass, antenna, name, bearings, _, _, _, share, _, within in rows:
        if name == NEW:
            of = f"{antenna}, compass {compass}, after {bearings} bearings"
            found.append(plain(f"followed over said, {of}", round(float(str(share)), 2), "times"))
            found.append(plain(f"within the 90 % time, {of}", round(float(str(within)), 1), "%"))
    return found


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--missions", type=int, default=80)
    parser.add_argument("--seed", type=int, default=1, help="of the first mission")
    parser.add_argument("--rows", default="whole,sector,swings,taught_swings,never_stopping", help="of field_world")
    parser.add_argument("--compass", default="sd", help="how far it is off, degrees, or sd: 4 in the mean square")
    parser.add_argument("--antennas", default="yagi", help="yagi, wide")
    parser.add_argument("--pieces", type=Path, help="folder that keeps each mission, to go on from")
    parser.add_argument("--told", action="store_true", help="fly nothing")
    add_out(parser)
    given = parser.parse_args()
    begun = begin(__file__)
    seeds = range(given.seed, given.seed + given.missions)
    settings = settings_of(given.compass, given.antennas)
    found = flown(given.rows.split(","), settings, seeds, given.pieces, given.told)
    rows = [
        row
        for setting, of in found.items()
        for name, missions in of.items()
        for row in rows_of(setting, name, missions.values())
    ]
    table = Table(name="plans", columns=COLUMNS, rows=tuple(rows))
    print(markdown(table))
    title, page = "What plans foretell", "planner-studies.md#what-plans-foretell"
    write(given.out, "study_foretold", title, begun, figures(rows), tables=[table], page=page)


if __name__ == "__main__":
    main()
