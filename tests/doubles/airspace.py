"""The planner's picture of where may be flown, from geometries in metres ENU."""

from __future__ import annotations

import math

import numpy as np
from shapely import Polygon, unary_union

from backend.search.area import region
from backend.search.problem import KEEP_OFF_M
from planner.types import LinearMotion, Problem


def airspace(fence: Polygon, *no_fly: Polygon) -> Problem:
    """As a mission's localization makes it."""
    return Problem(
        area=(np.array([(0.0, 0.0), (10.0, 0.0), (10.0, 10.0)]),),
        sigma=math.radians(7.0),
        threshold=10.0,
        measurement_time=30.0,
        motion=LinearMotion(7.0),
        flight_area=region(fence),
        no_fly=region(unary_union(no_fly).buffer(KEEP_OFF_M, join_style="mitre")),
    )
