"""Declination against published values; clock offset from a turn to both sides."""

from __future__ import annotations

from datetime import UTC, datetime

import numpy as np
import pytest
from refusals import refusing

from hardware.direction_finding.heading import HeadingError, declination_deg, estimate_clock_offset, made_true
from hardware.direction_finding.pattern_file import SMALL_YAGI, load_pattern
from hardware.readings import HeadingSample, Place, PowerSample, Sweep
from hardware.reasons.antenna import NoMagneticModel

PATTERN = load_pattern(SMALL_YAGI)


def at(year: int) -> float:
    return datetime(year, 1, 1, tzinfo=UTC).timestamp()


@pytest.mark.parametrize(
    ("lat", "lon", "year", "declination"),
    # test values of the WMM2025 report: 0 km, date 2025.0
    [(80.0, 0.0, 2025, 1.28), (0.0, 120.0, 2025, -0.16), (-80.0, 240.0, 2025, 68.78)],
)
def test_declination_is_the_models(lat: float, lon: float, year: int, declination: float) -> None:
    lon = (lon + 180.0) % 360.0 - 180.0
    assert declination_deg(Place(lat, lon), at(year)) == pytest.approx(declination, abs=0.03)


def test_true_headings_wrap_and_dates_without_a_model_are_refused() -> None:
    place = Place(-80.0, -120.0)
    magnetic = Sweep(np.zeros(2), np.array([10.0, 350.0]), np.zeros(2), 868e6, place, 0.0)
    east = declination_deg(place, at(2025))
    assert made_true(magnetic, place, at(2025)).heading_deg == pytest.approx([10.0 + east, (350.0 + east) % 360.0])
    with refusing(NoMagneticModel(1999), HeadingError):
        declination_deg(place, at(1999))


def turn(offset_s: float, both_ways: bool) -> tuple[list[PowerSample], list[HeadingSample]]:
    rng = np.random.default_rng(1)

    def nose(t: np.ndarray) -> np.ndarray:
        return 30.0 * t if not both_ways else np.where(t < 12.0, 30.0 * t, 360.0 - 30.0 * (t - 12.0))

    times = np.arange(0.0, 24.0, 0.05)
    power = PATTERN.gain_at(100.0 - nose(times)) + rng.normal(0.0, 1.0, times.size)
    samples = [PowerSample(float(t + offset_s), 868e6, float(p)) for t, p in zip(times, power, strict=True)]
    track = np.arange(-3.0, 27.0, 0.1)
    return samples, [HeadingSample(float(t), float(nose(np.array(t)) % 360.0), Place(50, 7)) for t in track]


@pytest.mark.parametrize("offset_s", [-0.6, 0.0, 0.37])
def test_a_turn_to_both_sides_tells_the_clock_offset(offset_s: float) -> None:
    found = estimate_clock_offset(*turn(offset_s, both_ways=True), PATTERN)
    assert found.identified
    assert found.offset_s == pytest.approx(offset_s, abs=0.04)


def test_a_steady_turn_cannot_tell_it_and_says_so() -> None:
    assert not estimate_clock_offset(*turn(0.3, both_ways=False), PATTERN).identified
