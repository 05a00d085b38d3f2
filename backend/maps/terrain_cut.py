"""What the uploaded terrains know around a place, as one grid: the finest first, the others where it knows nothing."""

from __future__ import annotations

import logging
import math
from collections.abc import Sequence

import numpy as np

from backend.maps.refusal import MapRefused
from backend.maps.terrarium import Terrarium
from backend.search.area import FAR_M
from backend.terrain import METRES_PER_DEGREE, Terrain
from hardware.readings import Place

log = logging.getLogger("crossfix.maps")

REACH_M = FAR_M + 800.0
"""Nothing farther from home is ever flown to; with it, as far as a home is from where the cut is taken."""
HOMES_DEG = 0.01
"""Homes this near to one another share their ground, and so its place on the disk."""
MOST_NODES = 4_000_000
ROWS_AT_ONCE = 512

Source = Terrain | Terrarium


def around(place: Place, sources: Sequence[Source]) -> Terrain | None:
    """The ground within reach of a home. None: no source knows any of it. Takes seconds: not on an event loop."""
    place = Place(*whereabouts(place))
    reach_lat = REACH_M / METRES_PER_DEGREE
    reach_lon = reach_lat / max(math.cos(math.radians(place.lat)), 0.01)
    box = (place.lon - reach_lon, place.lat - reach_lat, place.lon + reach_lon, place.lat + reach_lat)
    near = [source for source in sources if meets(bounds_of(source), box)]
    if not near:
        return None
    near.sort(key=lambda source: _steps(source, place.lat)[0])
    lat_step, lon_step = _steps(near[0], place.lat)
    apart = math.ceil(math.sqrt(4 * reach_lat * reach_lon / (lat_step * lon_step) / MOST_NODES))
    lat_step, lon_step = lat_step * apart, lon_step * apart
    north, west = _aligned(near[0], box[3], box[0], lat_step, lon_step)
    rows, columns = math.ceil(2 * reach_lat / lat_step) + 2, math.ceil(2 * reach_lon / lon_step) + 2
    heights = np.full((rows, columns), np.nan, np.float32)
    used: list[str] = []
    lon = west + np.arange(columns) * lon_step
    for source in near:
        before = int(np.isfinite(heights).sum())
        for first in range(0, rows, ROWS_AT_ONCE):
            lat = north - np.arange(first, min(first + ROWS_AT_ONCE, rows)) * lat_step
            part = heights[first : first + len(lat)]
            try:
                rows_of, columns_of = np.meshgrid(lat, lon, indexing="ij")
                found = source.at(np.asarray(rows_of.ravel(), np.float64), np.asarray(columns_of.ravel(), np.float64))
            except (OSError, ValueError, MapRefused) as error:  # deleted meanwhile, or damaged: the others still count
                log.warning("terrain %s cannot be read: %s", source, error)
                break
            np.copyto(part, found.reshape(part.shape).astype(np.float32), where=np.isnan(part))
        if int(np.isfinite(heights).sum()) > before:
            used += source.sources if isinstance(source, Terrain) else (source.name,)
    return Terrain(north, west, lat_step, lon_step, heights, tuple(used)) if used else None


def whereabouts(home: Place) -> tuple[float, float]:
    """Latitude and longitude that homes near to one another have in common."""
    return round(round(home.lat / HOMES_DEG) * HOMES_DEG, 6), round(round(home.lon / HOMES_DEG) * HOMES_DEG, 6)


def bounds_of(source: Source) -> tuple[float, float, float, float]:
    """West, south, east, north, degrees."""
    if isinstance(source, Terrarium):
        return source.bounds
    rows, columns = source.heights.shape
    south, east = (
        source.north_deg - (rows - 1) * source.lat_step_deg,
        source.west_deg + (columns - 1) * source.lon_step_deg,
    )
    return source.west_deg, south, east, source.north_deg


def meets(one: tuple[float, float, float, float], other: tuple[float, float, float, float]) -> bool:
    """Whether two boxes (west, south, east, north, degrees) have ground in common, across 180 degrees too."""
    beside = any(one[0] < other[2] + turn and other[0] + turn < one[2] for turn in (-360.0, 0.0, 360.0))
    return beside and one[1] < other[3] and other[1] < one[3]


def _steps(source: Source, lat_deg: float) -> tuple[float, float]:
    if isinstance(source, Terrain):
        return source.lat_step_deg, source.lon_step_deg
    step = source.step_deg(lat_deg)
    return step * math.cos(math.radians(lat_deg)), step


def _aligned(source: Source, north: float, west: float, lat_step: float, lon_step: float) -> tuple[float, float]:
    """On nodes of the finest source, so that none of its summits is flattened between them."""
    if isinstance(source, Terrarium):
        return north, west
    middle = source.west_deg + source.lon_step_deg * (source.heights.shape[1] - 1) / 2
    west += 360.0 * round((middle - west) / 360.0)
    up = math.ceil((north - source.north_deg) / lat_step)
    left = math.ceil((source.west_deg - west) / lon_step)
    return source.north_deg + up * lat_step, source.west_deg - left * lon_step
