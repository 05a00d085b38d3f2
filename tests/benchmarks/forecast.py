"""Did "localized in about ..." come true? Every plan of flown missions beside what then happened.

    python -m tests.benchmarks.forecast data/crossfix.sqlite [more databases] [--out FOLDER]

Only missions that localized count; times in seconds of the mission.
"""

from __future__ import annotations

import argparse
import json
import sqlite3
import statistics
from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from backend.store.packed import unpacked
from tests.benchmarks.figures.circumstances import begin
from tests.benchmarks.figures.pages import markdown
from tests.benchmarks.figures.record import Column, Figure, Table
from tests.benchmarks.figures.writer import add_out, plain, write


@dataclass(frozen=True, slots=True)
class Said:
    place_number: int
    mean_s: float
    p90_s: float
    happened_s: float


def said_in(database: Path) -> list[Said]:
    """Forecasts of the database's localized missions; the last word before each flight counts."""
    with sqlite3.connect(f"file:{database}?mode=ro", uri=True) as connection:
        rows = connection.execute(
            "SELECT mission_id, at_us / 1e6, kind, body FROM events "
            "WHERE kind IN ('plan_chosen', 'belief_updated') ORDER BY mission_id, seq"
        ).fetchall()
    plans: dict[str, list[tuple[float, dict]]] = defaultdict(list)
    localized: dict[str, float] = {}
    for mission, at_s, kind, body in rows:
        fact = json.loads(unpacked(body))
        if kind == "plan_chosen" and fact["time_90_s"] is not None:
            plans[mission].append((at_s, fact))
        elif kind == "belief_updated" and fact["localized"]:
            localized.setdefault(mission, at_s)
    return [
        Said(fact["place_number"], fact["expected_time_s"], fact["time_90_s"], localized[mission] - at_s)
        for mission, chosen in plans.items()
        if mission in localized
        for at_s, fact in chosen
        if at_s < localized[mission]
    ]


COLUMNS = ("place", "plans", "expected, s", "happened, s", "happened/expected", "within the 90 % figure")
DECIMALS = (0, 0, 0, 0, 2, 2)


def by_place(said: Iterable[Said]) -> Table:
    """A row for each place's number; the ratio is a median, the times are means."""
    groups: dict[int, list[Said]] = defaultdict(list)
    for one in said:
        groups[one.place_number].append(one)
    rows = []
    for number, ones in sorted(groups.items()):
        ratio = statistics.median(one.happened_s / one.mean_s for one in ones)
        expected = statistics.fmean(one.mean_s for one in ones)
        happened = statistics.fmean(one.happened_s for one in ones)
        rows.append((number, len(ones), expected, happened, ratio, within_90(ones)))
    columns = tuple(Column(name=name, decimals=places) for name, places in zip(COLUMNS, DECIMALS, strict=True))
    return Table(name="places", columns=columns, rows=tuple(rows))


def within_90(said: Sequence[Said]) -> float:
    """Share of the forecasts whose 90 % time was kept."""
    return sum(one.happened_s <= one.p90_s for one in said) / len(said)


def figures(said: Sequence[Said]) -> list[Figure]:
    ratio = statistics.median(one.happened_s / one.mean_s for one in said)
    return [
        plain("plans", len(said), ""),
        plain("time that followed over time expected, median", round(ratio, 2), "times"),
        plain("within the 90 % time", round(100.0 * within_90(said), 1), "%"),
    ]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("databases", nargs="+", type=Path)
    add_out(parser)
    given = parser.parse_args()
    begun = begin(__file__)
    said = [one for database in given.databases for one in said_in(database)]
    if not said:
        parser.exit(1, "no mission in these databases localized after a forecast\n")
    table = by_place(said)
    print(markdown(table))
    made = figures(said)
    write(given.out, "forecast", "Forecasts", begun, made, tables=[table], page="sensor-faults.md#demo-missions")


if __name__ == "__main__":
    main()
