from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import pytest

from hardware.authority import NOBODY
from hardware.autopilot.snapshot import HISTORY_S, Snapshot

T0 = 1_700_000_000.0
HERE: dict[str, Any] = {
    "time_boot_ms": 1000,
    "lat": 473977419,
    "lon": 85455938,
    "alt": 528_000,
    "relative_alt": 40_000,
    "vx": 300,
    "vy": -400,
    "vz": 12,
}


def attitude(boot_ms: int, yaw: float | None) -> dict[str, Any]:
    return {"time_boot_ms": boot_ms, "yaw": yaw}


def test_wire_units_become_named_units() -> None:
    snapshot = Snapshot()
    snapshot.fold("GLOBAL_POSITION_INT", HERE, T0)
    snapshot.fold("ATTITUDE", attitude(1000, math.radians(-90.0)), T0)
    snapshot.fold("HEARTBEAT", {"custom_mode": 4, "base_mode": 81 | 128, "autopilot": 3}, T0)
    snapshot.fold("GPS_RAW_INT", {"fix_type": 3, "satellites_visible": 12}, T0)
    snapshot.fold("BATTERY_STATUS", {"id": 0, "battery_remaining": 77}, T0)
    snapshot.fold("EXTENDED_SYS_STATE", {"landed_state": 2}, T0)
    snapshot.fold("HOME_POSITION", {"latitude": 473000000, "longitude": 85000000, "altitude": 488_000}, T0)

    t = snapshot.telemetry(T0 + 1.0, True, "GUIDED", NOBODY, "ardupilot")

    assert t.position is not None
    assert (t.position.lat, t.position.lon) == pytest.approx((47.3977419, 8.5455938))
    assert (t.altitude_amsl_m, t.altitude_relative_m) == (528.0, 40.0)
    assert (t.velocity_north_m_s, t.velocity_east_m_s, t.velocity_down_m_s) == (3.0, -4.0, 0.12)
    assert t.heading_deg == pytest.approx(270.0)
    assert (t.push_north_m_s2, t.push_east_m_s2) == (None, None)
    assert (t.armed, t.in_air, t.gps_fix, t.satellites) == (True, True, "3D", 12)
    assert (t.battery_percent, t.home_amsl_m) == (77.0, 488.0)


def test_a_vehicle_that_agreed_to_arm_is_not_disarmed_until_a_later_heartbeat_says_so() -> None:
    snapshot = Snapshot()
    assert not snapshot.disarmed
    snapshot.fold("HEARTBEAT", {"custom_mode": 4, "base_mode": 81}, T0)
    assert snapshot.disarmed
    snapshot.arming_at_s = T0 + 0.1
    assert not snapshot.disarmed
    assert snapshot.telemetry(T0 + 0.2, True, "GUIDED", NOBODY, "ardupilot").armed is None
    snapshot.fold("HEARTBEAT", {"custom_mode": 4, "base_mode": 81}, T0 + 0.2)
    assert not snapshot.disarmed
    snapshot.fold("HEARTBEAT", {"custom_mode": 4, "base_mode": 81}, T0 + 1.7)
    assert snapshot.disarmed


def test_what_was_never_heard_is_none() -> None:
    t = Snapshot().telemetry(T0, False, None, NOBODY, "unknown")

    assert t.position is None
    assert t.heading_deg is None
    assert t.battery_percent is None
    assert t.in_air is None


@pytest.mark.parametrize("yaw", [None, math.nan, math.inf])
def test_a_heading_that_is_no_number_is_not_taken(yaw: float | None) -> None:
    snapshot = Snapshot()
    snapshot.fold("ATTITUDE", attitude(1000, 1.0), T0)
    snapshot.fold("ATTITUDE", attitude(1050, yaw), T0 + 0.05)

    assert snapshot.heading_deg == pytest.approx(math.degrees(1.0))
    assert len(snapshot.headings(0.0)) == 1


def test_an_unknown_charge_or_place_leaves_the_last_one() -> None:
    snapshot = Snapshot()
    snapshot.fold("GLOBAL_POSITION_INT", HERE, T0)
    snapshot.fold("GLOBAL_POSITION_INT", HERE | {"lat": 0, "lon": 0}, T0 + 1)
    snapshot.fold("BATTERY_STATUS", {"id": 0, "battery_remaining": -1}, T0)

    assert snapshot.position is not None
    assert snapshot.position.lat == pytest.approx(47.3977419)
    assert snapshot.battery_percent is None


