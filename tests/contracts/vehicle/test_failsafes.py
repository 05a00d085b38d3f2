"""What every Vehicle makes of an autopilot whose own failsafe brings it home or down, and of a pilot who does."""

from __future__ import annotations

import pytest
from rig import Rig

from hardware.authority import FailsafeCause
from hardware.ports import NotInControl

WAYS_DOWN = {"RETURN", "RTL", "LAND"}
PARAMETERS = {
    "sim-px4": {"GF_ACTION": 3, "GF_MAX_HOR_DIST": 12},
    "sim-ardupilot": {"FENCE_TYPE": 2, "FENCE_RADIUS": 12, "FENCE_ENABLE": 1},
}


async def fails(rig: Rig, cause: FailsafeCause) -> None:
    match cause:
        case "battery":
            await rig.sim.order("battery", percent=4)
        case "transmitter":
            await rig.sim.order("transmitter_loss", seconds=600)
        case "position":
            await rig.sim.order("gps_loss", seconds=8)
        case _:
            for name, value in PARAMETERS[rig.name].items():
                await rig.sim.order("set_param", name=name, value=value)


@pytest.mark.parametrize("cause", ["battery", "transmitter", "position", "fence"])
async def test_a_failsafe_that_the_autopilot_names_is_no_pilot_and_an_operator_may_take_the_vehicle(
    rig: Rig, cause: FailsafeCause
) -> None:
    vehicle = rig.vehicle
    await rig.airborne()
    await vehicle.goto(rig.place(0.0, 30.0), rig.amsl(), 6.0)
    await fails(rig, cause)
    await rig.until(lambda: vehicle.telemetry().authority.who == "failsafe", 30, "the failsafe's way home")
    assert vehicle.telemetry().mode in WAYS_DOWN
    await rig.until(lambda: vehicle.telemetry().authority.cause == cause, 5, "its cause")
    with pytest.raises(NotInControl, match="failsafe"):
        await vehicle.goto(rig.place(0.0, 0.0), rig.amsl(), 5.0)

    vehicle.take_control()
    await vehicle.hold()
    assert vehicle.telemetry().authority.who == "ours"
    assert (await rig.sim.order("truth"))["mode"] in ("HOLD", "BRAKE")
    await rig.clock.sleep(3.0)
    await rig.sim.order("pilot_mode", mode="RETURN" if rig.name == "sim-px4" else "RTL")
    await rig.until(lambda: vehicle.telemetry().authority.who == "pilot", 5, "the pilot's switch")
    with pytest.raises(NotInControl):
        await vehicle.hold()


async def test_a_pilot_who_selects_the_way_home_that_a_failsafe_flies_has_the_vehicle(rig: Rig) -> None:
    """The mode does not change; PX4's state tells it, and ArduCopter's pilot by the channel of their switch."""
    await rig.airborne()
    await fails(rig, "battery")
    await rig.until(lambda: rig.vehicle.telemetry().authority.who == "failsafe", 30, "the failsafe's way home")
    await rig.clock.sleep(8.0)  # by now the channel of the pilot's switch is heard
    await rig.sim.order("pilot_mode", mode="RETURN" if rig.name == "sim-px4" else "RTL")
    await rig.until(lambda: rig.vehicle.telemetry().authority.who == "pilot", 5, "the pilot's switch")
    with pytest.raises(NotInControl):
        await rig.vehicle.hold()
