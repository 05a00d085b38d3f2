"""What both flavours do alike, and what each does as it was measured on the real one."""

from __future__ import annotations

import math

import pytest
from flown_firmware import ARM, HOME, SET_MODE, TAKE_OFF, flying, make, run
from pymavlink.dialects.v20 import development as mavlink

from hardware.sim.autopilot.ardupilot import ArduCopter
from hardware.sim.autopilot.copter import Wind
from hardware.sim.autopilot.firmware import (
    ACCEPTED,
    DENIED,
    FAILED,
    TEMPORARILY_REJECTED,
    UNSUPPORTED,
    Command,
    Firmware,
)
from hardware.sim.autopilot.px4 import Px4
from hardware.sim.autopilot.telemetry import gps_raw_int

BOTH = pytest.mark.parametrize("flavour", [Px4, ArduCopter])
REPOSITION, YAW, SPEED = 192, 115, 178


def goto(north: float, east: float, up: float = 20.0, yaw: float = math.nan, flags: float = 1.0) -> Command:
    lat, lon = HOME.to_geo(north, east)
    return Command(REPOSITION, 6.0, flags, math.nan, yaw, lat, lon, HOME.amsl_m + up, is_int=True)


def off(firmware: Firmware, north: float, east: float) -> float:
    return math.hypot(firmware.navigation.north - north, firmware.navigation.east - east)


@BOTH
def test_it_takes_off_flies_and_returns_to_where_it_stood(flavour: type[Px4]) -> None:
    firmware = flying(flavour, wind=Wind(5.0, 200.0, 2.0))
    assert firmware.command(goto(80.0, -60.0)) == ACCEPTED
    run(firmware, 60.0)
    assert off(firmware, 80.0, -60.0) < 2.0

    assert firmware.command(Command(20)) == ACCEPTED
    run(firmware, 120.0)
    assert not firmware.flight.armed
    assert firmware.copter.on_ground
    assert math.hypot(firmware.copter.north, firmware.copter.east) < 3.0


def test_px4_climbs_before_it_returns() -> None:
    firmware = flying(Px4, up=12.0)
    firmware.command(goto(60.0, 0.0, up=12.0))
    run(firmware, 40.0)
    firmware.command(Command(20))

    highest = 0.0
    while firmware.flight.armed:
        firmware.step(0.02)
        if firmware.navigation.up < 28.0 and highest < 28.0:
            assert off(firmware, 60.0, 0.0) < 3.0  # still above where it was
        highest = max(highest, firmware.navigation.up)
    assert highest == pytest.approx(30.0, abs=1.5)


def test_px4_obeys_the_yaw_of_a_reposition_and_arducopter_does_not() -> None:
    for flavour, turned in ((Px4, 90.0), (ArduCopter, 0.0)):
        firmware = flying(flavour)
        assert firmware.command(goto(0.0, 0.0, yaw=math.radians(90.0))) == ACCEPTED
        run(firmware, 5.0)
        assert firmware.copter.heading == pytest.approx(turned, abs=1.0)


def test_arducopter_turns_by_condition_yaw_at_its_rate_in_guided_only() -> None:
    firmware = flying(ArduCopter)
    relative = Command(YAW, 90.0, 30.0, 1.0, 1.0)
    assert firmware.command(relative) == ACCEPTED
    run(firmware, 1.5)
    assert 30.0 < firmware.copter.heading < 46.0
    run(firmware, 4.0)
    assert firmware.copter.heading == pytest.approx(90.0, abs=1.0)

    firmware.set_mode("BRAKE")
    assert firmware.command(relative) == ACCEPTED  # acknowledged, and nothing happens
    run(firmware, 4.0)
    assert firmware.copter.heading == pytest.approx(90.0, abs=1.0)
    assert flying(Px4).command(relative) == UNSUPPORTED


def test_px4_in_hold_flies_on_when_only_the_mode_is_commanded_and_brakes_when_paused() -> None:
    firmware = flying(Px4)
    firmware.command(goto(200.0, 0.0))
    run(firmware, 8.0)
    assert firmware.command(Command(SET_MODE, 1.0, 4.0, 3.0)) == ACCEPTED
    run(firmware, 5.0)
    assert firmware.copter.v_north > 5.0

    assert firmware.command(Command(REPOSITION, -1.0, 1.0)) == ACCEPTED
    run(firmware, 6.0)
    assert abs(firmware.copter.v_north) < 0.3
    assert firmware.copter.north < 120.0


