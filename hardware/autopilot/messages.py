"""The MAVLink commands Crossfix sends, as (message, fields) pairs. None is NaN: "not given". Numbers: common.xml."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

from hardware.readings import Place
from hardware.reasons.vehicle import CommandResult

SET_MODE, ARM, TAKE_OFF, REPOSITION, CONDITION_YAW, CHANGE_SPEED = 176, 400, 22, 192, 115, 178
SET_MESSAGE_INTERVAL, REQUEST_MESSAGE = 511, 512
HEARTBEAT_ID, CURRENT_MODE_ID, HOME_POSITION_ID, RC_CHANNELS_ID = 0, 436, 242, 65
_GLOBAL_INT = 5  # MAV_FRAME_GLOBAL_INT: altitude AMSL
_CUSTOM_MODE_ENABLED = 1.0
_CHANGE_MODE, _SAME_MODE = 1.0, 0.0  # MAV_DO_REPOSITION_FLAGS
_REPOSITIONED: frozenset[CommandResult] = frozenset({"accepted", "unsupported"})
"""PX4 answers "unsupported" to a reposition that changes no mode, and in HOLD obeys it."""

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
    """One command message, not yet addressed. `number`: its MAV_CMD, by which the acknowledgement comes.

    changes_mode: it takes the vehicle from whoever has just selected another mode. delivered: results that say no more
    than that it arrived; whether it is obeyed is for telemetry to show.
    """

    number: int
    message: str
    fields: dict[str, Any]
    changes_mode: bool = False
    delivered: frozenset[CommandResult] = frozenset({"accepted"})


def command_long(number: int, *params: float | None) -> Outgoing:
    """Up to seven params; those not given are NaN."""
    values = list(params) + [None] * (7 - len(params))
    fields: dict[str, Any] = {"command": number, "confirmation": 0}
    return Outgoing(number, "COMMAND_LONG", fields | {f"param{i}": value for i, value in enumerate(values, 1)})


def set_mode(custom: tuple[float, float]) -> Outgoing:
    """custom: (custom mode or PX4's main mode, PX4's sub mode or 0)."""
    order = command_long(SET_MODE, _CUSTOM_MODE_ENABLED, custom[0], custom[1], 0.0, 0.0, 0.0, 0.0)
    return replace(order, changes_mode=True)


def arm() -> Outgoing:
    """Without force: the autopilot's own prearm checks still refuse."""
    return command_long(ARM, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


def reposition(place: Place, altitude_amsl_m: float, speed_m_s: float | None, yaw_deg: float | None) -> Outgoing:
    """Fly there, in the mode that flies to such places: it never changes the mode, so it undoes no pilot's switch.

    COMMAND_INT keeps 1 cm of latitude. Yaw is radians on the wire; speed None keeps the present one.
    """
    fields: dict[str, Any] = {
        "frame": _GLOBAL_INT,
        "command": REPOSITION,
        "current": 0,
        "autocontinue": 0,
        "param1": -1.0 if speed_m_s is None else speed_m_s,
        "param2": _SAME_MODE,
        "param3": 0.0,
        "param4": None if yaw_deg is None else math.remainder(math.radians(yaw_deg), 2.0 * math.pi),
        "x": round(place.lat * 1e7),
        "y": round(place.lon * 1e7),
        "z": altitude_amsl_m,
    }
    return Outgoing(REPOSITION, "COMMAND_INT", fields, delivered=_REPOSITIONED)


def pause() -> Outgoing:
    """Brake and hover, from whatever mode: a reposition with no place, height or yaw. PX4 in HOLD flies on to the place
    it was sent to when only the mode is commanded (navigator_main.cpp, "All three set to NaN - pause vehicle")."""
    return replace(command_long(REPOSITION, -1.0, _CHANGE_MODE, 0.0), changes_mode=True)


def pause_here() -> Outgoing:
    """Brake and hover, in the mode that follows repositions."""
    return replace(command_long(REPOSITION, -1.0, _SAME_MODE, 0.0), delivered=_REPOSITIONED)


def yaw_alone(yaw_deg: float) -> Outgoing:
    """The nose, in the mode that follows repositions; the place that was ordered last stays the one to be at."""
    yaw_rad = math.remainder(math.radians(yaw_deg), 2.0 * math.pi)
    return replace(command_long(REPOSITION, -1.0, _SAME_MODE, 0.0, yaw_rad), delivered=_REPOSITIONED)


def message_interval(message_id: int, hz: float) -> Outgoing:
    """hz: how often the autopilot is to send that message from now on."""
    return command_long(SET_MESSAGE_INTERVAL, float(message_id), 1e6 / hz, 0.0, 0.0, 0.0, 0.0, 0.0)


def result_of(number: int) -> CommandResult:
    """number: MAV_RESULT."""
    return RESULTS[number] if 0 <= number < len(RESULTS) else "unknown"


def request_message(message_id: int) -> Outgoing:
    """The message once, now."""
    return command_long(REQUEST_MESSAGE, float(message_id), 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
