"""The vehicle loses GPS, over real sockets: the server holds it before its autopilot acts. No bearing is taken."""

from __future__ import annotations

import asyncio
from pathlib import Path

import pytest
from console import Console, simulated_vehicle

pytestmark = pytest.mark.system


@pytest.fixture
def speedup() -> float:
    """Slow enough that the five seconds until the autopilot lands by itself outlast what a busy machine holds up."""
    return 5.0


@pytest.mark.parametrize(("flavour", "during"), [("px4", "flight_started"), ("ardupilot", "sweep_started")])
async def test_a_mission_without_gps_is_held_by_the_server_and_takes_no_bearing(
    operator: Console, tmp_path: Path, during: str
) -> None:
    vehicle = await simulated_vehicle(tmp_path)
    await operator.start()
    await operator.until_event(during)
    since = (await vehicle.order("gps_loss", seconds=60))["time_s"]
    lost = await operator.until_event("link_lost")
    assert (lost["link"], lost["reason"]["code"]) == ("gps", "place_unknown")
    await operator.until_phase("hold")
    changed = [e["event"] for e in operator.of("phase_changed") if e["event"]["after"] == "hold"]
    assert changed[0]["reason"]["code"] == "place_unknown", operator.story()
    alerts = [e["event"] for e in operator.of("alert_raised") if e["event"]["topic"] == "gps"]
    assert [(alert["level"], alert["reason"]["code"]) for alert in alerts] == [("warning", "place_unknown")]
    tried = await operator.until_event("order_tried")
    assert (tried["order"], tried["way"]) == ("hold", "hold")
    async with asyncio.timeout(60):
        while not (await vehicle.order("commands", since_s=since))["commands"]:  # noqa: ASYNC110 (another process)
            await asyncio.sleep(0.05)
    assert operator.of("bearing_measured") == []
    refused = await operator.order("override", place={"lat": 47.3977, "lon": 8.5456})
    assert not refused["accepted"]
