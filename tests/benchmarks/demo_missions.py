"""Whole missions of the demo: how true is what they claim, and how soon do they claim it?

    python -m tests.benchmarks.demo_missions --missions 20

`crossfix demo` for each, in a process of its own: real sockets, the real server, the simulated autopilot, SQLite. PX4
and ArduCopter in turn. Prints where their databases are, for tests.benchmarks.forecast.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import math
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from tests.benchmarks.figures.circumstances import begin
from tests.benchmarks.figures.pages import markdown
from tests.benchmarks.figures.record import Column, Figure, Table
from tests.benchmarks.figures.writer import add_out, plain, wanted, write

FLAVOURS = ("px4", "ardupilot")


@dataclass(frozen=True, slots=True)
class Flown:
    """As `crossfix demo --json` tells it; times of the mission in seconds."""

    seed: int
    localized: bool
    in_c95: bool
    error_m: float
    stated_m: float
    time_s: float
    bearings: int
    bearing_errors_deg: tuple[float, ...]
    bearing_sigmas_deg: tuple[float, ...]
    plan_ms: tuple[float, ...]
    holds: int
    database: str


async def fly(seed: int, flavour: str, speedup: float) -> Flown:
    """Raises RuntimeError for a mission that tells nothing."""
    command = [str(Path(sys.executable).with_name("crossfix")), "demo", "--headless", "--json"]
    command += ["--seed", str(seed), "--flavour", flavour, "--speedup", f"{speedup:g}"]
    process = await asyncio.create_subprocess_exec(
        *command, stdout=asyncio.subprocess.PIPE, stderr=asyncio.subprocess.PIPE
    )
    out, said = await process.communicate()
    if not out.strip():
        raise RuntimeError(f"seed {seed} told nothing: {said.decode()[-400:]}")
    told = json.loads(out)
    return Flown(
        seed,
        told["localized"],
        told["in_c95"],
        told["error_m"],
        told["expected_rmse_m"],
        told["mission_time_s"],
        told["bearings"],
        tuple(told["bearing_errors_deg"]),
        tuple(told["bearing_sigmas_deg"]),
        tuple(told["plan_ms"]),
        len(told["holds"]),
        told["database"],
    )


async def fly_all(seeds: Sequence[int], speedup: float, at_once: int) -> list[Flown]:
    free = asyncio.Semaphore(at_once)

    async def one(number: int, seed: int) -> Flown:
        async with free:
            flown = await fly(seed, FLAVOURS[number % len(FLAVOURS)], speedup)
        print(f"{seed}: {flown.time_s:.0f} s, {flown.error_m:.1f} m, {flown.database}", file=sys.stderr, flush=True)
        return flown

    return list(await asyncio.gather(*(one(number, seed) for number, seed in enumerate(seeds))))


def spread(flown: Sequence[Flown]) -> Table:
    quantities = {
        "error, m": [one.error_m for one in flown],
        "expected error the mission stated, m": [one.stated_m for one in flown],
        "time from start to localized, s": [one.time_s for one in flown if one.localized],
        "bearings": [one.bearings for one in flown],
        "one plan, ms, beside all else": [ms for one in flown for ms in one.plan_ms],
    }
    names = ("", "least", "median", "90 %", "most", "mean")
    rows = tuple(
        (name, *(round(float(q), 1) for q in (*np.percentile(values, [0, 50, 90, 100]), np.mean(values))))
        for name, values in quantities.items()
    )
    return Table(name="spread", columns=tuple(Column(name=name) for name in names), rows=rows)


def figures(flown: Sequence[Flown]) -> list[Figure]:
    localized = [one for one in flown if one.localized]
    errors = [error for one in flown for error in one.bearing_errors_deg]
    stated = [sigma for one in flown for sigma in one.bearing_sigmas_deg]
    held = f"{sum(one.in_c95 for one in localized)} of {len(localized)}"
    rms = math.sqrt(float(np.mean(np.square(stated))))
    return [
        plain("missions localized", len(localized), "", note=f"of {len(flown)}, PX4 and ArduCopter flavour in turn"),
        plain("missions held on the way", sum(one.holds > 0 for one in flown), ""),
        plain("truth in C95", 100.0 * sum(one.in_c95 for one in localized) / len(localized), "%", note=held),
        plain("error, median", float(np.median([one.error_m for one in flown])), "m"),
        plain("expected error stated, median", float(np.median([one.stated_m for one in flown])), "m"),
        wanted("demo_time", float(np.mean([one.time_s for one in localized])), note=f"{len(localized)} missions"),
        plain("bearings, mean", float(np.mean([one.bearings for one in flown])), ""),
        plain(
            "bearing error, RMS",
            math.sqrt(float(np.mean(np.square(errors)))),
            "deg",
            note=f"{len(errors)} bearings; {rms:.1f} stated; {np.mean(errors):.1f} on average",
        ),
        plain("one plan, beside all else, median", float(np.median([ms for one in flown for ms in one.plan_ms])), "ms"),
    ]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--missions", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1, help="of the first")
    parser.add_argument("--speedup", type=float, default=5.0)
    parser.add_argument("--at-once", type=int, default=1)
    add_out(parser)
    given = parser.parse_args()
    begun = begin(__file__)
    seeds = range(given.seed, given.seed + given.missions)
    flown = asyncio.run(fly_all(seeds, given.speedup, given.at_once))
    table = spread(flown)
    print(markdown(table))
    print(" ".join(one.database for one in flown))
    page = "sensor-faults.md#demo-missions"
    write(given.out, "demo_missions", "Demo missions", begun, figures(flown), tables=[table], page=page)


if __name__ == "__main__":
    main()
