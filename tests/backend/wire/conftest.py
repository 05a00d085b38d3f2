"""A small mission with two bearings, one of them excluded later, an estimate, and three points of path."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta

import pytest

from backend.events import (
    BearingExcluded,
    BearingMeasured,
    BeliefUpdated,
    EstimateFact,
    Event,
    MissionDrafted,
    MissionStarted,
    Recorded,
)
from backend.mission.ports import TrackPoint
from backend.spec import EmitterSpec, MissionSpec, Place, Polygon

BEGAN = datetime(2026, 5, 1, 12, tzinfo=UTC)
AREA = Polygon(coordinates=[[(7.20, 50.62), (7.21, 50.62), (7.21, 50.63), (7.20, 50.63), (7.20, 50.62)]])


def bearing(number: int, lat: float, lon: float, bearing_deg: float) -> BearingMeasured:
    return BearingMeasured(
        bearing_id=f"b{number}",
        sweep_id=f"s{number}",
        place_number=number,
        place=Place(lat=lat, lon=lon),
        altitude_amsl_m=240.0,
        bearing_deg=bearing_deg,
        sigma_deg=6.0,
        quality=0.9,
        peaks=[],
        snr_db=20.0,
        drift_m=0.5,
        binned_db=[None] * 180,
        fitted_db=[None] * 180,
    )


@pytest.fixture(scope="module")
def recorded() -> list[Recorded]:
    estimate = EstimateFact(
        lat=50.625,
        lon=7.205,
        expected_rmse_m=9.8,
        c95=AREA,
        c95_area_m2=4100.0,
        major_axis_m=20.0,
        minor_axis_m=5.0,
        major_axis_deg=30.0,
    )
    emitter = EmitterSpec(label="fox & <hound>")
    events: list[Event] = [
        MissionDrafted(spec=MissionSpec(name='Meadow "A" & <B>', area=AREA, emitter=emitter)),
        MissionStarted(by="op", home=Place(lat=50.62, lon=7.205), home_amsl_m=200.0, software="test"),
        bearing(1, 50.622, 7.202, 45.0),
        bearing(2, 50.622, 7.208, 315.0),
        BeliefUpdated(
            bearings=2, estimate=estimate, consistent=True, localized=False, not_yet=["one side"], digest="0"
        ),
        bearing(3, 50.621, 7.205, 10.0),
        BearingExcluded(bearing_id="b3", by="op", reason="multipath"),
    ]
    return [
        Recorded(seq=seq, mission_id="m1", at_utc=BEGAN + timedelta(seconds=10 * seq), event=event)
        for seq, event in enumerate(events, start=1)
    ]


@pytest.fixture(scope="module")
def track() -> list[TrackPoint]:
    began_s, unknown = BEGAN.timestamp(), float("nan")
    return [
        TrackPoint(began_s + 21, 50.6201, 7.205, 230.0, 30.0, 0.0, 90.0, "GUIDED"),
        TrackPoint(began_s + 21.5, 50.6202, 7.205, unknown, 31.0, unknown, None, None),
        TrackPoint(began_s + 22, unknown, 7.205, 230.0, 32.0, 0.0, 90.0, "GUIDED"),
    ]
