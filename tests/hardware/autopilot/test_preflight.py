from __future__ import annotations

from dataclasses import replace

import pytest

from hardware.autopilot.ardupilot import ARDUPILOT
from hardware.autopilot.dialect import Dialect
from hardware.autopilot.preflight import failsafe_checks, telemetry_checks
from hardware.autopilot.px4 import PX4
from hardware.readings import GeoPoint, Telemetry

NOW = 1_700_000_000.0
READY = Telemetry(
    connected=True,
    at_s=NOW,
    position=GeoPoint(47.0, 8.0),
    position_at_s=NOW - 0.1,
    heading_deg=10.0,
    heading_at_s=NOW - 0.05,
    battery_percent=90.0,
    gps_fix="3D",
    satellites=12,
    home=GeoPoint(47.0, 8.0),
    autopilot="px4",
)
SAFE_PX4 = {"NAV_DLL_ACT": 2.0, "COM_RC_OVERRIDE": 1.0, "GF_ACTION": 2.0, "COM_OBL_RC_ACT": 0.0}
SAFE_ARDUPILOT = {"FS_GCS_ENABLE": 1.0, "MAV_GCS_SYSID": 255.0, "FENCE_ACTION": 1.0, "FS_THR_ENABLE": 1.0}


def refused(telemetry: Telemetry, prearm_ok: bool | None = True, latched: str | None = None) -> list[str]:
    checks = telemetry_checks(telemetry, prearm_ok, latched, minimum_battery_percent=30.0)
    assert all(check.remedy for check in checks)
    return [check.name for check in checks if check.blocking and not check.ok]


def test_a_ready_vehicle_passes() -> None:
    assert refused(READY) == []
    assert refused(READY, prearm_ok=None) == []


@pytest.mark.parametrize(
    ("change", "name"),
    [
        ({"connected": False}, "Vehicle link"),
        ({"gps_fix": "2D"}, "GPS"),
        ({"gps_fix": None}, "GPS"),
        ({"satellites": 4}, "GPS"),
        ({"position_at_s": NOW - 10.0}, "Position"),
        ({"position_at_s": None}, "Position"),
        ({"heading_at_s": NOW - 10.0}, "Heading"),
        ({"battery_percent": 12.0}, "Battery"),
        ({"home": None}, "Home position"),
    ],
)
def test_each_thing_missing_refuses_by_its_name(change: dict[str, object], name: str) -> None:
    assert refused(replace(READY, **change)) == [name]  # pyright: ignore[reportArgumentType]


def test_an_autopilot_that_would_not_arm_and_a_pilot_in_control_refuse() -> None:
    assert refused(READY, prearm_ok=False) == ["Ready to arm"]
    assert refused(replace(READY, in_air=True), prearm_ok=False) == []
    assert refused(READY, latched="the pilot took over") == ["Control"]
    assert refused(replace(READY, armed=True), latched="the pilot took over") == ["Control"]
    assert refused(replace(READY, armed=False), latched="the pilot took over and landed") == []


def test_a_battery_that_is_not_reported_is_a_caution_only() -> None:
    assert refused(replace(READY, battery_percent=None)) == []


@pytest.mark.parametrize(
    ("dialect", "values"), [(PX4, SAFE_PX4), (ARDUPILOT, SAFE_ARDUPILOT)], ids=["px4", "ardupilot"]
)
def test_safe_parameters_pass_and_each_one_that_would_not_act_refuses(
    dialect: Dialect, values: dict[str, float]
) -> None:
    assert all(check.ok for check in failsafe_checks(dialect, values))
    for rule in dialect.failsafes:
        assert rule.holds(rule.set_to), f"the remedy of {rule.parameter} is itself unsafe"
        unsafe = 6.0 if rule.parameter == "COM_OBL_RC_ACT" else 0.0
        bad = [check for check in failsafe_checks(dialect, values | {rule.parameter: unsafe}) if not check.ok]
        assert [check.name for check in bad] == [f"Failsafe {rule.parameter}"]
        assert rule.parameter in bad[0].remedy
        assert bad[0].blocking == rule.blocking


def test_a_parameter_that_cannot_be_read_is_not_taken_for_safe() -> None:
    bad = [check for check in failsafe_checks(PX4, {}) if not check.ok]

    assert len(bad) == len(PX4.failsafes)
    assert all("could not be read" in check.detail for check in bad)


@pytest.mark.parametrize(("value", "holds"), [(0, False), (1, True), (2, False), (3, True)])
def test_stick_override_must_cover_the_auto_modes(value: int, holds: bool) -> None:
    rule = next(rule for rule in PX4.failsafes if rule.parameter == "COM_RC_OVERRIDE")

    assert rule.holds(value) is holds
