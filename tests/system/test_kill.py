"""kill -9 in flight: the next server finds the vehicle still flying, holds, and has the identical belief."""

from __future__ import annotations

import asyncio
import json
import signal
import sys
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path

import pytest
from console import console, simulated_vehicle

from hardware.sim.autopilot.launch import SimulatedAutopilot

pytestmark = pytest.mark.system


@asynccontextmanager
async def server_process(data_dir: Path) -> AsyncIterator[tuple[str, asyncio.subprocess.Process]]:
    """`crossfix serve` in a process of its own; the URL it printed."""
    process = await asyncio.create_subprocess_exec(
        sys.executable, "-c", "from backend.cli.main import app; app()",
        "serve", "--port", "0", "--data-dir", str(data_dir), "--speedup", "12", "--seed", "3", "--json",
        stdout=asyncio.subprocess.PIPE,
    )  # fmt: skip
    assert process.stdout is not None
    try:
        async with asyncio.timeout(60):
            line = await process.stdout.readline()
        yield json.loads(line)["url"], process
    finally:
        if process.returncode is None:
            process.send_signal(signal.SIGINT)
            await process.wait()


async def seen_in(vehicle: SimulatedAutopilot, mode: str) -> None:
    async with asyncio.timeout(30):
        while True:
            if (await vehicle.order("truth"))["mode"] == mode:
                return
            await asyncio.sleep(0.1)


@pytest.mark.parametrize(("failsafe", "found_in"), [(1, "HOLD"), (2, "RETURN")])
async def test_after_kill_9_in_flight_the_mission_holds_with_the_identical_belief(
    tmp_path: Path, failsafe: int, found_in: str
) -> None:
    """Whatever the autopilot's own failsafe (NAV_DLL_ACT) made of the silence: it is not taken for a pilot."""
    async with server_process(tmp_path) as (url, process), console(url) as before:
        mission_id = await before.draft(planner={"seed": 3})
        await before.ready()
        vehicle = await simulated_vehicle(tmp_path)
        await vehicle.order("set_param", name="NAV_DLL_ACT", value=failsafe)
        await vehicle.order("set_param", name="RTL_LAND_DELAY", value=-1.0)
        await before.watch()
        await before.start()
        await before.until_event("bearing_measured")
        await before.until_event("flight_started", len(before.of("flight_started")) + 1)
        process.kill()
        await process.wait()
        await seen_in(vehicle, found_in)
    known = before.of("belief_updated")[-1]["event"]
    bearings = [e["event"]["bearing_id"] for e in before.of("bearing_measured")]
    assert bearings

    async with server_process(tmp_path) as (url, _), console(url) as after:
        after.mission_id = mission_id
        await after.watch()
        await after.until_phase("hold")
        await after.until_event("server_restarted")
        rebuilt = await after.until_event("belief_updated", len(before.of("belief_updated")) + 1)
        assert rebuilt["digest"] == known["digest"]
        assert rebuilt == known
        assert after.events[: len(before.events)] == before.events
        assert [e["event"]["bearing_id"] for e in after.of("bearing_measured")] == bearings
        await asyncio.sleep(1.0)
        assert after.phases[-1] == "hold"
        assert after.messages["telemetry"][-1]["in_air"]
        await vehicle.order("battery", percent=100)
        assert (await after.order("resume"))["accepted"]
        ended = await after.until_event("mission_ended", wall_s=120)
        assert ended["outcome"] == "localized", after.story()
        assert ended["mission_time_s"] > 60
