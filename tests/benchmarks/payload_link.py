"""A payload whose link is lost (figure 13): the sweep waits, or the vehicle holds; no reading is lost or counted twice.

    python -m tests.benchmarks.payload_link --missions 8 --out docs/measurements

`crossfix serve --receiver payload` flies a simulated vehicle in real time. The payload's agent listens here: it hears
an emitter through a small yagi as the nose truly points, and reaches the server through a proxy. In each sweep the link
is lost for 0.3 to 8 s, in turn in three ways: its connections are cut and refused, they stand still, or the agent is
stopped at once and started again on its spool. After 5 s without a reading the vehicle has to hold; it is resumed once
the link is back. A sweep that was kept has to hold every reading between its first and its last, each once, and the
mission to end with its emitter found, within three times the error it states.
"""

from __future__ import annotations

import argparse
import asyncio
import contextlib
import json
import math
import os
import random
import sys
import tempfile
import time
from collections.abc import AsyncIterator, Sequence
from contextlib import asynccontextmanager
from dataclasses import dataclass, field
from datetime import datetime
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from hardware.direction_finding.pattern_file import SMALL_YAGI, load_pattern
from hardware.frame import LocalFrame
from hardware.payload.agent import AgentSettings, PayloadAgent
from hardware.payload.spool import Spool
from hardware.readings import Channel, Place, PowerSample
from hardware.sim.autopilot.launch import Setting, SimulatedAutopilot, launch_simulated
from tests.benchmarks.figures.circumstances import begin
from tests.benchmarks.figures.writer import add_out, plain, wanted, write
from tests.system.console import Console, console
from tests.system.processes import serving

TOKEN = "a-token-for-the-payload"
RATE_HZ = 20.0
EMITTER_M = (90.0, 70.0)
"""East and north of home."""
FIRST = Channel(868_300_000.0)
"""Until the server says what it listens to."""
WAYS = ("cut", "stalled", "killed")
SHORTEST_S, LONGEST_S, TURN_S = 0.3, 8.0, 10.0
PATIENCE_S = 600.0
CLOCK_S = 0.02
"""The server corrects the agent's clock by its pings: this much may be left."""


class Radio:
    """Hears the emitter through the antenna on the nose of the vehicle, as it truly is. at_s: of all readings."""

    lost_percent = 0.0

    def __init__(self, vehicle: SimulatedAutopilot, emitter: Place, chance: random.Random) -> None:
        self._vehicle, self._emitter, self._chance = vehicle, emitter, chance
        self._pattern = load_pattern(SMALL_YAGI)
        self._channels: Sequence[Channel] = ()
        self.at_s: list[float] = []

    async def open(self, channels: Sequence[Channel]) -> None:
        self._channels = channels

    async def close(self) -> None: ...

    async def samples(self) -> AsyncIterator[PowerSample]:
        while True:
            await asyncio.sleep(1.0 / RATE_HZ)
            truth = await self._vehicle.order("truth", timeout_s=20.0)
            at_s = time.time()
            self.at_s.append(at_s)
            yield PowerSample(at_s, self._channels[0].frequency_hz, self._power_db(truth), -120.0)

    def _power_db(self, truth: dict[str, Any]) -> float:
        east, north = LocalFrame(Place(truth["lat"], truth["lon"])).to_enu(self._emitter)
        off_nose = math.degrees(math.atan2(east, north)) - truth["heading_deg"] - self._pattern.offset_to_nose_deg
        gain_db = float(self._pattern.gain_at(np.array(off_nose)))
        return gain_db - 20.0 - 20.0 * math.log10(max(math.hypot(east, north), 10.0)) + self._chance.gauss(0.0, 1.0)


