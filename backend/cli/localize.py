"""`crossfix localize`: where the emitter is, from a file of bearings."""

from __future__ import annotations

import json
import math
from dataclasses import fields, replace
from datetime import UTC, datetime
from pathlib import Path
from statistics import fmean
from typing import Annotated, Any, get_args

import numpy as np
import typer

from backend.bearing_file import kraken_in
from backend.cli.edge import print_json, remark, stop
from backend.cli.localize_mission import exported_in, localize_mission
from backend.search.reported import compass_share_deg
from backend.search.source_priors import LEAST_OUTLIERS, unknown_errors
from backend.settings import settings_of
from backend.spec import ErrorModel
from hardware.direction_finding.bearing_scatter import BearingScatter, bearing_scatter
from hardware.direction_finding.bearings_file import DEFAULT_SIGMA_DEG, RecordedBearing, bearings_in
from hardware.direction_finding.heading import HeadingError, declination_deg
from hardware.direction_finding.table_file import RecordingError, listed, read_table
from hardware.direction_finding.table_tags import meant
from hardware.frame import LocalFrame, compass_to_angle, middle_of
from hardware.readings import Place
from hardware.reasons.table import FileUnreadable
from planner.belief.estimate import confidence_region, estimate
from planner.belief.grid import GridBelief, fold
from planner.belief.joint import JointBelief, corrected, fold_joint, joint_prior
from planner.belief.source_errors import ErrorPrior, SourceErrors
from planner.belief.verdict import points_at, stated, verdict
from planner.geometry import convex_hull
from planner.options import Estimator
from planner.reason import sentence_of, text_of
from planner.types import (
    Bearing,
    InconsistentBearings,
    LinearMotion,
    LocalizationRule,
    PlannerError,
    Problem,
    Region,
)

SHORTEST_RANGE_M = 1000.0
RANGE_BY_SPREAD = 3.0
_DISC_CORNERS = 48
RIGHT_RAD = 1e-6
"""Standard deviation of a compass that is right."""
ESTIMATORS: tuple[Estimator, ...] = get_args(Estimator)
USUAL_OUTLIERS = 0.1
"""As a mission expects unless told otherwise."""
MEDIAN: Estimator = "geometric_median"
"""The place with the least expected error, the figure that is stated beside it."""
USUAL = ("joint", MEDIAN, 10.0)
"""Errors, estimator and threshold of who says nothing."""


