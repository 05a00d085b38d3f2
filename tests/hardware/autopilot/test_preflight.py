from __future__ import annotations

from dataclasses import replace

import pytest

from hardware.authority import Authority
from hardware.autopilot.ardupilot import ARDUPILOT
from hardware.autopilot.dialect import Dialect
from hardware.autopilot.preflight import Readiness, failsafe_check, telemetry_checks
from hardware.autopilot.px4 import PX4
from hardware.autopilot.remote_id import RemoteId
from hardware.readings import Place, PreflightCheck, Telemetry
from hardware.reasons.preflight import (
    ArmingChecked,
    FailsafeParameter,
    FailsafeUnread,
    FailsafeWithoutThreshold,
    NeverReported,
    RemoteIdChecked,
    RemoteIdRefuses,
    SatellitesUnknown,
)
from planner.reason import remedy_of

NOW = 1_700_000_000.0
READY = Telemetry(
    connected=True,
    at_s=NOW,
    position=Place(47.0, 8.0),
    position_at_s=NOW - 0.1,
    heading_deg=10.0,
    heading_at_s=NOW - 0.05,
    battery_percent=90.0,
    gps_fix="3D",
    satellites=12,
    home=Place(47.0, 8.0),
    autopilot="px4",
)
SAFE_PX4 = {
    "NAV_DLL_ACT": 2.0,
    "COM_DL_LOSS_T": 10.0,
    "COM_RC_OVERRIDE": 1.0,
    "GF_ACTION": 2.0,
    "COM_OBL_RC_ACT": 0.0,
    "COM_LOW_BAT_ACT": 3.0,
}
SAFE_ARDUPILOT = {
    "FS_GCS_ENABLE": 1.0,
    "FS_GCS_TIMEOUT": 5.0,
    "MAV_GCS_SYSID": 255.0,
    "FENCE_ACTION": 1.0,
    "FS_THR_ENABLE": 1.0,
    "BATT_FS_LOW_ACT": 2.0,
    "BATT_FS_CRT_ACT": 1.0,
}
NO_REMOTE_ID = RemoteId()
READY_TO_ARM = Readiness(True)


def refused(telemetry: Telemetry, prearm_ok: bool | None = True, remote_id: RemoteId = NO_REMOTE_ID) -> list[str]:
    checks = telemetry_checks(telemetry, Readiness(prearm_ok), remote_id, minimum_battery_percent=30.0)
    assert all(check.ok or remedy_of(check.reason) for check in checks)
    return [check.name for check in checks if check.blocking and not check.ok]


def test_a_ready_vehicle_passes() -> None:
    assert refused(READY) == []
    assert refused(READY, prearm_ok=None) == []


def test_an_autopilot_that_has_not_said_how_its_own_checks_stand_is_waited_for() -> None:
    """The first SYS_STATUS may come after the first position: until then nobody knows, and a start is refused."""
    unheard = telemetry_checks(READY, Readiness(None, heard=False), NO_REMOTE_ID, 30.0)

    assert [(one.name, one.reason) for one in unheard if not one.ok and one.blocking] == [
        ("ready_to_arm", NeverReported("own_checks"))
    ]
    flying = telemetry_checks(replace(READY, in_air=True), Readiness(None, heard=False), NO_REMOTE_ID, 30.0)
    assert all(one.ok for one in flying if one.name == "ready_to_arm")


@pytest.mark.parametrize(
    ("change", "name"),
    [
        ({"connected": False}, "vehicle_link"),
        ({"gps_fix": "2D"}, "gps"),
        ({"gps_fix": None}, "gps"),
        ({"satellites": 4}, "gps"),
        ({"odd_clock_rate": 0.9}, "heading"),
        ({"position_at_s": NOW - 10.0}, "position"),
        ({"position_at_s": None}, "position"),
        ({"heading_at_s": NOW - 10.0}, "heading"),
        ({"battery_percent": 12.0}, "battery"),
        ({"home": None}, "home"),
    ],
)
def test_each_thing_missing_refuses_by_its_name(change: dict[str, object], name: str) -> None:
    assert refused(replace(READY, **change)) == [name]  # pyright: ignore[reportArgumentType]


