"""A hold ends where the vehicle comes to rest, not at the place that PX4 reckoned while it still flew."""

from __future__ import annotations

import asyncio
from dataclasses import replace

import pytest
from paper import PLACE, POSCTL, Scene

from hardware.autopilot.guidance import Guidance
from hardware.autopilot.hold import BRAKES_S, STAYS_M_S, TAKEN_S, hold
from hardware.autopilot.hover import SETTLED_S
from hardware.autopilot.messages import REPOSITION
from hardware.autopilot.px4 import HOLD
from hardware.ports import NotInControl

DENIED = 2
BOOTED_S = 999.0


async def moves(scene: Scene, speed_m_s: float, seconds: float = 0.2) -> None:
    """North, ten reports a second."""
    for _ in range(round(seconds / 0.1)):
        scene.clock.at += 0.09
        boot_ms = round((scene.clock.at - BOOTED_S) * 1e3)
        scene.hear("GLOBAL_POSITION_INT", PLACE | {"time_boot_ms": boot_ms, "vx": round(speed_m_s * 100)})
        for _ in range(20):
            await asyncio.sleep(0)


async def holding(scene: Scene) -> asyncio.Task[None]:
    """Ordered at full speed."""
    scene.mode(HOLD)
    await moves(scene, 7.0)
    ordered = asyncio.create_task(hold(Guidance(scene.monitor)))
    await moves(scene, 7.0)
    assert scene.link.sent == [REPOSITION]
    return ordered


async def test_a_vehicle_that_nearly_rests_is_told_once_to_stay_there(flying: Scene) -> None:
    ordered = await holding(flying)
    await moves(flying, STAYS_M_S + 0.2)
    assert flying.link.sent == [REPOSITION]
    await moves(flying, STAYS_M_S - 0.1, SETTLED_S + 0.5)
    await asyncio.wait_for(ordered, 1.0)
    assert flying.link.sent == [REPOSITION, REPOSITION]
    assert flying.monitor.dialect.stay is not None
    assert not flying.monitor.dialect.stay.changes_mode


async def test_a_stay_that_is_refused_is_no_failure(flying: Scene) -> None:
    ordered = await holding(flying)
    flying.link.result = DENIED
    await moves(flying, 0.1, SETTLED_S + 0.5)
    await asyncio.wait_for(ordered, 1.0)
    assert flying.link.sent == [REPOSITION, REPOSITION]


async def test_a_pilot_who_takes_a_braking_vehicle_is_told_nothing_more(flying: Scene) -> None:
    ordered = await holding(flying)
    await moves(flying, 3.0)
    flying.mode(POSCTL)
    await moves(flying, 0.1, SETTLED_S + 0.5)
    with pytest.raises(NotInControl, match="POSCTL"):
        await ordered
    assert flying.link.sent == [REPOSITION]


