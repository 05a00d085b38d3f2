"""A mission that flies on without turning, over real sockets: to its claim, and ended in the middle of a swing."""

from __future__ import annotations

import asyncio
import math
from datetime import datetime
from pathlib import Path
from typing import Any

import pytest
from console import Console, console, simulated_vehicle
from test_kill import seen_in, server_process

from backend.cli.running import RunningServer
from backend.simulation.emitters import Signal
from hardware.frame import LocalFrame
from hardware.readings import Place
from hardware.sim.autopilot.launch import SimulatedAutopilot

pytestmark = pytest.mark.system

NEVER_STOP: dict[str, Any] = {
    "sensor": {"bearing_errors": "joint", "listen_on_the_way": True, "swing_on_the_way": True, "never_stop": True},
    "localization": {"minimum_places": 9},
    "planner": {"seed": 3},
}
"""Long enough that legs tell as much as a turn at one place or another, whatever chance has in store."""
A_SECOND_LEG: dict[str, Any] = {**NEVER_STOP, "localization": {"minimum_places": 3}}

SHORT_S = 20.0
"""A leg that lasts no longer may be over before the nose comes to a side, from wherever it began."""
YAW = {"px4": 192, "ardupilot": 115}
"""MAV_CMD by which the nose is sent somewhere in flight: reposition, or condition yaw."""
FLIGHT = {16, 20, 21, 22, 115, 176, 192, 400}
"""MAV_CMD that move the vehicle or its nose."""


async def in_a_swing(operator: Console, vehicle: SimulatedAutopilot, flavour: str) -> None:
    """One turn was made; the craft is on its second leg, and its nose was sent somewhere several times."""
    await operator.draft(**A_SECOND_LEG)
    await operator.ready(120)
    await operator.watch()
    await operator.start()
    await operator.until_event("flight_started", 2, wall_s=120)
    began_s = (await vehicle.order("truth"))["time_s"]
    async with asyncio.timeout(60):
        while len(await sent(vehicle, began_s, {YAW[flavour]})) < 3:  # noqa: ASYNC110 (another process)
            await asyncio.sleep(0.02)
    assert len(operator.of("place_reached")) == 1, "it is still on its way"


async def sent(vehicle: SimulatedAutopilot, since_s: float, kinds: set[int]) -> list[Any]:
    told = await vehicle.order("commands", since_s=since_s)
    return [command for command in told["commands"] if command[1] in kinds]


def flown_s(operator: Console, place_number: int) -> float:
    """From when the leg to this place began until what was heard on it was known."""
    begun, known = (
        next(
            datetime.fromisoformat(one["at_utc"])
            for one in operator.of(kind)
            if one["event"]["place_number"] == place_number
        )
        for kind in ("flight_started", "heard_on_the_way")
    )
    return (known - begun).total_seconds()


@pytest.mark.parametrize("flavour", ["px4", pytest.param("ardupilot", marks=pytest.mark.long)])
async def test_a_mission_is_localized_without_a_turn_at_every_place(server: RunningServer, operator: Console) -> None:
    await operator.draft(**NEVER_STOP)
    await operator.ready(120)
    await operator.watch()
    await operator.start()
    ended = await operator.until_event("mission_ended", wall_s=240)
    await operator.until_phase("ground")
    assert ended["outcome"] == "localized", operator.story()
    last = operator.of("belief_updated")[-1]["event"]
    assert server.receiver is not None
    truth = server.receiver.truth[Signal(868.3e6)]
    error = math.hypot(*LocalFrame(truth).to_enu(Place(last["estimate"]["lat"], last["estimate"]["lon"])))
    assert error < 4 * last["estimate"]["expected_rmse_m"]
    passed = operator.of("place_passed")
    assert passed, "it turned at every place"
    assert all(one["event"]["reason"]["code"] == "way_told_enough" for one in passed)
    numbers = {one["event"]["place_number"] for one in passed}
    swept = {one["event"]["place_number"] for one in operator.of("sweep_started")}
    assert min(swept) == 1
    assert not numbers & swept
    legs = [one["event"] for one in operator.of("heard_on_the_way") if one["event"]["place_number"] in numbers]
    assert legs
    assert all(leg["stretches"] for leg in legs)
    noses = [(why, flown_s(operator, leg["place_number"])) for leg in legs for why in leg["nose"]]
    assert all(why["rate_deg_s"] > 20.0 and why["end"] == "near_place" for why, _ in noses), noses
    assert all(why["swung"] > 0 for why, leg_s in noses if leg_s > SHORT_S), noses
    assert any(why["swung"] > 0 for why, _ in noses), noses
    turned = [one["event"]["reason"] for one in operator.of("phase_changed") if one["event"]["after"] == "measuring"]
    assert turned[0] == {"because": "first", "code": "turns_here"}