def test_a_command_takes_control_back_from_the_pilot_as_on_the_real_ones() -> None:
    for flavour, pilot, after in ((Px4, "POSCTL", "HOLD"), (ArduCopter, "LOITER", "GUIDED")):
        firmware = flying(flavour)
        firmware.switch_mode(pilot)
        assert firmware.command(goto(5.0, 0.0)) == ACCEPTED
        assert firmware.mode == after


def test_without_the_change_mode_flag_nothing_is_taken_from_the_pilot_and_only_the_answers_differ() -> None:
    for flavour, pilot, answer in ((Px4, "POSCTL", UNSUPPORTED), (ArduCopter, "LOITER", DENIED)):
        firmware = flying(flavour)
        firmware.switch_mode(pilot)
        assert firmware.command(goto(30.0, 0.0, flags=0.0)) == answer
        run(firmware, 5.0)
        assert firmware.mode == pilot
        assert off(firmware, 0.0, 0.0) < 3.0


def test_without_the_change_mode_flag_the_waiting_vehicle_obeys_though_px4_answers_unsupported() -> None:
    for flavour, answer in ((Px4, UNSUPPORTED), (ArduCopter, ACCEPTED)):
        firmware = flying(flavour)
        assert firmware.command(goto(30.0, 0.0, flags=0.0)) == answer
        run(firmware, 20.0)
        assert off(firmware, 30.0, 0.0) < 1.0


@pytest.mark.parametrize(("later", "flies"), [(0.3, True), (0.7, False)])
def test_px4_keeps_a_reposition_of_another_mode_for_half_a_second(later: float, flies: bool) -> None:
    firmware = flying(Px4)
    firmware.switch_mode("POSCTL")
    firmware.command(goto(30.0, 0.0, flags=0.0))
    run(firmware, later)
    firmware.switch_mode("HOLD")
    run(firmware, 15.0)
    assert (off(firmware, 30.0, 0.0) < 1.0) is flies


@pytest.mark.parametrize(("override", "takes"), [(0, False), (1, True), (2, False), (3, True)])
def test_px4_sticks_take_over_auto_modes_by_their_parameter(override: int, takes: bool) -> None:
    firmware = flying(Px4)
    firmware.parameters.set("COM_RC_OVERRIDE", override)
    firmware.outbox.clear()

    assert firmware.move_sticks((0.0, 2.0, 0.0), 0.0) is takes
    run(firmware, 4.0)
    texts = [message.text for message in firmware.outbox if isinstance(message, mavlink.MAVLink_statustext_message)]
    assert (firmware.mode == "POSCTL") is takes
    assert ("Pilot took over using sticks" in texts) is takes
    assert (firmware.copter.v_east > 1.5) is takes


def test_arducopters_sticks_take_nothing_over_but_its_mode_switch_does() -> None:
    firmware = flying(ArduCopter)
    assert firmware.move_sticks((2.0, 0.0, 0.0), 0.0) is False
    assert firmware.mode == "GUIDED"
    firmware.switch_mode("LOITER")
    assert firmware.move_sticks((2.0, 0.0, 0.0), 0.0) is True


@pytest.mark.parametrize(
    ("flavour", "parameter", "value", "mode"),
    [
        (Px4, "NAV_DLL_ACT", 0, "HOLD"),
        (Px4, "NAV_DLL_ACT", 2, "RETURN"),
        (Px4, "NAV_DLL_ACT", 3, "LAND"),
        (ArduCopter, "FS_GCS_ENABLE", 0, "GUIDED"),
        (ArduCopter, "FS_GCS_ENABLE", 1, "RTL"),
        (ArduCopter, "FS_GCS_ENABLE", 5, "LAND"),
    ],
)
def test_when_the_station_is_lost_it_acts_by_its_parameter(
    flavour: type[Px4], parameter: str, value: int, mode: str
) -> None:
    firmware = flying(flavour)
    firmware.parameters.set(parameter, value)
    firmware.gcs_heard_at = firmware.time

    run(firmware, 4.0)
    assert firmware.mode in ("HOLD", "GUIDED")
    run(firmware, 8.0)
    assert firmware.mode == mode


