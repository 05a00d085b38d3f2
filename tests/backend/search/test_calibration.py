"""What checked missions say of sigma, offset, outliers, fixes, forecasts and flight times."""

from __future__ import annotations

import math
from datetime import UTC, datetime, timedelta

import numpy as np
import pytest
from ground import FRAME, bearing

from backend.events import Event, PlaceReached, Recorded, TruthNoted
from backend.search.calibration import calibrate, wilson

TARGET = (200.0, 80.0)


def told(place: tuple[float, float] | None = TARGET) -> TruthNoted:
    at = None if place is None else FRAME.to_geo(*place)
    return TruthNoted(emitter_id="emitter-1", place=at, accuracy_m=3.0, how="map", by="anna")


def recorded(*events: Event) -> list[Recorded]:
    start = datetime(2026, 5, 1, tzinfo=UTC)
    return [
        Recorded(seq=n, mission_id="m", at_utc=start + timedelta(seconds=n), event=event)
        for n, event in enumerate(events, 1)
    ]


def seen_from(x: float, y: float, error_deg: float, sigma: float = 5.0) -> Event:
    compass = math.degrees(math.atan2(TARGET[0] - x, TARGET[1] - y)) + error_deg
    return bearing(x, y, compass % 360.0, sigma)


def test_sigma_offset_and_outliers_come_back() -> None:
    rng = np.random.default_rng(2)
    errors = rng.normal(6.0, 4.0, 60)
    places = rng.uniform([0.0, 0.0], [100.0, 100.0], (60, 2))
    events = [seen_from(x, y, error) for (x, y), error in zip(places, errors, strict=True)]
    wrong = [seen_from(10.0 * n, 0.0, 100.0) for n in range(3)]
    found = calibrate({"m": ("one", recorded(*events, *wrong, told()))}, "", "")
    assert found.suggested is not None
    assert found.suggested.sigma_deg == pytest.approx(4.0, rel=0.25)
    assert found.suggested.offset_deg == pytest.approx(6.0, abs=3 * found.suggested.offset_std_error_deg)
    assert [one.error_deg for one in found.bearings if one.outlier] == pytest.approx([100.0] * 3, abs=0.1)
    assert found.suggested.outlier_probability == pytest.approx(3 / 63, abs=0.006)
    assert found.within_1_sigma.low < found.within_1_sigma.share < found.within_1_sigma.high
    assert found.sharpness_deg == 5.0


def test_few_bearings_suggest_nothing_and_not_found_counts() -> None:
    few = recorded(seen_from(0.0, 0.0, 1.0), told())
    lost = recorded(seen_from(0.0, 0.0, 1.0), told(), told(None))
    found = calibrate({"a": ("a", few), "b": ("b", lost)}, "", "")
    assert (found.missions, found.not_found, len(found.bearings), found.suggested) == (2, 1, 1, None)
    assert calibrate({"a": ("a", few)}, "another", "").missions == 0


def test_flight_times_suggest_a_movement_model() -> None:
    reached = [
        PlaceReached(
            craft_id="craft-1",
            place_number=n,
            place=FRAME.to_geo(0.0, float(n * n * 10)),
            distance_m=0.0,
            flight_time_s=max(0.1, (n * n - (n - 1) ** 2) * 10 / 8.0 + 6.0),
        )
        for n in range(1, 14)
    ]
    errors = [seen_from(10.0 * n, 0.0, (-1.0) ** n) for n in range(10)]
    found = calibrate({"m": ("m", recorded(*reached, *errors, told()))}, "", "")
    assert found.suggested is not None
    assert found.suggested.speed_m_s == pytest.approx(8.0, rel=0.02)
    assert found.suggested.constant_s == pytest.approx(6.0, abs=0.3)


def test_an_interval_is_wilsons() -> None:
    found = wilson(8, 10)  # 0.49 to 0.94: Wilson 1927, as statsmodels' proportion_confint
    assert (found.share, found.low, found.high) == pytest.approx((0.8, 0.4902, 0.9433), abs=1e-3)
    assert (wilson(0, 0).low, wilson(0, 0).high) == (0.0, 1.0)
