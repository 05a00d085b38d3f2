"""ArduCopter, as measured on 4.7: GUIDED and BRAKE, DO_REPOSITION ignores yaw and speed, take-off is relative."""

from __future__ import annotations

from collections.abc import Mapping

from hardware.autopilot.dialect import (
    STATION_NOTICED_LOST_S,
    Dialect,
    FailsafeRule,
    ModeOrder,
    NetRules,
    OwnFence,
)
from hardware.autopilot.failsafe_names import FailsafeText, FailsafeWords
from hardware.autopilot.messages import HEARTBEAT_ID, TAKE_OFF, Outgoing, command_long, set_mode
from hardware.autopilot.opening import STATION_SYSTEM
from hardware.reasons.vehicle import CommandName

GUIDED, RTL, LAND, BRAKE, SMART_RTL, AUTO_RTL = 4, 6, 9, 17, 21, 27


def _order(command: CommandName, mode: int) -> ModeOrder:
    return ModeOrder(command, (mode, 0), frozenset({mode}))


def _take_off(relative_m: float, amsl_m: float) -> Outgoing:
    return command_long(TAKE_OFF, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, relative_m)


_ALTITUDE, _CIRCLE, _POLYGON = 1, 2, 4  # FENCE_TYPE
_UNION = 2  # FENCE_OPTIONS: inside one inclusion is enough


def _own_fence(values: Mapping[str, float]) -> OwnFence:
    enabled, kinds = values["FENCE_ENABLE"] > 0, int(values["FENCE_TYPE"])
    return OwnFence(
        watched=enabled and bool(kinds & _POLYGON),
        ceiling_m=values["FENCE_ALT_MAX"] if enabled and kinds & _ALTITUDE else None,
        ceiling_parameter="FENCE_ALT_MAX",
        radius_m=values.get("FENCE_RADIUS") if enabled and kinds & _CIRCLE else None,
        any_inclusion=bool(int(values.get("FENCE_OPTIONS", 0.0)) & _UNION),
    )


def _fence_for_mission(values: Mapping[str, float], ceiling_m: float) -> dict[str, float]:
    """What the owner has in force stays so; what is not enabled is none of the mission's business."""
    own = int(values["FENCE_TYPE"]) if values["FENCE_ENABLE"] > 0 else 0
    return {"FENCE_TYPE": float(own | _ALTITUDE | _POLYGON), "FENCE_ALT_MAX": ceiling_m, "FENCE_ENABLE": 1.0}


ARDUPILOT = Dialect(
    name="ardupilot",
    mode_names={
        0: "STABILIZE",
        1: "ACRO",
        2: "ALT_HOLD",
        3: "AUTO",
        GUIDED: "GUIDED",
        5: "LOITER",
        RTL: "RTL",
        7: "CIRCLE",
        LAND: "LAND",
        11: "DRIFT",
        13: "SPORT",
        15: "AUTOTUNE",
        16: "POSHOLD",
        BRAKE: "BRAKE",
        18: "THROW",
        20: "GUIDED_NOGPS",
        SMART_RTL: "SMART_RTL",
        AUTO_RTL: "AUTO_RTL",
    },
    mode_report=(HEARTBEAT_ID, 5.0),
    mode_switch="FLTMODE_CH",
    waiting_modes=frozenset({GUIDED, BRAKE}),
    returning_modes=frozenset({RTL, SMART_RTL, AUTO_RTL}),
    landing_modes=frozenset({LAND}),
    takeover_text=None,
    failsafe_words=FailsafeWords(
        (
            FailsafeText("Battery Failsafe", "battery"),
            FailsafeText("Radio Failsafe", "transmitter"),
            FailsafeText("GCS Failsafe", "silence"),
            FailsafeText("EKF Failsafe: changed to ", "position", ends=" Mode"),
            FailsafeText("Dead Reckoning started", "position"),
            FailsafeText("Failsafe: Terrain data missing", "other"),
            FailsafeText("", "fence", ends=" fence breached"),
            FailsafeText("", "fence", ends=" fences breached"),
        )
    ),
    state_tells_failsafe=False,
    waits_again=False,
    place_refused_texts=(),
    hold=(set_mode((BRAKE, 0)),) * 3,
    hold_modes=frozenset({BRAKE}),
    stay=None,
    hold_turns_nose=False,
    return_home=_order("return", RTL),
    land=_order("landing", LAND),
    before_take_off=_order("take_off_mode", GUIDED),
    take_off=_take_off,
    take_off_modes=frozenset({GUIDED}),
    settled_modes=frozenset({GUIDED}),
    steering=_order("steering_mode", GUIDED),
    reposition_sets_speed=False,
    turn_methods=("condition_yaw", "condition_yaw", "condition_yaw_absolute"),
    yaw_on_the_way="condition_yaw",
    prearm_has_present_bit=True,
    nets=NetRules(
        parameters=("FENCE_TYPE", "FENCE_ALT_MAX", "FENCE_RADIUS", "FENCE_OPTIONS", "FENCE_ENABLE"),
        required=frozenset({"FENCE_TYPE", "FENCE_ALT_MAX", "FENCE_ENABLE"}),
        own=_own_fence,
        for_mission=_fence_for_mission,
        most_corners=70,
    ),
    return_altitudes=(("RTL_ALT_M", 1.0), ("RTL_ALT", 0.01)),
    return_climbs=(("RTL_CLIMB_MIN_M", 1.0), ("RTL_CLIMB_MIN", 0.01)),
    failsafes=(
        FailsafeRule(
            "FS_GCS_ENABLE",
            "station",
            frozenset({1, 3, 4, 5, 6, 7}),
            1,  # RTL
        ),
        FailsafeRule(
            "FS_GCS_TIMEOUT",
            "station_time",
            frozenset(),
            5,
            within=STATION_NOTICED_LOST_S,
        ),
        FailsafeRule(
            "MAV_GCS_SYSID",
            "station_id",
            frozenset({STATION_SYSTEM}),
            STATION_SYSTEM,
            formerly="SYSID_MYGCS",
        ),
        FailsafeRule(
            "FENCE_ACTION",
            "fence",
            frozenset({1, 2, 3, 4, 5}),
            1,  # RTL or land
        ),
        FailsafeRule(
            "BATT_FS_LOW_ACT",
            "battery",
            frozenset({1, 2, 3, 4}),
            2,  # RTL
            thresholds=("BATT_LOW_VOLT", "BATT_LOW_MAH"),
        ),
        FailsafeRule(
            "BATT_FS_CRT_ACT",
            "battery_critical",
            frozenset({1, 2, 3, 4}),
            1,  # land
            blocking=False,
            thresholds=("BATT_CRT_VOLT", "BATT_CRT_MAH"),
        ),
        FailsafeRule(
            "FS_THR_ENABLE",
            "transmitter",
            frozenset({1, 2, 3, 4, 5, 6, 7}),
            1,  # RTL
            blocking=False,
        ),
    ),
)
