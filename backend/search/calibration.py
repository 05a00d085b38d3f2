"""How right bearings, fixes and forecasts were where the truth is known: pure, over the facts of many missions.

A bearing's error is measured against the place that somebody told; the offset is what bearings have in common, together
with what missions had already taken off them, so that it is the whole of it however often it is taken over.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from itertools import pairwise

import numpy as np
from shapely.geometry import Point, shape

from backend.events import (
    AntennaFact,
    BeliefUpdated,
    CraftSource,
    MissionDrafted,
    MissionEdited,
    MissionStarted,
    PlaceReached,
    PlanChosen,
    Recorded,
    TruthNoted,
)
from backend.search.counted import counted
from hardware.frame import LocalFrame
from hardware.readings import Place
from planner.motion import fit_motion
from planner.types import FloatArray, LinearConstantMotion, LinearMotion, PlannerError

FACTS_NEEDED = (
    "mission_drafted",
    "mission_edited",
    "mission_started",
    "plan_chosen",
    "place_reached",
    "bearing_measured",
    "bearing_excluded",
    "bearing_included",
    "belief_updated",
    "truth_noted",
)
BEARINGS_NEEDED = 8
"""Fewer suggest nothing: their standard deviation is itself unknown by a quarter."""
FEWEST_FLIGHTS = 8

OUTLIER_SIGMAS = 4.0
"""An error is an outlier beyond this many robust standard deviations (1.4826 times the median absolute deviation, which
is the standard deviation of a normal distribution), and never below LEAST_OUTLIER_DEG."""
LEAST_OUTLIER_DEG = 15.0


@dataclass(frozen=True, slots=True)
class Share:
    """held / of, with its 95 % interval."""

    of: int
    share: float
    low: float
    high: float


@dataclass(frozen=True, slots=True)
class Fix:
    """error_m, stated_m: of the estimate, true and expected. inside: the 95 % region."""

    mission_id: str
    name: str
    emitter_id: str
    error_m: float
    stated_m: float
    inside: bool
    localized: bool


@dataclass(frozen=True, slots=True)
class CheckedError:
    """error_deg: clockwise of the truth, in [-180, 180)."""

    mission_id: str
    place: Place
    error_deg: float
    sigma_deg: float
    outlier: bool


@dataclass(frozen=True, slots=True)
class _Flown:
    """An antenna as one mission flew it. in_file_deg, mounted_deg: of its front to the nose, clockwise, before and
    after what the mission takes off its bearings. antenna "": nobody kept which it was."""

    antenna: str
    at_utc: datetime
    in_file_deg: float
    mounted_deg: float


@dataclass(frozen=True, slots=True)
class _Error:
    """error_deg: as flown, clockwise of the truth, in [-180, 180)."""

    mission_id: str
    place: Place
    error_deg: float
    sigma_deg: float
    flown: _Flown


@dataclass(frozen=True, slots=True)
class Suggestion:
    """offset_deg: what bearings have in common, clockwise, with the antenna mounted as its file said at the newest
    flight and nothing taken off. speed_m_s, constant_s: of the flight times."""

    sigma_deg: float
    outlier_probability: float
    offset_deg: float
    offset_std_error_deg: float
    speed_m_s: float | None
    constant_s: float | None


@dataclass(frozen=True, slots=True)
class Calibrated:
    """See the wire's Calibration."""

    missions: int
    not_found: int
    fixes: list[Fix]
    bearings: list[CheckedError]
    within_1_sigma: Share
    within_2_sigma: Share
    outliers: Share
    c95: Share
    error_ratio: float | None
    forecast_90: Share
    sharpness_deg: float | None
    antennas: list[str]
    crafts: list[str]
    needed: int
    suggested: Suggestion | None


def wilson(held: int, of: int, z: float = 1.96) -> Share:
    """(p + z^2/2n +- z sqrt(p (1-p)/n + z^2/4n^2)) / (1 + z^2/n) (Wilson 1927); all that is possible when n = 0."""
    if of == 0:
        return Share(0, 0.0, 0.0, 1.0)
    p = held / of
    middle, half = p + z * z / (2 * of), z * math.sqrt(p * (1 - p) / of + z * z / (4 * of * of))
    scale = 1 + z * z / of
    return Share(of, p, max(0.0, (middle - half) / scale), min(1.0, (middle + half) / scale))


