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
from backend.mission.state import MissionState, evolve
from backend.ports import TrackPoint
from backend.scene.relief import Relief
from backend.search import area as areas
from backend.search.emitter import EmitterState
from backend.search.errors import MissionInputError
from hardware.frame import LocalFrame
from hardware.readings import Place


@dataclass(frozen=True, slots=True)
class SweepMark:
    """One sweep where it was taken. bearing_deg None: it was rejected. counted False: rejected, or excluded by the
    operator. quality None: there was no sweep to measure it.
    peaks: (bearing_deg, weight) of weaker directions. power_db: 180 bins of 2 degrees, NaN where empty."""

    place_number: int
    x: float
    y: float
    z: float
    bearing_deg: float | None
    sigma_deg: float
    quality: float | None
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
    """name: of the emitter, empty when it is the only one."""

    emitter_id: str
    name: str
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
    """home: None before the start. path: (n, 3), in time order. next_places: where the craft fly or measure now;
    none when the mission is over or no place is chosen yet. relief: None where the ground is taken to be flat. seq: the
    last event that is in here."""

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
    next_places: tuple[NextPlace, ...]
    estimates: tuple[EstimateMark, ...]
    path: NDArray[np.float64]
    vehicle: VehicleMark | None
    relief: Relief | None = None


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

    @property
    def emitter(self) -> EmitterState:
        """The one whose belief is shown: the most important that is not localized, else the first."""
        search = self.state.search
        return search.sought[0] if search.wanted else next(iter(search.emitters.values()))


def read_story(recorded: Sequence[Recorded], upto_seq: int | None = None) -> Story | None:
    """The mission after event `upto_seq` (None: the last). None when nothing is drafted by then."""
    state, plan = MissionState(), None
    rejected: list[SweepRejected] = []
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
    if state.search.spec is None:
        return None
    return Story(recorded[0].mission_id, seq, at_s, state, local_frame(state), tuple(rejected), plan)


def local_frame(state: MissionState) -> LocalFrame:
    """Around the home; before the start around the middle of the area."""
    if state.search.home is not None:
        return LocalFrame(state.search.home)
    return LocalFrame(areas.centre_of(state.search.mission.area))


def content(story: Story, track: Sequence[TrackPoint], vehicle: TrackPoint | None) -> Content:
    """`track`: the flown path; points after the story's last event are left out. `vehicle`: where it is now; None:
    where the path ends."""
    state, frame = story.state, story.frame
    mission = state.search.mission
    target = areas.area_geometry(mission.area, frame, "area", "area")
    try:
        fence = areas.fence(mission, target, frame)
        no_fly = areas.no_fly(mission, frame)
    except MissionInputError:
        fence, no_fly = target, ()
    path = flown_path(frame, [point for point in track if point.at_s <= story.at_s])
    now = vehicle or next((point for point in reversed(track) if point.at_s <= story.at_s), None)
    over = state.search.outcome is not None
    return Content(
        mission_id=story.mission_id,
        seq=story.seq,
        area=target,
        fence=fence,
        no_fly=no_fly,
        flight_altitude_m=mission.flight.altitude_relative_m,
        highest_m=mission.flight.maximum_altitude_relative_m,
        home=None if state.search.home is None else (0.0, 0.0),
        sweeps=_sweeps(story),
        candidates=() if over else _candidates(story),
        next_places=() if over else _next_places(story),
        estimates=_estimates(story),
        path=path,
        vehicle=None if now is None else vehicle_mark(frame, now),
    )


def flown_path(frame: LocalFrame, track: Sequence[TrackPoint]) -> NDArray[np.float64]:
    """(n, 3) m; z is the height above the home. Points with an unknown number are left out."""
    if not track:
        return np.empty((0, 3))
    flown = np.array([(point.lat_deg, point.lon_deg, point.altitude_relative_m) for point in track], np.float64)
    lat, lon, height = flown[:, 0], flown[:, 1], flown[:, 2]
    origin = frame.origin
    east, north, _ = pymap3d.geodetic2enu(lat, lon, 0.0, origin.lat, origin.lon, 0.0)
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
    return frame.to_enu(place)


def _sweeps(story: Story) -> tuple[SweepMark, ...]:
    """Rejected ones first, then the bearings, each in the order they were taken."""
    state = story.state
    height = state.search.mission.flight.altitude_relative_m
    marks: list[SweepMark] = []
    for event in story.rejected:
        x, y = _xy(story.frame, event.place)
        power = _power(event.binned_db)
        marks.append(SweepMark(event.place_number, x, y, height, None, 0.0, event.quality, False, (), power))
    return (*marks, *(_bearing(story, event) for event in state.search.measured))


def _bearing(story: Story, event: BearingMeasured) -> SweepMark:
    x, y = _xy(story.frame, event.place)
    return SweepMark(
        place_number=event.place_number,
        x=x,
        y=y,
        z=max(0.0, event.altitude_amsl_m - story.state.search.home_amsl_m),
        bearing_deg=event.bearing_deg,
        sigma_deg=event.sigma_deg,
        quality=None if event.sweep_id is None else event.quality,
        counted=story.state.search.emitters[event.emitter_id].counts(event),
        peaks=tuple((peak.bearing_deg, peak.weight) for peak in event.peaks),
        power_db=_power(event.binned_db),
    )


def _power(binned_db: Sequence[float | None]) -> NDArray[np.float64]:
    return np.array([np.nan if value is None else value for value in binned_db], float)


def _candidates(story: Story) -> tuple[CandidateMark, ...]:
    marks: list[CandidateMark] = []
    for fact in story.plan.candidates if story.plan else ():
        x, y = story.frame.to_enu(Place(fact.lat, fact.lon))
        marks.append(CandidateMark(x, y, fact.value_s, fact.dropped_in_round))
    return tuple(marks)


def _next_places(story: Story) -> tuple[NextPlace, ...]:
    marks: list[NextPlace] = []
    for craft in story.state.crafts.values():
        if (chosen := craft.chosen) is not None:
            x, y = _xy(story.frame, chosen.place)
            marks.append(
                NextPlace(chosen.place_number, x, y, chosen.expected_time_s, by_operator=chosen.source == "operator")
            )
    return tuple(marks)


def _estimates(story: Story) -> tuple[EstimateMark, ...]:
    """Of every emitter of which there is one."""
    search = story.state.search
    marks: list[EstimateMark] = []
    for emitter in search.emitters.values():
        if emitter.belief is None or (found := emitter.belief.measured_estimate) is None:
            continue
        x, y = story.frame.to_enu(Place(found.lat, found.lon))
        region = areas.area_geometry(found.c95, story.frame, "c95", "confidence_region")
        name = search.mission.emitter(emitter.emitter_id).label if len(search.emitters) > 1 else ""
        marks.append(
            EstimateMark(emitter.emitter_id, name, x, y, found.expected_rmse_m, region, emitter.belief.localized)
        )
    return tuple(marks)