def test_an_autopilot_that_would_not_arm_and_a_pilot_in_control_refuse() -> None:
    assert refused(READY, prearm_ok=False) == ["ready_to_arm"]
    assert refused(replace(READY, in_air=True), prearm_ok=False) == []
    taken = replace(READY, authority=Authority(who="pilot", taken_by="sticks"))
    assert refused(taken) == ["control"]
    assert refused(replace(taken, armed=True)) == ["control"]
    assert refused(replace(taken, armed=False)) == []


def test_satellites_that_the_autopilot_does_not_know_are_not_fine() -> None:
    unknown = replace(READY, satellites=None)
    (check,) = [one for one in telemetry_checks(unknown, READY_TO_ARM, NO_REMOTE_ID, 30.0) if one.name == "gps"]
    assert (check.ok, check.blocking, check.reason) == (False, False, SatellitesUnknown("3D"))
    assert refused(replace(unknown, gps_fix="2D")) == ["gps"]


@pytest.mark.parametrize(
    ("heard", "ok", "blocks", "reason"),
    [
        (NO_REMOTE_ID, False, False, RemoteIdChecked("unknown")),
        (RemoteId(NOW - 1.0), True, False, RemoteIdChecked("good")),
        (RemoteId(NOW - 60.0), False, True, RemoteIdChecked("silent")),
        (RemoteId(NOW - 1.0, "operator ID missing"), False, True, RemoteIdRefuses("operator ID missing")),
    ],
)
def test_remote_id_counts_by_what_its_transmitter_says(
    heard: RemoteId, ok: bool, blocks: bool, reason: RemoteIdChecked | RemoteIdRefuses
) -> None:
    (check,) = [one for one in telemetry_checks(READY, READY_TO_ARM, heard, 30.0) if one.name == "remote_id"]
    assert (check.ok, check.reason) == (ok, reason)
    assert refused(READY, remote_id=heard) == (["remote_id"] if blocks else [])


@pytest.mark.parametrize(
    ("dialect", "present", "healthy", "ready"),
    [
        (PX4, False, True, True),
        (PX4, False, False, False),
        (PX4, None, None, None),
        (ARDUPILOT, True, True, True),
        (ARDUPILOT, True, False, False),
        (ARDUPILOT, False, False, None),
    ],
)
def test_each_autopilot_says_in_its_own_way_whether_it_would_arm(
    dialect: Dialect, present: bool | None, healthy: bool | None, ready: bool | None
) -> None:
    assert dialect.prearm_ok(present, healthy) is ready


def test_what_an_autopilot_says_of_another_mode_than_ours_blocks_nothing() -> None:
    found = telemetry_checks(READY, Readiness(False, in_our_mode=False), NO_REMOTE_ID, 30.0)
    (check,) = [one for one in found if one.name == "ready_to_arm"]
    assert (check.ok, check.blocking, check.reason) == (False, False, ArmingChecked("not_in_this_mode"))


def test_no_failsafe_watches_a_battery_that_is_not_reported() -> None:
    rule = next(rule for rule in PX4.failsafes if rule.watch == "battery")
    assert failsafe_check(rule, rule.parameter, 0.0, {}).blocking
    assert not failsafe_check(rule, rule.parameter, 0.0, {}, charge_known=False).blocking


def test_a_battery_that_is_not_reported_is_a_caution_only() -> None:
    assert refused(replace(READY, battery_percent=None)) == []


