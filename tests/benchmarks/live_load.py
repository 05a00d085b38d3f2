"""How the live channel and the abort hold up under viewers. Prints figures; run it by hand:

    python -m tests.benchmarks.live_load fanout --viewers 100 --stalled 5 --hertz 10 --seconds 600
    python -m tests.benchmarks.live_load abort --viewers 50 --stalled 5 --times 200

fanout: a server process publishes telemetry (and an event a second, a belief every five); this process reads with all
viewers and measures from the publish to the read. abort: a whole server starts one mission after the other on a
simulated vehicle and gets ABORT in take-off or soon after, while everybody watches; measured from the request's
arrival in the server to the first command (hold) handed to the vehicle.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import os
import random
import socket
import statistics
import sys
import tempfile
import time
import urllib.request
from collections import Counter
from collections.abc import AsyncIterator, Sequence
from contextlib import asynccontextmanager, nullcontext
from dataclasses import replace
from pathlib import Path
from typing import Any
from uuid import uuid4

import numpy as np
import psutil
import uvicorn

from backend.api.services import Services
from backend.auth.access import Access
from backend.auth.audit import AuditLog
from backend.events import HoldOrdered, MissionDrafted, Recorded
from backend.live.hub import Hub
from backend.main import create_app, server_config
from backend.ports import CraftStatus, Status
from backend.settings import Settings
from backend.spec import MissionSpec, Polygon
from backend.store.opening import open_journal
from hardware.readings import Place, Telemetry
from hardware.sim.autopilot.launch import find_simulated
from planner.belief.grid import GridBelief
from tests.benchmarks.figures.circumstances import begin
from tests.benchmarks.figures.record import Figure
from tests.benchmarks.figures.writer import add_out, plain, wanted, write
from tests.benchmarks.live_viewers import Tally, stalled_viewer, view, viewers_only

MODULE = "tests.benchmarks.live_load"
SPEC = MissionSpec(name="load", area=Polygon(coordinates=[[(7.2, 50.6), (7.21, 50.6), (7.21, 50.61), (7.2, 50.6)]]))
TELEMETRY = Telemetry(
    connected=True,
    at_s=0.0,
    position=Place(50.623412, 7.204651),
    altitude_amsl_m=160.3,
    altitude_relative_m=40.3,
    heading_deg=123.4,
    velocity_north_m_s=3.2,
    velocity_east_m_s=-1.1,
    velocity_down_m_s=0.1,
    battery_percent=81.0,
    gps_fix="3D",
    satellites=14,
    armed=True,
    in_air=True,
    mode="GUIDED",
)


# The server of the fan-out


async def publish(services: Services, hertz: float) -> None:
    hub, journal, tick = services.hub, services.journal, 0
    y, x = np.mgrid[0:100, 0:100]
    density = np.exp(-((x - 30) ** 2 + (y - 60) ** 2) / 400.0)
    belief = GridBelief(density / density.sum(), 0.0, 0.0, 3.0, (), (), 3, True)
    craft = CraftStatus("craft-1", "load", "flying", "ok", -71.0, 0.1, 31.0)
    status = Status("load", "flying", (craft,), "ok")
    recorded: Sequence[Recorded] = []
    began = time.monotonic()
    while True:
        now = time.time()
        hub.telemetry("craft-1", replace(TELEMETRY, at_s=now, position_at_s=now, heading_at_s=now), now)
        if tick % round(hertz) == 0:
            hub.status(status)
            recorded = await journal.append("load", [HoldOrdered(craft_id="craft-1", by="x" * 300, reason=None)])
            hub.events(recorded)
        if tick % round(5 * hertz) == 0:
            hub.belief(
                "load",
                "emitter-1",
                recorded[-1].seq,
                3,
                belief,
                [(7.2, 50.6), (7.21, 50.6), (7.21, 50.61), (7.2, 50.61)],
            )
        tick += 1
        await asyncio.sleep(max(0.0, began + tick / hertz - time.monotonic()))


async def serve_fanout(port: int, folder: str, hertz: float) -> None:
    settings = Settings(port=port, data_dir=Path(folder), live_ping_timeout_s=60.0)

    @asynccontextmanager
    async def opening(settings: Settings) -> AsyncIterator[Services]:
        async with open_journal(settings, time.time) as journal:
            hub = Hub(journal.read_texts, time.time)
            await journal.append("load", [MissionDrafted(spec=SPEC)])
            nothing: Any = None
            access = Access(None, AuditLog(None, time.time), people_expected=False)
            services = Services(
                nothing, journal, hub, settings, time.time, access=access, finder=nothing, pattern=nothing
            )
            publishing = asyncio.create_task(publish(services, hertz))
            yield services
            publishing.cancel()

    await uvicorn.Server(server_config(settings, create_app(settings, opening))).serve()


def percentile(values: Sequence[float], share: float) -> float:
    return float(np.quantile(values, share)) if values else float("nan")


def free_port() -> int:
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        return free.getsockname()[1]


async def until_answers(port: int) -> None:
    async with asyncio.timeout(120):
        while True:
            try:
                await asyncio.to_thread(urllib.request.urlopen, f"http://127.0.0.1:{port}/api/missions", timeout=5)
                return
            except OSError:
                await asyncio.sleep(0.2)


async def fanout(viewers: int, stalled: int, hertz: float, seconds: float) -> dict[str, Any]:
    port = free_port()
    with tempfile.TemporaryDirectory() as folder:
        command = [sys.executable, "-m", MODULE, "serve-fanout", str(port), folder, str(hertz)]
        server = await asyncio.create_subprocess_exec(*command)
        watching: list[asyncio.Task[None]] = []
        sockets: list[socket.socket] = []
        try:
            await until_answers(port)
            process = psutil.Process(server.pid)
            sockets = [await asyncio.to_thread(stalled_viewer, port, "load") for _ in range(stalled)]
            tally = Tally()
            watching = [asyncio.create_task(view(port, "load", tally)) for _ in range(viewers)]
            await asyncio.sleep(5.0)
            tally.delays_ms.clear()
            memory_mb, processor = [], process.cpu_times()
            for _ in range(10):
                await asyncio.sleep(seconds / 10)
                memory_mb.append(process.memory_info().rss / 2**20)
            used = process.cpu_times()
            broken = [task for task in watching if task.done()]
        finally:
            for task in watching:
                task.cancel()
            await asyncio.gather(*watching, return_exceptions=True)
            for client in sockets:
                client.close()
            server.terminate()
            await server.wait()
    delays = tally.delays_ms
    return {
        "viewers": viewers,
        "stalled": stalled,
        "hertz": hertz,
        "seconds": seconds,
        "messages": len(delays),
        "expected": int(viewers * hertz * seconds),
        "p50_ms": percentile(delays, 0.5),
        "p99_ms": percentile(delays, 0.99),
        "max_ms": max(delays, default=float("nan")),
        "dropped_at_most": tally.dropped,
        "event_gaps": tally.gaps,
        "broken_viewers": len(broken),
        "server_cpu_share": (used.user + used.system - processor.user - processor.system) / seconds,
        "server_rss_mb": [round(value, 1) for value in memory_mb],
    }


# Abort


class Stopwatch:
    """ASGI wrapper that notes when a command's request arrives."""

    def __init__(self, app: Any) -> None:
        self.app = app
        self.arrived = 0.0

    async def __call__(self, scope: Any, receive: Any, send: Any) -> None:
        if scope["type"] == "http" and scope["path"].endswith("/commands"):
            self.arrived = time.perf_counter()
        await self.app(scope, receive, send)