@pytest.mark.parametrize("flavour", ["px4", "ardupilot"])
async def test_a_hold_in_the_middle_of_a_swing_stops_flight_and_nose(
    operator: Console, tmp_path: Path, flavour: str
) -> None:
    vehicle = await simulated_vehicle(tmp_path)
    await in_a_swing(operator, vehicle, flavour)
    assert (await operator.order("hold"))["accepted"]
    await operator.until_event("order_done")
    held_s = (await vehicle.order("truth"))["time_s"]
    await asyncio.sleep(1.0)
    assert await sent(vehicle, held_s + 0.2, FLIGHT) == []
    assert operator.phases[-1] == "hold"
    assert operator.of("heard_on_the_way")[-1]["event"]["place_number"] == 1, "a leg that a hold breaks off leaves none"
    assert (await operator.order("resume"))["accepted"]
    ended = await operator.until_event("mission_ended", wall_s=240)
    assert ended["outcome"] == "localized", operator.story()


@pytest.mark.parametrize("flavour", ["px4", "ardupilot"])
async def test_a_pilot_in_the_middle_of_a_swing_is_sent_nothing_more(
    operator: Console, tmp_path: Path, flavour: str
) -> None:
    vehicle = await simulated_vehicle(tmp_path)
    await in_a_swing(operator, vehicle, flavour)
    took = await vehicle.order("pilot_mode")
    await operator.until_phase("manual")
    await asyncio.sleep(1.0)
    assert await sent(vehicle, took["time_s"] + 0.5, FLIGHT) == []
    assert (await vehicle.order("truth"))["mode"] == took["mode"]
    assert operator.phases[-1] == "manual"
    assert operator.of("place_passed") == []


async def test_after_kill_9_in_the_middle_of_a_leg_it_holds_with_the_identical_belief(tmp_path: Path) -> None:
    async with server_process(tmp_path) as (url, process), console(url) as before:
        mission_id = await before.draft(**NEVER_STOP)
        await before.ready(120)
        vehicle = await simulated_vehicle(tmp_path)
        await vehicle.order("set_param", name="NAV_DLL_ACT", value=1)
        await before.watch()
        await before.start()
        await before.until_event("place_passed", wall_s=120)
        await before.until_event("flight_started", len(before.of("flight_started")) + 1)
        process.kill()
        await process.wait()
        await seen_in(vehicle, "HOLD")
    known = before.of("belief_updated")[-1]["event"]
    async with server_process(tmp_path) as (url, _), console(url) as after:
        after.mission_id = mission_id
        await after.watch()
        await after.until_phase("hold")
        await after.until_event("server_restarted")
        rebuilt = await after.until_event("belief_updated", len(before.of("belief_updated")) + 1)
        assert rebuilt == known
        assert after.events[: len(before.events)] == before.events
        await asyncio.sleep(1.0)
        assert after.phases[-1] == "hold"
        assert (await after.order("resume"))["accepted"]
        ended = await after.until_event("mission_ended", wall_s=240)
        assert ended["outcome"] == "localized", after.story()
