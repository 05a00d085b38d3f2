from __future__ import annotations

import json
from datetime import UTC, datetime

import pytest

from backend.cli.demo import MissionLog, _sentence, summary
from backend.events import BeliefUpdated, EstimateFact, Event, MissionEnded, Recorded
from backend.settings import Settings
from backend.spec import Polygon
from hardware.frame import LocalFrame
from hardware.readings import GeoPoint

TRUTH = GeoPoint(50.0, 7.0)


def log(*events: Event) -> MissionLog:
    at = datetime(2026, 1, 1, tzinfo=UTC)
    return MissionLog("m", [Recorded(seq=i, mission_id="m", at_utc=at, event=e) for i, e in enumerate(events, 1)])


def belief(east: float, size: float) -> BeliefUpdated:
    frame = LocalFrame(TRUTH)
    place = frame.to_geo(east, 0.0)
    corners = (
        (east - size, -size),
        (east + size, -size),
        (east + size, size),
        (east - size, size),
        (east - size, -size),
    )
    ring = [(p.lon_deg, p.lat_deg) for p in (frame.to_geo(*corner) for corner in corners)]
    estimate = EstimateFact(
        lat=place.lat_deg,
        lon=place.lon_deg,
        expected_rmse_m=4.0,
        c95=Polygon(coordinates=[ring]),
        c95_area_m2=4 * size**2,
        major_axis_m=3.0,
        minor_axis_m=2.0,
        major_axis_deg=10.0,
    )
    return BeliefUpdated(bearings=2, estimate=estimate, consistent=True, localized=True, not_yet=[], digest="d")


def ended(outcome: str) -> MissionEnded:
    return MissionEnded(outcome=outcome, reason="because", mission_time_s=95.0)  # type: ignore[arg-type]


@pytest.mark.parametrize(("east", "size", "inside"), [(3.0, 10.0, True), (30.0, 10.0, False)])
def test_the_last_estimate_is_compared_with_the_truth(east: float, size: float, inside: bool) -> None:
    result = summary(log(belief(100.0, 5.0), belief(east, size), ended("localized")), Settings(seed=7), TRUTH)
    assert result["localized"]
    assert result["error_m"] == pytest.approx(east, rel=1e-3)
    assert result["in_c95"] is inside
    assert result["seed"] == 7
    assert result["database"].endswith("crossfix.sqlite")
    json.dumps(result, allow_nan=False)
    assert f"{east:.1f} m from the emitter" in _sentence(result)


def test_not_localized_is_said_with_its_reason_and_no_made_up_numbers() -> None:
    nothing = BeliefUpdated(bearings=3, estimate=None, consistent=False, localized=False, not_yet=["x"], digest="d")
    result = summary(log(nothing, ended("not_localized")), Settings(), TRUTH)
    assert not result["localized"]
    assert result["error_m"] is None
    assert result["in_c95"] is None
    assert result["expected_rmse_m"] is None
    assert "because" in _sentence(result)