def calibrate(missions: Mapping[str, tuple[str, Sequence[Recorded]]], craft: str, antenna: str) -> Calibrated:
    """missions: by id, name and facts of FACTS_NEEDED, in order. craft, antenna: "" for any."""
    fixes: list[Fix] = []
    raw: list[_Error] = []
    flights: list[tuple[float, float]] = []
    kept: list[bool] = []
    antennas, crafts, of, not_found = set[str](), set[str](), 0, 0
    for mission_id, (name, recorded) in missions.items():
        started = [r.event for r in recorded if isinstance(r.event, MissionStarted)]
        own_crafts = {event.craft_id for event in started}
        own_antennas = {event.antenna.name for event in started if event.antenna is not None}
        crafts |= own_crafts
        antennas |= own_antennas
        if (craft and craft not in own_crafts) or (antenna and antenna not in own_antennas):
            continue
        truth = _truth(recorded)
        of += 1
        not_found += sum(place is None for place in truth.values())
        known = {emitter: place for emitter, place in truth.items() if place is not None}
        fixes += _fixes(mission_id, name, recorded, known)
        raw += _errors(mission_id, recorded, known, craft)
        flights += _flights(recorded, craft)
        kept += _forecasts(recorded)
    errors, beside, offset = _judged(raw)
    inside = [abs(one.error_deg) / one.sigma_deg for one in errors]
    outliers = sum(one.outlier for one in errors)
    ratios = [one.error_m / one.stated_m for one in fixes if one.stated_m > 0]
    return Calibrated(
        missions=of,
        not_found=not_found,
        fixes=fixes,
        bearings=errors,
        within_1_sigma=wilson(sum(z <= 1 for z in inside), len(inside)),
        within_2_sigma=wilson(sum(z <= 2 for z in inside), len(inside)),
        outliers=wilson(outliers, len(errors)),
        c95=wilson(sum(one.inside for one in fixes), len(fixes)),
        error_ratio=math.sqrt(float(np.mean(np.square(ratios)))) if ratios else None,
        forecast_90=wilson(sum(kept), len(kept)),
        sharpness_deg=float(np.mean([one.sigma_deg for one in errors])) if errors else None,
        antennas=sorted(antennas),
        crafts=sorted(crafts),
        needed=BEARINGS_NEEDED,
        suggested=_suggested(beside, len(raw), offset, flights),
    )


def _truth(recorded: Sequence[Recorded]) -> dict[str, Place | None]:
    """By emitter, the last word."""
    return {r.event.emitter_id: r.event.place for r in recorded if isinstance(r.event, TruthNoted)}


def _fixes(mission_id: str, name: str, recorded: Sequence[Recorded], known: Mapping[str, Place]) -> Iterable[Fix]:
    last = {r.event.emitter_id: r.event for r in recorded if isinstance(r.event, BeliefUpdated)}
    for emitter_id, place in known.items():
        belief = last.get(emitter_id)
        estimate = None if belief is None else belief.estimate
        if belief is None or estimate is None or belief.bearings == 0:
            continue
        east, north = LocalFrame(place).to_enu(Place(lat=estimate.lat, lon=estimate.lon))
        inside = bool(shape(estimate.c95.model_dump()).covers(Point(place.lon, place.lat)))
        error_m = math.hypot(east, north)
        yield Fix(mission_id, name, emitter_id, error_m, estimate.expected_rmse_m, inside, belief.localized)


def _flown(recorded: Sequence[Recorded]) -> dict[str, _Flown]:
    """By craft."""
    specs = [r.event.spec for r in recorded if isinstance(r.event, MissionDrafted | MissionEdited)]
    taken_off = specs[-1].sensor.bearing_offset_deg if specs else 0.0
    found: dict[str, _Flown] = {}
    for record in recorded:
        match record.event:
            case MissionStarted(craft_id=craft_id, antenna=None):
                found[craft_id] = _Flown("", record.at_utc, 0.0, -taken_off)
            case MissionStarted(craft_id=craft_id, antenna=AntennaFact(name=name, offset_to_nose_deg=mounted)):
                found[craft_id] = _Flown(name, record.at_utc, mounted + taken_off, mounted)
            case _:
                pass
    return found


def _errors(mission_id: str, recorded: Sequence[Recorded], known: Mapping[str, Place], craft: str) -> Iterable[_Error]:
    """Of the counted bearings that a craft took, of emitters whose place is known."""
    flown = _flown(recorded)
    for fact in counted(record.event for record in recorded):
        if fact.emitter_id not in known:
            continue
        if not isinstance(fact.source, CraftSource) or (craft and fact.source.craft_id != craft):
            continue
        east, north = LocalFrame(fact.place).to_enu(known[fact.emitter_id])
        wanted = math.degrees(math.atan2(east, north))
        unsaid = _Flown("", recorded[0].at_utc, 0.0, 0.0)
        yield _Error(
            mission_id,
            fact.place,
            (fact.bearing_deg - wanted + 180.0) % 360.0 - 180.0,
            max(fact.sigma_deg, 0.1),
            flown.get(fact.source.craft_id, unsaid),
        )


