"""The latest of everything the vehicle said, and a few minutes of headings: a fold of MAVLink messages. Pure."""

from __future__ import annotations

import math
from bisect import bisect_left
from collections import deque
from dataclasses import dataclass, field
from typing import Any, Literal

from hardware.authority import Authority
from hardware.autopilot.boot_clock import BootClock
from hardware.autopilot.ground import north_east_m
from hardware.autopilot.position_trust import PositionTrust
from hardware.readings import HeadingSample, Place, Telemetry
from hardware.reasons.preflight import GpsFixName

Fields = dict[str, Any]

HISTORY_S = 300.0
JUMP_M, JUMP_M_S = 5.0, 10.0
ARMING_S = 1.5
"""A heartbeat heard this long after the autopilot agreed to arm shows whether it did."""
_ARMED = 128  # MAV_MODE_FLAG_SAFETY_ARMED
_PREARM = 0x10000000  # MAV_SYS_STATUS_PREARM_CHECK
_FIXES: tuple[GpsFixName, ...] = ("no GPS", "no fix", "2D", "3D", "DGPS", "RTK float", "RTK fixed", "static", "PPP")
_ON_GROUND, _UNDEFINED = 1, 0  # MAV_LANDED_STATE
_UNKNOWN_COUNT = 255
"""GPS_RAW_INT: the count that stands for "not known"."""
_GRAVITY, _STEEPEST = 9.81, 1.2

NAMES = (
    "HEARTBEAT",
    "CURRENT_MODE",
    "ATTITUDE",
    "GLOBAL_POSITION_INT",
    "GPS_RAW_INT",
    "SYS_STATUS",
    "BATTERY_STATUS",
    "HOME_POSITION",
    "EXTENDED_SYS_STATE",
    "ESTIMATOR_STATUS",
    "EKF_STATUS_REPORT",
)
"""The messages the fold understands."""