@pytest.mark.parametrize(
    ("dialect", "values"), [(PX4, SAFE_PX4), (ARDUPILOT, SAFE_ARDUPILOT)], ids=["px4", "ardupilot"]
)
def test_safe_parameters_pass_and_each_one_that_would_not_act_refuses(
    dialect: Dialect, values: dict[str, float]
) -> None:
    for rule in dialect.failsafes:
        assert failsafe_check(
            rule, rule.parameter, values[rule.parameter], {"BATT_LOW_VOLT": 10.5, "BATT_LOW_MAH": 0.0}
        ).ok
        assert rule.holds(rule.set_to), f"the remedy of {rule.parameter} is itself unsafe"
        unsafe = 6.0 if rule.parameter == "COM_OBL_RC_ACT" else 0.0
        bad = failsafe_check(rule, rule.parameter, unsafe, {})
        assert (bad.name, bad.ok, bad.blocking) == ("failsafe", False, rule.blocking)
        assert bad.reason == FailsafeParameter(rule.watch, rule.parameter, unsafe, rule.wanted(unsafe))
        assert f"Set {rule.parameter} to {rule.wanted(unsafe)}" in remedy_of(bad.reason)


@pytest.mark.parametrize(("dialect", "name"), [(PX4, "COM_DL_LOSS_T"), (ARDUPILOT, "FS_GCS_TIMEOUT")])
def test_a_lost_station_must_be_noticed_within_half_a_minute(dialect: Dialect, name: str) -> None:
    (rule,) = [rule for rule in dialect.failsafes if rule.watch == "station_time"]
    assert (rule.parameter, rule.blocking) == (name, True)
    held = {seconds: rule.holds(seconds) for seconds in (0.0, 1.0, 2.0, 5.0, 10.0, 30.0, 30.5, 120.0, 300.0)}
    assert held == dict.fromkeys(held, False) | dict.fromkeys((2.0, 5.0, 10.0, 30.0), True)


def test_a_parameter_that_cannot_be_read_is_not_taken_for_safe() -> None:
    for rule in PX4.failsafes:
        check = failsafe_check(rule, rule.parameter, None, {})
        assert not check.ok
        assert check.reason == FailsafeUnread(rule.watch, rule.parameter, rule.set_to)


@pytest.mark.parametrize(("watch", "blocking"), [("battery", True), ("battery_critical", False)])
def test_a_battery_failsafe_that_nothing_sets_off_protects_nothing(watch: str, blocking: bool) -> None:
    rule = next(rule for rule in ARDUPILOT.failsafes if rule.watch == watch)
    assert rule.thresholds is not None
    voltage, charge = rule.thresholds

    def check(volts: float | None, mah: float | None) -> PreflightCheck:
        return failsafe_check(rule, rule.parameter, 2.0, {voltage: volts, charge: mah})

    assert check(10.5, 0.0).ok
    assert check(0.0, 400.0).ok
    assert check(None, 400.0).ok
    for volts, mah, known in ((0.0, 0.0, True), (-1.0, 0.0, True), (None, 0.0, False), (None, None, False)):
        bad = check(volts, mah)
        assert (bad.ok, bad.blocking) == (False, blocking)
        assert bad.reason == FailsafeWithoutThreshold(rule.watch, rule.parameter, voltage, charge, known)
        assert voltage in remedy_of(bad.reason)
    off = failsafe_check(rule, rule.parameter, 0.0, {voltage: 0.0, charge: 0.0})
    assert isinstance(off.reason, FailsafeParameter), "what must be mended first is said first"


def test_a_remedy_keeps_the_bits_that_it_does_not_need() -> None:
    rule = next(rule for rule in PX4.failsafes if rule.parameter == "COM_RC_OVERRIDE")

    assert rule.wanted(6.0) == 7


@pytest.mark.parametrize(("value", "holds"), [(0, False), (1, True), (2, False), (3, True)])
def test_stick_override_must_cover_the_auto_modes(value: int, holds: bool) -> None:
    rule = next(rule for rule in PX4.failsafes if rule.parameter == "COM_RC_OVERRIDE")

    assert rule.holds(value) is holds
