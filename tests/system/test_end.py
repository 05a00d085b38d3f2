"""SIGTERM in flight: the vehicle is held first, or handed to its failsafe at once, and either is said."""

from __future__ import annotations

import asyncio
import signal
from pathlib import Path

import pytest
from console import console
from processes import serving, truth_until, vehicle_apart
from test_reach import fly

pytestmark = pytest.mark.system


async def said(process: asyncio.subprocess.Process, wall_s: float) -> str:
    """All of standard error once the process has ended."""
    async with asyncio.timeout(wall_s):
        _, err = await process.communicate()
    return err.decode()


async def test_the_vehicle_is_held_before_the_server_ends_and_the_next_one_finds_it_so(tmp_path: Path) -> None:
    async with vehicle_apart() as vehicle:
        async with serving(tmp_path, "--vehicle", vehicle.url) as (url, process), console(url) as operator:
            mission_id = await fly(operator, "flying")
            await truth_until(vehicle, lambda truth: truth["speed_m_s"] > 3.0)
            process.send_signal(signal.SIGTERM)
            await truth_until(vehicle, lambda truth: truth["mode"] == "HOLD" and truth["speed_m_s"] < 1.0, 5)
            await operator.close()
            words = await said(process, 20)
            assert "craft-1: held" in words
            assert process.returncode == 0
        async with serving(tmp_path, "--vehicle", vehicle.url) as (url, _), console(url) as after:
            after.mission_id = mission_id
            await after.watch()
            await after.until_event("server_restarted")
            assert after.phases[-1] == "hold"
            (ordered,) = [e["event"] for e in after.of("hold_ordered")]
            assert ordered["reason"]["code"] == "server_ends"


async def test_a_vehicle_that_refuses_the_hold_is_handed_to_its_failsafe_and_that_is_said(tmp_path: Path) -> None:
    async with vehicle_apart() as vehicle:
        await vehicle.order("set_param", name="NAV_DLL_ACT", value=2)
        async with serving(tmp_path, "--vehicle", vehicle.url) as (url, process), console(url) as operator:
            await fly(operator, "flying")
            await asyncio.sleep(0.3)
            await vehicle.order("fault", kind="refuse", count=1000)
            process.send_signal(signal.SIGTERM)
            words = await said(process, 25)
            assert "craft-1: what it was ordered is NOT confirmed" in words
        await truth_until(vehicle, lambda truth: truth["mode"] == "RETURN", 40)


@pytest.mark.parametrize("second", [signal.SIGTERM, signal.SIGINT])
async def test_a_second_signal_of_either_kind_ends_it_at_once(tmp_path: Path, second: signal.Signals) -> None:
    async with (
        vehicle_apart() as vehicle,
        serving(tmp_path, "--vehicle", vehicle.url) as (url, process),
        console(url) as operator,
    ):
        await fly(operator, "flying")
        await asyncio.sleep(0.3)
        await vehicle.order("fault", kind="refuse", count=1000)
        process.send_signal(signal.SIGTERM)
        await asyncio.sleep(0.5)
        assert process.returncode is None
        process.send_signal(second)

        await said(process, 5)
        assert process.returncode == -second
