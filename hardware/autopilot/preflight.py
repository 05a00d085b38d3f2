"""The checklist before take-off: what was heard, and whether the autopilot's own failsafes would act. Pure."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

from hardware.autopilot.dialect import FailsafeRule
from hardware.autopilot.remote_id import RemoteId
from hardware.readings import PreflightCheck, Telemetry
from hardware.reasons.preflight import (
    ArmingChecked,
    BatteryCharge,
    ControlChecked,
    FailsafeParameter,
    FailsafeUnread,
    FailsafeWithoutThreshold,
    GpsChecked,
    HomeSet,
    LinkChecked,
    NeverReported,
    RemoteIdChecked,
    RemoteIdRefuses,
    ReportAge,
    SatellitesUnknown,
)
from hardware.reasons.vehicle_news import ClockRateOdd, VehicleUnheard

FRESH_S = 3.0
MINIMUM_SATELLITES = 6
REMOTE_ID_FRESH_S = 10.0
_GOOD_FIXES = frozenset({"3D", "DGPS", "RTK float", "RTK fixed", "PPP"})


@dataclass(frozen=True, slots=True)
class Readiness:
    """prearm_ok: the autopilot would arm, None: it does not say. heard: SYS_STATUS came, which says so or does not.
    in_our_mode: in a mode that we would arm in; PX4 answers for the present one only. said: its own words lately."""

    prearm_ok: bool | None
    heard: bool = True
    in_our_mode: bool = True
    said: str = ""


def telemetry_checks(
    telemetry: Telemetry, readiness: Readiness, remote_id: RemoteId, minimum_battery_percent: float
) -> list[PreflightCheck]:
    """Link, position, heading, battery, home, readiness, Remote ID, control."""
    t = telemetry
    return [
        PreflightCheck("vehicle_link", t.connected, LinkChecked(t.autopilot) if t.connected else VehicleUnheard()),
        _gps(t),
        _age("position", t.position_at_s, t.at_s),
        _heading(t),
        _battery(t, minimum_battery_percent),
        PreflightCheck("home", False, NeverReported("home"))
        if t.home is None
        else PreflightCheck("home", True, HomeSet(t.home.lat, t.home.lon)),
        _ready_to_arm(t, readiness),
        _remote_id(remote_id, t.at_s),
        _control(t),
    ]


def _gps(telemetry: Telemetry) -> PreflightCheck:
    fix, satellites = telemetry.gps_fix, telemetry.satellites
    if fix is None:
        return PreflightCheck("gps", False, NeverReported("gps"))
    if satellites is None:
        return PreflightCheck("gps", False, SatellitesUnknown(fix), blocking=fix not in _GOOD_FIXES)
    ok = fix in _GOOD_FIXES and satellites >= MINIMUM_SATELLITES
    return PreflightCheck("gps", ok, GpsChecked(fix, satellites, MINIMUM_SATELLITES))


def _age(what: Literal["position", "heading"], at_s: float | None, now_s: float) -> PreflightCheck:
    if at_s is None:
        return PreflightCheck(what, False, NeverReported(what))
    age_s = max(0.0, now_s - at_s)
    return PreflightCheck(what, age_s < FRESH_S, ReportAge(what, age_s))


def _heading(telemetry: Telemetry) -> PreflightCheck:
    """A heading that cannot be dated is none for a bearing, however fresh it looks."""
    if telemetry.odd_clock_rate is not None:
        return PreflightCheck("heading", False, ClockRateOdd(telemetry.odd_clock_rate))
    return _age("heading", telemetry.heading_at_s, telemetry.at_s)


def _battery(telemetry: Telemetry, minimum_percent: float) -> PreflightCheck:
    charge = telemetry.battery_percent
    if charge is None:
        return PreflightCheck("battery", False, NeverReported("battery"), blocking=False)
    return PreflightCheck("battery", charge >= minimum_percent, BatteryCharge(charge, minimum_percent))


def _ready_to_arm(telemetry: Telemetry, readiness: Readiness) -> PreflightCheck:
    if telemetry.in_air:
        return PreflightCheck("ready_to_arm", True, ArmingChecked("in_the_air"))
    if not readiness.heard:
        return PreflightCheck("ready_to_arm", False, NeverReported("own_checks"))
    if readiness.prearm_ok is False:
        state = "not_ready" if readiness.in_our_mode else "not_in_this_mode"
        reason = ArmingChecked(state, readiness.said)
        return PreflightCheck("ready_to_arm", False, reason, blocking=readiness.in_our_mode)
    return PreflightCheck("ready_to_arm", True, ArmingChecked("ready" if readiness.prearm_ok else "not_reported"))


def _remote_id(heard: RemoteId, now_s: float) -> PreflightCheck:
    """Unknown is not fine, but not every vehicle must have one."""
    if heard.at_s is None:
        return PreflightCheck("remote_id", False, RemoteIdChecked("unknown"), blocking=False)
    if now_s - heard.at_s > REMOTE_ID_FRESH_S:
        return PreflightCheck("remote_id", False, RemoteIdChecked("silent"))
    if heard.problem is None:
        return PreflightCheck("remote_id", True, RemoteIdChecked("good"))
    return PreflightCheck("remote_id", False, RemoteIdRefuses(heard.problem))


def _control(telemetry: Telemetry) -> PreflightCheck:
    """A vehicle that somebody else landed and disarmed may start again."""
    authority = telemetry.authority
    if authority.taken_by is None or authority.who == "ours" or telemetry.armed is False:
        return PreflightCheck("control", True, ControlChecked("nobody"))
    return PreflightCheck("control", False, ControlChecked(authority.who))


def failsafe_check(
    rule: FailsafeRule,
    name: str,
    value: float | None,
    thresholds: Mapping[str, float | None],
    charge_known: bool = True,
) -> PreflightCheck:
    """name: of the parameter in this version of the autopilot; value, and those of `rule.thresholds`: None when it
    could not be read. charge_known: the vehicle reports its battery; of one that does not, no failsafe can watch it."""
    wanted = rule.wanted(value)
    blocking = rule.blocking and (charge_known or rule.watch != "battery")
    if value is None:
        return PreflightCheck("failsafe", False, FailsafeUnread(rule.watch, name, wanted), blocking)
    reason = FailsafeParameter(rule.watch, name, value, wanted)
    if rule.holds(value) and rule.thresholds and not any((at or 0.0) > 0.0 for at in thresholds.values()):
        known = all(at is not None for at in thresholds.values())
        never = FailsafeWithoutThreshold(rule.watch, name, *rule.thresholds, known)
        return PreflightCheck("failsafe", False, never, blocking)
    return PreflightCheck("failsafe", rule.holds(value), reason, blocking)
