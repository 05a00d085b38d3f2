"""An operator takes the vehicle: from a pilot who gives it back with the switch, or from the autopilot's failsafe."""

from __future__ import annotations

import pytest
from paper import Scene

from hardware.authority import CommandSent, FailsafeNamed
from hardware.autopilot.mode_switch import SETTLED_S
from hardware.autopilot.px4 import HOLD, RETURNING
from hardware.autopilot.vehicle import MavsdkVehicle


def vehicle_of(scene: Scene) -> MavsdkVehicle:
    vehicle = MavsdkVehicle("udpin://127.0.0.1:1", scene.clock)
    vehicle._monitor = scene.monitor
    return vehicle


def switch_to(scene: Scene, pulse_us: int) -> None:
    scene.hear("RC_CHANNELS", {"chan5_raw": pulse_us})


@pytest.mark.parametrize("moved", ["before", "after"])
async def test_a_pilots_switch_is_heard_in_the_moment_in_which_an_operator_takes_the_vehicle_from_its_failsafe(
    flying: Scene, moved: str
) -> None:
    """They select the return that the failsafe flies; a failsafe gives nothing back by a switch."""
    flying.monitor.mode_switch.channel = 5
    switch_to(flying, 1165)
    flying.monitor.control.see(CommandSent(frozenset({HOLD})))
    flying.mode(HOLD)
    flying.monitor.control.see(FailsafeNamed("battery", flying.clock.now()))
    flying.mode(RETURNING)
    assert flying.monitor.telemetry().authority.who == "failsafe"
    if moved == "before":
        switch_to(flying, 1815)
    vehicle_of(flying).take_control()
    assert flying.monitor.telemetry().authority.who == "ours"
    if moved == "after":
        switch_to(flying, 1815)
    flying.clock.at += 2.0 * SETTLED_S
    flying.monitor.look_at_link(0.1)
    assert flying.monitor.telemetry().authority.who == "pilot"


async def test_the_switch_by_which_a_pilot_gives_the_vehicle_back_takes_nothing(flying: Scene) -> None:
    flying.monitor.mode_switch.channel = 5
    switch_to(flying, 1165)
    flying.monitor.control.see(CommandSent(frozenset({HOLD})))
    flying.mode(HOLD)
    flying.mode(RETURNING)
    assert flying.monitor.telemetry().authority.who == "pilot"
    switch_to(flying, 1815)
    vehicle_of(flying).take_control()
    flying.clock.at += 2.0 * SETTLED_S
    flying.monitor.look_at_link(0.1)
    assert flying.monitor.telemetry().authority.who == "ours"