@dataclass(slots=True)
class Snapshot:
    """Mutable on purpose: one instance a link, fed on the event loop."""

    heard_at_s: float | None = None
    custom_mode: int | None = None
    mode_at_s: float | None = None
    armed: bool | None = None
    """As the last heartbeat said."""
    heartbeat_at_s: float | None = None
    arming_at_s: float = -math.inf
    """When the autopilot last agreed to arm, or left an order to unanswered; infinite while the answer is awaited."""
    tells_current_mode: bool = False
    """It has sent CURRENT_MODE, which PX4 knows since 1.15."""
    landed_state: int = _UNDEFINED
    prearm_present: bool | None = None
    prearm_healthy: bool | None = None
    """The autopilot's own checks before arming, as SYS_STATUS has them; a Dialect says what they mean together."""
    position: Place | None = None
    position_at_s: float | None = None
    jumped_m: float | None = None
    """How far the last position was from where the vehicle could have flown; None when it was plausible."""
    altitude_amsl_m: float | None = None
    altitude_relative_m: float | None = None
    velocity_ned: tuple[float, float, float] | None = None
    fastest_m_s: float = 0.0
    """Since a hold was ordered, which begins with the speed of then."""
    heading_deg: float | None = None
    heading_at_s: float | None = None
    attitude_heard_at_s: float | None = None
    push_ne_m_s2: tuple[float, float] | None = None
    """(north, east) what of the thrust is horizontal, per mass, of a vehicle that holds its height."""
    battery_percent: float | None = None
    battery_at_s: float | None = None
    fix_type: int | None = None
    satellites: int | None = None
    home: Place | None = None
    home_amsl_m: float | None = None
    trust: PositionTrust = field(default_factory=PositionTrust)
    clock_stays_odd: bool = False
    """The rate of the autopilot's clock, as the monitor found it once a second (LastingOddity)."""
    _displaced_m: tuple[float, float] = (0.0, 0.0)
    """(north, east) the sum of all jumps of this flight: a jump back undoes one."""
    _position_boot_s: float = 0.0
    _boot_clock: BootClock = field(default_factory=BootClock)
    _headings: deque[HeadingSample] = field(default_factory=deque[HeadingSample])

    @property
    def reboots(self) -> int:
        """How often the autopilot's time since boot started again while we listened."""
        return self._boot_clock.reboots

    @property
    def clock_rate(self) -> float | None:
        """Seconds of the autopilot's clock in one of ours; None until it is known."""
        return self._boot_clock.measured_rate

    @property
    def clock_rate_is_odd(self) -> bool:
        """So far from ours that times are not what they seem."""
        return self._boot_clock.rate_is_odd

    def exchanged(self, sent_at_s: float, boot_s: float, heard_at_s: float) -> None:
        """A TIMESYNC, see BootClock."""
        self._boot_clock.exchanged(sent_at_s, boot_s, heard_at_s)

    def went_round(self, sent_at_s: float, heard_at_s: float) -> None:
        """A PING, see BootClock."""
        self._boot_clock.went_round(sent_at_s, heard_at_s)

    @property
    def disarmed(self) -> bool:
        """Certainly: a heartbeat of once a second does not yet know that the autopilot has just been armed."""
        return self.armed is False and (self.heartbeat_at_s or -math.inf) >= self.arming_at_s + ARMING_S

    @property
    def in_air(self) -> bool | None:
        """The autopilot's landed state; without one, armed and more than 1 m up. None: not yet known."""
        if self.landed_state != _UNDEFINED:
            return self.landed_state != _ON_GROUND
        if self.armed is None or self.altitude_relative_m is None:
            return None
        return self.armed and self.altitude_relative_m > 1.0

    @property
    def speed_m_s(self) -> float | None:
        """In three dimensions, climb included. None: not yet heard."""
        return None if self.velocity_ned is None else math.hypot(*self.velocity_ned)

    def fold(self, name: str, fields: Fields, heard_at_s: float) -> None:
        """Take one message in. A field that is not a number (null on the wire) is left as it was."""
        self.heard_at_s = heard_at_s
        self.trust.fold(name, fields, heard_at_s)
        match name:
            case "HEARTBEAT":
                self.custom_mode, self.mode_at_s = int(fields["custom_mode"]), heard_at_s
                self.armed, self.heartbeat_at_s = bool(int(fields["base_mode"]) & _ARMED), heard_at_s
            case "CURRENT_MODE":
                self.custom_mode, self.mode_at_s = int(fields["custom_mode"]), heard_at_s
                self.tells_current_mode = True
            case "ATTITUDE":
                self._attitude(fields, heard_at_s)
            case "GLOBAL_POSITION_INT":
                self._global_position(fields, heard_at_s)
            case "GPS_RAW_INT":
                seen = int(fields["satellites_visible"])
                self.fix_type, self.satellites = int(fields["fix_type"]), None if seen == _UNKNOWN_COUNT else seen
            case "SYS_STATUS":
                self._battery(fields, heard_at_s)
                self.prearm_present = bool(int(fields["onboard_control_sensors_present"]) & _PREARM)
                self.prearm_healthy = bool(int(fields["onboard_control_sensors_health"]) & _PREARM)
            case "BATTERY_STATUS":
                if int(fields.get("id", 0)) == 0:
                    self._battery(fields, heard_at_s)
            case "HOME_POSITION":
                self.home = Place(fields["latitude"] / 1e7, fields["longitude"] / 1e7)
                self.home_amsl_m = fields["altitude"] / 1e3
            case "EXTENDED_SYS_STATE":
                self.landed_state = int(fields["landed_state"])
            case _:
                pass

    def forget_landed(self) -> None:
        """After a silence it may stand or fly: until the autopilot says so again, arming and height tell."""
        self.landed_state = _UNDEFINED

    def _attitude(self, fields: Fields, heard_at_s: float) -> None:
        yaw = fields["yaw"]
        if yaw is None or not math.isfinite(yaw):
            return
        at = self._boot_clock.to_utc(fields["time_boot_ms"] / 1e3, heard_at_s)
        self.heading_deg, self.heading_at_s = math.degrees(yaw) % 360.0 % 360.0, at
        self.attitude_heard_at_s = heard_at_s
        self.push_ne_m_s2 = _push(fields.get("roll"), fields.get("pitch"), yaw)
        history = self._headings
        if not history or at > history[-1].at_s:
            place = self.position if self.trust.lost_since_s is None else None
            history.append(HeadingSample(at, self.heading_deg, place, math.hypot(*self._displaced_m)))
        while at - history[0].at_s > HISTORY_S:
            history.popleft()

    def _global_position(self, fields: Fields, heard_at_s: float) -> None:
        lat, lon = fields["lat"] / 1e7, fields["lon"] / 1e7
        if lat == 0.0 and lon == 0.0:
            return  # the autopilot has no position yet
        place, boot_s = Place(lat, lon), fields["time_boot_ms"] / 1e3
        self._jump(place, boot_s)
        self.position, self._position_boot_s = place, boot_s
        self.position_at_s = self._boot_clock.to_utc(boot_s, heard_at_s)
        self.altitude_amsl_m, self.altitude_relative_m = fields["alt"] / 1e3, fields["relative_alt"] / 1e3
        self.velocity_ned = (fields["vx"] / 100.0, fields["vy"] / 100.0, fields["vz"] / 100.0)
        self.fastest_m_s = max(self.fastest_m_s, math.hypot(*self.velocity_ned))

    def _jump(self, place: Place, boot_s: float) -> None:
        """A position so far from the last one that no vehicle could have flown there is a jump.

        By the autopilot's own clock: what a link holds back and then brings all at once is none.
        """
        self.jumped_m = None
        if not self.in_air:
            self._displaced_m = (0.0, 0.0)
        if self.position is None or boot_s < self._position_boot_s:
            return
        north, east = north_east_m(self.position, place)
        elapsed_s = boot_s - self._position_boot_s
        if math.hypot(north, east) <= JUMP_M + (JUMP_M_S + (self.speed_m_s or 0.0)) * elapsed_s:
            return
        self.jumped_m = math.hypot(north, east)
        if self.in_air:
            north_m_s, east_m_s, _ = self.velocity_ned or (0.0, 0.0, 0.0)
            before = self._displaced_m
            self._displaced_m = (before[0] + north - north_m_s * elapsed_s, before[1] + east - east_m_s * elapsed_s)

    def _battery(self, fields: Fields, heard_at_s: float) -> None:
        percent = fields["battery_remaining"]
        if percent is not None and 0 <= percent <= 100:
            self.battery_percent, self.battery_at_s = float(percent), heard_at_s

    def headings(self, since_s: float) -> list[HeadingSample]:
        """At or after `since_s`, in time order."""
        history = list(self._headings)
        return history[bisect_left(history, since_s, key=lambda sample: sample.at_s) :]

    def telemetry(
        self,
        now_s: float,
        connected: bool,
        mode: str | None,
        authority: Authority,
        autopilot: Literal["px4", "ardupilot", "unknown"],
    ) -> Telemetry:
        """now_s: UTC epoch seconds of the reading. Whoever holds the snapshot knows link, mode and authority."""
        north, east, down = self.velocity_ned or (None, None, None)
        push_north, push_east = self.push_ne_m_s2 or (None, None)
        return Telemetry(
            connected=connected,
            at_s=now_s,
            position=self.position,
            position_at_s=self.position_at_s,
            altitude_amsl_m=self.altitude_amsl_m,
            altitude_relative_m=self.altitude_relative_m,
            heading_deg=self.heading_deg,
            heading_at_s=self.heading_at_s,
            velocity_north_m_s=north,
            velocity_east_m_s=east,
            velocity_down_m_s=down,
            push_north_m_s2=push_north,
            push_east_m_s2=push_east,
            battery_percent=self.battery_percent,
            battery_at_s=self.battery_at_s,
            gps_fix=None if self.fix_type is None else _FIXES[min(self.fix_type, len(_FIXES) - 1)],
            satellites=self.satellites,
            position_lost_since_s=self.trust.lost_since_s,
            odd_clock_rate=self.clock_rate if self.clock_stays_odd else None,
            armed=None if self.armed is False and not self.disarmed else self.armed,
            in_air=self.in_air,
            mode=mode,
            mode_at_s=self.mode_at_s,
            home=self.home,
            home_amsl_m=self.home_amsl_m,
            authority=authority,
            autopilot=autopilot,
        )


def _push(roll: float | None, pitch: float | None, yaw: float) -> tuple[float, float] | None:
    """From the attitude in radians; None for one that no multicopter holds its height with."""
    if roll is None or pitch is None or not (abs(roll) < _STEEPEST and abs(pitch) < _STEEPEST):
        return None
    forward, right = -_GRAVITY * math.tan(pitch), _GRAVITY * math.tan(roll) / math.cos(pitch)
    return (
        forward * math.cos(yaw) - right * math.sin(yaw),
        forward * math.sin(yaw) + right * math.cos(yaw),
    )
