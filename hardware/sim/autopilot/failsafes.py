"""The failsafes of a simulated autopilot: what they watch, when they act, and how each flavour says so."""

from __future__ import annotations

import struct
from abc import ABC, abstractmethod
from typing import Literal

from pymavlink.dialects.v20 import development as mavlink

from hardware.sim.autopilot.copter import Copter
from hardware.sim.autopilot.flight import Flight
from hardware.sim.autopilot.sensors import Navigation

FLIES_ON_WITHOUT_FIX = 5.0
"""Seconds from the last fix to the autopilot's own landing, as measured on PX4."""
_EVENT_CRC, _EVENT_LEVELS = 160, 0x42  # critical, a warning inside
Cause = Literal["battery", "transmitter", "position", "fence", "silence"]


class Event(mavlink.MAVLink_message):
    """EVENT (#410), which no dialect of pymavlink 2.4 knows: to send only. number: with the component in byte 4."""

    id = 410
    msgname = "EVENT"

    def __init__(self, number: int, boot_ms: int, sequence: int, arguments: bytes) -> None:
        super().__init__(self.id, self.msgname)
        head = struct.pack("<IIHBBB", number, boot_ms, sequence, 0, 0, _EVENT_LEVELS)
        self._payload = head + arguments.ljust(40, b"\0")

    def pack(self, mav: mavlink.MAVLink, force_mavlink1: bool = False) -> bytes:
        """With the next sequence number of `mav`."""
        return bytes(self._pack(mav, _EVENT_CRC, self._payload, force_mavlink1))


class Failsafes(ABC):
    """What the flavours have in common. critical: what the heartbeat's state says of a failsafe."""

    copter: Copter
    flight: Flight
    navigation: Navigation
    mode: str
    time: float
    critical: bool = False
    gcs_heard_at: float | None
    gcs_failsafe: bool = False
    transmitter_lost_until: float = -1.0
    gcs_timeout_floor: float = 0.0
    """A ground station sends heartbeats by the wall clock: sped up, no less than this many simulated seconds."""
    _transmitter_lost_at: float | None = None
    _battery_failsafe: bool = False
    _position_failsafe: bool = False
    _held_before: bool = False
    """It lands without a fix, and held before: PX4 holds again once it has one."""

    @abstractmethod
    def fail_safe(self, cause: Cause, mode: str | None) -> None:
        """Select the mode (None: only warn) as a failsafe does, and say so."""

    @abstractmethod
    def set_mode(self, mode: str) -> None:
        """Select a mode and begin what it does."""

    @abstractmethod
    def say(self, text: str, severity: int = mavlink.MAV_SEVERITY_INFO) -> None:
        """As STATUSTEXT."""

    def watch_failsafes(self) -> None:
        """Once a step while it is armed."""
        self._watch_gcs()
        self._watch_transmitter()
        self._watch_battery()
        self._watch_fix()

    @abstractmethod
    def gcs_timeout(self) -> float:
        """Seconds without a ground station's heartbeat that count as lost."""

    @abstractmethod
    def gcs_lost(self) -> None:
        """The failsafe for a lost ground station, by its parameter."""

    def _watch_gcs(self) -> None:
        if self.gcs_heard_at is None or not self.flight.in_air:
            return
        lost = self.time - self.gcs_heard_at > max(self.gcs_timeout(), self.gcs_timeout_floor)
        if lost and not self.gcs_failsafe:
            self.gcs_failsafe = True
            self.gcs_lost()
        elif not lost:
            self.gcs_failsafe = False

    @abstractmethod
    def transmitter_timeout(self) -> float:
        """Seconds without the pilot's transmitter that count as lost."""

    @abstractmethod
    def transmitter_lost(self) -> None:
        """The failsafe for a lost transmitter, by its parameter; called once."""

    def _watch_transmitter(self) -> None:
        if self.time >= self.transmitter_lost_until:
            self._transmitter_lost_at = None
        elif self._transmitter_lost_at is None:
            self._transmitter_lost_at = self.time
        elif 0.0 <= self._transmitter_lost_at < self.time - self.transmitter_timeout():
            self._transmitter_lost_at = -1.0  # it has acted
            if self.flight.in_air:
                self.transmitter_lost()

    def _watch_fix(self) -> None:
        late = self.flight.in_air and self.navigation.without_fix_for > FLIES_ON_WITHOUT_FIX
        if late and not self._position_failsafe:
            self._position_failsafe = True
            if self.mode != "LAND":
                self._held_before = self.mode == "HOLD"
                self.fail_safe("position", "LAND")
        elif self.navigation.has_fix:
            self._position_failsafe = False
            if self._held_before and self.flight.in_air and self.mode == "LAND":
                self.set_mode("HOLD")
            self._held_before = False

    @abstractmethod
    def battery_low(self) -> None:
        """The battery failsafe, by its parameter; called once."""

    @abstractmethod
    def battery_threshold(self) -> float:
        """Percent."""

    def _watch_battery(self) -> None:
        if not self._battery_failsafe and self.copter.battery_percent < self.battery_threshold():
            self._battery_failsafe = True
            self.battery_low()
        if self.copter.energy <= 0.0 and self.flight.in_air and self.flight.task != "land":
            self.say("Battery empty", mavlink.MAV_SEVERITY_EMERGENCY)
            self.flight.land()
