"""Links that are bad or gone (figure 13): what the operator was promised happens, over real sockets.

pytest tests/system/test_links.py -m "system or long" -s      prints what the bad link cost
"""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path

import pytest
from console import Console, console, simulated_vehicle
from poor_link import PoorLink, poor_link

from backend.cli.running import RunningServer, running_server
from backend.settings import Settings
from hardware.sim.autopilot.launch import Setting, SimulatedAutopilot, free_port, launch_simulated


@asynccontextmanager
async def flown_through(
    link: PoorLink, folder: Path, flavour: str, speedup: float
) -> AsyncIterator[tuple[Console, SimulatedAutopilot]]:
    """A server that reaches its vehicle through this link only, and a console on it."""
    setting = Setting(flavour=flavour, speedup=speedup, seed=3, wind=(3.0, 240.0, 1.0))
    vehicle = await launch_simulated(setting)
    port = free_port()
    settings = Settings(port=0, data_dir=folder, vehicle_url=f"udpin://127.0.0.1:{port}", time_factor=speedup, seed=3)
    try:
        async with (
            poor_link(link, vehicle.connect_port, port),
            running_server(settings) as server,
            console(server.url) as shown,
        ):
            await until_heard(shown)
            await shown.draft(planner={"seed": 3})
            await shown.ready(90)
            await shown.watch()
            yield shown, vehicle
    finally:
        await vehicle.stop()


async def until_heard(shown: Console) -> None:
    """Before that nobody knows where to search."""
    async with asyncio.timeout(60):
        while (await shown.client.get("/api/vehicle")).json()["lat"] is None:  # noqa: ASYNC110 (asked as a page does)
            await asyncio.sleep(0.2)


@pytest.mark.long
@pytest.mark.timeout(900)
@pytest.mark.parametrize("flavour", ["px4", "ardupilot"])
async def test_a_late_and_lossy_link_costs_time_and_nothing_else(
    tmp_path: Path, flavour: str, capsys: pytest.CaptureFixture[str]
) -> None:
    """300 ms each way and 5 % lost each way: localized, never a false alarm, every command obeyed in the end."""
    async with flown_through(PoorLink(0.3, 0.05), tmp_path, flavour, speedup=2.0) as (shown, _):
        refused = await shown.start(90)
        await shown.until_event("flight_started", wall_s=120)
        assert (await shown.order("hold"))["accepted"]
        await shown.until_phase("hold")
        await asyncio.sleep(2.0)
        assert (await shown.order("resume"))["accepted"]
        ended = await shown.until_event("mission_ended", wall_s=400)
        holds = [e["event"]["reason"] for e in shown.of("phase_changed") if e["event"]["after"] == "hold"]
        alerts = [(e["event"]["topic"], e["event"]["reason"]["code"]) for e in shown.of("alert_raised")]
        with capsys.disabled():
            taken = len(shown.of("bearing_measured"))
            print(f"\n{flavour}: {ended['outcome']} in {ended['mission_time_s']:.0f} s, {taken} bearings, "
                  f"start refused {refused}, held because {holds}, alerts {alerts}")  # fmt: skip
    assert ended["outcome"] == "localized", ended
    assert [(reason["code"], reason["order"]) for reason in holds] == [("ordered", "hold")]
    assert not any("link" in code for _, code in alerts)


@pytest.mark.system
async def test_a_lost_console_holds_the_vehicle_and_then_sends_it_home(
    server: RunningServer, operator: Console, tmp_path: Path
) -> None:
    """The last browser goes away in flight: hold, then return, each by its timer; the journal tells afterwards."""
    await operator.draft(planner={"seed": 3}, timers={"console_lost_hold_s": 0.5, "console_lost_return_s": 2.0})
    await operator.ready()
    await operator.close()
    operator.events.clear()
    await operator.watch()
    await operator.start()
    await operator.until_event("flight_started")
    vehicle = await simulated_vehicle(tmp_path)
    await operator.close()
    async with asyncio.timeout(60):
        while (await vehicle.order("truth"))["mode"] != "LAND":  # noqa: ASYNC110 (another process)
            await asyncio.sleep(0.05)
    await operator.watch()
    await operator.until(lambda: "returning" in operator.phases)
    told = [e["event"] for e in operator.events]
    (lost,) = [e for e in told if e["kind"] == "link_lost"]
    assert lost["link"] == "console"
    assert operator.phases[operator.phases.index("returning") - 1] == "hold"
    (held,) = [e for e in told if e["kind"] == "hold_ordered"]
    assert (held["by"], held["reason"]["code"], held["reason"]["stage"]) == (None, "no_console", "hold")
    raised = [e for e in told if e["kind"] == "alert_raised"]
    assert any((e["level"], e["reason"]["code"]) == ("warning", "no_console") for e in raised)
