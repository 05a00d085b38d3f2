"""What a belief says, as it is recorded: the estimate with its region in degrees, and each source's errors."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from shapely import Polygon as ShapelyPolygon

from backend import spec
from backend.events import BearingMeasured, EstimateFact, SourceErrorsFact
from backend.search.planner_bearings import source_name
from hardware.frame import LocalFrame, angle_to_compass
from planner.belief.estimate import confidence_region
from planner.belief.grid import GridBelief
from planner.belief.joint import JointBelief
from planner.belief.moving import MovingBelief
from planner.types import Estimate, Ring


def estimate_fact(belief: GridBelief, spread: Estimate, frame: LocalFrame) -> EstimateFact:
    """spread: the estimate of that belief, in ENU of `frame`. Axes of one standard deviation."""
    place = frame.to_geo(spread.x, spread.y)
    region = confidence_region(belief)
    variances, directions = np.linalg.eigh(spread.covariance)
    minor, major = np.sqrt(np.maximum(variances, 0.0))
    axis = math.atan2(directions[1, 1], directions[0, 1])
    return EstimateFact(
        lat=place.lat,
        lon=place.lon,
        expected_rmse_m=spread.expected_rmse,
        c95=_polygon(region, frame),
        c95_area_m2=ShapelyPolygon(region).area,
        major_axis_m=float(major),
        minor_axis_m=float(minor),
        major_axis_deg=angle_to_compass(axis) % 180.0,
    )


def _polygon(ring: Ring, frame: LocalFrame) -> spec.Polygon:
    """Ring in ENU to GeoJSON, closed."""
    return spec.Polygon(coordinates=[frame.to_lon_lat(np.vstack([ring, ring[:1]]))])


def errors_facts(belief: GridBelief, measured: Sequence[BearingMeasured]) -> list[SourceErrorsFact]:
    """Of each source that the belief knows. Compass bearings turn the other way round than the planner's angles."""
    if not isinstance(belief, JointBelief | MovingBelief):
        return []
    sources = {source_name(fact.source): fact.source for fact in measured}
    return [
        SourceErrorsFact(
            source=sources[one.source],
            bearings=one.bearings,
            bias_deg=-math.degrees(one.bias),
            bias_std_error_deg=math.degrees(one.bias_sd),
            sigma_scale=one.scale,
            outlier_rate=one.outlier_rate,
        )
        for one in belief.errors
    ]
