"""No vehicle in the air is out of reach: after an abort and a kill -9, and without any mission."""

from __future__ import annotations

import asyncio
from pathlib import Path
from uuid import uuid4

import pytest
from console import Console, console
from processes import serving, truth_until, vehicle_apart

pytestmark = pytest.mark.system


async def order_craft(operator: Console, kind: str) -> dict[str, object]:
    body = {"command_id": str(uuid4()), "command": {"kind": kind}}
    answer = await operator.client.post("/api/crafts/craft-1/commands", json=body)
    assert answer.status_code == 200, answer.text
    return answer.json()


async def fly(operator: Console, phase: str) -> str:
    mission_id = await operator.draft(planner={"seed": 3})
    await operator.ready()
    await operator.watch()
    await operator.start()
    await operator.until_phase(phase)
    return mission_id


async def test_an_aborted_mission_whose_server_was_killed_is_held_and_still_reached(tmp_path: Path) -> None:
    async with vehicle_apart() as vehicle:
        async with serving(tmp_path, "--vehicle", vehicle.url) as (url, process), console(url) as before:
            mission_id = await fly(before, "flying")
            assert (await before.order("abort"))["accepted"]
            process.kill()
            await process.wait()
        async with serving(tmp_path, "--vehicle", vehicle.url) as (url, _), console(url) as after:
            after.mission_id = mission_id
            await after.watch()
            await after.until_phase("hold")
            await after.draft(planner={"seed": 3})
            refused = await after.order("start")
            assert refused["reason"]["code"] == "another_mission_flies"
            after.mission_id = mission_id
            assert (await after.order("hold"))["accepted"]
            await truth_until(vehicle, lambda truth: truth["mode"] == "HOLD" and truth["speed_m_s"] < 1.0)
            assert (await after.order("return"))["accepted"]
            # it returns by way points of ours; nobody stopped it while no server ran, so home may be below it already
            await truth_until(vehicle, lambda truth: truth["mode"] in ("RETURN", "LAND") or truth["speed_m_s"] > 1.0)
            assert (await order_craft(after, "land"))["accepted"]
            await truth_until(vehicle, lambda truth: truth["mode"] == "LAND")
            await after.until_phase("ground", wall_s=90)


async def test_a_vehicle_in_the_air_without_a_mission_is_shown_and_reached_and_nothing_is_sent_by_itself(
    tmp_path: Path,
) -> None:
    async with vehicle_apart() as vehicle:
        async with serving(tmp_path / "one", "--vehicle", vehicle.url) as (url, process), console(url) as before:
            await fly(before, "flying")
            assert (await before.order("hold"))["accepted"]
            await before.until_event("order_done")
            process.kill()
            await process.wait()
        commanded = {22, 176, 192, 400}  # take-off, mode, reposition, arm
        async with serving(tmp_path / "two", "--vehicle", vehicle.url) as (url, _), console(url) as after:
            since = (await vehicle.order("ping"))["time_s"]
            await after.draft(planner={"seed": 3})
            await after.watch()

            def shown() -> bool:
                status = after.messages.get("status", [])
                crafts = status[-1]["crafts"] if status else []
                return bool(crafts) and crafts[0]["mission_id"] is None and crafts[0]["phase"] != "ground"

            await after.until(shown)
            await asyncio.sleep(1.0)
            sent = (await vehicle.order("commands", since_s=since))["commands"]
            assert not [number for _, number in sent if number in commanded]
            assert (await after.order("start"))["reason"]["code"] == "already_in_air"
            assert (await order_craft(after, "hold"))["accepted"]
            assert (await order_craft(after, "return"))["accepted"]
            await truth_until(vehicle, lambda truth: truth["mode"] == "RETURN")
            await vehicle.order("pilot_mode")
            await truth_until(vehicle, lambda truth: truth["mode"] == "POSCTL")
            await after.until(lambda: after.messages["telemetry"][-1]["who"] == "pilot")
            refused = await order_craft(after, "land")
            assert not refused["accepted"]
            assert (await vehicle.order("truth"))["mode"] == "POSCTL"
            await vehicle.order("give_back")
            await asyncio.sleep(1.0)
            assert (await order_craft(after, "resume"))["accepted"]
            assert (await order_craft(after, "land"))["accepted"]
            await truth_until(vehicle, lambda truth: not truth["in_air"], 90)


@pytest.mark.parametrize(("fault", "count"), [("refuse", 5), ("ignore_all", 2), ("silent", 4)])
async def test_a_hold_that_is_refused_unheard_or_ignored_is_tried_again_until_the_vehicle_hovers(
    tmp_path: Path, fault: str, count: int
) -> None:
    async with (
        vehicle_apart() as vehicle,
        serving(tmp_path, "--vehicle", vehicle.url) as (url, _),
        console(url) as operator,
    ):
        await fly(operator, "flying")
        await asyncio.sleep(0.3)
        await vehicle.order("fault", kind=fault, count=count)
        assert (await operator.order("hold"))["accepted"]
        done = await operator.until_event("order_done")
        assert (done["order"], done["way"]) == ("hold", "hold")
        if fault == "refuse":
            assert operator.of("order_not_done")
        await truth_until(vehicle, lambda truth: truth["mode"] == "HOLD" and truth["speed_m_s"] < 1.0)
