"""Does the vehicle still know where it is? By its receiver, its own health and its estimator. Pure."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

BAD_REPORTS = 2
"""So many in a row from one source: a single one may be a stray message."""
_FIX_3D = 3  # GPS_FIX_TYPE
_GPS_SENSOR = 0x20  # MAV_SYS_STATUS_SENSOR_GPS
_POSITION_ABSOLUTE = 0x10  # ESTIMATOR_POS_HORIZ_ABS, EKF_POS_HORIZ_ABS


@dataclass(slots=True)
class PositionTrust:
    """A source counts once it was good: what a vehicle never had it cannot lose."""

    lost_since_s: float | None = None
    """UTC of the report that said so; None while the position is known, or never was."""
    _bad: dict[str, int] = field(default_factory=dict[str, int])
    """Reports in a row; a source is in it once it was good."""

    def fold(self, name: str, fields: dict[str, Any], heard_at_s: float) -> None:
        """Take one message in."""
        match name:
            case "GPS_RAW_INT":
                self._see(name, int(fields["fix_type"]) >= _FIX_3D, heard_at_s)
            case "SYS_STATUS" if int(fields["onboard_control_sensors_enabled"]) & _GPS_SENSOR:
                self._see(name, bool(int(fields["onboard_control_sensors_health"]) & _GPS_SENSOR), heard_at_s)
            case "ESTIMATOR_STATUS" | "EKF_STATUS_REPORT":
                self._see(name, bool(int(fields["flags"]) & _POSITION_ABSOLUTE), heard_at_s)
            case _:
                pass

    def _see(self, source: str, good: bool, heard_at_s: float) -> None:
        if good:
            self._bad[source] = 0
        elif source in self._bad:
            self._bad[source] += 1
        lost = any(reports >= BAD_REPORTS for reports in self._bad.values())
        if not lost:
            self.lost_since_s = None
        elif self.lost_since_s is None:
            self.lost_since_s = heard_at_s
