"""The MAVLink side: streams at their rates in simulated time, commands, parameters. Bytes in, bytes out; no socket."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

from pymavlink.dialects.v20 import development as mavlink

from hardware.sim.autopilot.fence_protocol import FENCE, FenceProtocol
from hardware.sim.autopilot.firmware import ACCEPTED, DENIED, UNSUPPORTED, Command, Firmware
from hardware.sim.autopilot.telemetry import autopilot_version, builders

_DATA_STREAMS: dict[int, tuple[int, ...]] = {
    mavlink.MAV_DATA_STREAM_EXTENDED_STATUS: (
        mavlink.MAVLINK_MSG_ID_SYS_STATUS,
        mavlink.MAVLINK_MSG_ID_GPS_RAW_INT,
        mavlink.MAVLINK_MSG_ID_EXTENDED_SYS_STATE,
        mavlink.MAVLINK_MSG_ID_BATTERY_STATUS,
        mavlink.MAVLINK_MSG_ID_HOME_POSITION,
    ),
    mavlink.MAV_DATA_STREAM_POSITION: (mavlink.MAVLINK_MSG_ID_GLOBAL_POSITION_INT,),
    mavlink.MAV_DATA_STREAM_EXTRA1: (mavlink.MAVLINK_MSG_ID_ATTITUDE,),
    mavlink.MAV_DATA_STREAM_EXTRA2: (mavlink.MAVLINK_MSG_ID_VFR_HUD,),
    mavlink.MAV_DATA_STREAM_EXTRA3: (mavlink.MAVLINK_MSG_ID_SYSTEM_TIME,),
}
"""REQUEST_DATA_STREAM's groups, as ArduPilot has them."""

_MODE_PERIOD = 0.5
"""Seconds between two reports of an unchanged mode."""
_SYSTEM, _COMPONENT = 1, mavlink.MAV_COMP_ID_AUTOPILOT1


