"""Did "localized in about ..." come true? Every plan of flown missions beside what then happened.

    python -m tests.benchmarks.forecast data/crossfix.sqlite [more databases]

Only missions that localized count; times in seconds of the mission.
"""

from __future__ import annotations

import json
import sqlite3
import statistics
import sys
from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Said:
    place_number: int
    mean_s: float
    p90_s: float
    happened_s: float


def said_in(database: str) -> list[Said]:
    """Forecasts of the database's localized missions; the last word before each flight counts."""
    with sqlite3.connect(f"file:{database}?mode=ro", uri=True) as connection:
        rows = connection.execute(
            "SELECT mission_id, at_us / 1e6, kind, body FROM events "
            "WHERE kind IN ('plan_chosen', 'belief_updated') ORDER BY mission_id, seq"
        ).fetchall()
    plans: dict[str, list[tuple[float, dict]]] = defaultdict(list)
    localized: dict[str, float] = {}
    for mission, at_s, kind, body in rows:
        fact = json.loads(body)
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


def report(said: Iterable[Said]) -> None:
    by_place: dict[int, list[Said]] = defaultdict(list)
    for one in said:
        by_place[one.place_number].append(one)
    print("place   plans  expected, s  happened, s  happened/expected  within the 90 % figure")
    for number, ones in sorted(by_place.items()):
        ratio = statistics.median(one.happened_s / one.mean_s for one in ones)
        within = sum(one.happened_s <= one.p90_s for one in ones) / len(ones)
        expected = statistics.fmean(one.mean_s for one in ones)
        happened = statistics.fmean(one.happened_s for one in ones)
        print(f"{number:5} {len(ones):7} {expected:12.0f} {happened:12.0f} {ratio:18.2f} {within:23.2f}")


if __name__ == "__main__":
    report([one for database in sys.argv[1:] for one in said_in(database)])
