"""Takeovers aimed at the commands of a manoeuvre: is a pilot's switch ever undone, and is it ever unnoticed?

    python -m tests.benchmarks.takeover_aimed --flavour px4 --times 200
    python -m tests.benchmarks.takeover_aimed --flavour ardupilot --times 200

A simulated vehicle alone, in real time, behind a radio of 0, 80 and 250 ms each way. The pilot strikes while it
steers (flight and turn: at moments around a command), takes off or returns, on PX4 every other time with the sticks. An
order that selects a mode (also the one for steering, after the vehicle was given back in another) is awaited before:
no autopilot carries it out on the condition that nobody switched meanwhile.
Undone: a second later the vehicle is in another mode than the pilot's. Unnoticed: a second later we do not know that
somebody else has control, or a flight command left later than that. Prints one JSON object; ends with status 1 when one
was undone or unnoticed.
"""

from __future__ import annotations

import argparse
import asyncio
import contextlib
import json
import random
import sys
from collections import Counter
from dataclasses import dataclass, field
from typing import Any

from hardware.autopilot.connect import connect_vehicle
from hardware.autopilot.vehicle import MavsdkVehicle
from hardware.clock import WallClock
from hardware.frame import LocalFrame
from hardware.ports import VehicleError
from hardware.readings import Place
from hardware.sim.autopilot.launch import Setting, SimulatedAutopilot, launch_simulated
from tests.benchmarks.figures.circumstances import begin
from tests.benchmarks.figures.record import Figure
from tests.benchmarks.figures.writer import add_out, plain, write

DELAYS_S = (0.0, 0.08, 0.25)
MANOEUVRES = ("flight", "turn", "flight", "turn", "take_off", "return")
"""Steering twice as often: it is many commands, an order is one."""
ORDERED_BEFORE_S = 1.0
"""An order of a person is one command; the pilot strikes once it was carried out. Steering goes on all the time."""
NOTICED_S = 1.0
HEIGHT_M = 12.0
FLIGHT_COMMANDS = {20, 21, 22, 115, 176, 178, 192, 400}


@dataclass
class Score:
    struck: Counter[str] = field(default_factory=Counter[str])
    undone: list[str] = field(default_factory=list[str])
    unnoticed: list[str] = field(default_factory=list[str])
    flown: int = 0
    """Vehicles that have made their share."""


@dataclass
class Trial:
    """One simulated vehicle after the other takeover; `chance` decides when."""

    flavour: str
    delay_s: float
    chance: random.Random
    vehicle: MavsdkVehicle
    sim: SimulatedAutopilot
    home: Place
    count: int = 0

    @property
    def steered(self) -> str:
        return "HOLD" if self.flavour == "px4" else "GUIDED"

    async def ready(self, in_air: bool) -> None:
        """Ours, and hovering at home or standing there."""
        await self.sim.order("battery", percent=100)
        if (await self.sim.order("truth"))["mode"] not in ("HOLD", "GUIDED"):
            await self.sim.order("give_back")
            await asyncio.sleep(2.0)
        self.vehicle.take_control()
        if not in_air:
            await self.vehicle.land()
            async with asyncio.timeout(90):
                while self.vehicle.telemetry().armed is not False:  # noqa: ASYNC110 (another process)
                    await asyncio.sleep(0.2)
            self.vehicle.take_control()
        elif not self.vehicle.telemetry().in_air:
            await self.vehicle.take_off(HEIGHT_M)

    async def manoeuvre(self, name: str) -> None:
        if name == "take_off":
            await self.vehicle.take_off(60.0)
        elif name == "return":
            await self.vehicle.return_home()
        elif name == "turn":
            await self.vehicle.turn(60.0)
        else:
            while True:
                there = LocalFrame(self.home).to_geo(self.chance.uniform(-4.0, 4.0), self.chance.uniform(-4.0, 4.0))
                amsl = (self.vehicle.telemetry().home_amsl_m or 0.0) + HEIGHT_M
                leg = asyncio.create_task(self.vehicle.goto(there, amsl, 5.0))
                try:
                    await asyncio.wait((leg,), timeout=0.5)  # the next place comes before it arrives: many commands
                    if leg.done():
                        leg.result()
                finally:
                    leg.cancel()
                    with contextlib.suppress(asyncio.CancelledError):
                        await leg

    async def strike(self, name: str, score: Score) -> None:
        """Begin the manoeuvre, let the pilot take over, and look a second later."""
        await self.ready(in_air=name != "take_off")
        flown = asyncio.create_task(self.manoeuvre(name))
        order = name in ("take_off", "return")
        if order:
            ordered = {"take_off": (22,), "return": (20, 176)}[name]
            async with asyncio.timeout(60):
                while not await self._received(ordered):  # noqa: ASYNC110 (another process)
                    await asyncio.sleep(0.05)
        else:
            async with asyncio.timeout(20):
                while self.vehicle.telemetry().mode != self.steered:  # noqa: ASYNC110 (known here: not selected again)
                    await asyncio.sleep(0.02)
            await asyncio.sleep(self.delay_s)  # a selection that was repeated until then has arrived
        await asyncio.sleep((ORDERED_BEFORE_S if order else 0.2) + self.chance.uniform(0.0, 1.2))
        self.count += 1
        sticks = self.flavour == "px4" and self.count % 2 == 0
        at_s, mode = await self._take_over(sticks)
        await asyncio.sleep(NOTICED_S)
        noticed = self.vehicle.telemetry().authority.who in ("pilot", "failsafe")
        await asyncio.sleep(2.0 * self.delay_s)
        truth = await self.sim.order("truth")
        what = f"{name} by {'sticks' if sticks else 'switch'} at {1e3 * self.delay_s:.0f} ms"
        score.struck[name] += 1
        if truth["mode"] != mode:
            score.undone.append(what)
        if not noticed or await self._commanded_since(at_s + NOTICED_S + 2.0 * self.delay_s):
            score.unnoticed.append(what)
        flown.cancel()
        await asyncio.gather(flown, return_exceptions=True)

    async def _received(self, numbers: tuple[int, ...]) -> bool:
        since = (await self.sim.order("ping"))["time_s"] - 5.0
        told = (await self.sim.order("commands", since_s=since))["commands"]
        return any(number in numbers for _, number in told)

    async def _take_over(self, sticks: bool) -> tuple[float, str]:
        if sticks:
            took = await self.sim.order("pilot_sticks", north_m_s=0.3)
            if took["took_control"]:
                return took["time_s"], took["mode"]
        took = await self.sim.order("pilot_mode")
        return took["time_s"], took["mode"]

    async def _commanded_since(self, at_s: float) -> bool:
        told = (await self.sim.order("commands", since_s=at_s))["commands"]
        return any(number in FLIGHT_COMMANDS for _, number in told)


