"""What PX4 and ArduCopter have in common: arming, tasks, failsafes, the faults a test may order. Pure, stepped in time.

A flavour gives modes their numbers and says how commands, sticks and failsafes behave (see px4.py, ardupilot.py; the
behaviour was measured on PX4 1.16 SIH and ArduCopter 4.7 SITL).
"""

from __future__ import annotations

import math
from abc import abstractmethod
from collections import deque
from collections.abc import Collection
from dataclasses import dataclass, field
from random import Random
from typing import ClassVar

from pymavlink.dialects.v20 import development as mavlink

from hardware.sim.autopilot.copter import Airframe, Copter, Wind
from hardware.sim.autopilot.failsafes import Failsafes
from hardware.sim.autopilot.fence import Fence
from hardware.sim.autopilot.flight import Flight
from hardware.sim.autopilot.geodesy import HomeFrame
from hardware.sim.autopilot.parameters import Parameters
from hardware.sim.autopilot.sensors import Navigation

ACCEPTED, TEMPORARILY_REJECTED, DENIED, UNSUPPORTED, FAILED = 0, 1, 2, 3, 4
"""MAV_RESULT."""
_CHUNK = 50


@dataclass(frozen=True, slots=True)
class Conditions:
    """Where and in what the vehicle flies. gps_sigma m; heading_error, heading_sigma deg; battery %."""

    home: HomeFrame
    seed: int = 1
    wind: Wind = field(default_factory=Wind)
    airframe: Airframe = field(default_factory=Airframe)
    gps_sigma: float = 0.3
    heading_deg: float = 0.0
    heading_error: float = 0.0
    heading_sigma: float = 0.3
    battery_percent: float = 100.0


@dataclass(frozen=True, slots=True)
class Command:
    """COMMAND_INT or COMMAND_LONG. lat, lon: degrees (None: not given). p1..p4, z: NaN is "not given"."""

    number: int
    p1: float = math.nan
    p2: float = math.nan
    p3: float = math.nan
    p4: float = math.nan
    lat: float | None = None
    lon: float | None = None
    z: float = math.nan
    frame: int = mavlink.MAV_FRAME_GLOBAL
    is_int: bool = False


@dataclass(slots=True)
class Faults:
    """What a test ordered to go wrong; counters count down with each command they spoil."""

    refuse: int = 0
    ignore_yaw: int = 0
    ignore_goto: int = 0
    ignore_all: int = 0
    silent: int = 0
    unanswered: int = 0
    """Obeyed, but their acknowledgements get lost."""
    only: int = 0
    """What is refused or unanswered is this MAV_CMD; 0: any."""
    home_m: float = 0.0
    """Above where home is taken to be, until arming sets it to where the vehicle stands: a barometer drifts."""
    link_lost_until: float = -1.0
    uplink_lost_until: float = -1.0
    link_delay: float = 0.0
    """Seconds each way."""
    no_prearm: bool = False
    fence_mute: int = 0
    """Number of answers about the fence that get lost."""
    fence_deaf_after: int = -1
    """After this number of messages about the fence every other one gets lost; -1: none."""
    fence_altered: bool = False
    """It keeps another fence than it is sent."""


def deg_or_none(value: float) -> float | None:
    """MAVLink's NaN means "not given"."""
    return None if math.isnan(value) else value


SWITCH_AT_REST_US, SWITCH_MOVED_US = 1165, 1815


