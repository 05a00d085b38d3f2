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
from backend.mission.errors import MissionInputError
from backend.mission.safety import FAR_M
from backend.spec import MissionSpec
from hardware.frame import LocalFrame
from hardware.readings import GeoPoint
from planner.types import Region, Ring

SMALLEST_M2 = 100.0
LARGEST_EXTENT_M = 5_000.0
MOST_VERTICES = 1_000


def area_geometry(area: spec.Area, frame: LocalFrame, field: str, what: str) -> BaseGeometry:
    """Polygon or multipolygon in metres ENU. Overlapping polygons are united.

    Raises MissionInputError for rings without extent, edges that cross, and too many vertices.
    """
    polygons = [area.coordinates] if isinstance(area, spec.Polygon) else area.coordinates
    if not polygons or not any(polygons):
        raise MissionInputError(f"{what} is empty", "draw an area of at least three corners", field)
    if sum(len(ring) for rings in polygons for ring in rings) > MOST_VERTICES:
        raise MissionInputError(f"{what} has more than {MOST_VERTICES} corners", "simplify it", field)
    single = isinstance(area, spec.Polygon)
    shapes = [
        _polygon(rings, frame, f"{field}.coordinates" if single else f"{field}.coordinates.{i}", what)
        for i, rings in enumerate(polygons)
    ]
    return unary_union(shapes)


def _polygon(rings: Sequence[Sequence[spec.LonLat]], frame: LocalFrame, field: str, what: str) -> Polygon:
    if not rings:
        raise MissionInputError(f"{what} is empty", "draw an area of at least three corners", field)
    for index, ring in enumerate(rings):
        if len({tuple(point) for point in ring}) < 3:
            raise MissionInputError(
                f"{what} has fewer than three different corners", "draw at least three", f"{field}.{index}"
            )
    outline, *holes = ([frame.to_enu(GeoPoint(lat, lon)) for lon, lat in ring] for ring in rings)
    polygon = Polygon(outline, holes)
    if not polygon.is_valid:
        raise MissionInputError(_why_invalid(polygon, what), "move the corners so that no two edges cross", field)
    return polygon


def _why_invalid(polygon: Polygon, what: str) -> str:
    why = explain_validity(polygon).lower()
    if "self-intersection" in why:
        return f"the outline of {what} crosses itself"
    if "hole lies outside" in why or "nested" in why:
        return f"a hole of {what} lies outside its outline"
    return f"{what} is no simple polygon ({why.split('[')[0].strip()})"


def target_area(mission: MissionSpec, frame: LocalFrame) -> BaseGeometry:
    """Where the emitter may be. Raises MissionInputError when empty, crossing itself, too small, too big or too far."""
    area = area_geometry(mission.area, frame, "area", "the area")
    if area.area < SMALLEST_M2:
        raise MissionInputError(
            f"the area has only {area.area:.0f} m2", f"draw at least {SMALLEST_M2:.0f} m2", "area.coordinates"
        )
    west, south, east, north = area.bounds
    if max(east - west, north - south) > LARGEST_EXTENT_M:
        raise MissionInputError(
            f"the area is {max(east - west, north - south) / 1000:.1f} km wide",
            f"search at most {LARGEST_EXTENT_M / 1000:.0f} km at a time",
            "area.coordinates",
        )
    return area


def check_reach(area: BaseGeometry) -> None:
    """Raises MissionInputError when the area lies far from the frame's origin, the vehicle's home."""
    nearest = area.distance(Point(0.0, 0.0))
    if not nearest <= FAR_M:
        raise MissionInputError(
            f"the area is {nearest / 1000:.1f} km away from the vehicle",
            "draw the area where the vehicle is, or carry the vehicle there",
            "area.coordinates",
        )


def fence(mission: MissionSpec, area: BaseGeometry, frame: LocalFrame) -> BaseGeometry:
    """Where the vehicle may be: the drawn fence, else the area with its margin."""
    if mission.flight.fence is not None:
        return area_geometry(mission.flight.fence, frame, "flight.fence", "the fence")
    return area.buffer(mission.flight.fence_margin_m, quad_segs=4)


def no_fly(mission: MissionSpec, frame: LocalFrame) -> tuple[BaseGeometry, ...]:
    return tuple(
        area_geometry(zone, frame, f"flight.no_fly.{i}", f"no-fly zone {i + 1}")
        for i, zone in enumerate(mission.flight.no_fly)
    )


def region(geometry: BaseGeometry) -> Region:
    """Outlines and holes as rings, not closed."""
    parts = geometry.geoms if isinstance(geometry, MultiPolygon) else [geometry]
    rings = []
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


def centre_of(area: spec.Area) -> GeoPoint:
    """Middle of the bounding rectangle, for a frame while no vehicle's home is known.

    Raises MissionInputError when there is no corner.
    """
    polygons = [area.coordinates] if isinstance(area, spec.Polygon) else area.coordinates
    corners = [point for rings in polygons for ring in rings for point in ring]
    if not corners:
        raise MissionInputError("the area is empty", "draw an area of at least three corners", "area")
    lon = [c[0] for c in corners]
    lat = [c[1] for c in corners]
    return GeoPoint(math.fsum((min(lat), max(lat))) / 2, math.fsum((min(lon), max(lon))) / 2)
