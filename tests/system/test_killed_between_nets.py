"""kill -9 while the autopilot is being given the fence of another search area: the next server gives it the whole of it
before anything is resumed."""

from __future__ import annotations

import asyncio
from pathlib import Path

import pytest
from console import Console, console
from poor_link import PoorLink, poor_link
from processes import serving, vehicle_apart

from hardware.sim.autopilot.launch import free_port

SLOW_S = 0.5
"""Each way, of wall time: a fence of some corners takes a good ten times as long."""


async def in_hold(shown: Console) -> None:
    async with asyncio.timeout(60):
        while (await shown.client.get("/api/vehicle")).json()["lat"] is None:  # noqa: ASYNC110 (asked as a page does)
            await asyncio.sleep(0.2)
    await shown.draft(planner={"seed": 3})
    await shown.ready(90)
    await shown.watch()
    await shown.start(60)
    await shown.until_event("flight_started")
    assert (await shown.order("hold"))["accepted"]
    await shown.until_phase("hold")


@pytest.mark.system
async def test_after_kill_9_between_the_nets_nothing_is_resumed_before_they_hang(tmp_path: Path) -> None:
    link, port = PoorLink(0.0, 0.0), free_port()
    arguments = ("--vehicle", f"udpin://127.0.0.1:{port}")
    async with vehicle_apart() as vehicle, poor_link(link, vehicle.connect_port, port):
        async with serving(tmp_path, *arguments) as (url, process), console(url) as before:
            await in_hold(before)
            mission_id = before.mission_id
            spec = (await before.client.get(f"/api/missions/{mission_id}")).json()["spec"]
            link.delay_s = SLOW_S
            wider = {"area": spec["area"], "priors": {}, "fence": None, "fence_margin_m": 120.0, "no_fly": []}
            changing = asyncio.create_task(before.order("change_area", search=wider))
            await before.until_event("nets_noted", 2)
            process.kill()
            await process.communicate()
            await asyncio.gather(changing, return_exceptions=True)
            assert before.of("nets_hung") == []
        link.delay_s = 0.0
        async with serving(tmp_path, *arguments) as (url, _), console(url) as after:
            after.mission_id = mission_id
            await after.watch()
            await after.until_event("server_restarted")
            refused: list[str] = []
            async with asyncio.timeout(60):
                while not (answer := await after.order("resume"))["accepted"]:
                    refused.append(answer["reason"]["code"])
                    await asyncio.sleep(0.2)
            assert "nets_changing" in refused, refused
            await after.until_event("resume_ordered")
            kinds = [recorded["event"]["kind"] for recorded in after.events]
            assert kinds.index("nets_hung") < kinds.index("resume_ordered")
            assert kinds.count("nets_hung") == 1
            await after.until_event("place_reached")