def test_the_station_failsafe_does_not_take_the_vehicle_from_a_pilot() -> None:
    for flavour, pilot in ((Px4, "POSCTL"), (ArduCopter, "LOITER")):
        firmware = flying(flavour)
        firmware.gcs_heard_at = firmware.time
        firmware.switch_mode(pilot)
        run(firmware, 30.0)
        assert firmware.mode == pilot


def test_px4_refuses_until_it_is_ready_and_arducopter_says_ready_before_guided_is_let_in() -> None:
    px4, ardupilot = run(make(Px4), 5.0), run(make(ArduCopter), 5.0)

    assert px4.command(Command(ARM, 1.0)) == TEMPORARILY_REJECTED
    assert ardupilot.prearm_ok
    assert ardupilot.command(Command(SET_MODE, 1.0, 4.0)) == FAILED
    assert ardupilot.command(Command(TAKE_OFF, z=20.0)) == FAILED


@BOTH
def test_it_disarms_while_one_waits_between_arming_and_take_off(flavour: type[Px4]) -> None:
    firmware = run(make(flavour), 12.0)
    assert firmware.command(Command(ARM, 1.0)) == ACCEPTED
    run(firmware, 8.0)
    assert firmware.flight.armed
    run(firmware, 4.0)
    assert not firmware.flight.armed


@BOTH
def test_in_the_air_it_does_not_disarm_and_on_the_ground_a_place_moves_nothing(flavour: type[Px4]) -> None:
    firmware = flying(flavour)
    assert firmware.command(Command(ARM, 0.0)) == DENIED
    assert firmware.flight.armed

    grounded = run(make(flavour), 12.0)
    grounded.command(goto(50.0, 0.0))
    run(grounded, 10.0)
    assert math.hypot(grounded.copter.north, grounded.copter.east) == 0.0


@BOTH
def test_a_low_battery_ends_the_flight_by_itself(flavour: type[Px4]) -> None:
    firmware = flying(flavour)
    firmware.copter.energy = 0.05 * firmware.copter.airframe.capacity
    firmware.outbox.clear()
    run(firmware, 6.0)

    assert firmware.mode in ("RETURN", "RTL")
    assert firmware.critical


@BOTH
def test_a_gps_jump_moves_the_vehicle_the_other_way_and_passes(flavour: type[Px4]) -> None:
    firmware = flying(flavour, gps_sigma=0.0)
    firmware.command(goto(0.0, 0.0))
    run(firmware, 3.0)
    firmware.navigation.jump(30.0, 0.0, seconds=6.0)
    run(firmware, 6.5)
    assert firmware.copter.north < -10.0
    run(firmware, 30.0)
    assert abs(firmware.copter.north) < 1.0


def test_the_fence_acts_by_its_parameter() -> None:
    for flavour, parameters, mode in (
        (Px4, {"GF_MAX_HOR_DIST": 50, "GF_ACTION": 3}, "RETURN"),
        (ArduCopter, {"FENCE_RADIUS": 50, "FENCE_ACTION": 1, "FENCE_ENABLE": 1}, "RTL"),
    ):
        firmware = flying(flavour)
        firmware.command(goto(90.0, 0.0))  # with the fence up PX4 refuses a place beyond it
        for name, value in parameters.items():
            firmware.parameters.set(name, value)
        run(firmware, 15.0)
        assert firmware.mode == mode


@BOTH
def test_ordered_faults_spoil_as_many_commands_as_told(flavour: type[Px4]) -> None:
    firmware = flying(flavour)
    firmware.faults.refuse, firmware.faults.silent, firmware.faults.ignore_goto = 1, 1, 1

    assert firmware.command(goto(9.0, 0.0)) is None
    assert firmware.command(goto(9.0, 0.0)) == DENIED
    assert firmware.command(goto(9.0, 0.0)) == ACCEPTED
    run(firmware, 10.0)
    assert off(firmware, 0.0, 0.0) < 1.5
    assert firmware.command(goto(9.0, 0.0)) == ACCEPTED
    run(firmware, 10.0)
    assert off(firmware, 9.0, 0.0) < 1.5