def _off(angle_deg: FloatArray) -> FloatArray:
    """In [-180, 180)."""
    return (angle_deg + 180.0) % 360.0 - 180.0


def _judged(raw: Sequence[_Error]) -> tuple[list[CheckedError], list[float], float]:
    """The errors with outliers told apart; how far those that are none are from the offset in common; that offset
    (their median), degrees. It is of an antenna that nothing is taken off, mounted as its newest file says."""
    if not raw:
        return [], [], 0.0
    newest = {one.flown.antenna: one.flown for one in sorted(raw, key=lambda one: one.flown.at_utc)}
    whole = np.array([one.error_deg + newest[one.flown.antenna].in_file_deg - one.flown.mounted_deg for one in raw])
    middle = math.degrees(np.angle(np.exp(1j * np.deg2rad(whole)).sum()))  # an antenna may look backwards
    offset = middle + float(np.median(_off(whole - middle)))
    beside = _off(whole - offset)
    spread = 1.4826 * float(np.median(np.abs(beside)))
    limit = max(OUTLIER_SIGMAS * spread, LEAST_OUTLIER_DEG)
    checked = [
        CheckedError(one.mission_id, one.place, one.error_deg, one.sigma_deg, bool(abs(by) > limit))
        for one, by in zip(raw, beside, strict=True)
    ]
    return checked, [float(by) for by in beside if abs(by) <= limit], math.remainder(offset, 360.0)


def _flights(recorded: Sequence[Recorded], craft: str) -> Iterable[tuple[float, float]]:
    """Distance (m) and time (s) between places that were reached one after another."""
    reached = [r.event for r in recorded if isinstance(r.event, PlaceReached) and craft in ("", r.event.craft_id)]
    for before, after in pairwise(reached):
        if before.craft_id == after.craft_id and after.flight_time_s > 0:
            east, north = LocalFrame(before.place).to_enu(after.place)
            yield math.hypot(east, north), after.flight_time_s


def _forecasts(recorded: Sequence[Recorded]) -> Iterable[bool]:
    """Of each forecast of a search that localized: whether the 90 % time held."""
    done = next((r.at_utc for r in recorded if isinstance(r.event, BeliefUpdated) and r.event.localized), None)
    if done is None:
        return
    for record in recorded:
        if isinstance(record.event, PlanChosen) and record.event.time_90_s is not None and record.at_utc < done:
            yield (done - record.at_utc).total_seconds() <= record.event.time_90_s


def _suggested(
    good: Sequence[float], of: int, offset: float, flights: Sequence[tuple[float, float]]
) -> Suggestion | None:
    """good: degrees beside the offset, of those of all bearings that are no outliers."""
    if len(good) < BEARINGS_NEEDED:
        return None
    sigma = math.sqrt(sum(error * error for error in good) / (len(good) - 1))
    speed, constant = _motion(flights)
    return Suggestion(
        sigma_deg=min(60.0, max(0.1, round(sigma, 1))),
        outlier_probability=round(min(0.5, 1.0 - len(good) / of), 2),
        offset_deg=round(offset, 1),
        # of a median: sqrt(pi / 2) sigma / sqrt(n)
        offset_std_error_deg=round(math.sqrt(math.pi / 2) * sigma / math.sqrt(len(good)), 1),
        speed_m_s=speed,
        constant_s=constant,
    )


def _motion(flights: Sequence[tuple[float, float]]) -> tuple[float | None, float | None]:
    """Speed and constant of flight time = distance / speed + constant; None while too few flights tell."""
    if len(flights) < FEWEST_FLIGHTS:
        return None, None
    distances, times = np.array(flights).T
    try:
        model, _ = fit_motion(distances, np.zeros(len(flights)), times)
    except PlannerError:
        return None, None
    match model:
        case LinearMotion(speed):
            return round(speed, 2), 0.0
        case LinearConstantMotion(speed, constant):
            return round(speed, 2), round(constant, 1)
        case _:
            line: FloatArray = np.asarray(np.polyfit(distances, times, 1), dtype=np.float64)
            slope, constant = float(line[0]), float(line[1])
            return (round(1.0 / slope, 2), round(constant, 1)) if slope > 0 else (None, None)
