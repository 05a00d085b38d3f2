from __future__ import annotations

import math
from collections import Counter
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pymavlink.dialects.v20 import development as mavlink

from hardware.sim.autopilot.ardupilot import ArduCopter
from hardware.sim.autopilot.firmware import Conditions, Firmware
from hardware.sim.autopilot.geodesy import HomeFrame
from hardware.sim.autopilot.px4 import Px4
from hardware.sim.autopilot.station import Station

BOTH = pytest.mark.parametrize("flavour", [Px4, ArduCopter])


class Ground:
    """A ground station's end of the wire."""

    def __init__(self, flavour: type[Firmware]) -> None:
        self.firmware = flavour(Conditions(home=HomeFrame(47.4, 8.5, 488.0)))  # pyright: ignore[reportCallIssue]
        self.station = Station(self.firmware)
        self._mavlink = mavlink.MAVLink(None, 255, 190)

    def decode(self, packets: list[bytes]) -> list[Any]:
        return [message for packet in packets for message in self._mavlink.parse_buffer(packet) or []]

    def send(self, message: Any) -> list[Any]:
        return self.decode(self.station.receive(bytes(message.pack(self._mavlink))))

    def command(self, number: int, *params: float) -> list[Any]:
        values = list(params) + [0.0] * (7 - len(params))
        return self.send(mavlink.MAVLink_command_long_message(1, 1, number, 0, *values))

    def run(self, seconds: float) -> list[Any]:
        heard: list[Any] = []
        for _ in range(round(seconds / 0.02)):
            self.firmware.step(0.02)
            heard += self.decode(list(self.station.due()))
        return heard

    def counts(self, seconds: float) -> Counter[str]:
        return Counter(message.get_type() for message in self.run(seconds))


def test_px4_reports_a_changed_mode_at_once_and_an_unchanged_one_twice_a_second() -> None:
    ground = Ground(Px4)
    ground.command(mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, mavlink.MAVLINK_MSG_ID_CURRENT_MODE, 50_000)
    assert ground.counts(10.0)["CURRENT_MODE"] == pytest.approx(20, abs=2)
    ground.firmware.switch_mode("POSCTL")
    number = ground.firmware.custom_mode
    told = [message.custom_mode for message in ground.run(0.06) if message.get_type() == "CURRENT_MODE"]
    assert number in told


def test_arducopter_has_no_current_mode_and_sends_its_heartbeat_as_often_as_asked() -> None:
    ground = Ground(ArduCopter)
    answer = ground.command(mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, mavlink.MAVLINK_MSG_ID_CURRENT_MODE, 50_000)[0]
    assert answer.result == mavlink.MAV_RESULT_UNSUPPORTED

    assert ground.command(mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, 0, 200_000)[0].result == mavlink.MAV_RESULT_ACCEPTED
    assert ground.counts(10.0)["HEARTBEAT"] == pytest.approx(50, abs=2)
    assert ground.command(mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, 0, -1)[0].result == mavlink.MAV_RESULT_DENIED
    assert ground.counts(10.0)["HEARTBEAT"] == pytest.approx(50, abs=2)


def test_px4_streams_by_itself_and_arducopter_only_its_heartbeat_until_asked() -> None:
    px4, ardupilot = Ground(Px4), Ground(ArduCopter)

    assert px4.counts(10.0)["ATTITUDE"] == pytest.approx(100, abs=2)
    assert set(ardupilot.counts(10.0)) == {"HEARTBEAT"}
    assert ardupilot.command(mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, 30, 50_000)[0].result == 0
    assert ardupilot.counts(10.0)["ATTITUDE"] == pytest.approx(200, abs=2)
    ardupilot.send(mavlink.MAVLink_request_data_stream_message(1, 1, mavlink.MAV_DATA_STREAM_POSITION, 4, 1))
    assert ardupilot.counts(10.0)["GLOBAL_POSITION_INT"] == pytest.approx(40, abs=1)


@BOTH
def test_a_rate_of_zero_stops_and_an_unknown_message_is_not_supported(flavour: type[Firmware]) -> None:
    ground = Ground(flavour)
    ground.command(mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, 30, 50_000)
    ground.command(mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, 30, -1)

    assert "ATTITUDE" not in ground.counts(3.0)
    assert (
        ground.command(mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, 12_345, 50_000)[0].result == mavlink.MAV_RESULT_UNSUPPORTED
    )
    assert ground.command(mavlink.MAV_CMD_REQUEST_MESSAGE, 12_345)[0].result == mavlink.MAV_RESULT_UNSUPPORTED


def test_a_mode_change_is_told_at_once_by_arducopter_and_by_px4_only_in_current_mode() -> None:
    px4, ardupilot = Ground(Px4), Ground(ArduCopter)
    px4.command(mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, 436, 50_000)
    for ground, mode in ((px4, "POSCTL"), (ardupilot, "ALT_HOLD")):
        ground.run(10.3)
        ground.firmware.switch_mode(mode)
        heard = ground.run(0.1)
        kinds = [message.get_type() for message in heard if getattr(message, "custom_mode", None) is not None]
        assert kinds[0] == ("CURRENT_MODE" if ground is px4 else "HEARTBEAT")
        assert all(
            message.custom_mode == ground.firmware.custom_mode for message in heard if hasattr(message, "custom_mode")
        )
        if ground is px4:
            assert "HEARTBEAT" not in kinds


