"""Readings of a leg count at their own place, heading and time, or are left out with a reason; never guessed."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from hardware.direction_finding.on_the_way import (
    BESIDE_M,
    MOST_STRETCHES,
    OnTheWay,
    WayError,
    WayReadings,
    heard_on_the_way,
)
from hardware.frame import LocalFrame
from hardware.readings import HeadingSample, Place, PowerSample

BEGIN = Place(50.6234, 7.2046)
FRAME = LocalFrame(BEGIN)
SPEED_M_S = 8.0


def leg(
    length_m: float = 120.0, turn_deg_s: float = 30.0, rate_hz: float = 10.0
) -> tuple[list[PowerSample], list[HeadingSample]]:
    """Eastward; the power tells the time, so that a reading can be known again."""
    at = np.arange(0.0, length_m / SPEED_M_S, 1.0 / rate_hz)
    samples = [PowerSample(t, 868e6, -60.0 + t, -120.0) for t in at]
    headings = [HeadingSample(t, (350.0 + turn_deg_s * t) % 360.0, FRAME.to_geo(SPEED_M_S * t, 0.0)) for t in at]
    return samples, headings


def heard(
    samples: list[PowerSample], headings: list[HeadingSample], turned_at: tuple[Place, ...] = (), offset: float = 0.0
) -> OnTheWay:
    return heard_on_the_way(samples, headings, offset, BEGIN, turned_at)


def left_out(found: OnTheWay) -> dict[str, int]:
    return {one.why: one.readings for one in found.left_out}


def test_each_reading_has_the_place_and_heading_of_its_own_time() -> None:
    samples, headings = leg()
    later = [replace(one, at_s=one.at_s + 0.037) for one in samples]  # between two headings
    found = heard(later, headings, offset=90.0)
    readings = found.readings
    at = readings.power_db - readings.power_db[0] + readings.east_m[0] / SPEED_M_S  # a mean tells the mean of times
    assert 0.03 < at[0] < 0.15
    assert readings.east_m == pytest.approx(SPEED_M_S * at, abs=0.05)
    assert readings.front_deg == pytest.approx(350.0 + 90.0 + 30.0 * at, abs=0.05)
    assert found.counted == len(samples) - 1, "the last was heard after the last heading"
    assert left_out(found) == {"heading_unknown": 1}


def test_stretches_are_about_20_m_long() -> None:
    readings = heard(*leg(length_m=130.0)).readings
    assert set(readings.stretch) == set(range(6))
    for k in range(6):
        assert 15.0 < np.ptp(readings.east_m[readings.stretch == k]) < 25.0


def test_headings_that_are_too_far_apart_are_not_bridged() -> None:
    samples, headings = leg(turn_deg_s=10.0)
    gap = [one for one in headings if not 4.0 <= one.at_s <= 6.0]
    found = heard(samples, gap)
    assert left_out(found)["heading_unknown"] == pytest.approx(21, abs=1)
    assert not ((found.readings.power_db > 4.5) & (found.readings.power_db < 5.5)).any()


@pytest.mark.parametrize(
    "unsure",
    [
        lambda one: replace(one, position=None),
        lambda one: replace(one, displaced_m=9.0),
        lambda one: replace(one, position=FRAME.to_geo(40.0, 0.0)),  # no longer told
    ],
)
def test_where_the_place_is_not_known_nothing_counts(unsure) -> None:  # type: ignore[no-untyped-def]
    samples, headings = leg()
    found = heard(samples, [unsure(one) if 5.0 <= one.at_s <= 8.0 else one for one in headings])
    assert left_out(found)["place_unknown"] == pytest.approx(31, abs=2)
    assert not ((found.readings.power_db > 5.3) & (found.readings.power_db < 7.7)).any()


def test_powers_that_tell_nothing_are_left_out() -> None:
    samples, headings = leg()
    samples[20] = replace(samples[20], clipped=True)
    samples[30] = replace(samples[30], power_db=-117.0)
    samples[40] = replace(samples[40], power_db=math.nan)
    samples[50] = replace(samples[50], detected=False)
    found = heard(samples, headings)
    assert left_out(found) == {"overdriven": 1, "at_noise": 2}
    assert found.counted == len(samples) - 4, "a pulse that was not heard is no reading"


def test_beside_a_turn_nothing_counts_twice() -> None:
    samples, headings = leg()
    found = heard(samples, headings, turned_at=(BEGIN, FRAME.to_geo(120.0, 0.0)))
    assert found.readings.east_m.min() >= BESIDE_M - 0.1
    assert found.readings.east_m.max() <= 120.0 - BESIDE_M + 0.1
    assert left_out(found)["beside_a_turn"] > 0


def test_an_antenna_that_points_one_way_tells_no_direction() -> None:
    found = heard(*leg(turn_deg_s=0.0))
    assert found.counted == 0
    assert left_out(found) == {"pointed_one_way": 150}
    assert found.readings.packed()


def test_a_long_leg_keeps_the_stretches_that_turned_furthest() -> None:
    samples, headings = leg(length_m=1000.0, turn_deg_s=10.0)
    headings = [replace(h, heading_deg=min(h.heading_deg, 350.0) if h.at_s < 30.0 else h.heading_deg) for h in headings]
    found = heard(samples, headings)
    assert found.readings.stretch.max() == MOST_STRETCHES - 1
    assert left_out(found)["too_many"] > 0
    assert len(found.readings.packed()) < 8_000


def test_nothing_heard_and_no_headings_are_no_readings() -> None:
    samples, headings = leg()
    assert heard([], headings).counted == 0
    assert left_out(heard(samples, [])) == {"heading_unknown": len(samples)}


def test_packed_readings_come_back_to_their_tenths() -> None:
    readings = heard(*leg()).readings
    again = WayReadings.unpacked(BEGIN, readings.packed())
    assert (again.stretch == readings.stretch).all()
    for name in ("east_m", "north_m", "front_deg", "power_db"):
        assert getattr(again, name) == pytest.approx(getattr(readings, name), abs=0.051)


@pytest.mark.parametrize("damaged", ["", "no base64!", "AAAA", "eJwzNDI2MTUzBwAFmwFt"])
def test_damaged_readings_are_refused(damaged: str) -> None:
    packed = heard(*leg()).readings.packed()
    for text in (damaged, packed[: len(packed) // 2]):
        with pytest.raises(WayError):
            WayReadings.unpacked(BEGIN, text)
