"""A small mission with three bearings, one of them excluded later, and an estimate: for what is made of it to read."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta

from backend.events import (
    BearingExcluded,
    BearingMeasured,
    BeliefUpdated,
    CraftSource,
    EstimateFact,
    Event,
    MissionDrafted,
    MissionStarted,
    Recorded,
)
from backend.spec import EmitterSpec, MissionSpec, Place, Polygon
from planner.reasons import NoBearingYet

BEGAN = datetime(2026, 5, 1, 12, tzinfo=UTC)
AREA = Polygon(coordinates=[[(7.20, 50.62), (7.21, 50.62), (7.21, 50.63), (7.20, 50.63), (7.20, 50.62)]])


def bearing(number: int, lat: float, lon: float, bearing_deg: float) -> BearingMeasured:
    return BearingMeasured(
        emitter_id="fox",
        source=CraftSource(craft_id="craft-1"),
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


def mission(*emitters: EmitterSpec) -> list[Event]:
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
    home = Place(lat=50.62, lon=7.205)
    return [
        MissionDrafted(spec=MissionSpec(name='Meadow "A" & <B>', area=AREA, emitters=list(emitters))),
        MissionStarted(craft_id="craft-1", by="op", home=home, home_amsl_m=200.0, software="test"),
        bearing(1, 50.622, 7.202, 45.0),
        bearing(2, 50.622, 7.208, 315.0),
        BeliefUpdated(
            emitter_id="fox",
            bearings=2,
            estimate=estimate,
            consistent=True,
            localized=False,
            not_yet=[NoBearingYet()],
            digest="0",
        ),
        bearing(3, 50.621, 7.205, 10.0),
        BearingExcluded(emitter_id="fox", bearing_id="b3", by="op", reason="multipath"),
    ]


def numbered(events: list[Event]) -> list[Recorded]:
    return [
        Recorded(seq=seq, mission_id="m1", at_utc=BEGAN + timedelta(seconds=10 * seq), event=event)
        for seq, event in enumerate(events, start=1)
    ]


FOX = EmitterSpec(emitter_id="fox", label="fox & <hound>")
TAG = EmitterSpec(emitter_id="tag", frequency_hz=150e6, label="tag")