def test_headings_are_stamped_with_the_autopilots_time_in_order_and_bounded() -> None:
    snapshot = Snapshot()
    count = int(HISTORY_S / 0.05) + 500
    for i in range(count):
        late = 0.0 if i == 0 or i % 7 else 0.4  # every seventh is heard late
        snapshot.fold("ATTITUDE", attitude(50 * i, 0.001 * (i % 6000)), T0 + 0.05 * i + late)

    samples = snapshot.headings(0.0)
    gaps = [b.at_s - a.at_s for a, b in pairwise(samples)]
    assert min(gaps) > 0.0
    assert max(gaps) < 0.06
    assert samples[-1].at_s - samples[0].at_s <= HISTORY_S
    recent = snapshot.headings(samples[-1].at_s - 1.0)
    assert 20 <= len(recent) <= 22
    assert recent[-1] == samples[-1]


def test_a_position_no_vehicle_could_have_flown_to_is_a_jump() -> None:
    snapshot = Snapshot()
    snapshot.fold("GLOBAL_POSITION_INT", HERE, T0)
    assert snapshot.jumped_m is None
    snapshot.fold("GLOBAL_POSITION_INT", HERE | {"time_boot_ms": 1100, "lat": HERE["lat"] + 60}, T0 + 0.1)
    assert snapshot.jumped_m is None  # 0.7 m
    snapshot.fold("GLOBAL_POSITION_INT", HERE | {"time_boot_ms": 1200, "lat": HERE["lat"] + 3000}, T0 + 0.2)
    assert snapshot.jumped_m == pytest.approx(32.7, abs=0.5)
    snapshot.fold("GLOBAL_POSITION_INT", HERE | {"time_boot_ms": 9200, "lat": HERE["lat"] + 3800}, T0 + 8.2)
    assert snapshot.jumped_m is None  # 9 m after 8 s of silence


def test_positions_that_the_link_held_back_are_no_jump() -> None:
    snapshot = Snapshot()
    snapshot.fold("GLOBAL_POSITION_INT", HERE, T0 + 8.0)
    twenty_m_north = HERE | {"time_boot_ms": 5000, "lat": HERE["lat"] + 1800}
    snapshot.fold("GLOBAL_POSITION_INT", twenty_m_north, T0 + 8.05)
    assert snapshot.jumped_m is None


def test_a_jump_in_flight_makes_the_place_unsure_until_it_jumps_back() -> None:
    snapshot = Snapshot()

    def displaced_m(boot_ms: int, north: int) -> float:
        heard_at_s = T0 + boot_ms / 1e3
        snapshot.fold("GLOBAL_POSITION_INT", HERE | {"time_boot_ms": boot_ms, "lat": HERE["lat"] + north}, heard_at_s)
        snapshot.fold("ATTITUDE", attitude(boot_ms, 1.0), heard_at_s)
        return snapshot.headings(0.0)[-1].displaced_m

    snapshot.fold("EXTENDED_SYS_STATE", {"landed_state": 1}, T0)
    displaced_m(1000, 0)
    assert displaced_m(1100, 3000) == 0.0  # on the ground the position may still be settling
    snapshot.fold("EXTENDED_SYS_STATE", {"landed_state": 2}, T0)
    assert displaced_m(1200, 3050) == 0.0
    assert displaced_m(1300, 5750) == pytest.approx(30.0, abs=0.5)
    assert displaced_m(1400, 5780) == pytest.approx(30.0, abs=0.5)
    assert displaced_m(1500, 3110) == pytest.approx(0.0, abs=1.0)


def test_in_air_without_a_landed_state_is_judged_by_height() -> None:
    snapshot = Snapshot()
    snapshot.fold("GLOBAL_POSITION_INT", HERE, T0)
    snapshot.fold("HEARTBEAT", {"custom_mode": 4, "base_mode": 81 | 128, "autopilot": 3}, T0)
    assert snapshot.in_air is True
    snapshot.fold("EXTENDED_SYS_STATE", {"landed_state": 1}, T0)
    assert snapshot.in_air is False


@pytest.mark.parametrize(
    ("roll", "pitch", "yaw", "north", "east"),
    [
        (0.0, -10.0, 0.0, 1.73, 0.0),
        (0.0, -10.0, 90.0, 0.0, 1.73),
        (10.0, 0.0, 0.0, 0.0, 1.73),
        (10.0, 0.0, 90.0, -1.73, 0.0),
    ],
)
def test_the_attitude_says_where_the_thrust_pushes(
    roll: float, pitch: float, yaw: float, north: float, east: float
) -> None:
    snapshot = Snapshot()
    angles = {"roll": math.radians(roll), "pitch": math.radians(pitch)}
    snapshot.fold("ATTITUDE", attitude(1000, math.radians(yaw)) | angles, T0)
    t = snapshot.telemetry(T0, True, "HOLD", NOBODY, "px4")
    assert (t.push_north_m_s2, t.push_east_m_s2) == pytest.approx((north, east), abs=0.01)