class Firmware(Failsafes):
    """Base of the flavours. `time` is seconds since boot, simulated."""

    name: ClassVar[str]
    mav_autopilot: ClassVar[int]
    modes: ClassVar[dict[str, int]]
    """Mode name -> custom_mode."""
    pilot_mode: ClassVar[str]
    """The mode that a pilot's mode switch selects to take over."""
    give_back_mode: ClassVar[str]
    heartbeat_on_mode_change: ClassVar[bool]
    """And as often as it is asked for. Else CURRENT_MODE is sent when the mode changed, no faster than asked for, and
    twice a second when it did not."""
    streams_by_default: ClassVar[dict[int, float]]
    """Message id -> Hz sent without being asked."""
    prearm_has_present_bit: ClassVar[bool]
    """Whether SYS_STATUS says that the checks before arming are reported; PX4 only ever sets their health bit."""
    any_inclusion: ClassVar[bool]
    """Of several zones to stay in, one is enough."""
    ready_after: ClassVar[float]
    """Seconds from boot until prearm checks pass."""

    def __init__(self, conditions: Conditions, parameters: Parameters) -> None:
        self.conditions = conditions
        self.home = conditions.home
        self.parameters = parameters
        self.rng = Random(conditions.seed)
        self.copter = Copter(conditions.airframe, conditions.wind, Random(conditions.seed + 1), conditions.heading_deg)
        self.copter.energy *= conditions.battery_percent / 100.0
        self.navigation = Navigation(
            self.copter,
            Random(conditions.seed + 2),
            conditions.gps_sigma,
            conditions.heading_error,
            conditions.heading_sigma,
        )
        self.flight = Flight(self.copter, self.navigation)
        self.faults = Faults()
        self.fence = Fence(self.home, self.any_inclusion)
        self.time = 0.0
        self.mode = next(iter(self.modes))
        self.mode_changed_at = 0.0
        self.outbox: deque[mavlink.MAVLink_message] = deque()
        self.commands: deque[tuple[float, int]] = deque(maxlen=10_000)
        """(time, MAV_CMD) of every command received, for tests that ask what passed."""
        self.gcs_heard_at: float | None = None
        self.heartbeat_due = False
        self.mode_switch_us = SWITCH_AT_REST_US
        """The pulse of the channel by which the pilot's transmitter selects modes."""
        self.rebooted = False
        """Set by `reboot`, cleared by whoever keeps what a reboot forgets (the streams)."""
        self._text_id = 0 if self.name == "px4" else 1  # PX4 counts from the one that means "whole"
        self._armed_at = 0.0

    # -- modes -----------------------------------------------------------------------------------------------------

    @property
    def custom_mode(self) -> int:
        """The mode's number in this flavour's own coding."""
        return self.modes[self.mode]

    def set_mode(self, mode: str) -> None:
        """Select a mode and begin what it does."""
        if mode != self.mode:
            self.mode = mode
            self.mode_changed_at = self.time
            self.heartbeat_due = self.heartbeat_on_mode_change
        self.enter(mode)

    @abstractmethod
    def enter(self, mode: str) -> None:
        """Begin the flight task of a mode."""

    def say(self, text: str, severity: int = mavlink.MAV_SEVERITY_INFO) -> None:
        """As STATUSTEXT, a long one in chunks."""
        self.say_bytes(text.encode(), severity)

    def say_bytes(self, words: bytes, severity: int, lost: Collection[int] = ()) -> None:
        """In one message, or in chunks of 50 bytes under an id of their own. lost: chunks that get lost."""
        if len(words) <= _CHUNK:
            self.outbox.append(mavlink.MAVLink_statustext_message(severity, words))
            return
        ends = len(words) // _CHUNK + 1  # one that is full is not the last
        for seq in range(ends):
            chunk = words[seq * _CHUNK : (seq + 1) * _CHUNK]
            if seq not in lost:
                self.outbox.append(mavlink.MAVLink_statustext_message(severity, chunk, self._text_id, seq))
        self._text_id = self._text_id % 65_535 + 1

    def report_remote_id(self, problem: str) -> None:
        """What a Remote ID transmitter would say now; no problem: the vehicle may arm."""
        good, bad = mavlink.MAV_ODID_ARM_STATUS_GOOD_TO_ARM, mavlink.MAV_ODID_ARM_STATUS_PRE_ARM_FAIL_GENERIC
        words = problem.encode()[:50]
        self.outbox.append(mavlink.MAVLink_open_drone_id_arm_status_message(bad if problem else good, words))

    # -- commands --------------------------------------------------------------------------------------------------

    def command(self, command: Command) -> int | None:
        """Carry out a command; MAV_RESULT, or None when (ordered so) no acknowledgement is sent."""
        self.commands.append((self.time, command.number))
        faults = self.faults
        if faults.silent > 0:
            faults.silent -= 1
            return None
        concerned = faults.only in (0, command.number)
        if faults.refuse > 0 and concerned:
            faults.refuse -= 1
            return DENIED
        if faults.ignore_all > 0:
            faults.ignore_all -= 1
            return ACCEPTED
        result = self.carry_out(command)
        if faults.unanswered > 0 and concerned:
            faults.unanswered -= 1
            return None
        return result

    @abstractmethod
    def carry_out(self, command: Command) -> int:
        """What the flavour makes of a command; MAV_RESULT."""

    def _spoiled_goto(self) -> bool:
        if self.faults.ignore_goto > 0:
            self.faults.ignore_goto -= 1
            return True
        return False

    def _spoiled_yaw(self) -> bool:
        if self.faults.ignore_yaw > 0:
            self.faults.ignore_yaw -= 1
            return True
        return False

    def reboot(self) -> None:
        """Time, mode, arming and whatever a ground station had asked for start again. Raises ValueError in the air."""
        if self.flight.in_air:
            raise ValueError("The autopilot does not reboot in the air: land first.")
        self.flight.disarm()
        self.time, self.mode, self.gcs_heard_at = 0.0, next(iter(self.modes)), None
        self.rebooted, self.critical = True, False

    # -- arming ----------------------------------------------------------------------------------------------------

    @property
    def prearm_ok(self) -> bool:
        """Also false when a test ordered it so."""
        return self.time >= self.ready_after and not self.faults.no_prearm

    def arm(self) -> int:
        """MAV_RESULT: temporarily rejected until the prearm checks pass. Armed already is accepted."""
        if not self.prearm_ok:
            self.say(
                "Preflight Fail: the position estimate is not ready, wait for the GPS", mavlink.MAV_SEVERITY_CRITICAL
            )
            return TEMPORARILY_REJECTED
        if not self.flight.armed:
            self.flight.arm()
            self.faults.home_m = 0.0
            self._armed_at = self.time
        return ACCEPTED

    def disarm(self) -> int:
        """MAV_RESULT: denied in the air."""
        if self.flight.in_air:
            return DENIED
        self.flight.disarm()
        return ACCEPTED

    @abstractmethod
    def disarm_delay(self) -> float:
        """Seconds on the ground, armed and without a take-off, after which the autopilot disarms (<= 0: never)."""

    # -- the pilot -------------------------------------------------------------------------------------------------

    @abstractmethod
    def move_sticks(self, velocity: tuple[float, float, float], yaw_rate: float) -> bool:
        """The pilot moves the sticks; True when that took control."""

    def switch_mode(self, mode: str) -> None:
        """The pilot's mode switch. Raises ValueError for a mode this flavour has not."""
        if mode not in self.modes:
            raise ValueError(f"{self.name} has no mode {mode}; it has {', '.join(self.modes)}.")
        self.set_mode(mode)

    # -- time ------------------------------------------------------------------------------------------------------

    def step(self, dt: float) -> None:
        """Advance by dt seconds of simulated time: first the flight, then the failsafes."""
        self.time += dt
        self.flight.step(dt)
        if self.flight.armed:
            self._watch_ground()
            self.watch_failsafes()
            self.watch()

    @abstractmethod
    def watch(self) -> None:
        """What a flavour watches besides."""

    def _watch_ground(self) -> None:
        flight = self.flight
        if flight.task in ("land", "return") and flight.grounded_for > 2.0:
            flight.disarm()
            self.landed()
            return
        delay = self.disarm_delay()
        if flight.task == "idle" and flight.grounded_for > delay > 0.0 and self.time - self._armed_at > delay:
            flight.disarm()
            self.say("Disarmed: no take-off")

    def landed(self) -> None:
        """After the motors stopped at the end of a landing."""

    def watches_station(self, system_id: int) -> bool:
        """Whether this ground station's heartbeats count for the failsafe."""
        return True
