"""Heights out of a PMTiles archive of Terrarium tiles: height = red * 256 + green + blue / 256 - 32768, metres AMSL.

Tiles are the XYZ squares of Web Mercator, read and decoded when they are needed; each is bounded in size.
"""

from __future__ import annotations

import math
from functools import lru_cache
from io import BytesIO
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from backend.maps.archive import Archive, bounds
from backend.maps.coverage import EQUATOR_M
from backend.maps.refusal import ArchiveUnusable, MapRefused
from backend.reasons.terrain import TerrariumFault, TerrariumUnusable

TILE_SIDES = (256, 512)
FINEST_M = 3.0
"""Finer pixels are not read: no terrain of this kind knows more."""
LOWEST_M, HIGHEST_M = -500.0, 9_000.0
LOOKED_AT = 8
MOST_TILES_AT_ONCE = 1024
"""In one answer; more would take gigabytes."""

Numbers = NDArray[np.float64]
Heights = NDArray[np.float32]


def _refused(fault: TerrariumFault) -> MapRefused:
    return MapRefused(TerrariumUnusable(fault))


def decode(tile: bytes) -> Heights:
    """(side, side) m AMSL from north to south, NaN where the tile is transparent or holds no height. MapRefused."""
    try:
        with Image.open(BytesIO(tile), formats=("PNG", "WEBP")) as picture:
            if picture.width != picture.height or picture.width not in TILE_SIDES:
                raise _refused("tile_size")
            red, green, blue, alpha = np.moveaxis(np.asarray(picture.convert("RGBA")).astype(np.float32), -1, 0)
    except (OSError, ValueError, SyntaxError, Image.DecompressionBombError) as error:
        raise _refused("damaged") from error
    heights = red * 256 + green + blue / 256 - 32768
    known = (alpha > 0) & (heights >= LOWEST_M) & (heights <= HIGHEST_M)
    return np.where(known, heights, np.float32(np.nan))


class Terrarium:
    """One archive as a source of heights. name: what to call it."""

    def __init__(self, path: Path, name: str) -> None:
        self.archive = Archive(path)
        self.name = name
        self._tile = lru_cache(maxsize=64)(self._decoded)

    def check(self) -> None:
        """Refuse an archive whose tiles are no Terrarium heights: looked at in its first tiles."""
        kind = self.archive.header["tile_type"].name
        if kind == "MVT":
            raise _refused("vector")
        if kind not in ("PNG", "WEBP"):
            raise _refused("picture_type")
        try:
            self.archive.check()
            found = [decode(tile) for _, tile in zip(range(LOOKED_AT), self.archive.tiles(), strict=False)]
        except ArchiveUnusable:
            raise
        if not any(np.isfinite(heights).mean() > 0.5 for heights in found):
            raise _refused("no_heights")

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """West, south, east, north, degrees."""
        return bounds(self.archive.header)

    @property
    def side(self) -> int:
        """Pixels of a tile."""
        return self.archive.tile_pixels() or 256

    def zoom_at(self, lat_deg: float) -> int:
        """The finest zoom that is worth reading there."""
        metres = EQUATOR_M * math.cos(math.radians(lat_deg)) / self.side
        worth = max(0, math.floor(math.log2(metres / FINEST_M)))
        return max(self.archive.header["min_zoom"], min(self.archive.header["max_zoom"], worth))

    def step_deg(self, lat_deg: float) -> float:
        """Between pixels, from west to east."""
        return 360.0 / (2 ** self.zoom_at(lat_deg) * self.side)

    def at(self, lat_deg: Numbers, lon_deg: Numbers) -> Numbers:
        """Heights (n,) by bilinear interpolation between the centres of pixels; NaN where no tile is."""
        zoom, side = self.zoom_at(float(np.mean(lat_deg))), self.side
        pixels = 2**zoom * side
        x = (lon_deg + 180.0) / 360.0 * pixels - 0.5
        y = (1 - np.arcsinh(np.tan(np.radians(lat_deg))) / np.pi) / 2 * pixels - 0.5
        left, top = np.floor(x).astype(np.int64), np.floor(y).astype(np.int64)
        west, north = int(left.min()) // side, int(top.min()) // side
        east, south = (int(left.max()) + 1) // side, (int(top.max()) + 1) // side
        if (east - west + 1) * (south - north + 1) > MOST_TILES_AT_ONCE:
            raise ValueError("too large an area for one answer")
        mosaic = np.block(
            [[self.tile(zoom, column, row) for column in range(west, east + 1)] for row in range(north, south + 1)]
        )
        column, row, u, v = left - west * side, top - north * side, x - left, y - top
        upper = (1 - u) * mosaic[row, column] + u * mosaic[row, column + 1]
        lower = (1 - u) * mosaic[row + 1, column] + u * mosaic[row + 1, column + 1]
        return (1 - v) * upper + v * lower

    def tile(self, zoom: int, x: int, y: int) -> Heights:
        """(side, side); NaN where there is no such tile, or it is damaged. Beyond 180 degrees x goes on."""
        return self._tile(zoom, x, y)

    def _decoded(self, zoom: int, x: int, y: int) -> Heights:
        nothing = np.full((self.side, self.side), np.nan, np.float32)
        if not 0 <= y < 2**zoom:
            return nothing
        try:
            content = self.archive.tile(zoom, x % 2**zoom, y)
            found = nothing if content is None else decode(content)
        except MapRefused:
            return nothing
        return found if found.shape == nothing.shape else nothing
