"""Whether a region covers a place, across the antimeridian too. Longitudes are counted on from a first one."""

from __future__ import annotations

from collections.abc import Sequence

from shapely import MultiPolygon, Point

from backend.spec import Area, LonLat, Place, Polygon

FEWEST_CORNERS = 4
"""Of a closed ring."""


def beside(lon_deg: float, first_deg: float) -> float:
    """The same meridian, at most half a turn from the first."""
    return lon_deg + 360.0 * round((first_deg - lon_deg) / 360.0)


def polygons_of(area: Area) -> list[list[list[LonLat]]]:
    """Rings of each, the outline first."""
    return [area.coordinates] if isinstance(area, Polygon) else area.coordinates


def is_region(area: Area) -> bool:
    """Every polygon has an outline, and every ring corners enough to be one."""
    polygons = polygons_of(area)
    return bool(polygons) and all(rings and all(len(ring) >= FEWEST_CORNERS for ring in rings) for rings in polygons)


def in_one_piece(polygons: Sequence[Sequence[Sequence[LonLat]]]) -> MultiPolygon:
    """In degrees, beside their first corner: some may lie beyond 180."""
    first = polygons[0][0][0][0]
    moved = [[[(beside(lon, first), lat) for lon, lat in ring] for ring in rings] for rings in polygons]
    return MultiPolygon([(outline, holes) for outline, *holes in moved])


def covers(region: Area, place: Place) -> bool:
    """What is no region covers nothing: servers of before took such in with bundles."""
    if not is_region(region):
        return False
    polygons = polygons_of(region)
    at = Point(beside(place.lon, polygons[0][0][0][0]), place.lat)
    return bool(in_one_piece(polygons).covers(at))