async def one_vehicle(flavour: str, delay_s: float, times: int, seed: int, score: Score, done: asyncio.Event) -> None:
    """Stays connected until all are done."""
    sim = await launch_simulated(Setting(flavour=flavour, seed=seed, link_delay_s=delay_s))
    vehicle = await connect_vehicle(sim.url, WallClock())
    try:
        await asyncio.sleep(12.0)
        home = vehicle.telemetry().home
        assert home is not None
        trial = Trial(flavour, delay_s, random.Random(seed), vehicle, sim, home)
        for number in range(times):
            with contextlib.suppress(VehicleError, TimeoutError):  # a try that one before spoiled does not count
                await trial.strike(MANOEUVRES[(number + seed) % len(MANOEUVRES)], score)
        score.flown += 1
        await done.wait()
    finally:
        await vehicle.close()
        await sim.stop()


async def run(flavour: str, times: int, vehicles: int, seed: int) -> dict[str, Any]:
    score, done = Score(), asyncio.Event()
    shares = [times // vehicles + (number < times % vehicles) for number in range(vehicles)]
    flights = [
        asyncio.create_task(one_vehicle(flavour, DELAYS_S[number % len(DELAYS_S)], share, seed + number, score, done))
        for number, share in enumerate(shares)
    ]
    while score.flown < vehicles and not any(flight.done() for flight in flights):  # noqa: ASYNC110 (ends when one broke, too)
        await asyncio.sleep(0.5)
    done.set()
    await asyncio.gather(*flights)
    return {
        "flavour": flavour,
        "takeovers": sum(score.struck.values()),
        "in": dict(score.struck.most_common()),
        "undone": len(score.undone),
        "unnoticed": len(score.unnoticed),
        "which": sorted([*score.undone, *score.unnoticed]),
    }


def figures(found: dict[str, Any]) -> list[Figure]:
    note = f"of {found['takeovers']} aimed, at 0, 80 and 250 ms each way"
    return [
        plain("undone", found["undone"], "", note=note),
        plain("unnoticed for 1 s", found["unnoticed"], "", note=note),
        *(plain(f"struck in {name}", count, "") for name, count in found["in"].items()),
    ]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--flavour", choices=("px4", "ardupilot"), default="px4")
    parser.add_argument("--times", type=int, default=60)
    parser.add_argument("--vehicles", type=int, default=6, help="flown at once")
    parser.add_argument("--seed", type=int, default=3)
    add_out(parser)
    given = parser.parse_args()
    begun = begin(__file__)
    result = asyncio.run(run(given.flavour, given.times, given.vehicles, given.seed))
    print(json.dumps(result, indent=2))
    title = f"Takeovers aimed at the commands of a manoeuvre, {given.flavour} (simulated)"
    name = f"takeover_aimed_{given.flavour}"
    write(given.out, name, title, begun, figures(result), page="faults-in-flight.md#takeovers")
    sys.exit(bool(result["undone"] or result["unnoticed"]))


if __name__ == "__main__":
    main()
