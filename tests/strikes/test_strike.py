"""The judge of takeovers is right about what the record says, and a strike at a simulated autopilot comes about."""

from __future__ import annotations

import asyncio
import random
from unittest.mock import AsyncMock, Mock

import pytest

from hardware.authority import Authority
from hardware.autopilot.connect import connect_vehicle
from hardware.clock import WallClock
from hardware.sim.autopilot.launch import Setting, free_port, launch_simulated
from tests.strikes.frames import Frame
from tests.strikes.pilot import HABITS, PILOT_SYSTEM, Pilot, piloted
from tests.strikes.proxy import COMMAND_ACK, COMMAND_LONG, CURRENT_MODE, HEARTBEAT, STATUS_TEXT, Passed, Proxy, proxied
from tests.strikes.scenes import Field
from tests.strikes.strike import left_for, story
from tests.strikes.wire import datagrams

MANUAL_CONTROL = 69
POSCTL, HOLD = 3 << 16, 4 << 16 | 3 << 24


def said(at_s: float, mode: int) -> Passed:
    return Passed(at_s, "from", CURRENT_MODE, {"custom_mode": mode})


def pilot_of(*passed: Passed) -> tuple[Proxy, Pilot]:
    proxy = Proxy(record=list(passed))
    return proxy, Pilot(proxy, HABITS["px4"])


def test_a_takeover_that_lasts_is_not_undone_by_a_report_of_the_mode_before() -> None:
    proxy, pilot = pilot_of(said(9.9, HOLD), said(10.0, POSCTL), said(10.1, HOLD), said(10.3, POSCTL))

    assert pilot.took(9.95) == 10.0
    assert left_for(proxy, pilot, 10.0) is None


def test_a_takeover_undone_is_seen_even_when_sticks_take_again() -> None:
    answer = {"target_system": PILOT_SYSTEM, "command": 176, "result": 0}
    proxy, pilot = pilot_of(
        Passed(10.0, "from", COMMAND_ACK, answer), said(10.05, HOLD), said(10.25, HOLD), said(10.4, POSCTL)
    )

    assert pilot.took(9.95) == 10.0
    assert left_for(proxy, pilot, 10.0) == HOLD


@pytest.mark.parametrize("fields", [{"target_system": 255, "result": 0}, {"target_system": PILOT_SYSTEM, "result": 2}])
def test_another_stations_answer_or_a_refusal_is_no_takeover(fields: dict[str, int]) -> None:
    _, pilot = pilot_of(Passed(10.0, "from", COMMAND_ACK, {"command": 176, **fields}), said(10.1, HOLD))

    assert pilot.took(9.9) is None


def test_the_sticks_are_told_by_text() -> None:
    _, pilot = pilot_of(Passed(10.0, "from", STATUS_TEXT, {"text": "Pilot took over using sticks"}))

    assert pilot.took(9.9) == 10.0


def test_the_story_of_a_takeover_tells_each_change_once() -> None:
    intended = {"custom_mode": HOLD, "intended_custom_mode": POSCTL}
    told = story(
        [
            Passed(10.0, "pilot", COMMAND_LONG, {"command": 176, "param1": 1.0, "param2": 3.0, "param3": 0.0}),
            said(10.1, POSCTL),
            said(10.2, POSCTL),
            Passed(10.3, "from", HEARTBEAT, {"custom_mode": POSCTL, "system_status": 4}),
            Passed(12.0, "from", STATUS_TEXT, {"text": "Failsafe activated\t"}),
            Passed(12.1, "from", CURRENT_MODE, intended),
        ],
        10.0,
    )

    assert list(told) == [
        "+0.000 s pilot: command 176 (1, 3, 0)",
        "+0.100 s from: mode 0x30000, intended None, system status None",
        "+0.300 s from: mode 0x30000, intended None, system status 4",
        "+2.000 s from: Failsafe activated",
        "+2.100 s from: mode 0x3040000, intended 196608, system status 4",
    ]


async def test_a_vehicle_that_somebody_else_took_before_is_not_struck_at(monkeypatch: pytest.MonkeyPatch) -> None:
    vehicle = Mock()
    vehicle.telemetry.return_value.authority = Authority(who="failsafe", taken_by="mode", mode="RETURN")
    proxy, pilot = pilot_of()
    field = Field(vehicle, proxy, pilot, random.Random(1))
    monkeypatch.setattr(field, "_prepare", AsyncMock())

    with pytest.raises(TimeoutError, match="before stay, by mode: RETURN"):
        await field.strike("stay", "crossing", "mode")

    vehicle.take_control.assert_called_once()
    vehicle.hold.assert_not_called()
    assert proxy.record == []


async def test_the_pilots_hands_go_on_by_themselves_and_move_as_they_are_told() -> None:
    heard: asyncio.Queue[int] = asyncio.Queue()
    proxy = Proxy(system=7)

    def take(frame: Frame) -> None:
        if frame.number == MANUAL_CONTROL:
            assert frame.system == PILOT_SYSTEM
            heard.put_nowait(frame.fields()["x"])

    async with datagrams(take, bind=("127.0.0.1", port := free_port())):
        proxy.vehicle_address = lambda: ("127.0.0.1", port)
        async with piloted(proxy, "px4") as pilot:
            async with asyncio.timeout(60):
                for _ in range(3):
                    assert await heard.get() == 0
                pilot.take_by_sticks()
                while await heard.get() == 0:
                    pass
                pilot.release_sticks()
                while await heard.get() != 0:
                    pass


@pytest.mark.slow
async def test_a_strike_at_a_simulated_px4_takes_and_is_noticed() -> None:
    autopilot = await launch_simulated(Setting(flavour="px4", speedup=1.0, seed=7))
    async with proxied(autopilot.url) as proxy, piloted(proxy, "px4") as pilot:
        vehicle = await connect_vehicle(proxy.url, WallClock())
        try:
            proxy.delay_s = 0.05
            outcome = await Field(vehicle, proxy, pilot, random.Random(1)).strike("flight", "under way", "mode")
        finally:
            await vehicle.close()
            await autopilot.stop()
            await asyncio.sleep(0)

    assert outcome.took_s is not None
    assert not outcome.undone
    assert outcome.noticed_s is not None
    assert 0.05 <= outcome.noticed_s < 1.0


async def test_a_proxy_leaves_its_address_to_the_next_one() -> None:
    url = f"udpin://127.0.0.1:{free_port()}"
    for _ in range(3):
        async with proxied(url):
            pass
