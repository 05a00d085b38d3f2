"""Geometry as RFC 7946 wants it, longitudes and latitudes in degrees: outlines counter-clockwise, holes clockwise, and
what lies across the antimeridian cut there in two."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import numpy as np
import shapely

from backend.spec import Area, Polygon

Point = list[float]
Rings = list[list[Point]]
EDGE_DEG, ROUND_DEG = 180.0, 360.0


def area_geometry(area: Area) -> dict[str, Any]:
    """A GeoJSON Polygon or MultiPolygon."""
    polygons = [area.coordinates] if isinstance(area, Polygon) else area.coordinates
    parts = [_wound(part) for rings in polygons for part in _cut(rings)]
    if len(parts) == 1 and isinstance(area, Polygon):
        return {"type": "Polygon", "coordinates": parts[0]}
    return {"type": "MultiPolygon", "coordinates": parts}


def path_geometry(points: Sequence[Point]) -> dict[str, Any]:
    """A GeoJSON LineString, or a MultiLineString across the antimeridian. points: two at least."""
    parts = [[points[0]]]
    for (lon, lat), there in pairwise(points):
        if abs(there[0] - lon) > EDGE_DEG:
            edge = math.copysign(EDGE_DEG, lon)
            whole = there[0] + 2.0 * edge - lon
            at = lat if whole == 0.0 else lat + (edge - lon) / whole * (there[1] - lat)
            _reach(parts[-1], [edge, at])
            parts.append([[-edge, at]])
            _reach(parts[-1], there)
        else:
            parts[-1].append(there)
    lines = [part for part in parts if len(part) > 1]
    if len(lines) == 1:
        return {"type": "LineString", "coordinates": lines[0]}
    return {"type": "MultiLineString", "coordinates": lines}


def _reach(line: list[Point], point: Point) -> None:
    if line[-1] != point:
        line.append(point)


def _cut(rings: Sequence[Sequence[Sequence[float]]]) -> list[Rings]:
    """A polygon's parts on either side of the antimeridian. As it is, if it is none or lies around a pole."""
    near = rings[0][0][0] if rings and rings[0] else 0.0
    whole = [_unrolled(ring, near) for ring in rings]
    lons = [lon for ring in whole for lon, _ in ring]
    if not lons or (min(lons) >= -EDGE_DEG and max(lons) <= EDGE_DEG):
        return [whole]
    as_it_is = [[list(point) for point in ring] for ring in rings]
    if any(len(ring) < 4 or ring[0] != ring[-1] for ring in whole):
        return [as_it_is]
    polygon = shapely.make_valid(shapely.Polygon(whole[0], whole[1:]), method="structure", keep_collapsed=False)
    parts: list[Rings] = []
    for round_deg in (-ROUND_DEG, 0.0, ROUND_DEG):
        side = shapely.box(round_deg - EDGE_DEG, -90.0, round_deg + EDGE_DEG, 90.0)
        for part in shapely.get_parts(shapely.intersection(polygon, side)):
            if isinstance(part, shapely.Polygon) and not part.is_empty:
                back = np.array([round_deg, 0.0])
                parts.append([(np.array(ring.coords) - back).tolist() for ring in (part.exterior, *part.interiors)])
    return parts or [as_it_is]


def _unrolled(ring: Sequence[Sequence[float]], near_deg: float) -> list[Point]:
    """Every longitude within half a round of the one before it, beyond 180 where need be."""
    points: list[Point] = []
    for lon, lat in ring:
        near_deg = lon + ROUND_DEG * round((near_deg - lon) / ROUND_DEG)
        points.append([near_deg, lat])
    return points


def _wound(rings: Rings) -> Rings:
    return [ring if (_twice_area(ring) >= 0.0) == (number == 0) else ring[::-1] for number, ring in enumerate(rings)]


def _twice_area(ring: list[Point]) -> float:
    """Positive counter-clockwise."""
    if not ring:
        return 0.0
    x0, y0 = ring[0]
    return math.fsum((x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0) for (x1, y1), (x2, y2) in pairwise(ring))
