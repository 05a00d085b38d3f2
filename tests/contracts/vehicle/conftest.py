from __future__ import annotations

import asyncio
import contextlib
import sys
from collections.abc import AsyncIterator
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent))

from rig import REAL_URL, SPEEDUP, Rig, ready

from hardware.autopilot.connect import connect_vehicle
from hardware.clock import ScaledClock, WallClock
from hardware.ports import VehicleError
from hardware.sim.autopilot.launch import Setting, launch_simulated


@pytest.fixture(params=["sim-px4", "sim-ardupilot", "real"])
async def rig(request: pytest.FixtureRequest) -> AsyncIterator[Rig]:
    name: str = request.param
    if name == "real":
        if REAL_URL is None:
            pytest.skip("CROSSFIX_TEST_VEHICLE names no vehicle")
        clock, autopilot, url = WallClock(), None, REAL_URL
    else:
        clock = ScaledClock(None, SPEEDUP)
        flavour = name.removeprefix("sim-")
        setting = Setting(flavour=flavour, speedup=SPEEDUP, seed=7, wind=(4.0, 250.0, 1.5), station_timeout_s=2.5)
        autopilot = await launch_simulated(setting)
        url = autopilot.url
    vehicle = await connect_vehicle(url, clock)
    rig = Rig(name, vehicle, clock, autopilot)

    async def listen() -> None:
        async for announcement in vehicle.changes():
            rig.news.append(announcement.reason)

    listener = asyncio.create_task(listen())
    try:
        await ready(vehicle, clock)
        yield rig
    finally:
        if autopilot is None and vehicle.telemetry().in_air:
            with contextlib.suppress(VehicleError):
                vehicle.take_control()
                await vehicle.land()
                await rig.until(lambda: not vehicle.telemetry().armed, 120, "landing")
        await vehicle.close()
        await asyncio.wait_for(listener, 60)  # closing ends changes()
        if autopilot is not None:
            await autopilot.stop()
