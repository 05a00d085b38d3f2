"""Ordered to arm, it may be armed. A climb goes on while it gains height, whatever a barometer says for a moment."""

from __future__ import annotations

import asyncio
import math
import random
from collections.abc import Callable

import pytest
from paper import ON_GROUND, PLACE, Scene, heartbeat

from hardware.autopilot.ardupilot import BRAKE, GUIDED
from hardware.autopilot.commander import ManoeuvreSuperseded
from hardware.autopilot.guidance import Guidance
from hardware.autopilot.messages import ARM
from hardware.autopilot.px4 import HOLD, TAKING_OFF
from hardware.autopilot.take_off import take_off
from hardware.ports import VehicleError

TARGET_M, CLIMBS_M_S = 40.0, 1.0
HOME_AMSL_M = 488.0


async def climbs(scene: Scene, height: Callable[[float], float], monkeypatch: pytest.MonkeyPatch) -> float:
    """The seconds until the take-off was done, with five reports a second of height(seconds since the order)."""
    monkeypatch.setattr("hardware.autopilot.take_off.RISES_WALL_S", 0.0)

    def hear(up: float) -> None:
        amsl, vz = HOME_AMSL_M + up, 0 if up >= TARGET_M else -100 * CLIMBS_M_S
        boot_ms = round(scene.clock.at * 1e3)
        heights = {"relative_alt": round(up * 1e3), "alt": round(amsl * 1e3)}
        scene.hear("GLOBAL_POSITION_INT", PLACE | heights | {"time_boot_ms": boot_ms, "vz": vz})
        scene.heartbeat(HOLD if up >= TARGET_M else TAKING_OFF, armed=True)

    hear(0.0)
    ordered = asyncio.create_task(take_off(Guidance(scene.monitor), TARGET_M))
    began_s = scene.clock.at
    while not ordered.done():
        scene.clock.at += 0.18
        hear(height(scene.clock.at - began_s))
        for _ in range(20):
            await asyncio.sleep(0)
    await ordered
    return scene.clock.at - began_s


@pytest.mark.parametrize("jump_m", [14.0, 30.0, -14.0])
async def test_a_height_that_jumps_for_a_moment_ends_no_climb(
    flying: Scene, monkeypatch: pytest.MonkeyPatch, jump_m: float
) -> None:
    """It was said to have climbed to 15 m only, while it climbed on at 1 m/s."""

    def height(after_s: float) -> float:
        jump = jump_m if 5.0 < after_s < 5.5 else 0.0
        return min(CLIMBS_M_S * after_s, TARGET_M) + jump

    assert await climbs(flying, height, monkeypatch) == pytest.approx(TARGET_M / CLIMBS_M_S, abs=1.0)


async def test_a_height_that_is_corrected_downwards_ends_no_climb(
    flying: Scene, monkeypatch: pytest.MonkeyPatch
) -> None:
    took_s = await climbs(flying, lambda s: min(CLIMBS_M_S * s - 12.0 * (s > 20.0), TARGET_M), monkeypatch)
    assert took_s == pytest.approx(TARGET_M / CLIMBS_M_S + 12.0, abs=1.0)


async def test_a_climb_that_pauses_for_eight_seconds_goes_on(flying: Scene, monkeypatch: pytest.MonkeyPatch) -> None:
    took_s = await climbs(flying, lambda s: min(s if s < 9.0 else max(9.0, s - 8.0), TARGET_M), monkeypatch)
    assert took_s == pytest.approx(TARGET_M / CLIMBS_M_S + 8.0, abs=1.0)


async def test_a_climb_that_stops_wavers_and_has_ended(flying: Scene, monkeypatch: pytest.MonkeyPatch) -> None:
    began_s = flying.clock.at
    with pytest.raises(VehicleError, match=r"climbed to 1\d\.\d m only"):
        await climbs(flying, lambda s: min(s, 10.5 + 0.4 * (round(s) % 2)), monkeypatch)
    assert flying.clock.at - began_s == pytest.approx(10.5 + 10.0, abs=1.5), "ten seconds after it stopped"


