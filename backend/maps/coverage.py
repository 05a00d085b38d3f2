"""Does a map show the area, and how finely? Counted in the map's own tiles, not from its bounding box.

Tiles are the XYZ squares of Web Mercator: at zoom z the world is 2^z tiles wide, a tile (x, y) counts from the
north-west. Areas are compared in that plane; over a mission's few kilometres its scale does not change visibly.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import shape
from shapely.geometry.base import BaseGeometry

from backend.maps.refusal import MapRefused
from backend.reasons.maps import AreaOnMaps, BeyondWebMaps
from backend.reasons.search import AreaEmpty, TooFewCorners
from backend.search.area import why_invalid
from backend.spec import Area, MultiPolygon
from backend.wire.maps import Coverage, MapCoverage, ZoomCoverage

EQUATOR_M = 40_075_016.686
TILE_PIXELS = 256
FLY_BY_METRES_PER_PIXEL = 10.0
"""A map this fine shows paths, hedges and buildings' blocks: enough to place an area."""

MOST_TILES = 2048
"""Zooms at which the area needs more tiles are not looked at."""

WHOLE = 1 - 1e-6
HIGHEST_LATITUDE = 85.0511

HasTile = Callable[[int, int, int], bool]


@dataclass(frozen=True, slots=True)
class TileSet:
    """What coverage needs to know of a map."""

    map_id: str
    name: str
    min_zoom: int
    max_zoom: int
    has: HasTile


def coverage(area: Area, maps: Iterable[TileSet]) -> Coverage:
    """Compare an area with every map. MapRefused when the area is empty, crosses itself or reaches a pole."""
    plane = to_plane(area)
    latitude = _middle_latitude(plane)
    found = [_of_map(plane, latitude, tiles) for tiles in maps]
    shown = shapely.union_all([fine for _, fine in found])
    left = plane.difference(shown)
    fraction = _share(plane.intersection(shown), plane)
    covered = fraction >= WHOLE
    return Coverage(
        covered=covered,
        fraction=1.0 if covered else fraction,
        missing=None if covered else to_geojson(left),
        summary=_summary(covered, fraction, [entry for entry, _ in found]),
        maps=[entry for entry, _ in found],
    )


def _summary(covered: bool, fraction: float, maps: Sequence[MapCoverage]) -> AreaOnMaps:
    if not maps:
        return AreaOnMaps("no_map", 0.0)
    if covered:
        return AreaOnMaps("whole", 100.0)
    return AreaOnMaps("not_finely" if fraction == 0 else "partly", math.floor(fraction * 100))


def _of_map(plane: BaseGeometry, latitude: float, tiles: TileSet) -> tuple[MapCoverage, BaseGeometry]:
    """What one map shows of the area, and where it is fine enough to fly by."""
    zooms: list[ZoomCoverage] = []
    fine: list[BaseGeometry] = []
    missing: BaseGeometry | None = None
    for zoom in range(tiles.min_zoom, tiles.max_zoom + 1):
        needed = tiles_over(plane, zoom)
        if needed is None:
            break
        present = needed[[tiles.has(zoom, int(x) % 2**zoom, int(y)) for x, y in needed]]
        shown = shapely.union_all(tile_squares(present, zoom))
        fraction = _share(plane.intersection(shown), plane)
        resolution = metres_per_pixel(zoom, latitude)
        zooms.append(
            ZoomCoverage(
                zoom=zoom,
                fraction=1.0 if fraction >= WHOLE else fraction,
                tiles_needed=len(needed),
                tiles_present=len(present),
                metres_per_pixel=resolution,
            )
        )
        missing = None if fraction >= WHOLE else plane.difference(shown)
        if resolution <= FLY_BY_METRES_PER_PIXEL:
            fine.append(shown)
    full = max((entry for entry in zooms if entry.fraction == 1.0), key=lambda entry: entry.zoom, default=None)
    entry = MapCoverage(
        map_id=tiles.map_id,
        name=tiles.name,
        zooms=zooms,
        full_to_zoom=full.zoom if full else None,
        metres_per_pixel=full.metres_per_pixel if full else None,
        missing=None if missing is None else to_geojson(missing),
    )
    return entry, shapely.union_all(fine)


def metres_per_pixel(zoom: int, latitude_deg: float) -> float:
    """Ground size of a pixel: equator * cos(latitude) / (256 * 2^zoom)."""
    return EQUATOR_M * math.cos(math.radians(latitude_deg)) / (TILE_PIXELS * 2**zoom)


