"""The pilot takes over at random moments (figure 12): how late does a last flight command reach their vehicle?

    python -m tests.benchmarks.takeover --flavour px4 --times 50
    python -m tests.benchmarks.takeover --flavour ardupilot --times 50

A whole mission by the real server in real time; the simulated autopilot notes when each command arrives. The
pilot uses the mode switch or, on PX4, every other time the sticks. Besides, after each takeover an operator orders
everything an operator can order: none of it may reach the vehicle before the pilot gives it back. Prints one JSON
object; ends with status 1 when a command came later than 200 ms.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import os
import random
import sys
import tempfile
from collections import Counter
from pathlib import Path
from typing import Any

from backend.cli.running import running_server
from backend.settings import Settings
from hardware.sim.autopilot.launch import SimulatedAutopilot
from tests.benchmarks.figures.circumstances import begin
from tests.benchmarks.figures.record import Figure
from tests.benchmarks.figures.writer import add_out, plain, wanted, write
from tests.strikes.strike import FLIGHT
from tests.system.console import Console, console, simulated_vehicle

ALLOWED_S = 0.2
LONG_SEARCH = {"localization": {"expected_rmse_m": 1.0, "maximum_bearings": 60}, "planner": {"budget": 400}}
MOMENTS = (("flying", 5.0), ("measuring", 12.0), ("measuring", 12.0), ("planning", 0.3))
"""In which phase the pilot strikes, and how many seconds after its beginning at most: a turn is many commands."""
ENDED = ("returning", "landing", "ground")


async def take_over(vehicle: SimulatedAutopilot, sticks: bool) -> float:
    """Simulated seconds at which the pilot had control."""
    if sticks:
        took = await vehicle.order("pilot_sticks", north_m_s=0.5)
        if took["took_control"]:
            return took["time_s"]
    return (await vehicle.order("pilot_mode"))["time_s"]


async def one(shown: Console, vehicle: SimulatedAutopilot, chance: random.Random, sticks: bool) -> tuple[str, float]:
    """(the phase it happened in, seconds from the takeover to the last flight command; 0 when none came)."""
    await vehicle.order("battery", percent=100)
    wanted, longest_s = chance.choice(MOMENTS)
    await shown.until(lambda: shown.phases[-1] in (wanted, *ENDED), 120)
    await asyncio.sleep(chance.uniform(0.0, longest_s))
    phase = shown.phases[-1]
    at_s = await take_over(vehicle, sticks)
    await shown.until_phase("manual", 10)
    for kind in ("hold", "return", "resume", "accept", "veto"):
        assert not (await shown.order(kind))["accepted"], f"{kind} was accepted while the pilot flew"
    await asyncio.sleep(1.5)
    told = await vehicle.order("commands", since_s=at_s + 1e-6)
    late = [when - at_s for when, number in told["commands"] if number in FLIGHT]
    await vehicle.order("give_back")
    async with asyncio.timeout(30):
        while not (await shown.order("resume"))["accepted"]:  # noqa: ASYNC110 (asked again as a person would)
            await asyncio.sleep(0.1)
    return phase, max(late, default=0.0)


async def run(flavour: str, times: int, seed: int) -> dict[str, Any]:
    chance, phases, late = random.Random(seed), Counter[str](), list[float]()
    with tempfile.TemporaryDirectory(prefix="crossfix-takeover-") as folder:
        settings = Settings(port=0, data_dir=Path(folder), simulate=flavour, seed=seed)  # type: ignore[arg-type]
        async with running_server(settings) as server, console(server.url) as shown:
            vehicle = await simulated_vehicle(Path(folder))
            while len(late) < times:
                await shown.close()
                shown.events.clear()
                await shown.draft(**LONG_SEARCH)
                await shown.ready(60)
                await shown.watch()
                await shown.start(60)
                await shown.until_event("took_off", wall_s=60)
                while len(late) < times and shown.phases[-1] not in ENDED:
                    phase, after_s = await one(shown, vehicle, chance, flavour == "px4" and len(late) % 2 == 1)
                    phases[phase] += 1
                    late.append(after_s)
                if len(late) < times:
                    await shown.until(lambda: shown.phases[-1] == "ground", 240)
    return {
        "flavour": flavour,
        "takeovers": len(late),
        "in": dict(phases.most_common()),
        "with_a_command_afterwards": sum(value > 0.0 for value in late),
        "latest_command_ms": round(1e3 * max(late), 1),
    }


def figures(found: dict[str, Any]) -> list[Figure]:
    return [
        wanted("takeover", found["latest_command_ms"], of=found["flavour"]),
        plain("takeovers", found["takeovers"], ""),
        plain("with a flight command afterwards", found["with_a_command_afterwards"], ""),
        *(plain(f"struck while {phase}", count, "") for phase, count in found["in"].items()),
    ]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--flavour", choices=("px4", "ardupilot"), default="px4")
    parser.add_argument("--times", type=int, default=int(os.environ.get("CROSSFIX_TAKEOVERS", "10")))
    parser.add_argument("--seed", type=int, default=3)
    add_out(parser)
    given = parser.parse_args()
    begun = begin(__file__)
    result = asyncio.run(run(given.flavour, given.times, given.seed))
    print(json.dumps(result, indent=2))
    title = f"The pilot takes over, {given.flavour}"
    write(given.out, f"takeover_{given.flavour}", title, begun, figures(result), page="faults-in-flight.md#takeovers")
    sys.exit(result["latest_command_ms"] > 1e3 * ALLOWED_S)


if __name__ == "__main__":
    main()
