from __future__ import annotations

from typing import Any

import pytest

from hardware.autopilot.position_trust import PositionTrust

GOOD: dict[str, dict[str, Any]] = {
    "GPS_RAW_INT": {"fix_type": 3},
    "SYS_STATUS": {"onboard_control_sensors_enabled": 0x20, "onboard_control_sensors_health": 0x20},
    "ESTIMATOR_STATUS": {"flags": 0x33F},
    "EKF_STATUS_REPORT": {"flags": 0x33F},
}
BAD: dict[str, dict[str, Any]] = {
    "GPS_RAW_INT": {"fix_type": 1},
    "SYS_STATUS": {"onboard_control_sensors_enabled": 0x20, "onboard_control_sensors_health": 0},
    "ESTIMATOR_STATUS": {"flags": 0x007},
    "EKF_STATUS_REPORT": {"flags": 0x007},
}


@pytest.mark.parametrize("name", GOOD)
def test_each_source_tells_of_a_loss_with_its_second_report_and_of_the_end(name: str) -> None:
    trust = PositionTrust()
    trust.fold(name, GOOD[name], 1.0)
    trust.fold(name, BAD[name], 2.0)
    assert trust.lost_since_s is None
    trust.fold(name, BAD[name], 2.2)
    trust.fold(name, BAD[name], 2.4)
    assert trust.lost_since_s == 2.2
    trust.fold(name, GOOD[name], 3.0)
    assert trust.lost_since_s is None


@pytest.mark.parametrize("name", GOOD)
def test_what_it_never_had_it_cannot_lose(name: str) -> None:
    trust = PositionTrust()
    for at in range(5):
        trust.fold(name, BAD[name], float(at))
    assert trust.lost_since_s is None


def test_it_is_lost_while_one_source_says_so() -> None:
    trust = PositionTrust()
    for name in ("GPS_RAW_INT", "ESTIMATOR_STATUS"):
        trust.fold(name, GOOD[name], 1.0)
        trust.fold(name, BAD[name], 2.0)
        trust.fold(name, BAD[name], 2.1)
    trust.fold("GPS_RAW_INT", GOOD["GPS_RAW_INT"], 3.0)
    assert trust.lost_since_s == 2.1


def test_a_sensor_that_is_switched_off_says_nothing() -> None:
    trust = PositionTrust()
    trust.fold("SYS_STATUS", GOOD["SYS_STATUS"], 1.0)
    for at in (2.0, 3.0, 4.0):
        off = {"onboard_control_sensors_enabled": 0, "onboard_control_sensors_health": 0}
        trust.fold("SYS_STATUS", off, at)
    assert trust.lost_since_s is None
