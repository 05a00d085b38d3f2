"""Ways that came with a mission out of a bundle: read with distrust, and kept as they are, bridges apart from roads."""

from __future__ import annotations

from typing import Any

import numpy as np
import shapely
from pydantic import ValidationError
from shapely.errors import ShapelyError
from shapely.geometry import shape

from backend.maps.features import MOST_FEATURES, storable
from backend.maps.ways import MOST_POSITIONS
from backend.wire.ways import MissionWays

FURTHEST_LON = 540.0
"""Across the antimeridian longitudes go on beyond 180."""


def read_brought_ways(content: bytes) -> MissionWays:
    """For a worker. Raises ValueError for what no Crossfix wrote."""
    try:
        ways = MissionWays.model_validate_json(content)
    except ValidationError:  # which does not come out of a worker
        raise ValueError("not of this form") from None
    if len(ways.features) > MOST_FEATURES:
        raise ValueError(f"{len(ways.features)} features")
    try:
        positions = sum(_positions(one.geometry, one.properties.kind == "barrier") for one in ways.features)
    except (ShapelyError, LookupError, TypeError, AttributeError, RecursionError) as error:
        raise ValueError("no geometry") from error
    if positions > MOST_POSITIONS:
        raise ValueError(f"{positions} positions")
    return ways.model_copy(update={"name": None if ways.name is None else storable(ways.name)[:200]})


def _positions(geometry: dict[str, Any], may_be_area: bool) -> int:
    """How many. Raises ValueError for what is no line on the Earth, nor an area that cannot be crossed."""
    found = shape(geometry)
    if found.geom_type != "MultiLineString" and not (may_be_area and found.geom_type == "MultiPolygon"):
        raise ValueError(found.geom_type)
    at = shapely.get_coordinates(found)
    if found.has_z or len(at) == 0 or not found.is_valid or not np.isfinite(at).all():
        raise ValueError("unsound")
    if np.abs(at[:, 0]).max() > FURTHEST_LON or np.abs(at[:, 1]).max() > 90.0:
        raise ValueError("beyond the Earth")
    return len(at)
