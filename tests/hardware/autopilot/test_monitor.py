"""What is heard of a vehicle, message by message."""

from __future__ import annotations

import pytest
from paper import ON_GROUND, PLACE, POSCTL, Scene, heartbeat

from hardware.autopilot.monitor import LINK_LOST_WALL_S
from hardware.autopilot.px4 import HOLD, RETURNING


@pytest.fixture
async def returning(flying: Scene) -> Scene:
    """By our order."""
    flying.monitor.latch.command(frozenset({RETURNING}))
    flying.mode(RETURNING)
    assert flying.monitor.telemetry().controller == "crossfix"
    return flying


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
    returning: Scene,
) -> None:
    returning.silence(2 * LINK_LOST_WALL_S)
    assert not returning.monitor.connected
    returning.mode(HOLD)
    returning.monitor.look_at_link(0.1)
    assert not returning.monitor.connected
    assert returning.monitor.telemetry().controller == "crossfix"
    returning.heartbeat(HOLD, armed=False)
    returning.monitor.look_at_link(0.1)
    telemetry = returning.monitor.telemetry()
    assert telemetry.connected
    assert telemetry.controller == "nobody"
    assert telemetry.in_air is False


async def test_a_pilot_who_took_over_unheard_has_control_with_the_first_word_of_his_mode(returning: Scene) -> None:
    returning.silence(2 * LINK_LOST_WALL_S)
    returning.mode(POSCTL)
    assert returning.monitor.telemetry().controller == "pilot"


async def test_a_hold_chosen_unheard_in_the_air_is_a_pilots_once_the_vehicle_says_that_it_flies(
    returning: Scene,
) -> None:
    returning.silence(2 * LINK_LOST_WALL_S)
    returning.heartbeat(HOLD, armed=True)
    returning.monitor.look_at_link(0.1)
    assert returning.monitor.telemetry().connected
    assert returning.monitor.telemetry().controller == "pilot"


async def test_a_silence_in_which_it_took_off_leaves_no_old_word_of_the_ground(returning: Scene) -> None:
    returning.landed(ON_GROUND)
    returning.silence(2 * LINK_LOST_WALL_S)
    returning.heartbeat(RETURNING, armed=True)
    returning.hear("GLOBAL_POSITION_INT", PLACE | {"time_boot_ms": 9000})
    returning.monitor.look_at_link(0.1)
    assert returning.monitor.telemetry().in_air
