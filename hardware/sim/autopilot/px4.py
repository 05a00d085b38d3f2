"""The PX4 flavour: main and sub modes, reposition with yaw, return by climbing first, sticks that take over."""

from __future__ import annotations

import math
import struct
from typing import ClassVar

from pymavlink.dialects.v20 import development as mavlink

from hardware.sim.autopilot.failsafes import Cause, Event
from hardware.sim.autopilot.firmware import (
    ACCEPTED,
    DENIED,
    TEMPORARILY_REJECTED,
    UNSUPPORTED,
    Command,
    Conditions,
    Firmware,
    deg_or_none,
)
from hardware.sim.autopilot.parameters import INT32, REAL32, Parameters

STOP_REACH = 0.25
"""Its stop point is nearer than it can brake: from 7 m/s it flies some 5 m past it and back."""
CREEPS_M = 2.2
"""So near to that stop point it is all but at rest, and needs some ten seconds for the rest of the way."""
FACES_ITS_STOP_M_S = 2.5
"""Until it has braked to this it turns its nose to its stop point, unless it was given a yaw."""
CARRIED_S, CARRIED_M_S = 1.2, 2.0
"""Told to stop while it begins to fly back to a stop point it goes on for so long, and comes back: it smooths its way.
Then it is farther from its place than PX4's NAV_ACC_RAD and turns its nose there, unless it was given a yaw."""
REPOSITION_KEPT = 0.5
"""Seconds for which a reposition that came in another mode is carried out when HOLD is entered (PX4's loiter.cpp)."""


def px4_mode(main: int, sub: int = 0) -> int:
    """custom_mode of HEARTBEAT: main mode in bits 16 to 23, sub mode in 24 to 31 (px4_custom_mode.h)."""
    return main << 16 | sub << 24


_ACTS, _ACTS_GENERIC, _DISENGAGED = 0x94CA8A, 0xDEDBD0, 0xC2DC72
_ANNOUNCED, _ANNOUNCED_GENERIC = 0xD11DF6, 0x44B3E0
"""PX4's events about a failsafe (commander_failsafe_enter...)."""
_ACTIONS = {"HOLD": 5, "RETURN": 6, "LAND": 7}
_CAUSES: dict[Cause, int] = {"transmitter": 1, "silence": 2, "battery": 4}
DEFAULTS: dict[str, tuple[float, int]] = {
    "NAV_DLL_ACT": (2, INT32),
    "NAV_RCL_ACT": (2, INT32),
    "RC_MAP_FLTMODE": (0, INT32),
    "COM_DL_LOSS_T": (10, INT32),
    "COM_RC_LOSS_T": (0.5, REAL32),
    "COM_FAIL_ACT_T": (5.0, REAL32),
    "COM_OBL_RC_ACT": (0, INT32),
    "COM_RC_OVERRIDE": (1, INT32),
    "COM_DISARM_PRFLT": (10.0, REAL32),
    "COM_LOW_BAT_ACT": (3, INT32),
    "BAT_LOW_THR": (0.15, REAL32),
    "BAT_CRIT_THR": (0.07, REAL32),
    "GF_ACTION": (2, INT32),
    "GF_MAX_HOR_DIST": (0.0, REAL32),
    "GF_MAX_VER_DIST": (0.0, REAL32),
    "MIS_TAKEOFF_ALT": (2.5, REAL32),
    "MPC_XY_CRUISE": (5.0, REAL32),
    "MPC_XY_VEL_MAX": (12.0, REAL32),
    "MPC_YAWRAUTO_MAX": (60.0, REAL32),
    "RTL_RETURN_ALT": (30.0, REAL32),
    "RTL_DESCEND_ALT": (30.0, REAL32),
    "RTL_LAND_DELAY": (0.0, REAL32),
    "SYS_AUTOSTART": (10040, INT32),
    "CAL_GYRO0_ID": (1310988, INT32),
    "CAL_ACC0_ID": (1310988, INT32),
    "CAL_MAG0_ID": (197388, INT32),
}