async def test_a_slow_vehicle_in_hold_is_paused_again_before_an_order_selects_the_mode(
    flying: Scene, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("hardware.autopilot.hold.BRAKES_WALL_S", 0.0)
    ordered = await holding(flying)
    await moves(flying, 7.0, BRAKES_S + 0.5)
    assert flying.link.sent == [REPOSITION, REPOSITION]
    assert not any(order.changes_mode for order in flying.monitor.dialect.hold[:2])
    flying.mode(POSCTL)
    await moves(flying, 7.0, BRAKES_S + 0.5)
    with pytest.raises(NotInControl, match="POSCTL"):
        await ordered
    assert flying.link.sent == [REPOSITION, REPOSITION]


async def test_an_autopilot_that_rests_where_it_stops_is_told_nothing_more(
    flying: Scene, monkeypatch: pytest.MonkeyPatch
) -> None:
    rests = replace(flying.monitor.dialect, stay=None)
    monkeypatch.setattr(type(flying.monitor), "dialect", rests)
    ordered = await holding(flying)
    await moves(flying, 0.1, SETTLED_S + 0.5)
    await asyncio.wait_for(ordered, 1.0)
    assert flying.link.sent == [REPOSITION]


async def test_a_nose_that_px4_would_turn_is_told_to_stay_once_the_hold_is_surely_taken(flying: Scene) -> None:
    flying.hear("ATTITUDE", {"time_boot_ms": 1, "roll": 0.0, "pitch": 0.0, "yaw": 2.0, "yawspeed": 0.5})
    ordered = await holding(flying)
    before_s = flying.clock.at
    while flying.link.sent == [REPOSITION]:
        await moves(flying, 6.5, 0.1)
        assert flying.clock.at - before_s < TAKEN_S + 0.2
    assert flying.link.sent == [REPOSITION, REPOSITION]
    assert flying.link.fields[-1]["param4"] == pytest.approx(2.0)
    assert all(flying.link.fields[-1][f"param{number}"] is None for number in (5, 6, 7))
    await moves(flying, 0.1, SETTLED_S + 0.5)
    await asyncio.wait_for(ordered, 1.0)
    assert flying.link.sent == [REPOSITION] * 4
    assert [fields["param4"] for fields in flying.link.fields[-2:]] == [None, pytest.approx(2.0)], "and where it stays"


async def test_a_nose_is_left_alone_by_a_hold_of_a_vehicle_that_hovers(flying: Scene) -> None:
    flying.hear("ATTITUDE", {"time_boot_ms": 1, "roll": 0.0, "pitch": 0.0, "yaw": 2.0, "yawspeed": 0.5})
    flying.mode(HOLD)
    await moves(flying, 0.2)
    ordered = asyncio.create_task(hold(Guidance(flying.monitor)))
    await moves(flying, 0.2, SETTLED_S + 0.5)
    await asyncio.wait_for(ordered, 1.0)
    assert [fields["param4"] for fields in flying.link.fields if fields["command"] == REPOSITION] == [None, None]


async def test_an_order_of_the_nose_that_was_lost_is_repeated_with_the_heading_of_then(
    flying: Scene, monkeypatch: pytest.MonkeyPatch
) -> None:
    """One lost frame turned a nose by 186 degrees, and a vehicle that braked was ordered to hold once more."""
    monkeypatch.setattr("hardware.autopilot.hold.BRAKES_WALL_S", 0.0)
    monkeypatch.setattr("hardware.autopilot.commander.ACK_WALL_S", 0.0)
    flying.hear("ATTITUDE", {"time_boot_ms": 1, "roll": 0.0, "pitch": 0.0, "yaw": 2.0, "yawspeed": -0.5})
    ordered = await holding(flying)
    flying.link.answers = False
    while flying.link.sent == [REPOSITION]:
        await moves(flying, 6.5, 0.1)
    flying.link.answers = True
    flying.hear("ATTITUDE", {"time_boot_ms": 2, "roll": 0.0, "pitch": 0.0, "yaw": 1.2, "yawspeed": -0.5})
    while flying.link.sent == [REPOSITION] * 2:
        await moves(flying, 5.0, 0.1)
        await asyncio.sleep(0.02)  # an answer is waited for by the wall clock
    told = [fields["param4"] for fields in flying.link.fields if fields["command"] == REPOSITION]
    noses = [yaw for yaw in told if yaw is not None]
    assert noses == pytest.approx([2.0, 1.2])
    await moves(flying, 3.5, BRAKES_S)
    assert len(flying.link.sent) == 3
    await moves(flying, 0.1, SETTLED_S + 0.5)
    await asyncio.wait_for(ordered, 1.0)


async def test_a_vehicle_that_gets_faster_until_the_hold_arrives_is_told_to_keep_its_nose(flying: Scene) -> None:
    """Over a slow link 1.5 m/s were known when 4 were flown: the nose swung by 147 degrees, and a vehicle that braked
    was ordered to hold once more."""
    flying.hear("ATTITUDE", {"time_boot_ms": 1, "roll": 0.0, "pitch": 0.0, "yaw": 2.0, "yawspeed": 0.5})
    flying.mode(HOLD)
    await moves(flying, 1.5)
    flying.link.answers = False
    ordered = asyncio.create_task(hold(Guidance(flying.monitor)))
    await asyncio.sleep(0)  # it knows of 1.5 m/s
    await moves(flying, 4.0)
    flying.monitor.commander.acknowledged({"command": REPOSITION, "result": 0})
    flying.link.answers = True
    await moves(flying, 3.0, TAKEN_S + 0.2)
    assert [fields["param4"] for fields in flying.link.fields if fields["command"] == REPOSITION][1:] == [2.0]
    await moves(flying, 2.3, BRAKES_S + 0.3)
    assert len(flying.link.sent) == 2, "slower than six tenths of its fastest"
    await moves(flying, 0.1, SETTLED_S + 0.5)
    await asyncio.wait_for(ordered, 1.0)