@BOTH
def test_parameters_are_read_set_and_listed_as_the_flavour_encodes_them(flavour: type[Firmware]) -> None:
    ground = Ground(flavour)
    name = "NAV_DLL_ACT" if flavour is Px4 else "FS_GCS_ENABLE"
    table = ground.firmware.parameters

    (value,) = ground.send(mavlink.MAVLink_param_request_read_message(1, 1, name.encode(), -1))
    assert table.decode(name, value.param_value) == table[name]
    if flavour is Px4:
        assert 0.0 < value.param_value < 1e-40  # the integer's bytes in a float
    table.set(name, 5)
    wire = table.encode(name)
    table.set(name, 0)
    (echo,) = ground.send(mavlink.MAVLink_param_set_message(1, 1, name.encode(), wire, value.param_type))
    assert table[name] == 5
    assert echo.param_id == name
    listed = ground.send(mavlink.MAVLink_param_request_list_message(1, 1))
    assert len(listed) == len(table)
    assert ground.send(mavlink.MAVLink_param_request_read_message(1, 1, b"NO_SUCH", -1)) == []


@BOTH
def test_garbage_moves_nothing_and_what_follows_is_understood(flavour: type[Firmware]) -> None:
    ground = Ground(flavour)

    assert ground.station.receive(bytes(range(256)) * 4) == []
    answers = []
    for _ in range(3):  # the first may complete what the garbage began
        answers = ground.command(mavlink.MAV_CMD_REQUEST_MESSAGE, mavlink.MAVLINK_MSG_ID_AUTOPILOT_VERSION)
    assert [message.get_type() for message in answers] == ["COMMAND_ACK", "AUTOPILOT_VERSION"]


def test_commands_for_another_system_are_not_ours() -> None:
    ground = Ground(Px4)
    other = mavlink.MAVLink_command_long_message(7, 1, mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 0, 1, 0, 0, 0, 0, 0, 0)

    assert ground.send(other) == []
    assert not ground.firmware.commands


@pytest.mark.parametrize(("system", "counts"), [(255, True), (245, False)])
def test_arducopters_failsafe_watches_the_station_named_by_its_parameter(system: int, counts: bool) -> None:
    ground = Ground(ArduCopter)
    encoder = mavlink.MAVLink(None, system, 190)
    beat = mavlink.MAVLink_heartbeat_message(mavlink.MAV_TYPE_GCS, mavlink.MAV_AUTOPILOT_INVALID, 0, 0, 0, 3)
    ground.firmware.time = 4.0

    ground.station.receive(bytes(beat.pack(encoder)))

    assert (ground.firmware.gcs_heard_at == 4.0) is counts


@BOTH
@pytest.mark.parametrize("micros", [-1.0, 1e30, math.inf, math.nan])
def test_the_heartbeat_cannot_be_turned_off(flavour: type[Firmware], micros: float) -> None:
    ground = Ground(flavour)

    (ack,) = ground.command(mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, mavlink.MAVLINK_MSG_ID_HEARTBEAT, micros)

    assert ack.result == mavlink.MAV_RESULT_DENIED
    assert ground.counts(5.0)["HEARTBEAT"] >= 4


SevenParameters = tuple[float, float, float, float, float, float, float]

NUMBERS = st.sampled_from([math.nan, math.inf, -math.inf, 0.0, -1.0, 1.0, 4.0, 1e30, 300.0])


@settings(max_examples=150, deadline=None)
@given(
    flavour=st.sampled_from([Px4, ArduCopter]),
    number=st.sampled_from([20, 21, 22, 115, 176, 178, 192, 400, 410, 511, 512, 520, 31_000]),
    params=st.tuples(*[NUMBERS] * 7),
    as_int=st.booleans(),
    in_air=st.booleans(),
)
def test_no_command_brings_it_down(
    flavour: type[Firmware], number: int, params: SevenParameters, as_int: bool, in_air: bool
) -> None:
    ground = Ground(flavour)
    ground.run(10.0)
    ground.firmware.flight.arm()
    if in_air:
        ground.firmware.copter.up = 20.0
        ground.firmware.set_mode("HOLD" if flavour is Px4 else "GUIDED")
    ground.command(mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, mavlink.MAVLINK_MSG_ID_GLOBAL_POSITION_INT, 100_000)
    if as_int:
        message = mavlink.MAVLink_command_int_message(1, 1, 5, number, 0, 0, *params[:4], 10, -10, params[6])
    else:
        message = mavlink.MAVLink_command_long_message(1, 1, number, 0, *params)

    answers = ground.send(message)
    heard = ground.counts(2.0)

    assert answers[0].get_type() == "COMMAND_ACK"
    assert heard["HEARTBEAT"] >= 1


def test_a_place_given_as_nan_is_no_place() -> None:
    ground = Ground(Px4)
    ground.run(7.0)
    ground.command(mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 1)
    ground.command(mavlink.MAV_CMD_NAV_TAKEOFF, *[math.nan] * 6, 508.0)
    ground.run(25.0)
    (ack,) = ground.command(mavlink.MAV_CMD_DO_REPOSITION, -1, 1, 0, *[math.nan] * 4)

    assert ack.result == mavlink.MAV_RESULT_ACCEPTED
    assert ground.firmware.flight.demand.north == pytest.approx(ground.firmware.navigation.north, abs=0.5)


@BOTH
def test_an_infinite_place_is_denied(flavour: type[Firmware]) -> None:
    ground = Ground(flavour)
    nowhere = (-1.0, 1.0, 0.0, math.nan, math.inf, -math.inf, 20.0)

    (ack,) = ground.command(mavlink.MAV_CMD_DO_REPOSITION, *nowhere)

    assert ack.result == mavlink.MAV_RESULT_DENIED