def post(port: int, path: str, body: object) -> Any:
    request = urllib.request.Request(
        f"http://127.0.0.1:{port}/api{path}", json.dumps(body).encode(), {"content-type": "application/json"}
    )
    return json.load(urllib.request.urlopen(request, timeout=60))


async def order(port: int, mission_id: str, kind: str) -> dict[str, Any]:
    body = {"command_id": str(uuid4()), "command": {"kind": kind}}
    return await asyncio.to_thread(post, port, f"/missions/{mission_id}/commands", body)


async def abort(viewers: int, stalled: int, times: int) -> dict[str, Any]:
    from backend.craft.reconnecting_vehicle import ReconnectingVehicle
    from backend.wiring import open_services

    held_at: list[float] = []
    hold = ReconnectingVehicle.hold

    async def timed_hold(self: ReconnectingVehicle) -> None:
        held_at.append(time.perf_counter())
        await hold(self)

    ReconnectingVehicle.hold = timed_hold
    port, chance = free_port(), random.Random(1)
    delays_ms, answers_ms, phases = [], [], Counter[str]()
    with tempfile.TemporaryDirectory() as folder:
        settings = Settings(port=port, data_dir=Path(folder), time_factor=16.0, live_ping_timeout_s=60.0)
        async with open_services(settings) as services:
            app = create_app(settings, lambda _: nullcontext(services))
            watch = Stopwatch(app)
            config = server_config(settings, app)
            config.app = watch
            server = uvicorn.Server(config)
            serving = asyncio.create_task(server.serve())
            await until_answers(port)
            kept = json.loads((Path(folder) / "simulated_vehicle.json").read_text())
            vehicle = await find_simulated(kept["connect_port"], kept["control_port"])
            if vehicle is None:
                raise SystemExit("the simulated vehicle does not answer")
            await vehicle.order("set_param", name="RTL_RETURN_ALT", value=5)
            spec = json.load(
                await asyncio.to_thread(urllib.request.urlopen, f"http://127.0.0.1:{port}/api/defaults", timeout=10)
            )["spec"]
            spec["flight"] |= {"altitude_relative_m": 6.0, "minimum_altitude_relative_m": 3.0}
            watching = await asyncio.create_subprocess_exec(
                sys.executable, "-m", MODULE, "viewers", str(port), str(viewers), str(stalled),
                stdin=asyncio.subprocess.PIPE, stdout=asyncio.subprocess.PIPE,
            )  # fmt: skip
            assert watching.stdin is not None
            assert watching.stdout is not None
            while len(delays_ms) < times:
                await vehicle.order("battery", percent=100)
                mission = (await asyncio.to_thread(post, port, "/missions", spec))["mission_id"]
                watching.stdin.write(f"{mission}\n".encode())
                await watching.stdout.readline()
                async with asyncio.timeout(60):
                    while not (await order(port, mission, "start"))["accepted"]:  # noqa: ASYNC110 (as a person would)
                        await asyncio.sleep(1.1)  # more than one refusal a second is slowed down
                await asyncio.sleep(chance.uniform(0.1, 1.5))
                held_at.clear()
                phase = services.missions.display.status().phase or ""
                asked = time.perf_counter()
                reply = await order(port, mission, "abort")
                answered = time.perf_counter()
                if not reply["accepted"] or not held_at:
                    raise SystemExit(f"abort in {phase} did not reach the vehicle: {reply}")
                phases[phase] += 1
                delays_ms.append(1e3 * (held_at[0] - watch.arrived))
                answers_ms.append(1e3 * (answered - asked))
            watching.stdin.close()
            await watching.wait()
            server.should_exit = True
            await serving
        await vehicle.stop()
    return {
        "viewers": viewers,
        "stalled": stalled,
        "aborts": len(delays_ms),
        "in": dict(phases.most_common()),
        "receipt_to_vehicle_p50_ms": percentile(delays_ms, 0.5),
        "receipt_to_vehicle_p99_ms": percentile(delays_ms, 0.99),
        "receipt_to_vehicle_max_ms": max(delays_ms, default=float("nan")),
        "answer_median_ms": statistics.median(answers_ms) if answers_ms else float("nan"),
    }