class Station:
    """One autopilot's MAVLink endpoint around a firmware."""

    def __init__(self, firmware: Firmware) -> None:
        self.firmware = firmware
        self._builders = builders(firmware.name)
        self._fence = FenceProtocol(firmware.fence, firmware.faults, refuses_repeated=firmware.name == "ardupilot")
        self._encoder = mavlink.MAVLink(None, _SYSTEM, _COMPONENT)
        self._decoder = mavlink.MAVLink(None)
        self._decoder.robust_parsing = True
        self._period: dict[int, float] = {}
        self._due: dict[int, float] = {}
        self._mode_sent: tuple[float, str] = (-math.inf, "")
        self.default_streams()

    def default_streams(self) -> None:
        """What is sent without being asked: as after every start of the autopilot."""
        self._period = {mavlink.MAVLINK_MSG_ID_HEARTBEAT: 1.0}
        self._period |= {message: 1.0 / hz for message, hz in self.firmware.streams_by_default.items()}
        self._due = dict.fromkeys(self._period, self.firmware.time)
        self._mode_sent = -math.inf, ""

    # -- out -------------------------------------------------------------------------------------------------------

    def pack(self, message: Any) -> bytes:
        """With the next MAVLink sequence number."""
        return bytes(message.pack(self._encoder))

    def due(self) -> Iterator[bytes]:
        """What is to be sent at the firmware's present time."""
        firmware, now = self.firmware, self.firmware.time
        if firmware.heartbeat_due:
            firmware.heartbeat_due = False
            yield self.pack(self._builders[mavlink.MAVLINK_MSG_ID_HEARTBEAT](firmware))
        while firmware.outbox:
            yield self.pack(firmware.outbox.popleft())
        for message, due in self._due.items():
            if now >= due and not (message == mavlink.MAVLINK_MSG_ID_CURRENT_MODE and self._mode_is_known):
                self._due[message] = max(due + self._period[message], now)
                yield self.pack(self._builders[message](firmware))

    @property
    def _mode_is_known(self) -> bool:
        """Asked when CURRENT_MODE is due: False sends it."""
        firmware, (sent_at, mode) = self.firmware, self._mode_sent
        known = mode == firmware.mode and firmware.time - sent_at < _MODE_PERIOD
        if not known:
            self._mode_sent = firmware.time, firmware.mode
        return known

    def _set_interval(self, message: int, hz: float) -> int:
        if message not in self._builders:
            return UNSUPPORTED
        beat = message == mavlink.MAVLINK_MSG_ID_HEARTBEAT  # a station must never lose it
        if not math.isfinite(hz) or (beat and not (self.firmware.heartbeat_on_mode_change and hz >= 1.0)):
            return DENIED
        if hz <= 0.0:
            self._due.pop(message, None)
            self._period.pop(message, None)
        else:
            self._period[message] = 1.0 / min(hz, 50.0)
            self._due[message] = self.firmware.time
        return ACCEPTED

    # -- in --------------------------------------------------------------------------------------------------------

    def receive(self, data: bytes) -> list[bytes]:
        """Answers to what a ground station sent."""
        answers: list[bytes] = []
        for message in self._decoder.parse_buffer(data) or []:
            answers += [self.pack(answer) for answer in self._answer(message)]
        return answers

    def _answer(self, message: Any) -> list[Any]:
        firmware = self.firmware
        match message.get_type():
            case "HEARTBEAT":
                if message.type == mavlink.MAV_TYPE_GCS and firmware.watches_station(message.get_srcSystem()):
                    firmware.gcs_heard_at = firmware.time
                return []
            case "COMMAND_LONG" | "COMMAND_INT":
                if message.target_system not in (0, _SYSTEM) or message.target_component not in (0, _COMPONENT):
                    return []
                return self._command(message)
            case "SET_MODE":
                number = mavlink.MAV_CMD_DO_SET_MODE
                custom = message.custom_mode
                main, sub = (custom >> 16 & 0xFF, custom >> 24) if firmware.name == "px4" else (custom, 0)
                firmware.command(Command(number, 1.0, float(main), float(sub)))
                return []
            case "PARAM_REQUEST_READ" | "PARAM_REQUEST_LIST" | "PARAM_SET":
                return self._parameters(message)
            case "REQUEST_DATA_STREAM":
                for wanted in _DATA_STREAMS.get(message.req_stream_id, ()):
                    self._set_interval(wanted, message.req_message_rate if message.start_stop else 0.0)
                return []
            case name if name.startswith("MISSION_") and getattr(message, "mission_type", None) == FENCE:
                return self._fence.answer(message)
            case "MISSION_REQUEST_LIST":
                return [
                    mavlink.MAVLink_mission_count_message(
                        message.get_srcSystem(), message.get_srcComponent(), 0, message.mission_type
                    )
                ]
            case "TIMESYNC" if message.tc1 == 0 and firmware.name == "px4":
                return []  # PX4 1.16 leaves the target of its answer uninitialised: nobody takes it for theirs
            case "TIMESYNC" if message.tc1 == 0:
                return [mavlink.MAVLink_timesync_message(int(firmware.time * 1e9), message.ts1)]
            case "PING" if message.target_system == 0:
                return [
                    mavlink.MAVLink_ping_message(
                        message.time_usec, message.seq, message.get_srcSystem(), message.get_srcComponent()
                    )
                ]
            case _:
                return []

    def _command(self, message: Any) -> list[Any]:
        try:
            result, answers = self._carry_out(message)
        except (ValueError, OverflowError):  # NaN or infinity where a whole number belongs
            result, answers = DENIED, []
        if result is None:
            return []
        ack = mavlink.MAVLink_command_ack_message(
            message.command, result, 0, 0, message.get_srcSystem(), message.get_srcComponent()
        )
        return [ack, *answers]

    def _carry_out(self, message: Any) -> tuple[int | None, list[Any]]:
        """(MAV_RESULT or None for no answer, messages that were asked for)."""
        answers: list[Any] = []
        result: int | None
        match message.command:
            case mavlink.MAV_CMD_SET_MESSAGE_INTERVAL:
                micros = message.param2
                default = {0.0: self.firmware.streams_by_default.get(int(message.param1), 1.0), -1.0: 0.0}
                result = self._set_interval(int(message.param1), default.get(micros, 1e6 / micros if micros else 0.0))
            case mavlink.MAV_CMD_REQUEST_MESSAGE:
                builder = self._builders.get(int(message.param1))
                result = UNSUPPORTED if builder is None else ACCEPTED
                answers = [] if builder is None else [builder(self.firmware)]
            case mavlink.MAV_CMD_REQUEST_AUTOPILOT_CAPABILITIES:
                result, answers = ACCEPTED, [autopilot_version(self.firmware)]
            case mavlink.MAV_CMD_GET_HOME_POSITION:
                result, answers = ACCEPTED, [self._builders[mavlink.MAVLINK_MSG_ID_HOME_POSITION](self.firmware)]
            case _:
                result = self.firmware.command(_as_command(message))
        return result, answers

    def _parameters(self, message: Any) -> list[Any]:
        table = self.firmware.parameters
        names = table.names()
        if message.get_type() == "PARAM_REQUEST_LIST":
            return [self._param_value(name) for name in names]
        if message.get_type() == "PARAM_REQUEST_READ" and message.param_index >= 0:
            index: int = message.param_index
            return [self._param_value(names[index])] if index < len(names) else []
        name = message.param_id.rstrip("\x00")
        if name not in table:
            return []
        if message.get_type() == "PARAM_SET":
            table.set(name, table.decode(name, message.param_value))
        return [self._param_value(name)]

    def _param_value(self, name: str) -> Any:
        table = self.firmware.parameters
        return mavlink.MAVLink_param_value_message(
            name.encode(), table.encode(name), table.kind(name), len(table), table.names().index(name)
        )


def _as_command(message: Any) -> Command:
    """Raises ValueError for infinities: NaN means "as it is", infinity means nothing."""
    number, values = message.command, (message.param1, message.param2, message.param3, message.param4)
    is_int = message.get_type() == "COMMAND_INT"
    rest = (message.z,) if is_int else (message.param5, message.param6, message.param7)
    if any(math.isinf(value) for value in (*values, *rest)):
        raise ValueError("a parameter is infinite")
    if is_int:
        given = message.x != 0x7FFFFFFF and message.y != 0x7FFFFFFF and (message.x, message.y) != (0, 0)
        lat, lon = (message.x / 1e7, message.y / 1e7) if given else (None, None)
        return Command(number, *values, lat, lon, message.z, message.frame, is_int=True)
    given = not (math.isnan(message.param5) or math.isnan(message.param6)) and (message.param5, message.param6) != (
        0,
        0,
    )
    lat, lon = (message.param5, message.param6) if given else (None, None)
    return Command(number, *values, lat, lon, message.param7)