@BOTH
@pytest.mark.parametrize("speed", [math.nan, -math.inf, -1.0, 0.0])
def test_a_speed_that_is_none_is_denied_and_it_flies_on(flavour: type[Px4], speed: float) -> None:
    firmware = flying(flavour)
    firmware.command(goto(40.0, 0.0))

    assert firmware.command(Command(SPEED, 1.0, speed)) == DENIED
    run(firmware, 25.0)
    assert off(firmware, 40.0, 0.0) < 2.0


PAUSE = Command(REPOSITION, -1.0, 0.0, 0.0)


def looking_back() -> Firmware:
    """A PX4 at full speed north, its nose south-east."""
    firmware = flying(Px4)
    firmware.command(goto(200.0, 0.0, yaw=math.radians(135.0)))
    run(firmware, 10.0)
    assert firmware.copter.v_north > 5.0
    assert firmware.copter.heading % 360.0 == pytest.approx(135.0, abs=2.0)
    return firmware


def test_px4_turns_its_nose_to_its_stop_point_while_it_brakes() -> None:
    firmware = looking_back()
    firmware.command(PAUSE)
    run(firmware, 10.0)
    assert firmware.copter.heading % 360.0 < 90.0


def test_a_yaw_alone_keeps_the_nose_of_a_px4_that_brakes_and_its_stop_point() -> None:
    firmware = looking_back()
    firmware.command(PAUSE)
    stop = firmware.flight.demand.north
    run(firmware, 0.3)
    nose = firmware.copter.heading
    assert firmware.command(Command(REPOSITION, -1.0, 0.0, 0.0, math.radians(nose))) == UNSUPPORTED
    run(firmware, 10.0)
    assert firmware.copter.heading == pytest.approx(nose, abs=2.0)
    assert firmware.flight.demand.north == stop
    assert off(firmware, stop, 0.0) < 2.5


def test_px4_flies_past_its_stop_point_and_turns_back() -> None:
    """Slow for a moment with metres to go: a hold reported then is reported too early."""
    firmware = flying(Px4)
    firmware.command(goto(300.0, 0.0))
    run(firmware, 10.0)
    firmware.command(Command(REPOSITION, -1.0, 0.0))
    while firmware.copter.v_north > 0.5:
        run(firmware, 0.1)
    turned_back = firmware.copter.north
    run(firmware, 8.0)
    assert 3.0 < turned_back - firmware.copter.north < 10.0
    assert abs(firmware.copter.v_north) < 0.3


@pytest.mark.parametrize("yaw_given", [False, True])
def test_px4_that_is_told_to_stop_as_it_turns_back_is_carried_on_and_faces_its_place(yaw_given: bool) -> None:
    """Seen on the real one some six seconds after a hold: the nose turned by up to 38 degrees."""
    firmware = flying(Px4)
    firmware.command(goto(300.0, 0.0, yaw=math.radians(90.0)))
    run(firmware, 10.0)
    firmware.command(PAUSE)
    firmware.command(Command(REPOSITION, -1.0, 0.0, 0.0, math.radians(90.0)))
    while firmware.copter.v_north > 0.4:
        run(firmware, 0.1)
    stays = firmware.navigation.north
    firmware.command(PAUSE)
    if yaw_given:
        run(firmware, 0.3)
        firmware.command(Command(REPOSITION, -1.0, 0.0, 0.0, math.radians(90.0)))
    farthest = turned = 0.0
    for _ in range(80):
        run(firmware, 0.1)
        farthest = max(farthest, off(firmware, stays, 0.0))
        turned = max(turned, abs(firmware.copter.heading - 90.0))
    assert 2.0 < farthest < 4.0
    assert off(firmware, stays, 0.0) < 1.0
    assert (turned < 5.0) if yaw_given else (turned > 20.0)


@pytest.mark.parametrize("flavour", [Px4, ArduCopter])
def test_without_a_fix_it_says_so_and_lands_after_a_while(flavour: type[Px4 | ArduCopter]) -> None:
    firmware = flying(flavour)
    firmware.navigation.lose_fix(20.0)
    run(firmware, 4.0)
    assert firmware.mode != "LAND"
    assert (gps_raw_int(firmware).to_dict()["fix_type"], firmware.navigation.satellites) == (1, 0)
    run(firmware, 2.0)
    assert firmware.mode == "LAND"
    run(firmware, 15.0)
    assert firmware.mode == ("HOLD" if flavour is Px4 else "LAND")
