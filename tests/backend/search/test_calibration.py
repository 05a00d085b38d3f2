"""What checked missions say of sigma, offset, outliers, fixes, forecasts and flight times."""

from __future__ import annotations

import math
from datetime import UTC, datetime, timedelta

import numpy as np
import pytest
from facts import belief, plan
from ground import AREA, FRAME, bearing

from backend.events import Event, MissionDrafted, MissionStarted, PlaceReached, Recorded, TruthNoted
from backend.search.antenna import antenna_fact
from backend.search.calibration import Calibrated, calibrate
from backend.search.told import told as told_by
from backend.spec import MissionSpec, SensorSpec
from hardware.direction_finding.antenna import AntennaPattern

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


def calibrated(missions: dict[str, list[Recorded]], craft: str = "") -> Calibrated:
    return calibrate({mission_id: ("m", told_by(facts)) for mission_id, facts in missions.items()}, craft, "")


def seen_from(x: float, y: float, error_deg: float, sigma: float = 5.0) -> Event:
    compass = math.degrees(math.atan2(TARGET[0] - x, TARGET[1] - y)) + error_deg
    return bearing(x, y, compass % 360.0, sigma)


def test_sigma_offset_and_outliers_come_back() -> None:
    rng = np.random.default_rng(2)
    errors = rng.normal(6.0, 4.0, 60)
    places = rng.uniform([0.0, 0.0], [100.0, 100.0], (60, 2))
    events = [seen_from(x, y, error) for (x, y), error in zip(places, errors, strict=True)]
    wrong = [seen_from(10.0 * n, 0.0, 100.0) for n in range(3)]
    found = calibrated({"m": recorded(*events, *wrong, told())})
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
    found = calibrated({"a": few, "b": lost})
    assert (found.missions, found.not_found, len(found.bearings), found.suggested) == (2, 1, 1, None)
    assert calibrated({"a": few}, "another").missions == 0


def test_a_forecast_is_told_with_how_often_it_held_and_how_long_it_was() -> None:
    """Three plans, 3, 2 and 1 s before the emitter was localized, of which one said half a second; one plan came after,
    and one belongs to a search that never localized."""
    said = [plan().model_copy(update={"time_90_s": stated}) for stated in (90.0, 0.5, 30.0, 1000.0)]
    facts = recorded(*said[:3], belief(3, localized=True), said[3], told())
    found = calibrated({"m": facts, "n": recorded(said[3], told())})
    assert (found.forecast_90.of, found.forecast_90.share) == (3, pytest.approx(2 / 3))
    assert found.forecast_90_s == pytest.approx((90.0 + 0.5 + 30.0) / 3)
    assert found.forecast_took_s == pytest.approx((3.0 + 2.0 + 1.0) / 3)
    assert calibrated({}).forecast_90_s is None


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
    found = calibrated({"m": recorded(*reached, *errors, told())})
    assert found.suggested is not None
    assert found.suggested.speed_m_s == pytest.approx(8.0, rel=0.02)
    assert found.suggested.constant_s == pytest.approx(6.0, abs=0.3)


def flown(file_deg: float, taken_off_deg: float, true_deg: float, days: int, name: str = "yagi") -> list[Recorded]:
    """A checked mission of an antenna whose front is `true_deg` clockwise of the nose, and of what its file and its
    mission believed of that. Own errors of +-2 degrees."""
    mounted = file_deg - taken_off_deg
    spec = MissionSpec(name="m", area=AREA, sensor=SensorSpec(bearing_offset_deg=taken_off_deg))
    pattern = AntennaPattern(name, np.array([0.0, 180.0]), np.array([0.0, -9.0]), mounted)
    start = MissionStarted(
        craft_id="craft-1", by="a", home=FRAME.origin, home_amsl_m=0.0, software="test", antenna=antenna_fact(pattern)
    )
    errors = [seen_from(10.0 * n, 0.0, mounted - true_deg + 2.0 * (-1.0) ** n) for n in range(10)]
    facts = recorded(MissionDrafted(spec=spec), start, *errors, told())
    return [record.model_copy(update={"at_utc": record.at_utc + timedelta(days=days)}) for record in facts]


@pytest.mark.parametrize(
    ("flights", "offset_deg"),
    [
        ([flown(0.0, 0.0, -6.0, 0)], 6.0),
        ([flown(0.0, 0.0, -6.0, 0), flown(0.0, 6.0, -6.0, 1)], 6.0),  # taken over
        ([flown(0.0, 6.0, -6.0, 0)], 6.0),
        ([flown(0.0, 6.0, 0.0, 0)], 0.0),  # it was wrong to
        ([flown(-6.0, 0.0, -6.0, 2), flown(0.0, 0.0, -6.0, 0), flown(0.0, 6.0, -6.0, 1)], 0.0),  # put right in the file
        ([flown(0.0, 6.0, -6.0, 0), flown(30.0, 0.0, 24.0, 1, "loop")], 6.0),
        ([flown(180.0, 0.0, 0.0, 0)], 180.0),
    ],
)
def test_the_suggested_offset_is_the_whole_of_it_whatever_was_taken_off_before(
    flights: list[list[Recorded]], offset_deg: float
) -> None:
    found = calibrated({f"m{n}": facts for n, facts in enumerate(flights)})
    assert found.suggested is not None
    assert math.remainder(found.suggested.offset_deg - offset_deg, 360.0) == pytest.approx(0.0, abs=0.2)
    assert found.suggested.sigma_deg == pytest.approx(2.0, abs=0.2), "what was taken off is no error"
    assert found.outliers.share == 0.0


def test_errors_are_shown_as_they_were_flown() -> None:
    found = calibrated({"m": flown(0.0, 6.0, -6.0, 0)})
    assert [one.error_deg for one in found.bearings] == pytest.approx([2.0, -2.0] * 5, abs=0.01)
    assert found.within_1_sigma.share == 1.0