def localize(
    file: Annotated[
        Path,
        typer.Argument(
            help="UAV-RT bearing file, CSV with columns lat, lon (or easting, northing, utm_zone), bearing_deg[, "
            "sigma_deg], a KrakenSDR's log, or a mission.json that Crossfix exported: believed as it was in flight, "
            "area, compass and all."
        ),
    ],
    area: Annotated[
        Path | None,
        typer.Option(
            help="GeoJSON polygon in which the emitter must be. Default: within --range of a bearing's place."
        ),
    ] = None,
    range_: Annotated[
        float | None,
        typer.Option(
            "--range",
            min=10.0,
            max=100_000.0,
            help="Metres from which the emitter can be heard. Default: 1000, or three times the spread of the places.",
        ),
    ] = None,
    sigma: Annotated[
        float | None,
        typer.Option(
            min=0.1,
            max=60.0,
            help="Standard deviation in degrees of bearings without their own. Default: estimated from how they miss "
            "one another, and CROSSFIX_HEADING_SIGMA_DEG.",
        ),
    ] = None,
    outliers: Annotated[
        float | None,
        typer.Option(
            min=0.0,
            max=0.5,
            help="Probability that a bearing is wrong altogether (0: none may be). Default: where the file states "
            "sigmas 0.1, with independent errors 0; else estimated.",
        ),
    ] = None,
    errors: Annotated[
        str,
        typer.Option(
            help="joint: all bearings may be turned by one angle, which is estimated with the place, as are the scale "
            "of their sigmas and the rate of outliers. independent: each has an error of its own."
        ),
    ] = "joint",
    threshold: Annotated[
        float, typer.Option(min=0.1, help='Expected error in metres below which the emitter counts as "localized".')
    ] = 10.0,
    tag: Annotated[
        str | None,
        typer.Option(help="Use this tag's bearings (of a mission: this emitter's) where there are several."),
    ] = None,
    magnetic: Annotated[
        datetime | None,
        typer.Option(
            formats=["%Y-%m-%d"],
            help="The bearings are a magnetic compass's, of this day: made true by the World Magnetic Model.",
        ),
    ] = None,
    estimator: Annotated[
        str,
        typer.Option(
            help=f"Point that is answered: {', '.join(ESTIMATORS)}. The default has the least expected error."
        ),
    ] = MEDIAN,
    json_: Annotated[bool, typer.Option("--json", help="Print one JSON object.")] = False,
) -> None:
    """Cross bearings: estimate, expected error and 95 % region of a stationary emitter, or that the bearings disagree.

    Example: crossfix localize bearings.csv --range 800 --json
    """
    try:
        if (mission := exported_in(file)) is not None:
            given = (area, range_, sigma, outliers, magnetic)
            _nothing_else(any(one is not None for one in given), (errors, estimator, threshold) != USUAL)
            _answered(localize_mission(mission, tag), json_)
            return
        table = read_table(file)
        kraken = kraken_in(table)
        recorded = kraken or bearings_in(table, sigma or DEFAULT_SIGMA_DEG)
        remark(*map(sentence_of, listed(file, recorded.remarks)))
        whole = kraken is not None and tag is None  # of several stations
        chosen = list(recorded.bearings) if whole else _of_tag(file, recorded.bearings, tag)
        chosen = chosen if magnetic is None else [_made_true(one, magnetic) for one in chosen]
        frame = LocalFrame(_middle(chosen))
        region = _read_area(area, frame) if area is not None else _audible(chosen, frame, range_)
        joint = _joint(errors)
        expected = USUAL_OUTLIERS if joint else 0.0
        if sigma is None and not all(b.stated for b in chosen):
            scatter = _scatter(chosen, frame, region)
            chosen, expected = _with_sigma(chosen, scatter.sigma_deg), scatter.outlier_probability
        rate = expected if outliers is None else outliers
        answer = _localize(chosen, frame, region, rate, threshold, _known_estimator(estimator), joint, whole)
    except (RecordingError, HeadingError, PlannerError, ValueError) as error:
        stop(error)
    _answered(answer, json_)


def _answered(answer: dict[str, Any], json_: bool) -> None:
    if json_:
        print_json(answer)
    else:
        typer.echo(_text(answer))


def _nothing_else(*asked: bool) -> None:
    if any(asked):
        raise ValueError("a mission says itself what it searches with: give none of these options but --tag and --json")


def _known_estimator(name: str) -> Estimator:
    for known in ESTIMATORS:
        if name == known:
            return known
    raise ValueError(f'"{name}" is no estimator: choose one of {", ".join(ESTIMATORS)}')


def _joint(errors: str) -> bool:
    if errors not in get_args(ErrorModel):
        raise ValueError(f'"{errors}" is no model of errors: choose one of {", ".join(get_args(ErrorModel))}')
    return errors == "joint"


def _of_tag(file: Path, bearings: tuple[RecordedBearing, ...], tag: str | None) -> list[RecordedBearing]:
    tags = sorted({b.tag for b in bearings if b.tag is not None})
    if tag is None and len(tags) > 1:
        raise ValueError(f"{file} holds bearings of several tags ({', '.join(tags)}); choose one with --tag")
    wanted = None if tag is None else meant(tag, tags)
    chosen = [b for b in bearings if wanted is None or b.tag == wanted]
    if not chosen:
        raise ValueError(f"{file} holds no bearing of tag {tag} (tags there: {', '.join(tags) or 'none'})")
    return chosen


def _made_true(one: RecordedBearing, day: datetime) -> RecordedBearing:
    """Raises HeadingError."""
    declination = declination_deg(one.place, day.replace(tzinfo=UTC).timestamp())
    return replace(one, bearing_deg=(one.bearing_deg + declination) % 360.0)


