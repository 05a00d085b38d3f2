"""What goes wrong in flight: the pilot takes over, the vehicle is gone, the receiver falls silent."""

from __future__ import annotations

import asyncio
from pathlib import Path

import pytest
from console import Console, simulated_vehicle

from backend.cli.running import RunningServer

pytestmark = pytest.mark.system


@pytest.mark.parametrize("flavour", ["px4", "ardupilot"])
async def test_the_pilot_takes_over_and_nothing_is_sent_until_resume(operator: Console, tmp_path: Path) -> None:
    vehicle = await simulated_vehicle(tmp_path)
    await operator.start()
    await operator.until_event("flight_started")
    took = await vehicle.order("pilot_mode")
    await operator.until_phase("manual")
    for kind in ("hold", "return", "accept"):
        assert not (await operator.order(kind))["accepted"]
    await asyncio.sleep(1.0)
    told = await vehicle.order("commands", since_s=took["time_s"] + 0.5)
    flown = [c for c in told["commands"] if c[1] in FLIGHT]
    assert flown == []
    assert operator.phases[-1] == "manual"
    refused = await operator.order("resume")
    assert not refused["accepted"]
    assert refused["reason"]["code"] == "not_given_back"
    assert (await vehicle.order("truth"))["mode"] == took["mode"]
    await vehicle.order("give_back")
    async with asyncio.timeout(60):
        while not (await operator.order("resume"))["accepted"]:  # noqa: ASYNC110 (asked again as a person would)
            await asyncio.sleep(0.1)
    ended = await operator.until_event("mission_ended", wall_s=120)
    assert ended["outcome"] == "localized", operator.story()


FLIGHT = {16, 20, 21, 22, 176, 192, 400}
"""MAV_CMD that move the vehicle: waypoint, return, land, take-off, mode, reposition, arm."""


async def test_a_vehicle_that_is_gone_is_said_and_the_mission_waits_for_it(operator: Console, tmp_path: Path) -> None:
    vehicle = await simulated_vehicle(tmp_path)
    await vehicle.order("set_param", name="NAV_DLL_ACT", value=1)
    await operator.start()
    await operator.until_event("flight_started")
    await vehicle.order("link_loss", seconds=72)
    lost = await operator.until_event("link_lost")
    assert lost["link"] == "vehicle"
    await operator.until_phase("hold")
    alert = await operator.until_event("alert_raised")
    assert alert["level"] == "warning"
    refused = await operator.order("resume")
    assert not refused["accepted"]
    assert refused["reason"]["code"] == "no_link"
    await operator.until_event("link_restored")
    assert (await operator.order("resume"))["accepted"]
    ended = await operator.until_event("mission_ended", wall_s=120)
    assert ended["outcome"] == "localized", operator.story()


async def test_a_silent_receiver_holds_the_measurement_and_loses_nothing(
    server: RunningServer, operator: Console
) -> None:
    await operator.start()
    await operator.until_phase("measuring")
    assert server.receiver is not None
    server.receiver.silence(True)
    await operator.until_phase("hold")
    assert any(e["event"]["link"] == "receiver" for e in operator.of("link_lost"))
    assert any(e["event"]["topic"] == "receiver" for e in operator.of("alert_raised"))
    before = len(operator.of("bearing_measured"))
    server.receiver.silence(False)
    await operator.until_event("link_restored")
    assert (await operator.order("resume"))["accepted"]
    ended = await operator.until_event("mission_ended", wall_s=120)
    assert ended["outcome"] == "localized", operator.story()
    assert len(operator.of("bearing_measured")) > before
