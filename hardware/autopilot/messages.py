"""The MAVLink commands Crossfix sends, as (message, fields) pairs. None is NaN: "not given". Numbers: common.xml."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from hardware.readings import Place
from hardware.reasons.vehicle import CommandResult

SET_MODE, ARM, TAKE_OFF, REPOSITION, CONDITION_YAW, CHANGE_SPEED = 176, 400, 22, 192, 115, 178
SET_MESSAGE_INTERVAL, REQUEST_MESSAGE = 511, 512
HOME_POSITION_ID = 242
_GLOBAL_INT = 5  # MAV_FRAME_GLOBAL_INT: altitude AMSL
_CUSTOM_MODE_ENABLED = 1.0
_CHANGE_MODE = 1.0  # MAV_DO_REPOSITION_FLAGS_CHANGE_MODE

RESULTS: tuple[CommandResult, ...] = (
    "accepted",
    "temporarily_rejected",
    "denied",
    "unsupported",
    "failed",
    "in_progress",
    "cancelled",
)
"""By the number of the MAV_RESULT."""


@dataclass(frozen=True, slots=True)
class Outgoing:
    """One command message, not yet addressed. `number`: its MAV_CMD, by which the acknowledgement comes."""

    number: int
    message: str
    fields: dict[str, Any]


def command_long(number: int, *params: float | None) -> Outgoing:
    """Up to seven params; those not given are NaN."""
    values = list(params) + [None] * (7 - len(params))
    fields: dict[str, Any] = {"command": number, "confirmation": 0}
    return Outgoing(number, "COMMAND_LONG", fields | {f"param{i}": value for i, value in enumerate(values, 1)})


def set_mode(custom: tuple[float, float]) -> Outgoing:
    """custom: (custom mode or PX4's main mode, PX4's sub mode or 0)."""
    return command_long(SET_MODE, _CUSTOM_MODE_ENABLED, custom[0], custom[1], 0.0, 0.0, 0.0, 0.0)


def arm() -> Outgoing:
    """Without force: the autopilot's own prearm checks still refuse."""
    return command_long(ARM, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


def reposition(place: Place, altitude_amsl_m: float, speed_m_s: float | None, yaw_deg: float | None) -> Outgoing:
    """Fly there; COMMAND_INT keeps 1 cm of latitude. Yaw is radians on the wire; speed None keeps the present one."""
    fields: dict[str, Any] = {
        "frame": _GLOBAL_INT,
        "command": REPOSITION,
        "current": 0,
        "autocontinue": 0,
        "param1": -1.0 if speed_m_s is None else speed_m_s,
        "param2": _CHANGE_MODE,
        "param3": 0.0,
        "param4": None if yaw_deg is None else math.remainder(math.radians(yaw_deg), 2.0 * math.pi),
        "x": round(place.lat * 1e7),
        "y": round(place.lon * 1e7),
        "z": altitude_amsl_m,
    }
    return Outgoing(REPOSITION, "COMMAND_INT", fields)


def pause() -> Outgoing:
    """Brake and hover: a reposition with no place, height or yaw. PX4 in HOLD flies on to the place it was sent to when
    only the mode is commanded (navigator_main.cpp, "All three set to NaN - pause vehicle")."""
    return command_long(REPOSITION, -1.0, _CHANGE_MODE, 0.0)


def message_interval(message_id: int, hz: float) -> Outgoing:
    """hz: how often the autopilot is to send that message from now on."""
    return command_long(SET_MESSAGE_INTERVAL, float(message_id), 1e6 / hz, 0.0, 0.0, 0.0, 0.0, 0.0)


def result_of(number: int) -> CommandResult:
    """number: MAV_RESULT."""
    return RESULTS[number] if 0 <= number < len(RESULTS) else "unknown"


def request_message(message_id: int) -> Outgoing:
    """The message once, now."""
    return command_long(REQUEST_MESSAGE, float(message_id), 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