def _scatter(bearings: list[RecordedBearing], frame: LocalFrame, region: Region) -> BearingScatter:
    """Of those without a sigma; what all of them share, the compass', shows in no scatter and is added."""
    open_ = [b for b in bearings if not b.stated]
    corners = np.concatenate(region)
    places = np.array([frame.to_enu(b.place) for b in open_])
    degrees = np.array([b.bearing_deg for b in open_])
    found = bearing_scatter(places, degrees, corners.min(axis=0), corners.max(axis=0))
    return replace(found, sigma_deg=math.hypot(found.sigma_deg, settings_of().heading_sigma_deg))


def _with_sigma(bearings: list[RecordedBearing], sigma_deg: float) -> list[RecordedBearing]:
    return [b if b.stated else replace(b, sigma_deg=sigma_deg) for b in bearings]


def _middle(bearings: list[RecordedBearing]) -> Place:
    return middle_of([b.place.lat for b in bearings], [b.place.lon for b in bearings], fmean)


def _audible(bearings: list[RecordedBearing], frame: LocalFrame, range_m: float | None) -> Region:
    """Hull of the discs of `range_m` around the places where bearings were taken."""
    places = np.array([frame.to_enu(b.place) for b in bearings])
    spread = float(np.max(np.hypot(*(places - places.mean(axis=0)).T)))
    reach = range_m or max(SHORTEST_RANGE_M, RANGE_BY_SPREAD * 2.0 * spread)
    turn = 2.0 * math.pi * np.arange(_DISC_CORNERS) / _DISC_CORNERS
    disc = reach * np.column_stack([np.cos(turn), np.sin(turn)])
    return (convex_hull((places[:, None, :] + disc[None, :, :]).reshape(-1, 2)),)


def _read_area(path: Path, frame: LocalFrame) -> Region:
    try:
        data = json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise RecordingError(FileUnreadable(str(path), error.strerror or str(error))) from error
    except ValueError as error:
        raise ValueError(f"{path} is not GeoJSON ({error})") from error
    try:
        rings = _rings(data)
        region = tuple(
            np.array([frame.to_enu(Place(float(p[1]), float(p[0]))) for p in ring[:-1]], dtype=np.float64)
            for ring in rings
        )
    except (KeyError, TypeError, ValueError, IndexError):
        raise ValueError(f"{path} holds no usable GeoJSON; draw the area as Polygon or MultiPolygon") from None
    if not region:
        raise ValueError(f"{path} holds no GeoJSON polygon; draw the area as Polygon or MultiPolygon")
    return region


def _rings(data: dict[str, Any]) -> list[list[list[float]]]:
    kind = data["type"]
    if kind == "FeatureCollection":
        return [ring for feature in data["features"] for ring in _rings(feature)]
    if kind == "Feature":
        return _rings(data["geometry"])
    if kind == "Polygon":
        return list(data["coordinates"])
    if kind == "MultiPolygon":
        return [ring for polygon in data["coordinates"] for ring in polygon]
    return []


def _localize(
    recorded: list[RecordedBearing],
    frame: LocalFrame,
    region: Region,
    outliers: float,
    threshold: float,
    estimator: Estimator,
    joint: bool,
    stations: bool,
) -> dict[str, Any]:
    """stations: the tags of the bearings are the stations that took them, each with errors of its own."""
    bearings: list[Bearing] = []
    for b in recorded:
        x, y = frame.to_enu(b.place)
        sigma = math.radians(_own_sigma_deg(b) if joint else b.sigma_deg)
        source = (b.tag or "") if stations else ""
        bearings.append(Bearing(x, y, compass_to_angle(b.bearing_deg), sigma, outliers, source=source))
    problem = Problem(region, bearings[0].sigma, threshold, 0.0, LinearMotion(1.0), estimator=estimator)
    belief = _fold_joint(problem, bearings, outliers) if joint else _fold(problem, bearings, outliers)
    judged = verdict(problem, LocalizationRule(threshold), bearings, belief)
    answer: dict[str, Any] = {
        "estimate": None,
        "estimator": estimator,
        "expected_rmse_m": None,
        "c95": None,
        "consistent": judged.consistent,
        "localized": judged.localized,
        "not_yet": [text_of(reason) for reason in judged.reasons],
        "bearings": len(bearings),
        "sigma_deg": round(max(b.sigma_deg for b in recorded), 2),
        "outlier_probability": round(outliers, 3),
        "sources": [_source(one) for one in belief.errors] if isinstance(belief, JointBelief) else [],
    }
    if belief is not None:
        spread = stated(belief, estimate(belief, problem.estimator), problem.threshold)
        place = frame.to_geo(spread.x, spread.y)
        outline = [frame.to_geo(x, y) for x, y in confidence_region(belief)]
        ring = [[round(p.lon, 8), round(p.lat, 8)] for p in (*outline, outline[0])]
        answer["estimate"] = {"lat": round(place.lat, 8), "lon": round(place.lon, 8)}
        answer["expected_rmse_m"] = round(spread.expected_rmse, 3)
        answer["c95"] = {"type": "Polygon", "coordinates": [ring]}
    return answer


