"""How wrong are headings while the vehicle turns, behind a late radio and with a clock that is not ours?

    python -m tests.benchmarks.heading_time

Simulated PX4 in real time, three turns at 30 degrees a second each: what the vehicle link says of the nose at a
moment against where it truly was. Each case is a constant delay each way and a rate of the autopilot's clock. Prints
one JSON object; ends with status 1 when a median is above 0.5 degrees.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import math
import sys
from dataclasses import dataclass

import numpy as np

from hardware.autopilot.connect import connect_vehicle
from hardware.clock import WallClock
from hardware.readings import HeadingSample
from hardware.sim.autopilot.launch import Setting, SimulatedAutopilot, launch_simulated
from tests.benchmarks.figures.circumstances import begin
from tests.benchmarks.figures.record import Figure
from tests.benchmarks.figures.writer import add_out, plain, write

RATE_DEG_S = 30.0
LONGEST_ASKED_S = 0.01
"""An answer of the simulator that took longer says too little of when the nose was there."""


@dataclass(frozen=True, slots=True)
class Case:
    name: str
    delay_s: float = 0.0
    clock_rate: float = 1.0


CASES = (
    Case("plain"),
    Case("150 ms each way", delay_s=0.15),
    Case("clock at 0.98", clock_rate=0.98),
    Case("both", delay_s=0.15, clock_rate=0.98),
)


async def truth_of(
    sim: SimulatedAutopilot, clock: WallClock, rate: float, until: asyncio.Task[None]
) -> list[tuple[float, float]]:
    """(UTC, degrees) as often as it can be asked for. The simulator steps: what it tells is of its time since boot."""
    asked: list[tuple[float, float, float]] = []
    while not until.done():
        asked_s = clock.now()
        told = await sim.order("truth")
        answered_s = clock.now()
        if answered_s - asked_s < LONGEST_ASKED_S:
            asked.append((told["time_s"] / rate, told["heading_deg"], 0.5 * (asked_s + answered_s)))
        await asyncio.sleep(0.02)
    offset_s = min(at_s - boot_s for boot_s, _, at_s in asked)
    return [(boot_s + offset_s, heading_deg) for boot_s, heading_deg, _ in asked]


def errors_deg(samples: list[HeadingSample], truth: list[tuple[float, float]]) -> list[float]:
    """Told minus true."""
    nose = np.unwrap([sample.heading_deg for sample in samples], period=360.0)
    told = np.interp([at for at, _ in truth], [sample.at_s for sample in samples], nose)
    return [math.remainder(a - b, 360.0) for a, (_, b) in zip(told, truth, strict=True)]


async def fly(case: Case) -> list[float]:
    """Errors in degrees, over all turns."""
    clock, found = WallClock(), list[float]()
    sim = await launch_simulated(Setting(link_delay_s=case.delay_s, clock_rate=case.clock_rate, seed=4))
    try:
        vehicle = await connect_vehicle(sim.url, clock)
        try:
            await asyncio.sleep(8.0)
            await vehicle.take_off(10.0)
            for _ in range(3):
                began_s = clock.now()
                turn = asyncio.create_task(vehicle.turn(RATE_DEG_S))
                truth = await truth_of(sim, clock, case.clock_rate, turn)
                await turn
                await asyncio.sleep(1.0)
                found += errors_deg(vehicle.headings(began_s - 2.0), truth)
                await asyncio.sleep(10.0)
        finally:
            await vehicle.close()
    finally:
        await sim.stop()
    return found


async def run() -> dict[str, dict[str, float]]:
    flown = await asyncio.gather(*(fly(case) for case in CASES))
    return {
        case.name: {
            "median_deg": round(float(np.median(np.abs(errors))), 2),
            "p95_deg": round(float(np.percentile(np.abs(errors), 95)), 2),
            "compared": len(errors),
        }
        for case, errors in zip(CASES, flown, strict=True)
    }


def figures(found: dict[str, dict[str, float]]) -> list[Figure]:
    note = f"three turns at {RATE_DEG_S:g} degrees a second"
    return [
        plain(f"heading error, {which}: {name}", values[key], "deg", note=note)
        for name, values in found.items()
        for key, which in (("median_deg", "median"), ("p95_deg", "95 %"))
    ]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add_out(parser)
    given = parser.parse_args()
    begun = begin(__file__)
    result = asyncio.run(run())
    print(json.dumps(result, indent=2))
    title = "Headings behind a late radio and by a clock that is not ours (simulated)"
    write(given.out, "heading_time", title, begun, figures(result), page="faults-in-flight.md#headings-in-time")
    sys.exit(any(values["median_deg"] > 0.5 for values in result.values()))


if __name__ == "__main__":
    main()
