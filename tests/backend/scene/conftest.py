"""A mission as its journal tells it: three bearings, one rejected sweep, a plan with candidates, and the flown path."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta

import numpy as np
import pytest

from backend.events import (
    FIRST_CRAFT,
    BearingMeasured,
    CandidateFact,
    CraftSource,
    Event,
    FlightStarted,
    MissionDrafted,
    MissionStarted,
    Peak,
    PlanChosen,
    Recorded,
    SweepRejected,
)
from backend.ports import TrackPoint
from backend.reasons.search import Localized
from backend.search.localization import localization
from backend.spec import FIRST_EMITTER, EmitterSpec, FlightSpec, MissionSpec, Polygon
from hardware.frame import LocalFrame
from hardware.readings import Place
from hardware.reasons.sweep import NoPulseHeard

HOME = Place(lat=50.6234, lon=7.2046)
HOME_AMSL_M = 200.0
FRAME = LocalFrame(HOME)
EMITTER = (40.0, 130.0)
PLACES = ((0.0, 20.0), (-95.0, 75.0), (-20.0, 190.0), (120.0, 190.0))


def place(x: float, y: float) -> Place:
    point = FRAME.to_geo(x, y)
    return point


def polygon(corners: Iterable[tuple[float, float]]) -> Polygon:
    ring = [(at.lon, at.lat) for at in (place(x, y) for x, y in corners)]
    return Polygon(coordinates=[[*ring, ring[0]]])


def bearing_to(x: float, y: float) -> float:
    return math.degrees(math.atan2(EMITTER[0] - x, EMITTER[1] - y)) % 360.0


@dataclass
class Log:
    """Records events one second apart."""

    recorded: list[Recorded] = field(default_factory=list)
    at_utc: datetime = datetime(2026, 5, 1, 12, tzinfo=UTC)

    def add(self, event: Event) -> None:
        self.at_utc += timedelta(seconds=1)
        seq = len(self.recorded) + 1
        self.recorded.append(Recorded(seq=seq, mission_id="m1", at_utc=self.at_utc, event=event))


def bearing(number: int, x: float, y: float) -> BearingMeasured:
    direction = bearing_to(x, y)
    off = np.radians((np.arange(180) * 2 + 1) - direction)
    power: list[float | None] = [float(value) for value in -60 + 10 * np.log10(np.maximum(np.cos(off / 2) ** 8, 0.003))]
    return BearingMeasured(
        emitter_id=FIRST_EMITTER,
        source=CraftSource(craft_id=FIRST_CRAFT),
        bearing_id=f"b{number}",
        sweep_id=f"s{number}",
        place_number=number,
        place=place(x, y),
        altitude_amsl_m=HOME_AMSL_M + 40.0,
        bearing_deg=direction,
        sigma_deg=6.0,
        quality=0.9,
        peaks=[Peak(bearing_deg=(direction + 130) % 360, weight=0.3)] if number == 2 else [],
        snr_db=20.0,
        drift_m=0.5,
        binned_db=power,
        fitted_db=list(power),
    )


@pytest.fixture(scope="module")
def spec() -> MissionSpec:
    area = polygon([(-150, 0), (163, -10), (170, 150), (60, 210), (-140, 180)])
    zone = polygon([(90, 100), (140, 100), (140, 150), (90, 150)])
    return MissionSpec(name="sample", area=area, flight=FlightSpec(no_fly=[zone]))


@pytest.fixture(scope="module")
def recorded(spec: MissionSpec) -> list[Recorded]:
    log = Log()
    log.add(MissionDrafted(spec=spec))
    log.add(MissionStarted(craft_id=FIRST_CRAFT, by="test", home=HOME, home_amsl_m=HOME_AMSL_M, software="test"))
    task = localization(spec, HOME)
    measured: list[BearingMeasured] = []
    for number, (x, y) in enumerate(PLACES[:3], start=1):
        if number == 2:
            silent: list[float | None] = [None] * 90 + [-80.0] * 90
            log.add(
                SweepRejected(
                    emitter_id=FIRST_EMITTER,
                    source=CraftSource(craft_id=FIRST_CRAFT),
                    sweep_id="r1",
                    place_number=2,
                    attempt=1,
                    quality=0.4,
                    reason=NoPulseHeard(),
                    place=place(x, y),
                    binned_db=silent,
                    fitted_db=[None] * 180,
                )
            )
        measured.append(bearing(number, x, y))
        log.add(measured[-1])
        log.add(task.belief_fact(measured)[0])
        there = place(*PLACES[number])
        log.add(
            PlanChosen(
                craft_id=FIRST_CRAFT,
                place_number=number + 1,
                place=there,
                source="planner",
                reason=Localized(),
                expected_time_s=83.0,
                time_90_s=120.0,
                candidates=candidates(),
                rollouts=100,
                plan_ms=5.0,
            )
        )
    log.add(
        FlightStarted(craft_id=FIRST_CRAFT, place_number=4, place=place(*PLACES[3]), altitude_amsl_m=HOME_AMSL_M + 40)
    )
    return log.recorded


def candidates() -> list[CandidateFact]:
    found = []
    for index, (x, y) in enumerate([(120, 190), (100, 190), (-100, 60), (0, 0)]):
        at = place(x, y)
        found.append(
            CandidateFact(
                lat=at.lat,
                lon=at.lon,
                value_s=100.0 + index,
                std_error_s=1.0,
                rollouts=20,
                dropped_in_round=None if index == 0 else 4 - index,
            )
        )
    return found


@pytest.fixture(scope="module")
def track(recorded: list[Recorded]) -> list[TrackPoint]:
    """Two points a second from the start to the last event, northwards at 40 m."""
    began, ended = recorded[1].at_utc.timestamp(), recorded[-1].at_utc.timestamp()
    points = []
    for index, at_s in enumerate(np.arange(began, ended + 0.25, 0.5)):
        at = place(0.0, 3.0 * index)
        points.append(TrackPoint(float(at_s), at.lat, at.lon, 240.0, 40.0, 90.0, 80.0, "GUIDED"))
    return points


@pytest.fixture(scope="module")
def two_emitters(spec: MissionSpec) -> list[Recorded]:
    """The first is localized, of the other there is one bearing."""
    emitters = [EmitterSpec(label="fox"), EmitterSpec(emitter_id="emitter-2", label="hare", frequency_hz=868.4e6)]
    both = spec.model_copy(update={"emitters": emitters})
    log = Log()
    log.add(MissionDrafted(spec=both))
    log.add(MissionStarted(craft_id=FIRST_CRAFT, by="test", home=HOME, home_amsl_m=HOME_AMSL_M, software="test"))
    measured = [bearing(number, x, y) for number, (x, y) in enumerate(PLACES[:3], start=1)]
    for fact in measured:
        log.add(fact)
    found, _ = localization(both, HOME, FIRST_EMITTER).belief_fact(measured)
    log.add(found.model_copy(update={"localized": True}))
    log.add(bearing(3, *PLACES[2]).model_copy(update={"emitter_id": "emitter-2", "bearing_id": "b4"}))
    return log.recorded
