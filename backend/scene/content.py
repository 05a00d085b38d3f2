"""What a mission's scene shows, read from its recorded events: the fold of the facts, in metres around the home.

Nothing here says how it is drawn. Frame: local east-north-up metres, z above the home. Bearings: degrees clockwise from
true north.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pymap3d
from numpy.typing import NDArray
from shapely.geometry.base import BaseGeometry

from backend.events import BearingMeasured, PlanChosen, Recorded, SweepRejected
from backend.mission import area as areas
from backend.mission.errors import MissionInputError
from backend.mission.ports import TrackPoint
from backend.mission.state import MissionState, evolve
from backend.spec import Place
from hardware.frame import LocalFrame
from hardware.readings import GeoPoint


@dataclass(frozen=True, slots=True)
class SweepMark:
    """One sweep where it was taken. bearing_deg None: it was rejected. counted False: rejected, or excluded by the
    operator. peaks: (bearing_deg, weight) of weaker directions. power_db: 180 bins of 2 degrees, NaN where empty."""

    place_number: int
    x: float
    y: float
    z: float
    bearing_deg: float | None
    sigma_deg: float
    quality: float
    counted: bool
    peaks: tuple[tuple[float, float], ...]
    power_db: NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class CandidateMark:
    """dropped_in_round None: survived. value_s: expected time until localized by way of it."""

    x: float
    y: float
    value_s: float
    dropped_in_round: int | None


@dataclass(frozen=True, slots=True)
class NextPlace:
    """expected_time_s None: not known. by_operator: the operator chose it."""

    number: int
    x: float
    y: float
    expected_time_s: float | None
    by_operator: bool


@dataclass(frozen=True, slots=True)
class EstimateMark:
    x: float
    y: float
    expected_rmse_m: float
    c95: BaseGeometry
    localized: bool


@dataclass(frozen=True, slots=True)
class VehicleMark:
    """heading_deg None: not known."""

    x: float
    y: float
    z: float
    heading_deg: float | None


@dataclass(frozen=True, slots=True)
class Content:
    """home: None before the start. path: (n, 3), in time order. next_place: where it flies or measures now, None when
    the mission is over or the place is not chosen yet. seq: the last event that is in here."""

    mission_id: str
    seq: int
    area: BaseGeometry
    fence: BaseGeometry
    no_fly: tuple[BaseGeometry, ...]
    flight_altitude_m: float
    highest_m: float
    home: tuple[float, float] | None
    sweeps: tuple[SweepMark, ...]
    candidates: tuple[CandidateMark, ...]
    next_place: NextPlace | None
    estimate: EstimateMark | None
    path: NDArray[np.float64]
    vehicle: VehicleMark | None


@dataclass(frozen=True, slots=True)
class Story:
    """A mission read up to one event: its state, and the sweeps that were rejected on the way."""

    mission_id: str
    seq: int
    at_s: float
    state: MissionState
    frame: LocalFrame
    rejected: tuple[SweepRejected, ...]
    plan: PlanChosen | None


def read_story(recorded: Sequence[Recorded], upto_seq: int | None = None) -> Story | None:
    """The mission after event `upto_seq` (None: the last). None when nothing is drafted by then."""
    state, rejected, plan = MissionState(), [], None
    seq, at_s = 0, 0.0
    for record in recorded:
        if upto_seq is not None and record.seq > upto_seq:
            break
        seq, at_s = record.seq, record.at_utc.timestamp()
        state = evolve(state, record.event, at_s)
        if isinstance(record.event, SweepRejected):
            rejected.append(record.event)
        elif isinstance(record.event, PlanChosen):
            plan = record.event
    if state.spec is None:
        return None
    return Story(recorded[0].mission_id, seq, at_s, state, local_frame(state), tuple(rejected), plan)


def local_frame(state: MissionState) -> LocalFrame:
    """Around the home; before the start around the middle of the area."""
    if state.home is not None:
        return LocalFrame(GeoPoint(state.home.lat, state.home.lon))
    return LocalFrame(areas.centre_of(state.mission.area))


def content(story: Story, track: Sequence[TrackPoint], vehicle: TrackPoint | None) -> Content:
    """`track`: the flown path; points after the story's last event are left out. `vehicle`: where it is now; None:
    where the path ends."""
    state, frame = story.state, story.frame
    mission = state.mission
    target = areas.area_geometry(mission.area, frame, "area", "the area")
    try:
        fence = areas.fence(mission, target, frame)
        no_fly = areas.no_fly(mission, frame)
    except MissionInputError:
        fence, no_fly = target, ()
    path = flown_path(frame, [point for point in track if point.at_s <= story.at_s])
    now = vehicle or next((point for point in reversed(track) if point.at_s <= story.at_s), None)
    over = state.outcome is not None
    return Content(
        mission_id=story.mission_id,
        seq=story.seq,
        area=target,
        fence=fence,
        no_fly=no_fly,
        flight_altitude_m=mission.flight.altitude_relative_m,
        highest_m=mission.flight.maximum_altitude_relative_m,
        home=None if state.home is None else (0.0, 0.0),
        sweeps=_sweeps(story),
        candidates=() if over else _candidates(story),
        next_place=None if over else _next_place(story),
        estimate=_estimate(story),
        path=path,
        vehicle=None if now is None else vehicle_mark(frame, now),
    )


def flown_path(frame: LocalFrame, track: Sequence[TrackPoint]) -> NDArray[np.float64]:
    """(n, 3) m; z is the height above the home. Points with an unknown number are left out."""
    if not track:
        return np.empty((0, 3))
    lat, lon, height = np.array([(point.lat_deg, point.lon_deg, point.altitude_relative_m) for point in track], float).T
    origin = frame.origin
    east, north, _ = pymap3d.geodetic2enu(lat, lon, 0.0, origin.lat_deg, origin.lon_deg, 0.0)
    path = np.column_stack((east, north, height))
    return path[np.isfinite(path).all(axis=1)]


def vehicle_mark(frame: LocalFrame, point: TrackPoint) -> VehicleMark | None:
    """None when its place or height is not a number."""
    path = flown_path(frame, [point])
    if not len(path):
        return None
    heading = float("nan") if point.heading_deg is None else point.heading_deg
    x, y, z = path[0].tolist()
    return VehicleMark(x, y, z, heading if np.isfinite(heading) else None)


def _xy(frame: LocalFrame, place: Place) -> tuple[float, float]:
    return frame.to_enu(GeoPoint(place.lat, place.lon))


def _sweeps(story: Story) -> tuple[SweepMark, ...]:
    """Rejected ones first, then the bearings, each in the order they were taken."""
    state = story.state
    height = state.mission.flight.altitude_relative_m
    marks = []
    for event in story.rejected:
        x, y = _xy(story.frame, event.place)
        power = _power(event.binned_db)
        marks.append(SweepMark(event.place_number, x, y, height, None, 0.0, event.quality, False, (), power))
    return (*marks, *(_bearing(story, event) for event in state.measured))


def _bearing(story: Story, event: BearingMeasured) -> SweepMark:
    x, y = _xy(story.frame, event.place)
    return SweepMark(
        place_number=event.place_number,
        x=x,
        y=y,
        z=max(0.0, event.altitude_amsl_m - story.state.home_amsl_m),
        bearing_deg=event.bearing_deg,
        sigma_deg=event.sigma_deg,
        quality=event.quality,
        counted=event.bearing_id not in story.state.excluded,
        peaks=tuple((peak.bearing_deg, peak.weight) for peak in event.peaks),
        power_db=_power(event.binned_db),
    )


def _power(binned_db: Sequence[float | None]) -> NDArray[np.float64]:
    return np.array([np.nan if value is None else value for value in binned_db], float)


def _candidates(story: Story) -> tuple[CandidateMark, ...]:
    marks = []
    for fact in story.plan.candidates if story.plan else ():
        x, y = story.frame.to_enu(GeoPoint(fact.lat, fact.lon))
        marks.append(CandidateMark(x, y, fact.value_s, fact.dropped_in_round))
    return tuple(marks)


def _next_place(story: Story) -> NextPlace | None:
    chosen = story.state.chosen
    if chosen is None:
        return None
    x, y = _xy(story.frame, chosen.place)
    return NextPlace(chosen.place_number, x, y, chosen.expected_time_s, chosen.source == "operator")


def _estimate(story: Story) -> EstimateMark | None:
    belief = story.state.belief
    if belief is None or belief.estimate is None:
        return None
    found = belief.estimate
    x, y = story.frame.to_enu(GeoPoint(found.lat, found.lon))
    region = areas.area_geometry(found.c95, story.frame, "c95", "the confidence region")
    return EstimateMark(x, y, found.expected_rmse_m, region, belief.localized)
