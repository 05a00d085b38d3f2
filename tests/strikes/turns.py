"""Ways to turn and listen beside one another on a real autopilot, from the same seeds: minutes, degrees, energy, truth,
and what the nose does when it is asked to swing in flight.

    python -m tests.strikes.turns udpin://127.0.0.1:14540 --flavour px4 --pairs 3
    python -m tests.strikes.turns udpin://127.0.0.1:14540 --flavour px4 --pairs 3 --beside swings
    python -m tests.strikes.turns udpin://127.0.0.1:14540 --flavour px4 --pairs 5 --beside new --delays 0 80

Each seed has its own emitter and is flown twice: with whole turns and a still nose, and as `--beside` says. Prints a
line a mission, then one JSON object; ends with status 1 when a mission failed or claimed a place that is not so.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import statistics
import sys
from collections.abc import Sequence

from backend.events.bearings import WHOLE_DEG
from tests.benchmarks.figures.circumstances import begin
from tests.benchmarks.figures.record import Column, Figure, Table
from tests.benchmarks.figures.writer import add_out, plain, write
from tests.strikes.missions import IN_WORDS, Flown, line, one

WHOLE = "whole"
STILL = {"sector_turns": False, "listen_on_the_way": False, "swing_on_the_way": False, "never_stop": False}
"""What `sensor` of a mission says of whole turns and a still nose, whatever new missions do."""
LISTENS = {"listen_on_the_way": True, "swing_on_the_way": True}
BESIDE: dict[str, tuple[str, str, dict[str, bool]]] = {
    "sectors": ("turns", "as far as needed", STILL | {"sector_turns": True}),
    "swings": ("swings", "whole, nose swung on the way", STILL | LISTENS),
    "new": ("new", "as in new missions", STILL | {"sector_turns": True} | LISTENS),
}
"""The record, in words, and as `sensor` says it."""


def figures(flights: dict[str, list[Flown]]) -> list[Figure]:
    found = list[Figure]()
    for turns, begun in flights.items():
        flown = [flight for flight in begun if not flight.failed]
        if len(flown) < len(begun):
            found.append(plain(f"turns {turns}: not flown to the end", len(begun) - len(flown), "", note=turns))
        if not flown:
            continue
        note = f"{turns}; {len(flown)} missions"
        drawn = [flight.drawn_mah for flight in flown if flight.drawn_mah is not None]
        found += [
            plain(f"turns {turns}: localized", sum(f.localized for f in flown), "", note=note),
            plain(f"turns {turns}: truth in C95", sum(bool(f.in_c95) for f in flown), "", note=note),
            plain(f"turns {turns}: time, mean", statistics.fmean(f.took_s for f in flown), "s", note=note),
            plain(f"turns {turns}: of it planning, mean", statistics.fmean(f.planned_s for f in flown), "s", note=note),
            plain(
                f"turns {turns}: turned, mean",
                statistics.fmean(flight.turned_deg for flight in flown),
                "deg",
                note=note,
            ),
        ]
        speeds = [flight.speed_m_s for flight in flown if flight.speed_m_s is not None]
        if speeds:
            found.append(plain(f"turns {turns}: speed over ground, mean", statistics.fmean(speeds), "m/s", note=note))
        turns_made = [deg for flight in flown for deg in flight.turns_deg]
        if turns_made:
            of = f"{len(turns_made)} turns of {note}"
            less = sum(deg < WHOLE_DEG for deg in turns_made)
            found += [
                plain(f"turns {turns}: that went less than all the way round", less, "", note=of),
                plain(f"turns {turns}: degrees of a turn, median", statistics.median(turns_made), "deg", note=of),
            ]
        tilts = [flight.tilt_deg for flight in flown if flight.tilt_deg is not None]
        if tilts:
            found.append(plain(f"turns {turns}: tilt, at most", max(tilts), "deg", note=f"{note}; 99 % of the time"))
        legs = [leg for flight in flown for leg in flight.nose]
        if legs:
            of = f"{len(legs)} legs"
            left = sum(leg.end in ("lags", "refused") for leg in legs)
            found += [
                plain(f"turns {turns}: sides that the nose came to", sum(leg.swung for leg in legs), "", note=of),
                plain(f"turns {turns}: nose, mean", statistics.fmean(leg.rate_deg_s for leg in legs), "deg/s", note=of),
                plain(f"turns {turns}: nose behind, at most", max(leg.lag_deg for leg in legs), "deg", note=of),
                plain(f"turns {turns}: legs on which it did not follow or was refused", left, "", note=of),
            ]
        if drawn:
            found.append(plain(f"turns {turns}: charge drawn, mean", statistics.fmean(drawn), "mAh", note=note))
    return found


def table(flights: dict[str, list[Flown]]) -> Table:
    columns = (
        Column(name="seed"),
        Column(name="delay each way, ms"),
        Column(name="turns"),
        Column(name="outcome"),
        Column(name="time, s", decimals=0),
        Column(name="of it planning, s", decimals=0),
        Column(name="turned, deg", decimals=0),
        Column(name="drawn, mAh", decimals=0),
        Column(name="speed, m/s", decimals=1),
        Column(name="tilt, deg", decimals=0),
        Column(name="legs swung"),
        Column(name="nose behind, deg", decimals=0),
        Column(name="bearings"),
        Column(name="degrees of each turn"),
        Column(name="error, m", decimals=1),
        Column(name="stated, m", decimals=1),
        Column(name="in C95"),
    )
    rows = tuple(
        (
            flight.seed,
            round(flight.delay_s * 1e3),
            turns,
            flight.failed or flight.outcome,
            flight.took_s,
            flight.planned_s,
            flight.turned_deg,
            flight.drawn_mah,
            flight.speed_m_s,
            flight.tilt_deg,
            len(flight.nose),
            max((leg.lag_deg for leg in flight.nose), default=None),
            len(flight.bearing_errors_deg),
            ", ".join(f"{deg:.0f}" for deg in flight.turns_deg),
            flight.error_m,
            flight.stated_m,
            IN_WORDS[flight.in_c95],
        )
        for pair in zip(*flights.values(), strict=False)
        for turns, flight in zip(flights, pair, strict=True)
    )
    return Table(name="missions", columns=columns, rows=rows)


async def run(given: argparse.Namespace) -> dict[str, list[Flown]]:
    record, words, wanted = BESIDE[given.beside]
    both = {WHOLE: STILL, words: wanted}
    flights: dict[str, list[Flown]] = {turns: [] for turns in both}
    for number in range(given.pairs):
        delay_s = given.delays[number % len(given.delays)] / 1e3
        for turns, sensor in both.items():
            flights[turns].append(await one(given.vehicle, given.seed + number, delay_s, {"sensor": sensor}))
            print(f"{turns}: {line(flights[turns][-1])}", flush=True)
        title = f"Turns {words}, on a real autopilot, {given.flavour}"
        tables = [table(flights)]
        page = "faults-in-flight.md#real-autopilots"
        write(given.out, f"{record}_{given.flavour}", title, given.begun, figures(flights), tables=tables, page=page)
    return flights


def every(flights: dict[str, list[Flown]]) -> Sequence[Flown]:
    return [flight for flown in flights.values() for flight in flown]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("vehicle", help="its address, as `crossfix serve --vehicle` takes it")
    parser.add_argument("--flavour", choices=("px4", "ardupilot"), default="px4")
    parser.add_argument("--beside", choices=sorted(BESIDE), default="sectors", help="what whole turns are held against")
    parser.add_argument("--pairs", type=int, default=3)
    parser.add_argument("--seed", type=int, default=1, help="of the first pair")
    parser.add_argument("--delays", type=float, nargs="+", default=[0.0], help="ms each way, of the pairs in turn")
    add_out(parser)
    given = parser.parse_args()
    given.begun = begin(__file__)
    flights = asyncio.run(run(given))
    print(json.dumps([figure.model_dump(exclude_defaults=True) for figure in figures(flights)], indent=2))
    sys.exit(any(flight.failed or flight.false for flight in every(flights)))


if __name__ == "__main__":
    main()
