"""Turns as far as needed beside whole ones on a real autopilot, from the same seeds: minutes, degrees, energy, truth.

    python -m tests.strikes.turns udpin://127.0.0.1:14540 --flavour px4 --pairs 3

Each seed has its own emitter and is flown twice. Prints a line a mission, then one JSON object; ends with status 1 when
a mission failed or claimed a place that is not so.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import statistics
import sys
from collections.abc import Sequence

from tests.benchmarks.figures.circumstances import begin
from tests.benchmarks.figures.record import Column, Figure, Table
from tests.benchmarks.figures.writer import add_out, plain, write
from tests.strikes.missions import Flown, line, one

TURNS = {"whole": False, "as far as needed": True}
"""In words, and as `sensor.sector_turns` says it."""


def figures(flights: dict[str, list[Flown]]) -> list[Figure]:
    found = list[Figure]()
    for turns, flown in flights.items():
        if not flown:
            continue
        note = f"{turns}; {len(flown)} missions"
        drawn = [flight.drawn_mah for flight in flown if flight.drawn_mah is not None]
        found += [
            plain(f"turns {turns}: localized", sum(f.localized for f in flown), "", note=note),
            plain(f"turns {turns}: truth in C95", sum(bool(f.in_c95) for f in flown), "", note=note),
            plain(f"turns {turns}: time, mean", statistics.fmean(f.took_s for f in flown), "s", note=note),
            plain(
                f"turns {turns}: turned, mean",
                statistics.fmean(flight.turned_deg for flight in flown),
                "deg",
                note=note,
            ),
        ]
        if drawn:
            found.append(plain(f"turns {turns}: charge drawn, mean", statistics.fmean(drawn), "mAh", note=note))
    return found


def table(flights: dict[str, list[Flown]]) -> Table:
    columns = (
        Column(name="seed"),
        Column(name="turns"),
        Column(name="outcome"),
        Column(name="time, s", decimals=0),
        Column(name="turned, deg", decimals=0),
        Column(name="drawn, mAh", decimals=0),
        Column(name="bearings"),
        Column(name="error, m", decimals=1),
        Column(name="stated, m", decimals=1),
    )
    rows = tuple(
        (
            flight.seed,
            turns,
            flight.failed or flight.outcome,
            flight.took_s,
            flight.turned_deg,
            flight.drawn_mah,
            len(flight.bearing_errors_deg),
            flight.error_m,
            flight.stated_m,
        )
        for pair in zip(*flights.values(), strict=False)
        for turns, flight in zip(flights, pair, strict=True)
    )
    return Table(name="missions", columns=columns, rows=rows)


async def run(given: argparse.Namespace) -> dict[str, list[Flown]]:
    flights: dict[str, list[Flown]] = {turns: [] for turns in TURNS}
    for number in range(given.pairs):
        for turns, sector in TURNS.items():
            changes = {"sensor": {"sector_turns": sector}}
            flights[turns].append(await one(given.vehicle, given.seed + number, given.delay / 1e3, changes))
            print(f"{turns}: {line(flights[turns][-1])}", flush=True)
        title = f"Turns as far as needed on a real autopilot, {given.flavour}"
        tables = [table(flights)]
        page = "faults-in-flight.md#real-autopilots"
        write(given.out, f"turns_{given.flavour}", title, given.begun, figures(flights), tables=tables, page=page)
    return flights


def every(flights: dict[str, list[Flown]]) -> Sequence[Flown]:
    return [flight for flown in flights.values() for flight in flown]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("vehicle", help="its address, as `crossfix serve --vehicle` takes it")
    parser.add_argument("--flavour", choices=("px4", "ardupilot"), default="px4")
    parser.add_argument("--pairs", type=int, default=3)
    parser.add_argument("--seed", type=int, default=1, help="of the first pair")
    parser.add_argument("--delay", type=float, default=0.0, help="ms each way")
    add_out(parser)
    given = parser.parse_args()
    given.begun = begin(__file__)
    flights = asyncio.run(run(given))
    print(json.dumps([figure.model_dump(exclude_defaults=True) for figure in figures(flights)], indent=2))
    sys.exit(any(flight.failed or flight.false for flight in every(flights)))


if __name__ == "__main__":
    main()
