"""Telemetry as the console gets it: the age of each group of values when it was sent, never a silently old number."""

from __future__ import annotations

import math
from datetime import UTC, datetime

from backend.wire.messages import TelemetryMessage
from hardware.readings import Telemetry


def telemetry_message(craft_id: str, telemetry: Telemetry, now_s: float, dropped: int = 0) -> TelemetryMessage:
    """`now_s`: UTC epoch seconds on the clock that stamped the telemetry. Numbers that are not finite become None."""
    place = telemetry.position
    north, east = telemetry.velocity_north_m_s, telemetry.velocity_east_m_s
    down = _finite(telemetry.velocity_down_m_s)
    return TelemetryMessage(
        craft_id=craft_id,
        at_utc=datetime.fromtimestamp(now_s, UTC),
        connected=telemetry.connected,
        lat=_finite(place.lat) if place else None,
        lon=_finite(place.lon) if place else None,
        position_age_s=_age(telemetry.position_at_s, now_s),
        altitude_amsl_m=_finite(telemetry.altitude_amsl_m),
        altitude_relative_m=_finite(telemetry.altitude_relative_m),
        heading_deg=_finite(telemetry.heading_deg),
        heading_age_s=_age(telemetry.heading_at_s, now_s),
        ground_speed_m_s=None if north is None or east is None else _finite(math.hypot(north, east)),
        climb_m_s=None if down is None else -down,
        battery_percent=_finite(telemetry.battery_percent),
        battery_age_s=_age(telemetry.battery_at_s, now_s),
        gps_fix=telemetry.gps_fix,
        satellites=telemetry.satellites,
        armed=telemetry.armed,
        in_air=telemetry.in_air,
        mode=telemetry.mode,
        mode_age_s=_age(telemetry.mode_at_s, now_s),
        who=telemetry.authority.who,
        autopilot=telemetry.autopilot,
        dropped=dropped,
    )


def _finite(value: float | None) -> float | None:
    return value if value is not None and math.isfinite(value) else None


def _age(at_s: float | None, now_s: float) -> float | None:
    """A clock that is a little ahead of ours makes no negative age."""
    return None if at_s is None else max(0.0, now_s - at_s)
