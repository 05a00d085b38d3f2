"""Random stories of a flight (figure 19): whatever happened before, are hold, return and land obeyed in the air?

    python -m tests.benchmarks.random_stories --stories 500
    python -m tests.benchmarks.random_stories --stories 20 --flavour ardupilot --seed 7

A story is a mission that is started, then orders, the pilot's switch, refusals, silence, lost links and satellites, an
empty battery and kills -9 in a random order. At its end the faults are taken away and the pilot gives back; then hold,
return and land are ordered in a random order, through the mission or the craft, and each must be seen at the vehicle.
Other than that any order may be refused, but by a sentence. Prints one JSON object; ends with status 1 when a vehicle
in the air was out of reach or anything raised.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import os
import random
import sys
import tempfile
from collections.abc import Awaitable, Callable
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any
from uuid import uuid4

from hardware.sim.autopilot.launch import Setting, SimulatedAutopilot, launch_simulated
from tests.benchmarks.figures.circumstances import begin
from tests.benchmarks.figures.writer import add_out, plain, wanted, write
from tests.benchmarks.kill_loop import LONG_SEARCH, Server, Servers, warm_up
from tests.system.console import Console, console

ORDERS = ("hold", "resume", "return", "land", "abort", "start", "keep_holding")
REACH = ("hold", "return", "land")
MOST_ACTS = 6
ANSWER_S = 60.0
"""Wall time, for an answer of the simulated vehicle."""
OBEYED_S = 60.0
"""Wall time, for an order to be accepted and then seen at the vehicle, on a busy machine."""
TRACEBACK = "Traceback (most recent call last)"

Truth = dict[str, Any]


@dataclass
class Found:
    """unreached: how each story ended in which an order was not obeyed. raised: tracebacks and answers of 5xx."""

    stories: int = 0
    acts: int = 0
    kills: int = 0
    ended_on_the_ground: int = 0
    obeyed: int = 0
    unreached: list[str] = field(default_factory=list[str])
    raised: list[str] = field(default_factory=list[str])


@dataclass
class Story:
    """shown: a console of the server that runs now. told: what happened, for a story that went wrong."""

    chance: random.Random
    vehicle: SimulatedAutopilot
    servers: Servers
    found: Found
    server: Server
    shown: Console
    told: list[str] = field(default_factory=list[str])

    async def at_vehicle(self, do: str, **arguments: Any) -> dict[str, Any]:
        return await self.vehicle.order(do, timeout_s=ANSWER_S, **arguments)

    async def craft_order(self, kind: str) -> dict[str, Any]:
        body = {"command_id": str(uuid4()), "command": {"kind": kind}}
        return self.answered(await self.shown.client.post("/api/crafts/craft-1/commands", json=body))

    async def order(self, kind: str) -> dict[str, Any]:
        body = {"command_id": str(uuid4()), "command": {"kind": kind}}
        path = f"/api/missions/{self.shown.mission_id}/commands"
        return self.answered(await self.shown.client.post(path, json=body))

    def answered(self, reply: Any) -> dict[str, Any]:
        if reply.status_code >= 500 and reply.status_code != 503:  # 503: busy, in words
            self.found.raised.append(f"{reply.status_code} {reply.text[:200]}")
        return reply.json() if reply.status_code == 200 else {"accepted": False, "reason": reply.text[:200]}

    async def act(self) -> None:
        """One thing that happens."""
        for_seconds = self.chance.choice((1, 3, 8))
        to_mission, to_craft = self.chance.choice(ORDERS), self.chance.choice((*REACH, "resume"))
        acts: dict[str, Callable[[], Awaitable[Any]]] = {
            "order": lambda: self.order(to_mission),
            "order to the craft": lambda: self.craft_order(to_craft),
            "pilot": lambda: self.at_vehicle("pilot_mode"),
            "give back": lambda: self.at_vehicle("give_back"),
            "refuse": lambda: self.at_vehicle("fault", kind="refuse", count=self.chance.randint(1, 5)),
            "ignore": lambda: self.at_vehicle("fault", kind="ignore_all", count=self.chance.randint(1, 3)),
            "silent": lambda: self.at_vehicle("fault", kind="silent", count=self.chance.randint(1, 4)),
            "link": lambda: self.at_vehicle("link_loss", seconds=for_seconds),
            "satellites": lambda: self.at_vehicle("gps_loss", seconds=for_seconds),
            "late link": lambda: self.at_vehicle("link_delay", seconds=self.chance.choice((0.08, 0.25))),
            "battery": lambda: self.at_vehicle("battery", percent=self.chance.choice((12, 25, 40))),
            "kill": self.kill,
        }
        likely = {"order": 5, "order to the craft": 2, "kill": 2}
        name = self.chance.choices([*acts], [likely.get(each, 1) for each in acts])[0]
        answer = await acts[name]()
        self.found.acts += 1
        name += {"order": f" {to_mission}", "order to the craft": f" {to_craft}"}.get(name, "")
        self.told.append(name if answer is None else f"{name}: {brief(answer)}")
        await asyncio.sleep(self.chance.uniform(0.0, 1.0))

    async def kill(self) -> None:
        """And start the next server, which finds what flies."""
        mission_id = self.shown.mission_id
        await self.shown.close()
        self.server.kill()
        await self.server.gone()
        self.found.kills += 1
        await asyncio.sleep(self.chance.choice((0.0, 0.3, 2.5)))
        self.server = await self.servers.forked()
        self.shown = Console(self.server.url, self.shown.client)
        self.shown.client.base_url = self.server.url
        self.shown.mission_id = mission_id

    async def begin(self) -> None:
        await self.at_vehicle("battery", percent=100)
        await self.shown.draft(**LONG_SEARCH)
        await self.shown.ready(120)
        async with asyncio.timeout(4 * OBEYED_S):
            while not (answer := await self.order("start"))["accepted"]:
                self.told[:] = [f"start: {brief(answer)}"]
                await asyncio.sleep(2.0)  # who is refused more often is slowed down
        await asyncio.sleep(self.chance.uniform(0.0, 4.0))

    async def calm(self) -> None:
        """Nothing is wrong any more, and the pilot has given back."""
        for kind in ("refuse", "ignore_all", "silent"):
            await self.at_vehicle("fault", kind=kind, count=0)
        await self.at_vehicle("link_delay", seconds=0.0)
        await self.at_vehicle("link_loss", seconds=0.0)
        await self.at_vehicle("gps_loss", seconds=0.0)
        await self.at_vehicle("battery", percent=100)
        if (truth := await self.at_vehicle("truth"))["armed"]:
            self.told.append(f"calm in {truth['mode']} at {truth['altitude_relative_m']:.0f} m")
            await self.at_vehicle("give_back")

    async def reach(self) -> None:
        """Raises TimeoutError when the vehicle in the air is out of reach."""
        for kind in self.chance.sample(REACH, len(REACH)):
            through = self.chance.choice((self.order, self.craft_order))
            async with asyncio.timeout(OBEYED_S):
                while (await self.at_vehicle("truth"))["in_air"]:
                    await self.craft_order("resume")  # the pilot has given back: this server may fly again
                    answer = await through(kind)
                    if not answer["accepted"]:
                        other = self.order if through == self.craft_order else self.craft_order
                        answer = await other(kind)
                    self.told.append(f"{kind}: {brief(answer)}")
                    if answer["accepted"] and await self.obeyed(kind):
                        self.found.obeyed += 1
                        break
                    await asyncio.sleep(0.5)

    async def obeyed(self, kind: str) -> bool:
        """Seen at the vehicle within some seconds."""
        truth: Truth = {}
        for _ in range(40):
            truth = await self.at_vehicle("truth")
            if not truth["in_air"] or OBEYS[kind](truth):
                return True
            await asyncio.sleep(0.1)
        self.told.append(f"{kind} is not done: {truth['mode']}, {truth['speed_m_s']:.1f} m/s")
        return False

    async def flies(self) -> bool:
        """Whether its mission does, as the list of missions says."""
        missions = (await self.shown.client.get("/api/missions")).json()["missions"]
        return any(one["flying"] for one in missions if one["mission_id"] == self.shown.mission_id)

    async def land(self) -> None:
        """Until the mission has ended: one that is on the ground in hold ends with an order to land."""
        async with asyncio.timeout(4 * OBEYED_S):
            while (await self.at_vehicle("truth"))["armed"] or await self.flies():
                await self.craft_order("resume")
                await self.craft_order("land")
                await self.order("land")
                await asyncio.sleep(0.5)


def brief(answer: dict[str, Any]) -> str:
    """Of an order to the server or the simulated vehicle."""
    if "accepted" not in answer:
        return "so"
    return "accepted" if answer["accepted"] else json.dumps(answer["reason"])[:120]


HOLDING, HOMEWARD, LANDING = ("HOLD", "LOITER", "BRAKE", "GUIDED", "POSHOLD"), ("RETURN", "RTL"), ("LAND",)
OBEYS: dict[str, Callable[[Truth], bool]] = {
    "hold": lambda truth: truth["mode"] in HOLDING and truth["speed_m_s"] < 1.0,
    # by way points of ours, by itself, or over home and so on its way down
    "return": lambda truth: truth["mode"] in (*HOMEWARD, *LANDING) or truth["speed_m_s"] > 1.0,
    "land": lambda truth: truth["mode"] in LANDING,
}


async def run(first: int, stories: int, flavour: str, speedup: float, seed: int, folder: Path) -> Found:
    """The vehicle does not land by itself however long no server runs."""
    found, stays_up = Found(), {"NAV_DLL_ACT": 1.0, "RTL_LAND_DELAY": -1.0} if flavour == "px4" else {}
    os.environ["CROSSFIX_LOG_FILE"] = str(folder / "server.log")
    setting = Setting(flavour=flavour, speedup=speedup, seed=seed, keep_running=True, parameters=stays_up)  # type: ignore[arg-type]
    vehicle = await launch_simulated(setting)
    given = ["--port", "0", "--data-dir", str(folder), "--speedup", str(speedup), "--vehicle", vehicle.url, "--json"]
    servers = Servers(given)
    try:
        server = await servers.forked()
        async with console(server.url) as shown:
            for number in range(first, first + stories):
                story = Story(random.Random(f"{seed} {number}"), vehicle, servers, found, server, shown)
                try:
                    await story.begin()
                    for _ in range(story.chance.randint(1, MOST_ACTS)):
                        await story.act()
                    await story.calm()
                    in_air = (await story.at_vehicle("truth"))["in_air"]
                    found.ended_on_the_ground += not in_air
                    await story.reach()
                    await story.land()
                except (TimeoutError, AssertionError) as error:
                    story.told.append(f"OUT OF REACH: {error!r}, {await story.at_vehicle('truth')}")
                    found.unreached.append(f"story {number}: {'; '.join(story.told)}")
                    await story.calm()
                    await story.land()
                found.stories += 1
                server, shown = story.server, story.shown
                print(f"story {number}: {'; '.join(story.told)}", file=sys.stderr, flush=True)
            server.kill()
    finally:
        await servers.close()
        await vehicle.stop()
    said = (folder / "server.log").read_text() if (folder / "server.log").exists() else ""
    found.raised += [said[at : at + 1500] for at in _places(said, TRACEBACK)]
    return found


def _places(text: str, part: str) -> list[int]:
    return [at for at in range(len(text)) if text.startswith(part, at)]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--stories", type=int, default=500)
    parser.add_argument("--first", type=int, default=0, help="number of the first: a story that went wrong, again")
    parser.add_argument("--flavour", choices=("px4", "ardupilot"), default="px4")
    parser.add_argument("--speedup", type=float, default=8.0)
    parser.add_argument("--seed", type=int, default=1)
    add_out(parser)
    given = vars(parser.parse_args())
    out, begun = given.pop("out"), begin(__file__)
    warm_up()
    with tempfile.TemporaryDirectory(prefix="crossfix-random-stories-", ignore_cleanup_errors=True) as folder:
        found = asyncio.run(run(**given, folder=Path(folder)))
    print(json.dumps(asdict(found), indent=1))
    note = f"{found.stories} stories, {found.acts} acts, {found.kills} of them kills -9; {given['flavour']}"
    made = [
        wanted("out_of_reach", len(found.unreached), note=note),
        wanted("stories", len(found.raised), note=note),
        plain("stories of these that ended on the ground before", found.ended_on_the_ground, ""),
        plain("orders to hold, return and land that were seen at the vehicle", found.obeyed, ""),
    ]
    name = f"random_stories_{given['flavour']}"
    write(out, name, f"Random stories, {given['flavour']}", begun, made, page="faults-in-flight.md")
    sys.exit(bool(found.unreached or found.raised))


if __name__ == "__main__":
    main()
