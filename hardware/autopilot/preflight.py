"""The checklist before take-off: what was heard, and whether the autopilot's own failsafes would act. Pure."""

from __future__ import annotations

from collections.abc import Mapping

from hardware.autopilot.dialect import Dialect
from hardware.readings import PreflightCheck, Telemetry

FRESH_S = 3.0
MINIMUM_SATELLITES = 6
_GOOD_FIXES = frozenset({"3D", "DGPS", "RTK float", "RTK fixed", "PPP"})


def _age(at_s: float | None, now_s: float) -> str:
    return "never heard" if at_s is None else f"{max(0.0, now_s - at_s):.1f} s old"


def telemetry_checks(
    telemetry: Telemetry, prearm_ok: bool | None, latched: str | None, minimum_battery_percent: float
) -> list[PreflightCheck]:
    """Link, position, heading, battery, home, readiness, control."""
    t, now = telemetry, telemetry.at_s
    fresh_position = t.position_at_s is not None and now - t.position_at_s < FRESH_S
    fresh_heading = t.heading_at_s is not None and now - t.heading_at_s < FRESH_S
    charge = "not reported" if t.battery_percent is None else f"{t.battery_percent:.0f} %"
    home = "not known" if t.home is None else f"{t.home.lat_deg:.6f}, {t.home.lon_deg:.6f}"
    ready = "not reported by this autopilot" if prearm_ok is None else "ready" if prearm_ok else "not ready"
    return [
        PreflightCheck(
            "Vehicle link", t.connected, f"{t.autopilot}, mode {t.mode}", "Check radio, cable and vehicle address."
        ),
        PreflightCheck(
            "GPS",
            t.gps_fix in _GOOD_FIXES and (t.satellites is None or t.satellites >= MINIMUM_SATELLITES),
            f"{t.gps_fix or 'not reported'}, {t.satellites if t.satellites is not None else '?'} satellites",
            f"Wait for a 3D fix with at least {MINIMUM_SATELLITES} satellites under open sky.",
        ),
        PreflightCheck(
            "Position", fresh_position, _age(t.position_at_s, now), "Wait until the autopilot knows where it is."
        ),
        PreflightCheck(
            "Heading",
            fresh_heading,
            _age(t.heading_at_s, now),
            "Check the compass: bearings need the vehicle's heading.",
        ),
        PreflightCheck(
            "Battery",
            t.battery_percent is not None and t.battery_percent >= minimum_battery_percent,
            charge,
            f"Charge to at least {minimum_battery_percent:.0f} %, or set up the battery monitor.",
            blocking=t.battery_percent is not None,
        ),
        PreflightCheck(
            "Home position", t.home is not None, home, "Wait until the autopilot has set its home (it needs GPS)."
        ),
        PreflightCheck(
            "Ready to arm",
            prearm_ok is not False or bool(t.in_air),
            "in the air" if t.in_air else ready,
            "Read the autopilot's messages: its own checks refuse to arm.",
        ),
        PreflightCheck(
            "Control",
            latched is None or t.armed is False,
            latched or "no pilot intervenes",
            "Give control back with the transmitter, then resume.",
        ),
    ]


def failsafe_checks(dialect: Dialect, parameters: Mapping[str, float | None]) -> list[PreflightCheck]:
    """`parameters`: name -> value as read, None when the autopilot did not give it."""
    checks: list[PreflightCheck] = []
    for rule in dialect.failsafes:
        value = parameters.get(rule.parameter)
        detail = f"{rule.what}: {rule.parameter} " + ("could not be read" if value is None else f"= {value:g}")
        ok = value is not None and rule.holds(value)
        checks.append(
            PreflightCheck(f"Failsafe {rule.parameter}", ok, detail, "" if ok else rule.remedy, rule.blocking)
        )
    return checks
