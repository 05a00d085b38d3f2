"""Areas of the specification as geometry in the mission's local frame, refused with reasons when unusable."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from shapely import MultiPolygon, Point, Polygon, unary_union
from shapely.coords import CoordinateSequence
from shapely.geometry.base import BaseGeometry
from shapely.validation import explain_validity

from backend import spec
from backend.reasons import search as reasons
from backend.reasons.search import Geometry
from backend.search.errors import MissionInputError
from backend.spec import MissionSpec
from hardware.frame import LocalFrame
from hardware.readings import Place
from planner.types import Region, Ring

SMALLEST_M2 = 100.0
LARGEST_EXTENT_M = 5_000.0
MOST_VERTICES = 1_000
FAR_M = 5_000.0
"""Beyond this the local tangent plane is no longer true to a metre, and a place is more likely a mistake."""
EDGE_TOLERANCE_M = 2.0
"""A hovering vehicle wanders this much: its own place is judged with this much mercy at the edges of fence and no-fly
zones, and no place to measure at is nearer to a zone."""


def area_geometry(area: spec.Area, frame: LocalFrame, field: str, what: Geometry) -> BaseGeometry:
    """Polygon or multipolygon in metres ENU. Overlapping polygons are united.

    Raises MissionInputError for rings without extent, edges that cross, and too many vertices.
    """
    polygons = [area.coordinates] if isinstance(area, spec.Polygon) else area.coordinates
    if not polygons or not any(polygons):
        raise MissionInputError(reasons.AreaEmpty(what), field)
    if sum(len(ring) for rings in polygons for ring in rings) > MOST_VERTICES:
        raise MissionInputError(reasons.TooManyCorners(what, MOST_VERTICES), field)
    single = isinstance(area, spec.Polygon)
    shapes = [
        _polygon(rings, frame, f"{field}.coordinates" if single else f"{field}.coordinates.{i}", what)
        for i, rings in enumerate(polygons)
    ]
    return unary_union(shapes)


def _polygon(rings: Sequence[Sequence[spec.LonLat]], frame: LocalFrame, field: str, what: Geometry) -> Polygon:
    if not rings:
        raise MissionInputError(reasons.AreaEmpty(what), field)
    for index, ring in enumerate(rings):
        if len({tuple(point) for point in ring}) < 3:
            raise MissionInputError(reasons.TooFewCorners(what), f"{field}.{index}")
    outline, *holes = ([frame.to_enu(Place(lat, lon)) for lon, lat in ring] for ring in rings)
    polygon = Polygon(outline, holes)
    if not polygon.is_valid:
        raise MissionInputError(why_invalid(polygon, what), field)
    return polygon


def why_invalid(geometry: BaseGeometry, what: Geometry) -> reasons.OutlineUnusable:
    """By the library's own explanation, which has no codes."""
    why = explain_validity(geometry).lower()
    if "self-intersection" in why:
        return reasons.OutlineUnusable(what, "crosses_itself")
    if "hole lies outside" in why or "nested" in why:
        return reasons.OutlineUnusable(what, "hole_outside")
    return reasons.OutlineUnusable(what, "not_simple")


def target_area(mission: MissionSpec, frame: LocalFrame) -> BaseGeometry:
    """Where the emitter may be. Raises MissionInputError when empty, crossing itself, too small, too big or too far."""
    area = area_geometry(mission.area, frame, "area", "area")
    if area.area < SMALLEST_M2:
        raise MissionInputError(reasons.AreaTooSmall(area.area, SMALLEST_M2), "area.coordinates")
    west, south, east, north = area.bounds
    if max(east - west, north - south) > LARGEST_EXTENT_M:
        width = max(east - west, north - south)
        raise MissionInputError(reasons.AreaTooWide(width, LARGEST_EXTENT_M), "area.coordinates")
    return area


def check_reach(area: BaseGeometry) -> None:
    """Raises MissionInputError when the area lies far from the frame's origin, the vehicle's home."""
    nearest = area.distance(Point(0.0, 0.0))
    if not nearest <= FAR_M:
        raise MissionInputError(reasons.AreaTooFar(nearest), "area.coordinates")


def fence(mission: MissionSpec, area: BaseGeometry, frame: LocalFrame) -> BaseGeometry:
    """Where the vehicle may be: the drawn fence, else the area with its margin."""
    if mission.flight.fence is not None:
        return area_geometry(mission.flight.fence, frame, "flight.fence", "fence")
    return area.buffer(mission.flight.fence_margin_m, quad_segs=4)


def no_fly(mission: MissionSpec, frame: LocalFrame) -> tuple[BaseGeometry, ...]:
    """One geometry a zone, m ENU of `frame`. Raises MissionInputError."""
    return tuple(
        area_geometry(zone, frame, f"flight.no_fly.{i}", "no_fly") for i, zone in enumerate(mission.flight.no_fly)
    )


def region(geometry: BaseGeometry) -> Region:
    """Outlines and holes as rings, not closed."""
    parts = geometry.geoms if isinstance(geometry, MultiPolygon) else [geometry]
    rings: list[Ring] = []
    for part in parts:
        if isinstance(part, Polygon) and not part.is_empty:
            rings += [_ring(part.exterior.coords), *(_ring(hole.coords) for hole in part.interiors)]
    return tuple(rings)


def _ring(coordinates: CoordinateSequence) -> Ring:
    return np.asarray(coordinates, dtype=float)[:-1, :2]


def corner_of(area: spec.Area) -> spec.Place:
    """The first corner: where the local frame lies while a mission's home is not known."""
    rings = area.coordinates if isinstance(area, spec.Polygon) else area.coordinates[0]
    lon, lat = rings[0][0]
    return spec.Place(lat=lat, lon=lon)


def centre_of(area: spec.Area) -> Place:
    """Middle of the bounding rectangle, for a frame while no vehicle's home is known.

    Raises MissionInputError when there is no corner.
    """
    polygons = [area.coordinates] if isinstance(area, spec.Polygon) else area.coordinates
    corners = [point for rings in polygons for ring in rings for point in ring]
    if not corners:
        raise MissionInputError(reasons.AreaEmpty("area"), "area")
    first = corners[0][0]
    lon = [first + math.remainder(c[0] - first, 360.0) for c in corners]  # an area may lie across the antimeridian
    lat = [c[1] for c in corners]
    return Place(math.fsum((min(lat), max(lat))) / 2, math.remainder(math.fsum((min(lon), max(lon))) / 2, 360.0))