class Link:
    """A proxy on a port of its own to the server's."""

    def __init__(self, server_port: int) -> None:
        self._server_port = server_port
        self._open = asyncio.Event()
        self._open.set()
        self._refusing = False
        self._writers: set[asyncio.StreamWriter] = set()

    def lose(self, way: str) -> None:
        self._open.clear()
        if way == "cut":
            self._refusing = True
            for writer in self._writers:
                writer.transport.abort()

    def mend(self) -> None:
        self._refusing = False
        self._open.set()

    async def serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        if self._refusing:
            writer.transport.abort()
            return
        far_reader, far_writer = await asyncio.open_connection("127.0.0.1", self._server_port)
        self._writers |= {writer, far_writer}
        try:
            await asyncio.gather(self._pass_on(reader, far_writer), self._pass_on(far_reader, writer))
        finally:
            self._writers -= {writer, far_writer}

    async def _pass_on(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        with contextlib.suppress(ConnectionError):
            while piece := await reader.read(2**16):
                await self._open.wait()
                writer.write(piece)
                await writer.drain()
        writer.close()


class Loss(NamedTuple):
    """UTC epoch seconds."""

    way: str
    began_s: float
    ended_s: float


@dataclass
class Found:
    """held: how often the vehicle did. wrong: with a sweep, or with how a mission ended."""

    losses: list[Loss] = field(default_factory=list[Loss])
    sweeps: int = 0
    held: int = 0
    localized: int = 0
    wrong: list[str] = field(default_factory=list[str])


class Agent:
    """The payload's agent as a task here; killed, it goes on from its spool."""

    def __init__(self, folder: Path, port: int, radio: Radio) -> None:
        self._settings = AgentSettings((f"ws://127.0.0.1:{port}/api/payload",), TOKEN, retry_s=0.2, longest_retry_s=1.0)
        self._file, self._radio = folder / "samples.sqlite", radio
        self._task: asyncio.Task[None] | None = None
        self._spool: Spool | None = None

    def start(self) -> None:
        self._spool = Spool(self._file)
        self._task = asyncio.create_task(PayloadAgent(self._settings, self._radio, self._spool, (FIRST,)).run())

    async def kill(self) -> None:
        assert self._task is not None
        assert self._spool is not None
        self._task.cancel()
        await asyncio.gather(self._task, return_exceptions=True)
        self._spool.close()


async def lose_it_in_each_sweep(
    shown: Console, link: Link, agent: Agent, chance: random.Random, losses: list[Loss]
) -> None:
    for number in range(1, 1000):
        await shown.until(lambda number=number: len(shown.of("sweep_started")) >= number, PATIENCE_S)
        way, seconds = WAYS[number % len(WAYS)], chance.uniform(SHORTEST_S, LONGEST_S)
        await asyncio.sleep(chance.uniform(0.0, TURN_S))
        began_s = time.time()
        if way == "killed":
            await agent.kill()
        else:
            link.lose(way)
        await asyncio.sleep(seconds)
        if way == "killed":
            agent.start()
        else:
            link.mend()
        losses.append(Loss(way, began_s, time.time()))


async def resume_each_time(shown: Console) -> None:
    for held in range(1, 1000):
        await shown.until(lambda held=held: shown.phases.count("hold") >= held, PATIENCE_S)
        await shown.until(lambda: len(shown.of("link_restored")) == len(shown.of("link_lost")), PATIENCE_S)
        await asyncio.sleep(2.0)
        answer = await shown.order("resume")
        if not answer["accepted"]:
            raise RuntimeError(f"no resume: {answer['reason']}")


def wrong_with(sweep: dict[str, Any], heard_at_s: Sequence[float]) -> str | None:
    """None: it holds every reading between its first and its last, each once."""
    began_s = datetime.fromisoformat(sweep["began_at_utc"]).timestamp()
    at_s = [began_s + after_s for after_s in sweep["at_s"]]
    if sorted(set(at_s)) != at_s:
        return f"{len(at_s) - len(set(at_s))} readings twice or out of order"
    meant = [heard for heard in heard_at_s if at_s[0] - CLOCK_S <= heard <= at_s[-1] + CLOCK_S]
    return None if len(meant) == len(at_s) else f"{len(at_s)} of {len(meant)} readings"


@asynccontextmanager
async def payload_flight(folder: Path, seed: int) -> AsyncIterator[tuple[Console, Link, Agent, Radio, LocalFrame]]:
    vehicle = await launch_simulated(Setting(speedup=1.0, seed=seed, keep_running=True))
    try:
        truth = await vehicle.order("truth")
        home = LocalFrame(Place(truth["lat"], truth["lon"]))
        radio = Radio(vehicle, home.to_geo(*EMITTER_M), random.Random(seed))
        more = ("--vehicle", vehicle.url, "--receiver", "payload", "--speedup", "1", "--seed", str(seed))
        async with serving(folder, *more) as (url, _), console(url) as shown:
            link = Link(int(url.rsplit(":", 1)[1]))
            async with await asyncio.start_server(link.serve, "127.0.0.1", 0) as listening:
                agent = Agent(folder, listening.sockets[0].getsockname()[1], radio)
                agent.start()
                try:
                    yield shown, link, agent, radio, home
                finally:
                    await agent.kill()
    finally:
        await vehicle.stop()


async def fly(folder: Path, seed: int, found: Found) -> None:
    async with payload_flight(folder, seed) as (shown, link, agent, radio, home):
        await shown.draft()
        await shown.ready(PATIENCE_S)
        await shown.watch()
        await shown.start(60)
        losing = asyncio.create_task(lose_it_in_each_sweep(shown, link, agent, random.Random(seed), found.losses))
        resuming = asyncio.create_task(resume_each_time(shown))
        ended = await shown.until_event("mission_ended", wall_s=PATIENCE_S)
        for task in (losing, resuming):
            task.cancel()
        await asyncio.gather(losing, resuming, return_exceptions=True)
        link.mend()
        found.held += shown.phases.count("hold")
        for sweep_id in {event["event"]["sweep_id"]: None for event in shown.events if event["event"].get("sweep_id")}:
            answer = await shown.client.get(f"/api/missions/{shown.mission_id}/sweeps/{sweep_id}")
            found.sweeps += 1
            wrong = wrong_with(answer.json(), radio.at_s) if answer.status_code == 200 else answer.text
            found.wrong += [] if wrong is None else [f"seed {seed}: {wrong}"]
        times = _error_over_stated(shown, home)
        if ended["outcome"] == "localized" and times is not None and times <= 3.0:
            found.localized += 1
        else:
            found.wrong.append(f"seed {seed}: {ended['outcome']}, {times} times the error it states")


def _error_over_stated(shown: Console, home: LocalFrame) -> float | None:
    updates = shown.of("belief_updated")
    if not updates:
        return None
    last = updates[-1]["event"]["estimate"]
    east, north = home.to_enu(Place(last["lat"], last["lon"]))
    return math.dist((east, north), EMITTER_M) / last["expected_rmse_m"]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--missions", type=int, default=4)
    parser.add_argument("--seed", type=int, default=1)
    add_out(parser)
    given = parser.parse_args()
    begun = begin(__file__)
    os.environ["CROSSFIX_PAYLOAD_TOKENS"] = json.dumps([TOKEN])
    found = Found()
    for seed in range(given.seed, given.seed + given.missions):
        with tempfile.TemporaryDirectory(prefix="crossfix-payload-") as folder:
            asyncio.run(fly(Path(folder), seed, found))
        print(seed, found, flush=True)
    lost_s = [loss.ended_s - loss.began_s for loss in found.losses]
    by_way = ", ".join(f"{sum(loss.way == way for loss in found.losses)} {way}" for way in WAYS)
    figures = [
        wanted("payload_link", len(found.wrong), note=f"link lost {len(found.losses)} times: {by_way}"),
        plain("payload's link lost for, at most", round(max(lost_s), 1), "s"),
        plain("payload's link lost: holds", found.held, ""),
        plain("payload's link lost: sweeps kept", found.sweeps, ""),
        plain("payload's link lost: missions localized", found.localized, "", note=f"of {given.missions}"),
    ]
    write(given.out, "payload_link", "The payload's link lost in mid-sweep", begun, figures, page="faults-in-flight.md")
    sys.exit(bool(found.wrong))


if __name__ == "__main__":
    main()