class Px4(Firmware):
    """Mode numbers and parameter defaults are PX4's own."""

    name: ClassVar[str] = "px4"
    mav_autopilot: ClassVar[int] = mavlink.MAV_AUTOPILOT_PX4
    modes: ClassVar[dict[str, int]] = {
        "HOLD": px4_mode(4, 3),
        "MANUAL": px4_mode(1),
        "ALTCTL": px4_mode(2),
        "POSCTL": px4_mode(3),
        "TAKEOFF": px4_mode(4, 2),
        "MISSION": px4_mode(4, 4),
        "RETURN": px4_mode(4, 5),
        "LAND": px4_mode(4, 6),
        "ACRO": px4_mode(5),
        "OFFBOARD": px4_mode(6),
        "STABILIZED": px4_mode(7),
    }
    auto: ClassVar[frozenset[str]] = frozenset({"HOLD", "TAKEOFF", "MISSION", "RETURN", "LAND"})
    pilot_mode: ClassVar[str] = "POSCTL"
    give_back_mode: ClassVar[str] = "HOLD"
    heartbeat_on_mode_change: ClassVar[bool] = False
    prearm_has_present_bit: ClassVar[bool] = False
    any_inclusion: ClassVar[bool] = False
    ready_after: ClassVar[float] = 6.0
    streams_by_default: ClassVar[dict[int, float]] = {
        mavlink.MAVLINK_MSG_ID_SYS_STATUS: 1.0,
        mavlink.MAVLINK_MSG_ID_GPS_RAW_INT: 1.0,
        mavlink.MAVLINK_MSG_ID_ATTITUDE: 10.0,
        mavlink.MAVLINK_MSG_ID_GLOBAL_POSITION_INT: 5.0,
        mavlink.MAVLINK_MSG_ID_VFR_HUD: 2.0,
        mavlink.MAVLINK_MSG_ID_BATTERY_STATUS: 0.5,
        mavlink.MAVLINK_MSG_ID_HOME_POSITION: 0.5,
        mavlink.MAVLINK_MSG_ID_EXTENDED_SYS_STATE: 1.0,
        mavlink.MAVLINK_MSG_ID_SYSTEM_TIME: 1.0,
    }

    def __init__(self, conditions: Conditions) -> None:
        super().__init__(conditions, Parameters(DEFAULTS, bytewise=True))
        self._take_off_up = 0.0
        self._kept: tuple[float, Command] | None = None
        self._faces_its_stop = False
        self._carried: tuple[float, float, float] | None = None
        """Until when it is carried on, and where it was told to stop."""
        self._given_yaw = False
        self._after_landing = "HOLD"
        self._breached = False
        self._acts_at: tuple[float, str, Cause] | None = None
        """When a failsafe that was announced selects its mode, which, and why."""
        self._events = 0

    # -- modes -----------------------------------------------------------------------------------------------------

    def set_mode(self, mode: str) -> None:
        if mode in ("RETURN", "LAND") and self.mode not in ("RETURN", "LAND"):
            self._after_landing = "TAKEOFF" if self.mode == "TAKEOFF" else "HOLD"
        self._user_takes()
        super().set_mode(mode)

    def _user_takes(self) -> None:
        """Whoever selects a mode, even the present one, ends a failsafe that acts or is about to."""
        self.critical, self._acts_at = False, None

    def arm(self) -> int:
        """In TAKEOFF it then takes off unasked: only the mode is looked at."""
        if not self.flight.armed:
            self._take_off_up = self.parameters["MIS_TAKEOFF_ALT"]
        return super().arm()

    def enter(self, mode: str) -> None:
        flight = self.flight
        self._faces_its_stop, self._carried = False, None
        if mode == "RETURN":
            p = self.parameters
            flight.return_home(p["RTL_RETURN_ALT"], p["MPC_XY_CRUISE"], p["RTL_DESCEND_ALT"], p["RTL_LAND_DELAY"])
        elif mode == "LAND":
            flight.land()
        elif mode == "TAKEOFF":
            if flight.armed:
                flight.take_off(self._take_off_up)
        elif flight.in_air:
            self._pause() if mode == "HOLD" else flight.stop(STOP_REACH, CREEPS_M)
            if mode == "HOLD" and self._kept is not None and self.time - self._kept[0] < REPOSITION_KEPT:
                self._fly(self._kept[1])

    def watch(self) -> None:
        flight = self.flight
        if self._acts_at is not None and self.time >= self._acts_at[0]:
            self._act(*self._acts_at[1:])
        if self._faces_its_stop and self._speed() < FACES_ITS_STOP_M_S:
            self._faces_its_stop = False
            flight.turn_by(0.0, self.parameters["MPC_YAWRAUTO_MAX"])
        if self._carried is not None and self.time > self._carried[0]:
            self._come_back(*self._carried[1:])
        if self.mode == "TAKEOFF":
            if flight.task == "idle":
                flight.take_off(self._take_off_up)
            elif self.navigation.up > self._take_off_up - 0.5:
                self.set_mode("HOLD")
        if self.mode in self.auto and self.mode not in ("RETURN", "LAND"):
            self._watch_fence()

    def landed(self) -> None:
        """Told to land in its climb, it goes back to TAKEOFF."""
        self.mode, self.critical = self._after_landing, False

    def _within_fence(self, north: float, east: float, up: float) -> bool:
        far, high = self.parameters["GF_MAX_HOR_DIST"], self.parameters["GF_MAX_VER_DIST"]
        too_far = 0.0 < far < math.hypot(north, east) or 0.0 < high < up
        return not too_far and self.fence.allows(north, east)

    def _watch_fence(self) -> None:
        nav = self.navigation
        outside = not self._within_fence(nav.north, nav.east, nav.up)
        action = {2: "HOLD", 3: "RETURN", 5: "LAND"}.get(int(self.parameters["GF_ACTION"]))
        breached, self._breached = outside and not self._breached, outside
        if breached and action and self.mode != action:
            self.say("Geofence violation: approaching or outside geofence", mavlink.MAV_SEVERITY_CRITICAL)
            self.fail_safe("fence", action)

    # -- commands --------------------------------------------------------------------------------------------------

    def carry_out(self, command: Command) -> int:
        match command.number:
            case mavlink.MAV_CMD_COMPONENT_ARM_DISARM:
                return self.arm() if command.p1 >= 0.5 else self.disarm()
            case mavlink.MAV_CMD_DO_SET_MODE:
                return self._select(px4_mode(int(command.p2), 0 if math.isnan(command.p3) else int(command.p3)))
            case mavlink.MAV_CMD_NAV_TAKEOFF:
                up = command.z - self.home.amsl_m if not math.isnan(command.z) else self.parameters["MIS_TAKEOFF_ALT"]
                self._take_off_up = max(up, self.parameters["MIS_TAKEOFF_ALT"])
                return self._select(self.modes["TAKEOFF"])
            case mavlink.MAV_CMD_DO_REPOSITION:
                return self._reposition(command)
            case mavlink.MAV_CMD_NAV_RETURN_TO_LAUNCH:
                return self._select(self.modes["RETURN"])
            case mavlink.MAV_CMD_NAV_LAND:
                return self._select(self.modes["LAND"])
            case mavlink.MAV_CMD_DO_CHANGE_SPEED:
                if not command.p2 > 0.0:
                    return DENIED
                self.flight.demand.speed = min(command.p2, self.parameters["MPC_XY_VEL_MAX"])
                return ACCEPTED
            case _:
                return UNSUPPORTED

    def _select(self, custom_mode: int) -> int:
        mode = next((name for name, number in self.modes.items() if number == custom_mode), None)
        if mode is None:
            return DENIED
        if mode in self.auto and self.time < self.ready_after:
            return TEMPORARILY_REJECTED
        if mode != self.mode or not self.flight.in_air:
            self.set_mode(mode)  # HOLD while in HOLD changes nothing: it flies on to where it was sent
        self._user_takes()
        return ACCEPTED

    def _reposition(self, command: Command) -> int:
        """Speed, change-mode flag, yaw (radians), place, altitude AMSL.

        Without the flag the answer is "unsupported" in every mode, and in HOLD it is obeyed all the same: the mode and
        the place are two programs' business (commander and navigator).
        """
        if not self.flight.in_air:
            return TEMPORARILY_REJECTED
        change_mode = not math.isnan(command.p2) and int(command.p2) & 1
        answer = ACCEPTED if change_mode else UNSUPPORTED
        if self._spoiled_goto():
            return answer
        if change_mode and self.mode != "HOLD":
            self.set_mode("HOLD")
        if self.mode == "HOLD":
            self._fly(command)
        else:
            self._kept = self.time, command
        return answer

    def _fly(self, command: Command) -> None:
        nav = self.navigation
        if self._refused_place(command):
            return
        if command.lat is None and math.isnan(command.z) and math.isnan(command.p4):
            self._pause()  # "all three set to NaN - pause vehicle"
            return
        self._faces_its_stop = False
        demand, flies = self.flight.demand, self.flight.task == "fly"
        place = (demand.north, demand.east) if flies else (nav.north, nav.east)
        if command.lat is None and flies and math.isnan(command.z):  # a yaw alone
            if not self._spoiled_yaw():
                self.flight.turn_to(math.degrees(command.p4), self.parameters["MPC_YAWRAUTO_MAX"])
                self._given_yaw = True
            return
        self._carried = None
        if command.lat is not None and command.lon is not None:
            place = self.home.to_local(command.lat, command.lon)
        up = command.z - self.home.amsl_m if not math.isnan(command.z) else nav.up
        speed = command.p1 if command.p1 > 0.0 else self.parameters["MPC_XY_CRUISE"]
        self.flight.fly_to(*place, up, min(speed, self.parameters["MPC_XY_VEL_MAX"]))
        yaw = deg_or_none(math.degrees(command.p4))
        limit = self.parameters["MPC_YAWRAUTO_MAX"]
        if yaw is not None and not self._spoiled_yaw():
            self.flight.turn_to(yaw, limit)
        elif yaw is None and math.hypot(place[0] - nav.north, place[1] - nav.east) > 2.0:
            # with no yaw asked for the nose turns to where it flies
            self.flight.turn_to(math.degrees(math.atan2(place[1] - nav.east, place[0] - nav.north)), limit)

    def _pause(self) -> None:
        flight, nav = self.flight, self.navigation
        was, flew = flight.demand, flight.task == "fly"
        flight.stop(STOP_REACH, CREEPS_M)
        self._given_yaw, self._carried = False, None
        slow = self._speed() < FACES_ITS_STOP_M_S
        if flew and slow and math.hypot(was.north - nav.north, was.east - nav.east) > CREEPS_M:
            self._carried = self.time + CARRIED_S, flight.demand.north, flight.demand.east
            flight.fly_to(was.north, was.east, flight.demand.up, CARRIED_M_S)
        self._faces_its_stop = not slow
        if self._faces_its_stop:
            copter = flight.copter
            course = math.degrees(math.atan2(copter.v_east, copter.v_north))
            flight.turn_to(course, self.parameters["MPC_YAWRAUTO_MAX"])

    def _come_back(self, north: float, east: float) -> None:
        flight, nav = self.flight, self.navigation
        self._carried = None
        flight.fly_to(north, east, flight.demand.up, CARRIED_M_S)
        if not self._given_yaw:
            back = math.degrees(math.atan2(east - nav.east, north - nav.north))
            flight.turn_to(back, self.parameters["MPC_YAWRAUTO_MAX"])

    def _speed(self) -> float:
        """Over ground, m/s."""
        return math.hypot(self.flight.copter.v_north, self.flight.copter.v_east)

    def _refused_place(self, command: Command) -> bool:
        """The commander has accepted it before the navigator looks at the fence, and says no by a text alone."""
        if command.lat is None or command.lon is None or self.parameters["GF_ACTION"] < 2.0:
            return False
        up = self.navigation.up if math.isnan(command.z) else command.z - self.home.amsl_m
        if self._within_fence(*self.home.to_local(command.lat, command.lon), up):
            return False
        self.say("Reposition is outside geofence\t", mavlink.MAV_SEVERITY_CRITICAL)
        return True

    def disarm_delay(self) -> float:
        return self.parameters["COM_DISARM_PRFLT"]

    # -- pilot and failsafes ---------------------------------------------------------------------------------------

    def move_sticks(self, velocity: tuple[float, float, float], yaw_rate: float) -> bool:
        """COM_RC_OVERRIDE bit 0 covers the auto modes, bit 1 offboard."""
        override = int(self.parameters["COM_RC_OVERRIDE"])
        covered = override & 1 if self.mode in self.auto else override & 2 if self.mode == "OFFBOARD" else True
        if not covered:
            return False
        if self.mode in self.auto or self.mode == "OFFBOARD":
            self.set_mode("POSCTL")
            self.say("Pilot took over using sticks")
        self.flight.sticks(velocity, yaw_rate)
        return True

    def gcs_timeout(self) -> float:
        return self.parameters["COM_DL_LOSS_T"]

    def gcs_lost(self) -> None:
        action = {1: "HOLD", 2: "RETURN", 3: "LAND"}.get(int(self.parameters["NAV_DLL_ACT"]))
        if action and self.mode in self.auto and self.mode not in ("RETURN", "LAND"):
            self._act(action, "silence")

    def battery_threshold(self) -> float:
        return 100.0 * self.parameters["BAT_CRIT_THR"]

    def battery_low(self) -> None:
        action = {2: "LAND", 3: "RETURN"}.get(int(self.parameters["COM_LOW_BAT_ACT"]))
        self.say("Critical battery\t", mavlink.MAV_SEVERITY_EMERGENCY)
        if self.flight.in_air and self.mode in self.auto:
            self.fail_safe("battery", action)

    def transmitter_timeout(self) -> float:
        return self.parameters["COM_RC_LOSS_T"]

    def transmitter_lost(self) -> None:
        action = {1: "HOLD", 2: "RETURN", 3: "LAND"}.get(int(self.parameters["NAV_RCL_ACT"]))
        if action:
            self.fail_safe("transmitter", action)

    def fail_safe(self, cause: Cause, mode: str | None) -> None:
        """It hovers before most of them act. A warning says the same words without an event."""
        delay = self.parameters["COM_FAIL_ACT_T"]
        if mode is None:
            self.say("Failsafe activated\t", mavlink.MAV_SEVERITY_CRITICAL)
        elif cause == "position" or mode == "HOLD" or delay <= 0.0:
            self._act(mode, cause)
        else:
            if self.mode != "HOLD":
                self.set_mode("HOLD")
            self.critical, self._acts_at = True, (self.time + delay, mode, cause)
            self._tell(_ANNOUNCED, _ANNOUNCED_GENERIC, mode, cause, struct.pack("<H", int(delay)))
            self.say(f"Failsafe activated: entering Hold for {delay:.0f} seconds\t", mavlink.MAV_SEVERITY_CRITICAL)

    def _act(self, mode: str, cause: Cause) -> None:
        self.say("Failsafe activated\t", mavlink.MAV_SEVERITY_CRITICAL)
        self.set_mode(mode)
        self.critical = True
        self._tell(_ACTS, _DISENGAGED if cause == "position" else _ACTS_GENERIC, mode, cause)

    def _tell(self, number: int, generic: int, mode: str, cause: Cause, delay: bytes = b"") -> None:
        """As an event: the mode that was wanted, the action, the delay, the cause where it has a number."""
        action = 8 if cause == "position" else _ACTIONS[mode]
        arguments = struct.pack("<IB", self.modes["HOLD"], action) + delay
        if cause in _CAUSES:
            arguments += bytes((_CAUSES[cause],))
        number = (1 << 24) | (number if cause in _CAUSES else generic)
        self._events += 1
        self.outbox.append(Event(number, int(self.time * 1000.0), self._events % 65_536, arguments))
