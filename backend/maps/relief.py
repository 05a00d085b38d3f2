"""Pictures of the ground for the map: Terrarium tiles for its shading, and contour lines.

A tile is made from whatever terrain there is, so that the page needs one source for all of it.
"""

from __future__ import annotations

from collections.abc import Sequence
from io import BytesIO
from typing import Any, cast

import numpy as np
from contourpy import LineType, contour_generator
from numpy.typing import NDArray
from PIL import Image

from backend.maps.terrain_cut import Source, bounds_of, meets
from backend.maps.terrarium import Terrarium
from backend.terrain import Terrain

TILE = 256
LOWEST_ZOOM, HIGHEST_ZOOM = 8, 15
MOST_CONTOUR_NODES = 400_000
STEPS_M = (1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0)
MOST_LINES_ABOVE_ONE_ANOTHER = 25

Numbers = NDArray[np.float64]


def relief_tile(sources: Sequence[Source], zoom: int, x: int, y: int) -> bytes | None:
    """A Terrarium tile as PNG; what is not known is as high as the rest of it. None: nothing of it is known."""
    lon, lat = _pixels(zoom, x, y)
    heights = np.full((TILE, TILE), np.nan)
    for source in sources:
        if not meets(bounds_of(source), (lon[0], lat[-1], lon[-1], lat[0])):
            continue
        if isinstance(source, Terrarium):
            found = _scaled(source.tile(zoom, x, y))
        else:
            found = source.at(*(axis.ravel() for axis in np.meshgrid(lat, lon, indexing="ij"))).reshape(TILE, TILE)
        np.copyto(heights, found, where=np.isnan(heights))
    if np.isnan(heights).all():
        return None
    return _encode(np.where(np.isnan(heights), np.nanmean(heights), heights))


def _pixels(zoom: int, x: int, y: int) -> tuple[Numbers, Numbers]:
    """Longitudes and latitudes (256,) of the centres of a tile's pixels, from west to east and from north to south."""
    at = (np.arange(TILE) + 0.5) / TILE
    lon = (x + at) / 2**zoom * 360.0 - 180.0
    lat = np.degrees(np.arctan(np.sinh(np.pi * (1 - 2 * (y + at) / 2**zoom))))
    return lon, lat


def _scaled(heights: NDArray[np.float32]) -> Numbers:
    each = heights.shape[0] // TILE
    return heights[::each, ::each].astype(float)


def _encode(heights: Numbers) -> bytes:
    value = np.rint((heights + 32768.0) * 256.0).astype(np.int64)
    rgb = np.stack((value >> 16, (value >> 8) & 255, value & 255), axis=-1).astype(np.uint8)
    picture = BytesIO()
    Image.fromarray(rgb).save(picture, "PNG", compress_level=3)
    return picture.getvalue()


def contours(terrain: Terrain) -> dict[str, object]:
    """Contour lines as a GeoJSON FeatureCollection; `height_m` AMSL, `index` on each fifth line."""
    every = max(1, round((terrain.heights.size / MOST_CONTOUR_NODES) ** 0.5))
    heights = terrain.heights[::every, ::every].astype(float)
    rows, columns = heights.shape
    lat: Numbers = terrain.north_deg - np.arange(rows, dtype=np.float64) * terrain.lat_step_deg * every
    lon: Numbers = terrain.west_deg + np.arange(columns, dtype=np.float64) * terrain.lon_step_deg * every
    lowest, highest = float(np.nanmin(heights)), float(np.nanmax(heights))
    step = next((s for s in STEPS_M if (highest - lowest) / s <= MOST_LINES_ABOVE_ONE_ANOTHER), STEPS_M[-1])
    generator = contour_generator(lon, lat, np.ma.masked_invalid(heights), line_type=LineType.Separate)
    features: list[dict[str, object]] = []
    for number in range(int(np.ceil(lowest / step)), int(np.floor(highest / step)) + 1):
        found = cast(list[Numbers], generator.lines(number * step))  # one array a line: LineType.Separate
        lines: list[Any] = [np.round(line, 5).tolist() for line in found if len(line) > 3]
        if lines:
            features.append(
                {
                    "type": "Feature",
                    "properties": {"height_m": number * step, "index": number % 5 == 0},
                    "geometry": {"type": "MultiLineString", "coordinates": lines},
                }
            )
    return {"type": "FeatureCollection", "features": features}
