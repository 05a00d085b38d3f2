"""Another ground station's view: MAVSDK's own plugins find the simulated autopilot healthy and fly it."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Callable

import pytest
from mavsdk.asyncio import Configuration, Mavsdk
from mavsdk.asyncio.plugins.action import ActionAsync
from mavsdk.asyncio.plugins.telemetry import TelemetryAsync
from mavsdk.component_type import ComponentType

from hardware.sim.autopilot.launch import Setting, SimulatedAutopilot, launch_simulated


@pytest.fixture(params=["px4", "ardupilot"])
async def sim(request: pytest.FixtureRequest) -> AsyncIterator[SimulatedAutopilot]:
    sim = await launch_simulated(Setting(flavour=request.param, speedup=10.0))
    try:
        yield sim
    finally:
        await sim.stop()


async def until(sim: SimulatedAutopilot, happened: Callable[[dict[str, float]], bool]) -> None:
    for _ in range(300):
        if happened(await sim.order("truth")):
            return
        await asyncio.sleep(0.05)
    pytest.fail(f"did not happen: {await sim.order('truth')}")


async def test_mavsdks_own_plugins_find_it_healthy_and_fly_it(sim: SimulatedAutopilot) -> None:
    mavsdk = Mavsdk(Configuration.create_with_component_type(ComponentType.GROUND_STATION))
    try:
        await mavsdk.add_any_connection(sim.url)
        system = await mavsdk.first_autopilot(timeout_s=10.0)
        assert system is not None
        telemetry, action = TelemetryAsync(system), ActionAsync(system)
        await telemetry.set_rate_position(10.0)
        await telemetry.set_rate_home(1.0)
        await telemetry.set_rate_health(1.0)

        async def healthy() -> None:
            async for health in telemetry.subscribe_health():
                if health.is_global_position_ok and health.is_home_position_ok and health.is_armable:
                    return

        await asyncio.wait_for(healthy(), 60)
        await asyncio.sleep(1.0)
        await action.set_takeoff_altitude(10.0)
        await action.arm()
        await action.takeoff()
        await until(sim, lambda truth: truth["altitude_relative_m"] > 9.0)
        truth = await sim.order("truth")
        await action.goto_location(truth["lat"] + 2e-4, truth["lon"], truth["altitude_amsl_m"] + 5.0, 0.0)
        await until(sim, lambda now: abs(now["lat"] - truth["lat"] - 2e-4) < 2e-5)
        await action.return_to_launch()
        await until(sim, lambda now: not now["in_air"])
    finally:
        await asyncio.to_thread(mavsdk.destroy)