def fanout_figures(found: dict[str, Any]) -> list[Figure]:
    """Memory: the last of ten looks against the first."""
    first_mb, *_, last_mb = found["server_rss_mb"]
    seconds = f"{found['seconds']:.0f} s"
    return [
        wanted("fanout", round(found["p99_ms"], 1), note=seconds),
        wanted("fanout_memory", round(100.0 * (last_mb / first_mb - 1.0), 2), note=seconds),
        plain("publish to read, median", round(found["p50_ms"], 1), "ms"),
        plain("publish to read, worst", round(found["max_ms"], 1), "ms"),
        plain("telemetry values read", found["messages"], "", note=f"{found['expected']:,} sent"),
        plain("telemetry values skipped by one viewer, at most", found["dropped_at_most"], ""),
        plain("events lost or doubled", found["event_gaps"], ""),
        plain("viewers that dropped out", found["broken_viewers"], ""),
        plain("server, of one core", round(100.0 * found["server_cpu_share"], 1), "%"),
        plain("server's memory", last_mb, "MB"),
    ]


def abort_figures(found: dict[str, Any]) -> list[Figure]:
    return [
        wanted("abort", round(found["receipt_to_vehicle_p99_ms"], 1), note=f"{found['aborts']} aborts"),
        plain("request to vehicle command, median", round(found["receipt_to_vehicle_p50_ms"], 1), "ms"),
        plain("request to vehicle command, worst", round(found["receipt_to_vehicle_max_ms"], 1), "ms"),
        plain("request to answer, median", round(found["answer_median_ms"], 1), "ms"),
        *(plain(f"aborted while {phase}", count, "") for phase, count in found["in"].items()),
    ]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    one = commands.add_parser("fanout")
    one.add_argument("--viewers", type=int, default=100)
    one.add_argument("--stalled", type=int, default=5)
    one.add_argument("--hertz", type=float, default=10.0)
    one.add_argument("--seconds", type=float, default=60.0)
    two = commands.add_parser("abort")
    two.add_argument("--viewers", type=int, default=50)
    two.add_argument("--stalled", type=int, default=5)
    two.add_argument("--times", type=int, default=int(os.environ.get("CROSSFIX_ABORTS", "200")))
    for measuring in (one, two):
        add_out(measuring)
    server = commands.add_parser("serve-fanout")
    for name, kind in (("port", int), ("folder", str), ("hertz", float)):
        server.add_argument(name, type=kind)
    only = commands.add_parser("viewers")
    for name, kind in (("port", int), ("viewers", int), ("stalled", int)):
        only.add_argument(name, type=kind)
    given = vars(parser.parse_args())
    run = {"fanout": fanout, "abort": abort, "serve-fanout": serve_fanout, "viewers": viewers_only}
    kind, out, begun = given.pop("command"), given.pop("out", None), begin(__file__)
    result = asyncio.run(run[kind](**given))
    if result is not None:
        print(json.dumps(result, indent=2))
        title, made = {"fanout": ("Live fan-out", fanout_figures), "abort": ("Abort", abort_figures)}[kind]
        write(out, f"live_{kind}", title, begun, made(result), page="faults-in-flight.md#viewers")


if __name__ == "__main__":
    main()
