"""PX4, as measured on 1.16: main and sub modes, DO_REPOSITION obeys speed and yaw, take-off altitude is AMSL."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from hardware.autopilot.dialect import (
    STATION_NOTICED_LOST_S,
    Dialect,
    FailsafeRule,
    ModeOrder,
    NetRules,
    OwnFence,
)
from hardware.autopilot.failsafe_names import FailsafeEvent, FailsafeText, FailsafeWords
from hardware.autopilot.messages import CURRENT_MODE_ID, TAKE_OFF, Outgoing, command_long, pause, pause_here, set_mode
from hardware.reasons.vehicle import CommandName


def px4_mode(main: int, sub: int = 0) -> int:
    """The raw custom mode (px4_custom_mode.h): main mode in byte 2, sub mode in byte 3."""
    return main << 16 | sub << 24


_AUTO = 4
_TAKE_OFF, _LOITER, _MISSION, _RETURN, _LAND, _PRECISION_LAND = 2, 3, 4, 5, 6, 9
HOLD, TAKING_OFF = px4_mode(_AUTO, _LOITER), px4_mode(_AUTO, _TAKE_OFF)
RETURNING, LANDING = px4_mode(_AUTO, _RETURN), px4_mode(_AUTO, _LAND)


def _order(command: CommandName, sub: int, *modes: int) -> ModeOrder:
    return ModeOrder(command, (_AUTO, sub), frozenset(modes))


def _take_off(relative_m: float, amsl_m: float) -> Outgoing:
    return replace(command_long(TAKE_OFF, None, None, None, None, None, None, amsl_m), changes_mode=True)


def _own_fence(values: Mapping[str, float]) -> OwnFence:
    """GF_ACTION 0 looks at nothing; 1 only warns, but is the owner's limit all the same."""
    watched = values["GF_ACTION"] > 0
    high, far = values["GF_MAX_VER_DIST"], values.get("GF_MAX_HOR_DIST", 0.0)
    return OwnFence(
        watched=watched,
        ceiling_m=high if watched and high > 0.0 else None,
        ceiling_parameter="GF_MAX_VER_DIST",
        radius_m=far if watched and far > 0.0 else None,
        any_inclusion=False,
    )


def _fence_for_mission(values: Mapping[str, float], ceiling_m: float) -> dict[str, float]:
    """GF_ACTION is asked for by the failsafe rules."""
    return {"GF_MAX_VER_DIST": ceiling_m}


PX4 = Dialect(
    name="px4",
    mode_names={
        px4_mode(1): "MANUAL",
        px4_mode(2): "ALTCTL",
        px4_mode(3): "POSCTL",
        px4_mode(3, 1): "ORBIT",
        px4_mode(3, 2): "POSCTL SLOW",
        px4_mode(_AUTO, 1): "READY",
        TAKING_OFF: "TAKEOFF",
        HOLD: "HOLD",
        px4_mode(_AUTO, _MISSION): "MISSION",
        RETURNING: "RETURN",
        LANDING: "LAND",
        px4_mode(_AUTO, 8): "FOLLOW",
        px4_mode(_AUTO, _PRECISION_LAND): "PRECISION LAND",
        px4_mode(5): "ACRO",
        px4_mode(6): "OFFBOARD",
        px4_mode(7): "STABILIZED",
        px4_mode(10): "TERMINATION",
    },
    mode_report=(CURRENT_MODE_ID, 200.0),
    mode_switch="RC_MAP_FLTMODE",
    waiting_modes=frozenset({HOLD, TAKING_OFF}),
    returning_modes=frozenset({RETURNING}),
    landing_modes=frozenset({LANDING, px4_mode(_AUTO, _PRECISION_LAND)}),
    takeover_text="Pilot took over",
    # a warning says "Failsafe activated", too; the numbers are those of commander_failsafe_enter and of its _hold and
    # _generic forms (libevents: FNV-1a of the name), of failsafe_cause_t and of failsafe_action_t from "rtl" on
    failsafe_words=FailsafeWords(
        texts=(
            FailsafeText("Failsafe activated", None, "acts_as_announced"),
            FailsafeText("Failsafe activated: entering Hold for ", None, "will_act", ends=""),
            FailsafeText("Geofence violation", "fence", "cause", ends=""),
            FailsafeText("Critical battery", "battery", "cause"),
            FailsafeText("Emergency battery level", "battery", "cause"),
        ),
        events={
            0x94CA8A: FailsafeEvent(acts=True, cause_at=5),
            0xDEDBD0: FailsafeEvent(acts=True),
            0xC2DC72: FailsafeEvent(acts=True, cause="position"),  # "autopilot disengaged": what needs no position
            0xD11DF6: FailsafeEvent(acts=False, cause_at=7),
            0x44B3E0: FailsafeEvent(acts=False),
        },
        causes={1: "transmitter", 2: "silence", 3: "battery", 4: "battery", 5: "battery", 6: "battery"},
        homeward_actions=frozenset({6, 7, 8}),
    ),
    state_tells_failsafe=True,
    waits_again=True,
    place_refused_texts=("Reposition is outside geofence",),
    # twice without a mode: a slow PX4 that already holds is sent nothing that could undo a pilot
    hold=(pause_here(), pause_here(), pause(), set_mode((_AUTO, _LOITER)), pause()),
    hold_modes=frozenset({HOLD}),
    stay=pause_here(),
    hold_turns_nose=True,  # to where it stops, at MPC_YAW_MODE 0 (FlightTaskAuto.cpp)
    return_home=_order("return", _RETURN, RETURNING, LANDING, px4_mode(_AUTO, _PRECISION_LAND)),
    land=_order("landing", _LAND, LANDING),
    before_take_off=_order("take_off_mode", _LOITER, HOLD),  # armed in TAKING_OFF it climbs unasked, to 2.5 m
    take_off=_take_off,
    take_off_modes=frozenset({TAKING_OFF, HOLD}),
    settled_modes=frozenset({HOLD}),
    steering=_order("steering_mode", _LOITER, HOLD),
    reposition_sets_speed=True,
    turn_methods=("yaw_steps", "yaw_steps", "nudged_yaw_steps"),
    yaw_on_the_way="reposition",
    prearm_has_present_bit=False,
    nets=NetRules(
        parameters=("GF_ACTION", "GF_MAX_HOR_DIST", "GF_MAX_VER_DIST"),
        required=frozenset({"GF_ACTION", "GF_MAX_VER_DIST"}),
        own=_own_fence,
        for_mission=_fence_for_mission,
        most_corners=60,
    ),
    return_altitudes=(("RTL_RETURN_ALT", 1.0),),
    return_climbs=(),
    failsafes=(
        FailsafeRule(
            "NAV_DLL_ACT",
            "station",
            frozenset({1, 2, 3}),
            2,  # return
        ),
        FailsafeRule(
            "COM_DL_LOSS_T",
            "station_time",
            frozenset(),
            10,
            within=STATION_NOTICED_LOST_S,
        ),
        FailsafeRule(
            "COM_RC_OVERRIDE",
            "sticks",
            frozenset(),
            1,
            bit=1,
        ),
        FailsafeRule(
            "GF_ACTION",
            "fence",
            frozenset({2, 3, 5}),
            3,  # return
        ),
        FailsafeRule(
            "COM_LOW_BAT_ACT",
            "battery",
            frozenset({2, 3}),
            3,  # return when critical, land in an emergency
        ),
        FailsafeRule(
            "COM_OBL_RC_ACT",
            "offboard",
            frozenset({0, 1, 3, 4, 5}),
            0,  # position
            blocking=False,
        ),
    ),
)
