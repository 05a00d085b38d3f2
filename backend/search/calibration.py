"""How right bearings, fixes and forecasts were where the truth is known: pure, over what many missions told.

The offset is what bearings have in common, together with what missions had already taken off them, so that it is the
whole of it however often it is taken over.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass

import numpy as np

from backend.search.told import Flown, Leg, Told, ToldError
from hardware.readings import Place
from planner.motion import fit_motion
from planner.shares import wilson
from planner.types import FloatArray, LinearConstantMotion, LinearMotion, PlannerError

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
class _Error:
    mission_id: str
    told: ToldError
    flown: Flown


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
    sharpness_m: float | None
    forecast_90_s: float | None
    forecast_took_s: float | None
    antennas: list[str]
    crafts: list[str]
    needed: int
    suggested: Suggestion | None


def _share(held: int, of: int) -> Share:
    return Share(of, held / of if of else 0.0, *wilson(held, of))


def calibrate(missions: Mapping[str, tuple[str, Told]], craft: str, antenna: str) -> Calibrated:
    """missions: by id, name and what they told. craft, antenna: "" for any."""
    asked = {
        mission_id: (name, one)
        for mission_id, (name, one) in missions.items()
        if craft in ("", *one.crafts) and antenna in ("", *one.antennas)
    }
    fixes = [Fix(mission_id, name, **asdict(fix)) for mission_id, (name, one) in asked.items() for fix in one.fixes]
    raw = [
        _Error(mission_id, error, one.flown[error.craft_id])
        for mission_id, (_, one) in asked.items()
        for error in one.errors
        if craft in ("", error.craft_id)
    ]
    legs = [leg for _, one in asked.values() for leg in one.legs if craft in ("", leg.craft_id)]
    forecasts = [forecast for _, one in asked.values() for forecast in one.forecasts]
    kept = [one.took_s <= one.time_90_s for one in forecasts]
    errors, beside, offset = _judged(raw)
    inside = [abs(one.error_deg) / one.sigma_deg for one in errors]
    outliers = sum(one.outlier for one in errors)
    ratios = [one.error_m / one.stated_m for one in fixes if one.stated_m > 0]
    return Calibrated(
        missions=len(asked),
        not_found=sum(one.not_found for _, one in asked.values()),
        fixes=fixes,
        bearings=errors,
        within_1_sigma=_share(sum(z <= 1 for z in inside), len(inside)),
        within_2_sigma=_share(sum(z <= 2 for z in inside), len(inside)),
        outliers=_share(outliers, len(errors)),
        c95=_share(sum(one.inside for one in fixes), len(fixes)),
        error_ratio=math.sqrt(float(np.mean(np.square(ratios)))) if ratios else None,
        forecast_90=_share(sum(kept), len(kept)),
        sharpness_deg=_mean([one.sigma_deg for one in errors]),
        sharpness_m=_mean([one.stated_m for one in fixes]),
        forecast_90_s=_mean([one.time_90_s for one in forecasts]),
        forecast_took_s=_mean([one.took_s for one in forecasts]),
        antennas=sorted({name for _, one in missions.values() for name in one.antennas}),
        crafts=sorted({name for _, one in missions.values() for name in one.crafts}),
        needed=BEARINGS_NEEDED,
        suggested=_suggested(beside, len(raw), offset, legs),
    )


def _mean(numbers: Sequence[float]) -> float | None:
    return float(np.mean(numbers)) if numbers else None


def _off(angle_deg: FloatArray) -> FloatArray:
    """In [-180, 180)."""
    return (angle_deg + 180.0) % 360.0 - 180.0


def _judged(raw: Sequence[_Error]) -> tuple[list[CheckedError], list[float], float]:
    """The errors with outliers told apart; how far those that are none are from the offset in common; that offset
    (their median), degrees. It is of an antenna that nothing is taken off, mounted as its newest file says."""
    if not raw:
        return [], [], 0.0
    newest = {one.flown.antenna: one.flown for one in sorted(raw, key=lambda one: one.flown.at_utc)}
    whole = np.array(
        [one.told.error_deg + newest[one.flown.antenna].in_file_deg - one.flown.mounted_deg for one in raw]
    )
    middle = math.degrees(np.angle(np.exp(1j * np.deg2rad(whole)).sum()))  # an antenna may look backwards
    offset = middle + float(np.median(_off(whole - middle)))
    beside = _off(whole - offset)
    spread = 1.4826 * float(np.median(np.abs(beside)))
    limit = max(OUTLIER_SIGMAS * spread, LEAST_OUTLIER_DEG)
    checked = [
        CheckedError(one.mission_id, one.told.place, one.told.error_deg, one.told.sigma_deg, bool(abs(by) > limit))
        for one, by in zip(raw, beside, strict=True)
    ]
    return checked, [float(by) for by in beside if abs(by) <= limit], math.remainder(offset, 360.0)


def _suggested(good: Sequence[float], of: int, offset: float, legs: Sequence[Leg]) -> Suggestion | None:
    """good: degrees beside the offset, of those of all bearings that are no outliers."""
    if len(good) < BEARINGS_NEEDED:
        return None
    sigma = math.sqrt(sum(error * error for error in good) / (len(good) - 1))
    speed, constant = _motion(legs)
    return Suggestion(
        sigma_deg=min(60.0, max(0.1, round(sigma, 1))),
        outlier_probability=round(min(0.5, 1.0 - len(good) / of), 2),
        offset_deg=round(offset, 1),
        # of a median: sqrt(pi / 2) sigma / sqrt(n)
        offset_std_error_deg=round(math.sqrt(math.pi / 2) * sigma / math.sqrt(len(good)), 1),
        speed_m_s=speed,
        constant_s=constant,
    )


def _motion(legs: Sequence[Leg]) -> tuple[float | None, float | None]:
    """Speed and constant of flight time = distance / speed + constant; None while too few legs tell."""
    if len(legs) < FEWEST_FLIGHTS:
        return None, None
    distances, times = np.array([(leg.distance_m, leg.time_s) for leg in legs]).T
    try:
        model, _ = fit_motion(distances, np.zeros(len(legs)), times)
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
