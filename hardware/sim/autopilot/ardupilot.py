"""The ArduCopter flavour: streams nothing unasked, GUIDED and BRAKE, yaw by CONDITION_YAW, disarms while waiting."""

from __future__ import annotations

import math
from typing import ClassVar

from pymavlink.dialects.v20 import development as mavlink

from hardware.sim.autopilot.failsafes import Cause
from hardware.sim.autopilot.firmware import (
    ACCEPTED,
    DENIED,
    FAILED,
    UNSUPPORTED,
    Command,
    Conditions,
    Firmware,
)
from hardware.sim.autopilot.parameters import INT8, INT16, INT32, REAL32, Parameters

DEFAULTS: dict[str, tuple[float, int]] = {
    "FS_GCS_ENABLE": (1, INT8),
    "FS_GCS_TIMEOUT": (5.0, REAL32),
    "FS_THR_ENABLE": (1, INT8),
    "FENCE_ENABLE": (0, INT8),
    "FENCE_ACTION": (1, INT8),
    "FENCE_TYPE": (7, INT8),
    "FENCE_RADIUS": (300.0, REAL32),
    "FENCE_ALT_MAX": (100.0, REAL32),
    "FENCE_OPTIONS": (1, INT16),
    "DISARM_DELAY": (10, INT8),
    "FLTMODE_CH": (5, INT8),
    "BATT_LOW_VOLT": (10.5, REAL32),
    "BATT_LOW_MAH": (0.0, REAL32),
    "BATT_CRT_VOLT": (9.9, REAL32),
    "BATT_CRT_MAH": (0.0, REAL32),
    "BATT_FS_LOW_ACT": (2, INT8),
    "BATT_FS_CRT_ACT": (1, INT8),
    "RTL_ALT": (1500, INT32),
    "RTL_CLIMB_MIN": (0, INT32),
    "RTL_LOIT_TIME": (5000, INT32),
    "WPNAV_SPEED": (1000.0, REAL32),
    "ATC_SLEW_YAW": (4500.0, REAL32),
    "WP_YAW_BEHAVIOR": (2, INT8),
    "MAV_GCS_SYSID": (255, INT16),
}

_SAID: dict[Cause, tuple[int, str]] = {
    "battery": (mavlink.MAV_SEVERITY_WARNING, "Battery Failsafe"),
    "transmitter": (mavlink.MAV_SEVERITY_WARNING, "Radio Failsafe"),
    "silence": (mavlink.MAV_SEVERITY_WARNING, "GCS Failsafe"),
    "position": (mavlink.MAV_SEVERITY_CRITICAL, "EKF Failsafe: changed to LAND Mode"),
    "fence": (mavlink.MAV_SEVERITY_NOTICE, "Polygon fence breached"),
}
GUIDED_AFTER = 9.0
"""Seconds from boot until the position estimate lets GUIDED in; prearm claims to be ready before."""


