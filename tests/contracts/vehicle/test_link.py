"""What every Vehicle makes of a link and an autopilot that do not do what was asked."""

from __future__ import annotations

import asyncio
import socket

import pytest
from rig import DEAD_STATION, FLIGHT_COMMANDS, SPEEDUP, Rig

from hardware.autopilot.connect import connect_vehicle
from hardware.autopilot.messages import SET_MODE
from hardware.autopilot.vehicle import MavsdkVehicle
from hardware.clock import WallClock
from hardware.ports import VehicleError, VehicleUnreachable
from hardware.readings import PreflightCheck
from hardware.reasons.preflight import ArmingChecked, RemoteIdRefuses
from hardware.reasons.vehicle import CommandUnanswered, NoProgress
from hardware.reasons.vehicle_news import VehicleHeardAgain, VehicleUnheard
from hardware.sim.autopilot.launch import free_port


async def test_a_lost_link_is_flagged_and_a_flight_survives_it(rig: Rig) -> None:
    vehicle, sim = rig.vehicle, rig.sim
    await sim.order("set_param", name=DEAD_STATION[rig.name][0], value=0)  # else the autopilot returns by itself
    await rig.airborne()
    place = rig.place(0.0, 140.0)
    flight = asyncio.create_task(vehicle.goto(place, rig.amsl(), 3.0))
    await rig.until(lambda: (vehicle.telemetry().velocity_north_m_s or 0.0) > 1.0, 20, "flying north")

    await sim.order("link_loss", seconds=2.0 * SPEEDUP)  # shorter than the 3 wall seconds that a link may be silent
    await rig.clock.sleep(2.2 * SPEEDUP)
    assert vehicle.telemetry().connected
    assert VehicleUnheard() not in rig.news
    await sim.order("link_loss", seconds=4.0 * SPEEDUP)
    await rig.until(lambda: not vehicle.telemetry().connected, 3.9 * SPEEDUP, "the lost link")
    old = vehicle.telemetry()
    assert old.position_at_s is not None
    assert rig.clock.now() - old.position_at_s > 3.0  # its age can be seen
    await rig.until(lambda: vehicle.telemetry().connected, 30, "the restored link")
    await asyncio.wait_for(flight, 60)

    assert rig.off_by(place) < 3.0
    assert VehicleUnheard() in rig.news
    assert any(isinstance(news, VehicleHeardAgain) for news in rig.news)


async def test_a_return_of_a_vehicle_that_is_heard_and_hears_nothing_is_the_failsafes(rig: Rig) -> None:
    vehicle, sim = rig.vehicle, rig.sim
    patience = "COM_DL_LOSS_T" if rig.name == "sim-px4" else "FS_GCS_TIMEOUT"
    await sim.order("set_param", name=patience, value=2)  # as the rig has it, by the wall clock
    await rig.airborne()
    await vehicle.preflight()  # reads it
    await rig.clock.sleep(1.0 * SPEEDUP)
    await sim.order("uplink_loss", seconds=12.0 * SPEEDUP)
    returns = DEAD_STATION[rig.name][1]
    await rig.until(lambda: vehicle.telemetry().mode == returns, 11.0 * SPEEDUP, "the failsafe's return")
    telemetry = vehicle.telemetry()
    assert telemetry.connected
    assert telemetry.authority.who == "failsafe"
    assert VehicleUnheard() not in rig.news


async def test_an_acknowledged_goto_that_does_nothing_is_seen_repeated_and_at_last_an_error(rig: Rig) -> None:
    vehicle, sim = rig.vehicle, rig.sim
    await rig.airborne()
    place = rig.place(0.0, 25.0)

    await sim.order("fault", kind="ignore_goto", count=1)
    await vehicle.goto(place, rig.amsl(), 6.0)
    assert rig.off_by(place) < 3.0
    assert any(isinstance(because, NoProgress) for because in rig.tried_again())

    await sim.order("fault", kind="ignore_goto", count=100)
    with pytest.raises(VehicleError, match="did not arrive"):
        await vehicle.goto(rig.place(0.0, 60.0), rig.amsl(), 6.0)


