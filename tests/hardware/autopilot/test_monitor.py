"""What is heard of a vehicle, message by message, without a network."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any

import pytest

from hardware.autopilot.link import Fields
from hardware.autopilot.messages import ACCEPTED
from hardware.autopilot.monitor import LINK_LOST_WALL_S, Monitor
from hardware.autopilot.px4 import HOLD, RETURNING, px4_mode
from hardware.clock import WallClock

POSCTL = px4_mode(3)
ON_GROUND, IN_AIR = 1, 2
PLACE: Fields = {"time_boot_ms": 1000, "lat": 473977419, "lon": 85455938, "alt": 528_000, "relative_alt": 40_000}
PLACE |= {"vx": 0, "vy": 0, "vz": 0}


class HandClock(WallClock):
    """Time moves when told."""

    def __init__(self) -> None:
        self.at = 1_000.0

    def now(self) -> float:
        return self.at


class PaperLink:
    """Nothing is sent: a command is acknowledged at once. `opened`: what is heard while the link is opened."""

    url = "paper"

    def __init__(self, heard: Callable[[str, Fields], None], opened: list[tuple[str, Fields]]) -> None:
        self.heard = heard
        self.opened = opened

    async def open(self, timeout_s: float) -> None:
        for name, fields in self.opened:
            self.heard(name, fields)

    async def send(self, name: str, fields: Fields, allowed: Callable[[], bool]) -> bool:
        number = fields["command"]
        asyncio.get_running_loop().call_soon(self.heard, "COMMAND_ACK", {"command": number, "result": ACCEPTED})
        return True

    async def close(self) -> None:
        pass


class Scene:
    def __init__(self, *opened: tuple[str, Fields]) -> None:
        self.clock = HandClock()
        self.monitor = Monitor("udpin://127.0.0.1:1", self.clock)
        self.monitor.link = PaperLink(self.hear, list(opened))  # type: ignore[assignment]

    def hear(self, name: str, fields: Fields) -> None:
        self.clock.at += 0.01
        self.monitor._on_message(name, fields)

    def mode(self, mode: int) -> None:
        self.hear("CURRENT_MODE", {"custom_mode": mode})

    def heartbeat(self, mode: int, armed: bool) -> None:
        self.hear(*heartbeat(mode, armed))

    def landed(self, state: int) -> None:
        self.hear("EXTENDED_SYS_STATE", {"landed_state": state})

    def silence(self, seconds: float) -> None:
        self.clock.at += seconds
        for _ in range(int(seconds / 0.5)):
            self.monitor.look_at_link(0.5)


def heartbeat(mode: int, armed: bool) -> tuple[str, dict[str, Any]]:
    return "HEARTBEAT", {"custom_mode": mode, "base_mode": 1 | 128 * armed, "autopilot": 12}


@pytest.fixture
async def flying() -> Scene:
    """Connected, returning by our order."""
    scene = Scene(
        heartbeat(HOLD, True), ("EXTENDED_SYS_STATE", {"landed_state": IN_AIR}), ("GLOBAL_POSITION_INT", PLACE)
    )
    await scene.monitor.connect(1.0)
    await scene.monitor.close()
    scene.monitor.connected = True
    scene.monitor.latch.command(frozenset({RETURNING}))
    scene.mode(RETURNING)
    assert scene.monitor.telemetry().controller == "crossfix"
    return scene


@pytest.mark.parametrize(("mode", "controller"), [(POSCTL, "pilot"), (RETURNING, "pilot"), (HOLD, "nobody")])
async def test_who_has_control_is_known_when_connecting_is_done_though_the_mode_came_before_all_else(
    mode: int, controller: str
) -> None:
    """An order given at once would take the vehicle from a pilot."""
    scene = Scene(heartbeat(mode, True), ("GLOBAL_POSITION_INT", PLACE))
    await scene.monitor.connect(1.0)
    assert scene.monitor.telemetry().controller == controller
    await scene.monitor.close()


async def test_a_vehicle_that_landed_unheard_is_judged_by_what_it_says_now_and_no_pilot_landed_it(
    flying: Scene,
) -> None:
    flying.silence(2 * LINK_LOST_WALL_S)
    assert not flying.monitor.connected
    flying.mode(HOLD)
    flying.monitor.look_at_link(0.1)
    assert not flying.monitor.connected
    assert flying.monitor.telemetry().controller == "crossfix"
    flying.heartbeat(HOLD, armed=False)
    flying.monitor.look_at_link(0.1)
    telemetry = flying.monitor.telemetry()
    assert telemetry.connected
    assert telemetry.controller == "nobody"
    assert telemetry.in_air is False


async def test_a_pilot_who_took_over_unheard_has_control_with_the_first_word_of_his_mode(flying: Scene) -> None:
    flying.silence(2 * LINK_LOST_WALL_S)
    flying.mode(POSCTL)
    assert flying.monitor.telemetry().controller == "pilot"


async def test_a_hold_chosen_unheard_in_the_air_is_a_pilots_once_the_vehicle_says_that_it_flies(
    flying: Scene,
) -> None:
    flying.silence(2 * LINK_LOST_WALL_S)
    flying.heartbeat(HOLD, armed=True)
    flying.monitor.look_at_link(0.1)
    assert flying.monitor.telemetry().connected
    assert flying.monitor.telemetry().controller == "pilot"


async def test_a_silence_in_which_it_took_off_leaves_no_old_word_of_the_ground(flying: Scene) -> None:
    flying.landed(ON_GROUND)
    flying.silence(2 * LINK_LOST_WALL_S)
    flying.heartbeat(RETURNING, armed=True)
    flying.hear("GLOBAL_POSITION_INT", PLACE | {"time_boot_ms": 9000})
    flying.monitor.look_at_link(0.1)
    assert flying.monitor.telemetry().in_air
