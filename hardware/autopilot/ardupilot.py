"""ArduCopter, as measured on 4.7: GUIDED and BRAKE, DO_REPOSITION ignores yaw and speed, take-off is relative."""

from __future__ import annotations

from hardware.autopilot.dialect import Dialect, FailsafeRule, ModeOrder
from hardware.autopilot.link import STATION_SYSTEM
from hardware.autopilot.messages import TAKE_OFF, Outgoing, command_long, set_mode

GUIDED, RTL, LAND, BRAKE, SMART_RTL = 4, 6, 9, 17, 21


def _order(name: str, mode: int) -> ModeOrder:
    return ModeOrder(name, (mode, 0), frozenset({mode}))


def _take_off(relative_m: float, amsl_m: float) -> Outgoing:
    return command_long(TAKE_OFF, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, relative_m)


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
        27: "AUTO_RTL",
    },
    calm=frozenset({GUIDED, BRAKE}),
    hold=(set_mode((BRAKE, 0)),) * 3,
    hold_modes=frozenset({BRAKE}),
    return_home=_order("RTL", RTL),
    land=_order("LAND", LAND),
    before_take_off=_order("GUIDED", GUIDED),
    take_off=_take_off,
    take_off_modes=frozenset({GUIDED}),
    settled_modes=frozenset({GUIDED}),
    reposition_modes=frozenset({GUIDED}),
    reposition_sets_speed=False,
    turn_methods=("condition_yaw", "condition_yaw", "condition_yaw_absolute"),
    failsafes=(
        FailsafeRule(
            "FS_GCS_ENABLE",
            "ground station lost",
            frozenset({1, 3, 4, 5, 6, 7}),
            1,
            "Set FS_GCS_ENABLE to 1 (RTL): at 0 a vehicle without its station hovers until its battery is empty.",
        ),
        FailsafeRule(
            "MAV_GCS_SYSID",
            "the ground station that its failsafe watches",
            frozenset({STATION_SYSTEM}),
            STATION_SYSTEM,
            f"Set MAV_GCS_SYSID (SYSID_MYGCS before 4.7) to {STATION_SYSTEM}, Crossfix' MAVLink system id: "
            "the autopilot does not notice the loss of any other.",
            formerly="SYSID_MYGCS",
        ),
        FailsafeRule(
            "FENCE_ACTION",
            "geofence breached",
            frozenset({1, 2, 3, 4, 5}),
            1,
            "Set FENCE_ACTION to 1 (RTL or land): at 0 the autopilot only reports the fence being left.",
        ),
        FailsafeRule(
            "FS_THR_ENABLE",
            "radio control lost",
            frozenset({1, 2, 3, 4, 5, 6, 7}),
            1,
            "Set FS_THR_ENABLE to 1 (RTL) when a pilot stands by with a transmitter.",
            blocking=False,
        ),
    ),
)