@pytest.mark.parametrize(
    "noise_m",
    [
        lambda s: 1.5 * (-1) ** round(2 * s),
        lambda s: 1.5 * math.sin(2.0 * math.pi * s / 8.0),
        lambda s: random.Random(round(1e3 * s)).gauss(0.0, 0.8),
    ],
    ids=["alternating", "wandering", "random"],
)
async def test_a_climb_that_stops_has_ended_though_its_height_is_noisy(
    flying: Scene, monkeypatch: pytest.MonkeyPatch, noise_m: Callable[[float], float]
) -> None:
    """Each swing back up was taken for a gain after a jump, and it was waited for until the end of the whole climb."""
    began_s = flying.clock.at
    with pytest.raises(VehicleError, match=r"climbed to \d+\.\d m only"):
        await climbs(flying, lambda s: min(s, 20.0) + noise_m(s), monkeypatch)
    assert flying.clock.at - began_s < 20.0 + 25.0, "of the 110 s that the whole climb may take"


async def test_a_climb_with_a_noisy_height_goes_on(flying: Scene, monkeypatch: pytest.MonkeyPatch) -> None:
    took_s = await climbs(flying, lambda s: min(CLIMBS_M_S * s + 1.5 * (-1) ** round(2 * s), TARGET_M), monkeypatch)
    assert took_s == pytest.approx(TARGET_M / CLIMBS_M_S, abs=3.0)


async def test_a_climb_that_becomes_a_slow_descent_has_ended(flying: Scene, monkeypatch: pytest.MonkeyPatch) -> None:
    """Every two metres that it sank were taken for a jump, and it was waited for until the end of the whole climb."""
    began_s = flying.clock.at
    with pytest.raises(VehicleError, match=r"climbed to 1\d\.\d m only"):
        await climbs(flying, lambda s: min(s, 20.0 - 0.3 * (s - 20.0)), monkeypatch)
    assert flying.clock.at - began_s == pytest.approx(20.0 + 10.0, abs=1.5)


async def test_until_the_arming_is_answered_no_heartbeat_says_that_it_is_disarmed(flying: Scene) -> None:
    """Over a slow link one that left before the order came long after it: a return was refused, and it took off."""
    flying.heartbeat(HOLD, armed=False)
    flying.hear("GLOBAL_POSITION_INT", PLACE)
    assert flying.monitor.snapshot.disarmed
    flying.link.answers = False
    guidance = Guidance(flying.monitor)
    ordered = asyncio.create_task(take_off(guidance, TARGET_M))
    while ARM not in flying.link.sent:  # noqa: ASYNC110 (nothing else is moved)
        await asyncio.sleep(0)
    for _ in range(4):
        flying.clock.at += 0.6
        flying.heartbeat(HOLD, armed=False)
        assert not flying.monitor.snapshot.disarmed
    guidance.begin("return")
    flying.hear("COMMAND_ACK", {"command": ARM, "result": 0})
    with pytest.raises(ManoeuvreSuperseded):
        await ordered
    assert not flying.monitor.snapshot.disarmed, "it agreed just now"


async def test_an_arming_whose_answer_another_mode_cut_off_may_have_been_done() -> None:
    """What stops it was refused until a heartbeat came, as if it had not been sent."""
    scene = Scene(
        (heartbeat(GUIDED, False)[0], heartbeat(GUIDED, False)[1] | {"autopilot": 3}),
        ("EXTENDED_SYS_STATE", {"landed_state": ON_GROUND}),
        ("GLOBAL_POSITION_INT", PLACE | {"relative_alt": 0}),
    )
    await scene.monitor.connect(1.0)
    await scene.monitor.close()
    scene.monitor.connected = True
    scene.link.answers = False
    snapshot = scene.monitor.snapshot
    assert snapshot.disarmed
    ordered = asyncio.create_task(take_off(Guidance(scene.monitor), TARGET_M))
    while ARM not in scene.link.sent:  # noqa: ASYNC110 (nothing else is moved)
        await asyncio.sleep(0)
    scene.hear("HEARTBEAT", {"custom_mode": BRAKE, "base_mode": 1, "autopilot": 3})
    while snapshot.arming_at_s == math.inf:  # noqa: ASYNC110
        await asyncio.sleep(0)
    assert not snapshot.disarmed
    ordered.cancel()