class ArduCopter(Firmware):
    """Mode numbers and parameter defaults are ArduCopter's own."""

    name: ClassVar[str] = "ardupilot"
    mav_autopilot: ClassVar[int] = mavlink.MAV_AUTOPILOT_ARDUPILOTMEGA
    modes: ClassVar[dict[str, int]] = {
        "STABILIZE": 0,
        "ALT_HOLD": 2,
        "AUTO": 3,
        "GUIDED": 4,
        "LOITER": 5,
        "RTL": 6,
        "LAND": 9,
        "POSHOLD": 16,
        "BRAKE": 17,
        "SMART_RTL": 21,
    }
    auto: ClassVar[frozenset[str]] = frozenset({"AUTO", "GUIDED", "RTL", "LAND", "BRAKE", "SMART_RTL"})
    pilot_mode: ClassVar[str] = "LOITER"
    give_back_mode: ClassVar[str] = "BRAKE"
    heartbeat_on_mode_change: ClassVar[bool] = True
    prearm_has_present_bit: ClassVar[bool] = True
    any_inclusion: ClassVar[bool] = False
    ready_after: ClassVar[float] = 3.0
    streams_by_default: ClassVar[dict[int, float]] = {}

    def __init__(self, conditions: Conditions) -> None:
        super().__init__(conditions, Parameters(DEFAULTS, bytewise=False))
        self._breached = False

    # -- modes -----------------------------------------------------------------------------------------------------

    def enter(self, mode: str) -> None:
        flight = self.flight
        if mode in ("RTL", "SMART_RTL"):
            p = self.parameters
            climbed = flight.navigation.up + max(0.0, p["RTL_CLIMB_MIN"] / 100.0)
            up, speed = max(p["RTL_ALT"] / 100.0, climbed), p["WPNAV_SPEED"] / 100.0
            flight.return_home(up, speed, math.inf, p["RTL_LOIT_TIME"] / 1000.0)
        elif mode == "LAND":
            flight.land()
        elif flight.in_air:
            flight.stop()

    def watch(self) -> None:
        if self.parameters["FENCE_ENABLE"] and self.mode not in ("RTL", "LAND"):
            self._watch_fence()

    def _within_fence(self, north: float, east: float, up: float) -> bool:
        """FENCE_TYPE: bit 0 the ceiling, 1 the circle around home, 2 the polygons."""
        kinds = int(self.parameters["FENCE_TYPE"])
        too_high = bool(kinds & 1) and up > self.parameters["FENCE_ALT_MAX"]
        too_far = bool(kinds & 2) and math.hypot(north, east) > self.parameters["FENCE_RADIUS"]
        return not (too_high or too_far) and (not kinds & 4 or self.fence.allows(north, east))

    def _watch_fence(self) -> None:
        nav = self.navigation
        outside = not self._within_fence(nav.north, nav.east, nav.up)
        action = {1: "RTL", 2: "LAND", 3: "SMART_RTL", 4: "BRAKE"}.get(int(self.parameters["FENCE_ACTION"]))
        breached, self._breached = outside and not self._breached, outside
        if breached and action and self.mode != action:
            self.fail_safe("fence", action)

    # -- commands --------------------------------------------------------------------------------------------------

    def carry_out(self, command: Command) -> int:
        match command.number:
            case mavlink.MAV_CMD_COMPONENT_ARM_DISARM:
                return self._arm() if command.p1 >= 0.5 else self.disarm()
            case mavlink.MAV_CMD_DO_SET_MODE:
                return self._select(int(command.p2))
            case mavlink.MAV_CMD_NAV_TAKEOFF:
                return self._take_off(command)
            case mavlink.MAV_CMD_DO_REPOSITION:
                return self._reposition(command)
            case mavlink.MAV_CMD_CONDITION_YAW:
                return self._condition_yaw(command)
            case mavlink.MAV_CMD_DO_CHANGE_SPEED:
                return self._change_speed(command)
            case mavlink.MAV_CMD_NAV_RETURN_TO_LAUNCH:
                return self._select(self.modes["RTL"])
            case mavlink.MAV_CMD_NAV_LAND:
                return self._select(self.modes["LAND"])
            case _:
                return UNSUPPORTED

    def _arm(self) -> int:
        if self.mode in ("RTL", "LAND", "BRAKE"):
            self.say("Arm: mode not armable", mavlink.MAV_SEVERITY_CRITICAL)
            return FAILED
        result = self.arm()
        return ACCEPTED if result == ACCEPTED else FAILED

    def _select(self, custom_mode: int) -> int:
        mode = next((name for name, number in self.modes.items() if number == custom_mode), None)
        needs_position = mode not in ("STABILIZE", "ALT_HOLD", "LAND")
        if mode is None or (needs_position and self.time < GUIDED_AFTER):
            self.say(f"Mode change to {mode} failed: requires position", mavlink.MAV_SEVERITY_CRITICAL)
            return FAILED
        self.set_mode(mode)
        return ACCEPTED

    def _take_off(self, command: Command) -> int:
        if command.is_int and command.frame not in (
            mavlink.MAV_FRAME_GLOBAL_RELATIVE_ALT,
            mavlink.MAV_FRAME_GLOBAL_RELATIVE_ALT_INT,
        ):
            return DENIED
        if self.mode != "GUIDED" or not self.flight.armed or self.flight.in_air or not command.z > 0.0:
            return FAILED
        self.flight.take_off(command.z)
        return ACCEPTED

    def _reposition(self, command: Command) -> int:
        """Ignores yaw; with the change-mode flag it forces GUIDED, also out of the pilot's hands."""
        change_mode = not math.isnan(command.p2) and int(command.p2) & 1
        if self.mode != "GUIDED" and not change_mode:
            return DENIED
        if command.lat is None or command.lon is None:
            return DENIED
        if self._spoiled_goto():
            return ACCEPTED
        up = self.navigation.up if math.isnan(command.z) else command.z - self.home.amsl_m
        place = self.home.to_local(command.lat, command.lon)
        if self.parameters["FENCE_ENABLE"] and not self._within_fence(*place, up):
            return FAILED
        if self.mode != "GUIDED":
            if self._select(self.modes["GUIDED"]) != ACCEPTED:
                return FAILED
            self.flight.demand.speed = self.parameters["WPNAV_SPEED"] / 100.0
        if not self.flight.in_air:
            return ACCEPTED
        nav = self.navigation
        north, east = self.home.to_local(command.lat, command.lon)
        up = command.z if math.isnan(command.z) else command.z - self.home.amsl_m
        self.flight.fly_to(north, east, nav.up if math.isnan(up) else up, self.flight.demand.speed)
        self.flight.demand.heading = self.copter.heading
        if self.parameters["WP_YAW_BEHAVIOR"] and math.hypot(north - nav.north, east - nav.east) > 2.0:
            bearing = math.degrees(math.atan2(east - nav.east, north - nav.north))
            self.flight.turn_to(bearing, self.parameters["ATC_SLEW_YAW"] / 100.0)
        return ACCEPTED

    def _condition_yaw(self, command: Command) -> int:
        """Acknowledged in every mode, obeyed in GUIDED only."""
        if not 0.0 <= command.p1 <= 360.0:
            return FAILED
        if self.mode != "GUIDED" or self._spoiled_yaw():
            return ACCEPTED
        slew = self.parameters["ATC_SLEW_YAW"] / 100.0
        rate = min(command.p2, slew) if command.p2 > 0.0 else slew
        direction = 0 if math.isnan(command.p3) else int(command.p3)
        if command.p4 == 1.0:
            self.flight.turn_by(command.p1 if direction >= 0 else -command.p1, rate)
        else:
            self.flight.turn_to(command.p1, rate, direction)
        return ACCEPTED

    def _change_speed(self, command: Command) -> int:
        if not command.p2 > 0.0:
            return DENIED
        if self.mode != "GUIDED":
            return FAILED
        self.flight.demand.speed = command.p2
        return ACCEPTED

    def disarm_delay(self) -> float:
        return self.parameters["DISARM_DELAY"]

    # -- pilot and failsafes ---------------------------------------------------------------------------------------

    def move_sticks(self, velocity: tuple[float, float, float], yaw_rate: float) -> bool:
        """Sticks alone take nothing over in ArduCopter's autonomous modes: the pilot uses the mode switch."""
        if self.mode in self.auto:
            return False
        self.flight.sticks(velocity, yaw_rate)
        return True

    def watches_station(self, system_id: int) -> bool:
        return system_id == self.parameters["MAV_GCS_SYSID"]

    def gcs_timeout(self) -> float:
        return self.parameters["FS_GCS_TIMEOUT"]

    def gcs_lost(self) -> None:
        action = {1: "RTL", 2: "RTL", 3: "SMART_RTL", 4: "SMART_RTL", 5: "LAND", 7: "BRAKE"}.get(
            int(self.parameters["FS_GCS_ENABLE"])
        )
        if action and self.mode in self.auto and self.mode not in ("RTL", "LAND"):
            self.fail_safe("silence", action)

    def battery_threshold(self) -> float:
        return 10.0

    def battery_low(self) -> None:
        action = {1: "LAND", 2: "RTL", 3: "SMART_RTL"}.get(int(self.parameters["BATT_FS_LOW_ACT"]))
        watched = self.parameters["BATT_LOW_VOLT"] > 0.0 or self.parameters["BATT_LOW_MAH"] > 0.0
        if watched and self.flight.in_air and self.mode in self.auto:
            self.fail_safe("battery", action)

    def transmitter_timeout(self) -> float:
        return 1.0

    def transmitter_lost(self) -> None:
        action = {1: "RTL", 2: "RTL", 3: "LAND", 4: "SMART_RTL", 5: "SMART_RTL"}.get(
            int(self.parameters["FS_THR_ENABLE"])
        )
        if self.parameters["FS_THR_ENABLE"]:
            self.fail_safe("transmitter", action)

    def fail_safe(self, cause: Cause, mode: str | None) -> None:
        """The mode first, then its text: both in one turn of its loop. The state stays critical but for the fence."""
        self.critical = self.critical or cause != "fence"
        if mode is not None:
            self.set_mode(mode)
        if cause == "battery":
            self.say("Battery 1 is low 10.40V used 2400 mAh", mavlink.MAV_SEVERITY_WARNING)
        severity, text = _SAID[cause]
        self.say(text, severity)