def _own_sigma_deg(bearing: RecordedBearing) -> float:
    """Without the compass' share, which a joint belief counts once for all of them, as it does of those in flight."""
    if not bearing.stated:
        return bearing.sigma_deg
    return math.sqrt(bearing.sigma_deg**2 - compass_share_deg(bearing.sigma_deg) ** 2)


def _fold(problem: Problem, bearings: list[Bearing], outliers: float) -> GridBelief | None:
    """As a joint belief that knows everything else, whose cells are as fine as the bearings cross.

    None when no bearing may be wrong and they contradict each other.
    """
    if outliers == 0.0:
        try:
            fold(problem, bearings)
        except InconsistentBearings:
            return None
    known = fold_joint(joint_prior(problem, otherwise=_known(max(outliers, LEAST_OUTLIERS))), bearings)
    return GridBelief(**{one.name: getattr(known, one.name) for one in fields(GridBelief)})


def _known(outliers: float) -> ErrorPrior:
    """A compass that is right, sigmas that are true, and this rate of outliers."""
    one = np.ones(1)
    return ErrorPrior(RIGHT_RAD * one, one, one, one, outliers * one, one)


def _fold_joint(problem: Problem, bearings: list[Bearing], outliers: float) -> GridBelief | None:
    """None when hardly two of several bearings agree on a place: then all of them may be outliers."""
    belief = fold_joint(joint_prior(problem, otherwise=unknown_errors(outliers)), bearings)
    found = estimate(belief, problem.estimator)
    agreeing = sum(points_at(bearing, found.x, found.y) for bearing in corrected(belief, bearings))
    return None if agreeing < min(2, len(bearings)) else belief


def _source(errors: SourceErrors) -> dict[str, float | int | str | None]:
    """name: of the station, where the file tells."""
    return {
        "name": errors.source or None,
        "bearings": errors.bearings,
        "bias_deg": round(-math.degrees(errors.bias), 2),
        "bias_std_error_deg": round(math.degrees(errors.bias_sd), 2),
        "sigma_scale": round(errors.scale, 3),
        "outlier_rate": round(errors.outlier_rate, 3),
    }


def _of(name: str | None) -> str:
    return "" if name is None else f" of {name}"


def _text(answer: dict[str, Any]) -> str:
    if answer["estimate"] is None:
        return (
            f"no estimate from {answer['bearings']} bearings: they contradict each other "
            "(or cross outside the area: try a larger --range)"
        )
    place = answer["estimate"]
    lines = [
        f"emitter at {place['lat']:.6f}, {place['lon']:.6f}, expected error {answer['expected_rmse_m']:.1f} m, "
        f"from {answer['bearings']} bearing{'s' if answer['bearings'] != 1 else ''}"
    ]
    lines += [
        f"all bearings{_of(one['name'])} turned clockwise by {round(one['bias_deg']):+d} ± "
        f"{one['bias_std_error_deg']:.0f} degrees, which is taken into account; their errors are "
        f"{one['sigma_scale']:.1f} times what was stated"
        for one in answer["sources"]
    ]
    lines.append("localized" if answer["localized"] else f"not yet localized: {' '.join(answer['not_yet'])}")
    return "\n".join(lines)
