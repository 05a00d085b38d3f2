"""Fewer positions for a large overlay: every look at the map draws all of them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import shapely
from shapely.geometry import mapping, shape
from shapely.geometry.base import BaseGeometry

from backend.reasons.maps import PositionsThinned
from backend.wire.maps import OverlayFeature

MOST_POSITIONS = 100_000
FIRST_TOLERANCE_DEG = 1e-6
"""A tenth of a metre."""
METRES_A_DEGREE = 111_320.0
LARGEST_TOLERANCE_DEG = 1e-3


def simplified(
    features: Sequence[OverlayFeature], most: int = MOST_POSITIONS
) -> tuple[list[OverlayFeature], PositionsThinned | None]:
    """A position of a line or ring is left out when it lies within a tolerance of the one before; the tolerance is
    doubled until at most `most` are left, or it is as large as an overlay can bear. None: nothing was changed; else the
    lines and rings that were given have lost their coordinates: a million positions as lists take 150 MB.

    Time grows with the number of positions; Douglas and Peucker's rule took 50 s for a zigzag of 700,000.
    """
    before = sum(_count(feature.geometry["coordinates"]) for feature in features)
    if before <= most:
        return list(features), None
    shapes: list[BaseGeometry] = []
    for feature in features:
        shapes.append(_shape(feature.geometry["type"], feature.geometry["coordinates"]))
        if not _is_points(shapes[-1]):
            feature.geometry["coordinates"] = []
    tolerance_deg, after, thinner = FIRST_TOLERANCE_DEG, before, shapes
    while after > most and tolerance_deg <= LARGEST_TOLERANCE_DEG:
        thinner = [_thinned(one, tolerance_deg) for one in shapes]
        after = _positions(thinner)
        tolerance_deg *= 2
    changed = [
        feature if _is_points(one) else feature.model_copy(update={"geometry": dict(mapping(one))})
        for feature, one in zip(features, thinner, strict=True)
    ]
    return changed, PositionsThinned(before, after, tolerance_deg / 2 * METRES_A_DEGREE)


def _shape(kind: str, coordinates: Any) -> BaseGeometry:
    """From arrays: shapely would copy a list of positions one by one, which takes as much memory again."""
    depth = {"Point": 0, "LineString": 0, "MultiPoint": 0, "Polygon": 1, "MultiLineString": 1, "MultiPolygon": 2}[kind]
    return shape({"type": kind, "coordinates": _arrays(coordinates, depth)})


def _arrays(coordinates: Any, depth: int) -> Any:
    if depth == 0:
        return np.asarray(coordinates, dtype=np.float64)
    return [_arrays(part, depth - 1) for part in coordinates]


def _count(coordinates: Any) -> int:
    """Of positions."""
    if not coordinates:
        return 0
    if not isinstance(coordinates[0], list | tuple):
        return 1
    if not isinstance(coordinates[0][0], list | tuple):
        return len(coordinates)
    return sum(_count(part) for part in coordinates)


def _positions(shapes: Sequence[BaseGeometry]) -> int:
    counts = shapely.get_num_coordinates(shapes)  # pyright: ignore[reportUnknownMemberType]: its stubs lack a type
    return int(counts.sum())


def _is_points(one: BaseGeometry) -> bool:
    return one.geom_type in ("Point", "MultiPoint")


def _thinned(one: BaseGeometry, tolerance_deg: float) -> BaseGeometry:
    if _is_points(one):
        return one
    try:
        return shapely.remove_repeated_points(one, tolerance_deg)
    except shapely.errors.GEOSException:  # a ring smaller than the tolerance
        return one