async def test_an_acknowledged_turn_that_does_nothing_is_seen_repeated_and_at_last_an_error(rig: Rig) -> None:
    vehicle, sim = rig.vehicle, rig.sim
    await rig.airborne()

    # PX4 is sent three yaw steps ahead of the nose, a few more when the wind moves it
    await sim.order("fault", kind="ignore_yaw", count=5 if rig.name == "sim-px4" else 3)
    began = rig.clock.now()
    await vehicle.turn(45.0)
    headings = [sample.heading_deg for sample in vehicle.headings(began)]
    assert {int(heading // 20) for heading in headings} == set(range(18))
    assert rig.tried_again()

    await sim.order("fault", kind="ignore_yaw", count=1000)
    with pytest.raises(VehicleError, match="acknowledged the turn but did not make it"):
        await vehicle.turn(45.0)


async def test_a_refusal_reaches_the_caller_in_words(rig: Rig) -> None:
    await rig.airborne()
    await rig.sim.order("fault", kind="refuse", count=1)

    with pytest.raises(VehicleError, match=r"refused.*denied"):
        await rig.vehicle.goto(rig.place(0.0, 20.0), rig.amsl(), 5.0)


async def test_an_unanswered_command_is_sent_again_visibly(rig: Rig) -> None:
    await rig.airborne()
    await rig.sim.order("fault", kind="silent", count=1)

    await rig.vehicle.goto(rig.place(0.0, 20.0), rig.amsl(), 5.0)

    assert CommandUnanswered("place", 1) in rig.tried_again()


async def test_an_order_of_a_mode_that_shows_is_not_sent_again_though_its_answer_is_lost(rig: Rig) -> None:
    """Sent again it would undo a pilot who switched meanwhile."""
    await rig.airborne()
    since_s = (await rig.sim.order("ping"))["time_s"]
    await rig.sim.order("fault", kind="unanswered", count=1)

    await rig.vehicle.return_home()
    await rig.clock.sleep(5.0)

    sent = (await rig.sim.order("commands", since_s=since_s))["commands"]
    assert [number for _, number in sent if number in FLIGHT_COMMANDS] == [SET_MODE]


async def test_nobody_there_is_said_in_words() -> None:
    with pytest.raises(VehicleUnreachable, match="No autopilot answers"):
        await connect_vehicle(f"udpin://127.0.0.1:{free_port()}", WallClock(), timeout_s=0.3)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as taken:
        taken.bind(("127.0.0.1", 0))
        with pytest.raises(VehicleUnreachable, match="cannot be opened"):
            await connect_vehicle(f"udpin://127.0.0.1:{taken.getsockname()[1]}", WallClock(), timeout_s=0.3)
    with pytest.raises(ValueError, match="udpin://"):
        MavsdkVehicle("14540", WallClock())


async def test_the_checklist_says_what_a_remote_id_transmitter_says(rig: Rig) -> None:
    async def row() -> PreflightCheck:
        return next(check for check in await rig.vehicle.preflight() if check.name == "remote_id")

    await rig.sim.order("remote_id", problem="")
    await rig.clock.sleep(2.0)
    assert (await row()).ok
    await rig.sim.order("remote_id", problem="operator ID \x1b missing")
    await rig.clock.sleep(2.0)
    assert (await row()).reason == RemoteIdRefuses("operator ID missing")


async def test_ready_to_arm_is_what_the_autopilot_says_of_itself(rig: Rig) -> None:
    async def row() -> PreflightCheck:
        return next(check for check in await rig.vehicle.preflight() if check.name == "ready_to_arm")

    async with asyncio.timeout(60):
        while (await row()).reason != ArmingChecked("ready"):
            await rig.clock.sleep(0.5)
    await rig.sim.order("prearm", ok=False)
    await rig.clock.sleep(3.0)
    check = await row()
    assert (check.ok, check.blocking, check.reason) == (False, True, ArmingChecked("not_ready"))
