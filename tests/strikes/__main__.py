"""A pilot strikes at a real autopilot (or its firmware's own simulator) while this program steers it.

    make fly-real VEHICLE=udpin://127.0.0.1:14540
    python -m tests.strikes udpin://127.0.0.1:14540 --flavour px4 --times 96 --delays 0 80 250

It takes off and flies some 70 m around its home at 12 m. The pilot takes over by mode switch and, where the autopilot
lets them, by sticks, aimed at the commands that steer: under way on the link, or given before the takeover is known
here. Prints a line a takeover, then one JSON object; ends with status 1 when one was undone or not noticed.

--orders aims at what has to select a mode (hold out of a return, return, landing; ArduCopter's steering after a hold)
instead. No autopilot carries that
out on the condition that nobody switched: such a takeover may be undone, and must be noticed within a second.
"""

from __future__ import annotations

import argparse
import asyncio
import contextlib
import json
import math
import random
import sys
import time
from pathlib import Path

from hardware.autopilot.connect import connect_vehicle
from hardware.clock import WallClock
from hardware.ports import VehicleError
from tests.benchmarks.figures.circumstances import begin
from tests.benchmarks.figures.writer import add_out, write
from tests.strikes.pilot import piloted
from tests.strikes.proxy import proxied
from tests.strikes.scenes import MANOEUVRES, MOMENTS, ORDERS, SCENES, Field, Scene
from tests.strikes.strike import Means, Moment, Outcome, ready
from tests.strikes.tally import figures, line, summary, table, unnoticed

Planned = tuple[float, Scene, Moment, Means]


async def run(given: argparse.Namespace) -> tuple[list[Outcome], list[str]]:
    """The outcomes; and takeovers that were told though nobody struck. Several vehicles fly at once, a share each."""
    planned = _order(given)
    outcomes, by_nobody = list[Outcome](), list[str]()
    async with asyncio.TaskGroup() as flying:
        for number, url in enumerate(given.vehicle):
            share = planned[number :: len(given.vehicle)]
            flying.create_task(_fly(given, number, url, share, outcomes, by_nobody))
    return outcomes, by_nobody


async def _fly(
    given: argparse.Namespace,
    number: int,
    url: str,
    share: list[Planned],
    outcomes: list[Outcome],
    by_nobody: list[str],
) -> None:
    end_s = time.monotonic() + 60.0 * given.minutes
    rc = given.rc[number] if given.rc else None
    async with proxied(url) as proxy, piloted(proxy, given.flavour, rc) as pilot:
        vehicle = await connect_vehicle(proxy.url, WallClock())
        field = Field(vehicle, proxy, pilot, random.Random(given.seed + number))
        try:
            await ready(vehicle)
            vehicle.take_control()
            for delay_s, scene, moment, means in share:
                if time.monotonic() > end_s:
                    break
                proxy.delay_s = delay_s
                try:
                    outcome = await field.strike(scene, moment, means)
                except (TimeoutError, VehicleError) as error:
                    print(f"{scene}, {moment}: did not come about: {error}", flush=True)
                    continue
                outcomes.append(outcome)
                print(line(outcome, pilot.flies), flush=True)
        finally:
            proxy.delay_s = 0.0
            by_nobody += field.by_nobody
            with contextlib.suppress(VehicleError):
                vehicle.take_control()
                await vehicle.land()
            await vehicle.close()
            if given.record is not None:
                with given.record.open("a") as record:
                    record.writelines(f"{json.dumps(vars_of(passed))}\n" for passed in proxy.record)


def vars_of(passed: object) -> list[object]:
    return [getattr(passed, name) for name in ("at_s", "way", "number", "fields")]


def _order(given: argparse.Namespace) -> list[Planned]:
    """Delays, scenes and means mixed evenly, so that a run cut short is still balanced; moments taken in turn."""
    mixed: list[tuple[float, Scene, Means]] = [
        (delay / 1000.0, scene, means) for scene in given.scenes for means in given.means for delay in given.delays
    ]
    rounds: list[Planned] = [
        (delay_s, scene, MOMENTS[scene][number % len(MOMENTS[scene])], means)
        for number in range(given.times // len(mixed) + 1)
        for delay_s, scene, means in mixed
    ]
    return rounds[: given.times]


def address(text: str) -> tuple[str, int]:
    """HOST:PORT. Raises ValueError for anything else."""
    host, _, port = text.rpartition(":")
    return host, int(port)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("vehicle", nargs="+", help="its address, as `crossfix serve --vehicle` takes it")
    parser.add_argument("--flavour", choices=("px4", "ardupilot"), default="px4")
    parser.add_argument(
        "--rc", nargs="+", type=address, default=[], metavar="HOST:PORT",
        help="where ArduPilot's simulator listens for a transmitter (127.0.0.1:5501), one a vehicle, with FLTMODE4 17 "
        "and FLTMODE5 5; else the pilot is a second ground station",
    )  # fmt: skip
    parser.add_argument("--times", type=int, default=48)
    parser.add_argument("--minutes", type=float, default=math.inf, help="begin no takeover after so long")
    parser.add_argument("--delays", type=float, nargs="+", default=[0.0, 80.0, 250.0], help="ms each way")
    parser.add_argument("--scenes", nargs="+", choices=SCENES, default=list(MANOEUVRES))
    parser.add_argument("--orders", action="store_true", help="aim at orders that have to select a mode")
    parser.add_argument("--means", nargs="+", choices=("mode", "sticks"), default=None)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--record", type=Path, help="write what passed, a JSON line each")
    add_out(parser)
    given = parser.parse_args()
    if given.rc and len(given.rc) != len(given.vehicle):
        parser.error(f"--rc: {len(given.vehicle)} vehicles need as many transmitters, not {len(given.rc)}.")
    if given.flavour == "ardupilot":
        given.scenes = [scene for scene in given.scenes if scene != "stay"]  # its hold is one order
    given.means = given.means or (["mode", "sticks"] if given.flavour == "px4" else ["mode"])
    if given.orders:
        given.scenes = [scene for scene in ORDERS if given.flavour == "ardupilot" or scene != "steering ordered"]
    begun = begin(__file__)
    outcomes, by_nobody = asyncio.run(run(given))
    print(json.dumps(summary(outcomes) | {"by_nobody": by_nobody}, indent=2))
    title = f"Takeovers of a real autopilot{' that meet orders of a mode' if given.orders else ''}, {given.flavour}"
    page = "faults-in-flight.md#real-autopilots"
    found = figures(outcomes, given.flavour, len(by_nobody), given.orders)
    if outcomes:
        name = f"strikes_{'orders_' if given.orders else ''}{given.flavour}"
        write(given.out, name, title, begun, found, tables=[table(outcomes)], page=page)
    failed = any(
        outcome.counts and (unnoticed(outcome) or (outcome.undone and not given.orders)) for outcome in outcomes
    )
    sys.exit(failed or bool(by_nobody))


if __name__ == "__main__":
    main()
