"""What every DirectionFinder must do."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import pytest

from hardware.direction_finding.estimate import SparseDirectionFinder
from hardware.direction_finding.least_squares import CorrelationDirectionFinder, LeastSquaresDirectionFinder
from hardware.direction_finding.pattern_file import SMALL_YAGI, load_pattern
from hardware.ports import DirectionFinder
from hardware.readings import Place, Sweep

PATTERN = load_pattern(SMALL_YAGI)
HEADING = np.arange(0.0, 360.0, 1.5)


@pytest.fixture(params=[SparseDirectionFinder, LeastSquaresDirectionFinder, CorrelationDirectionFinder])
def finder(request: pytest.FixtureRequest) -> DirectionFinder:
    return request.param()


def sweep(bearing_deg: float, noise_db: float = 0.0, **more: object) -> Sweep:
    rng = np.random.default_rng(5)
    power = -60.0 + PATTERN.gain_at(bearing_deg - HEADING) + rng.normal(0.0, 1.0, HEADING.size) * noise_db
    base = Sweep(HEADING / 30.0, HEADING, power, 868e6, Place(50.0, 7.0), 100.0)
    return dataclasses.replace(base, **more)


@pytest.mark.parametrize("bearing_deg", [0.0, 0.4, 91.3, 180.0, 359.9])
def test_points_at_the_emitter(finder: DirectionFinder, bearing_deg: float) -> None:
    reading = finder.estimate(sweep(bearing_deg, noise_db=0.5), PATTERN)
    assert reading.accepted, reading.reason
    assert 0.0 <= reading.bearing_deg < 360.0
    assert abs((reading.bearing_deg - bearing_deg + 180.0) % 360.0 - 180.0) < 2.0
    assert 0.0 < reading.sigma_deg < 20.0
    assert 0.7 <= reading.quality <= 1.0
    assert reading.binned_db.shape == reading.fitted_db.shape == (180,)


def test_antenna_offset_turns_the_bearing(finder: DirectionFinder) -> None:
    turned = dataclasses.replace(PATTERN, offset_to_nose_deg=40.0)
    assert finder.estimate(sweep(100.0), turned).bearing_deg == pytest.approx(140.0, abs=1.5)


def test_is_pure(finder: DirectionFinder) -> None:
    first, again = finder.estimate(sweep(77.0, 1.0), PATTERN), finder.estimate(sweep(77.0, 1.0), PATTERN)
    assert first.bearing_deg == again.bearing_deg
    assert first.sigma_deg == again.sigma_deg


@pytest.mark.parametrize(
    "bad",
    [
        {"power_db": np.full(HEADING.size, np.nan)},
        {"clipped_samples": HEADING.size},
        {"power_db": np.full(HEADING.size, -80.0)},
        {"at_s": np.empty(0), "heading_deg": np.empty(0), "power_db": np.empty(0)},
        {"heading_deg": np.full(HEADING.size, 12.0)},
    ],
)
def test_useless_sweeps_are_rejected_with_a_reason(finder: DirectionFinder, bad: dict[str, Any]) -> None:
    reading = finder.estimate(sweep(10.0, **bad), PATTERN)
    assert not reading.accepted
    assert reading.reason
    assert np.isfinite([reading.bearing_deg, reading.sigma_deg, reading.quality]).all()