def tiles_over(plane: BaseGeometry, zoom: int) -> NDArray[np.int64] | None:
    """(n, 2) x, y of the tiles that share area with the geometry; None when there are too many. Beyond 180 degrees x
    goes on, below 0 or from 2^zoom."""
    n = 2**zoom
    sides: list[float] = (np.array(plane.bounds) * n).tolist()
    west, north, east, south = sides
    x = np.arange(math.floor(west), math.floor(east) + 1)
    y = np.arange(int(max(north, 0.0)), int(min(south, n - 1e-9)) + 1)
    if len(x) * len(y) > 4 * MOST_TILES:
        return None
    tiles = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    squares = tile_squares(tiles, zoom)
    # shapely does not say what it is an array of
    shared = shapely.area(shapely.intersection(squares, plane))  # pyright: ignore[reportUnknownMemberType]
    tiles = tiles[shared > 0]
    return tiles if len(tiles) <= MOST_TILES else None


def tile_squares(tiles: NDArray[np.int64], zoom: int) -> NDArray[np.object_]:
    """The tiles as squares of the plane."""
    corner = tiles / 2**zoom
    size = 1 / 2**zoom
    west: NDArray[np.float64] = corner[:, 0]
    north: NDArray[np.float64] = corner[:, 1]
    return shapely.box(west, north, west + size, north + size)


def to_plane(area: Area) -> BaseGeometry:
    """The area in the Mercator plane, 0..1 from west to east and from north to south; in one piece across 180 degrees,
    beyond 0 or 1."""
    try:
        geometry = shape(area.model_dump())
        geometry = shapely.transform(geometry, _beside_first)
    except (ValueError, IndexError, shapely.errors.GEOSException) as error:
        raise MapRefused(TooFewCorners("area")) from error
    if not geometry.is_empty and not geometry.is_valid:
        raise MapRefused(why_invalid(geometry, "area"))
    if geometry.is_empty or geometry.area == 0:
        raise MapRefused(AreaEmpty("area"))
    if max(abs(geometry.bounds[1]), abs(geometry.bounds[3])) > HIGHEST_LATITUDE:
        raise MapRefused(BeyondWebMaps())
    return shapely.transform(geometry, _project)


def _beside_first(lon_lat: NDArray[np.float64]) -> NDArray[np.float64]:
    """Each longitude at most half a turn from the first."""
    lon = lon_lat[:, 0]
    return np.column_stack((lon - 360.0 * np.rint((lon - lon[:1]) / 360.0), lon_lat[:, 1]))


def _project(lon_lat: NDArray[np.float64]) -> NDArray[np.float64]:
    """Web Mercator: x = (lon + 180) / 360, y = (1 - asinh(tan(lat)) / pi) / 2."""
    lon, lat = lon_lat[:, 0], np.radians(lon_lat[:, 1])
    return np.column_stack(((lon + 180) / 360, (1 - np.arcsinh(np.tan(lat)) / np.pi) / 2))


def _unproject(xy: NDArray[np.float64]) -> NDArray[np.float64]:
    lat = np.arctan(np.sinh(np.pi * (1 - 2 * xy[:, 1])))
    lon = xy[:, 0] * 360 - 180
    return np.column_stack((lon - 360.0 * np.rint(lon / 360.0), np.degrees(lat)))


def _middle_latitude(plane: BaseGeometry) -> float:
    y = (plane.bounds[1] + plane.bounds[3]) / 2
    return float(_unproject(np.array([[0.0, y]]))[0, 1])


def _share(part: BaseGeometry, whole: BaseGeometry) -> float:
    return min(1.0, part.area / whole.area)


def to_geojson(plane: BaseGeometry) -> MultiPolygon | None:
    """Back to lon/lat, seven decimals (a centimetre); lines and points that a difference leaves behind are dropped."""
    polygons = [part for part in shapely.get_parts(plane) if part.geom_type == "Polygon" and part.area > 0]
    if not polygons:
        return None
    rings = [
        [
            [(round(lon, 7), round(lat, 7)) for lon, lat in _unproject(shapely.get_coordinates(ring)).tolist()]
            for ring in (polygon.exterior, *polygon.interiors)
        ]
        for polygon in polygons
    ]
    return MultiPolygon(coordinates=rings)
