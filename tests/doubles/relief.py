"""Made-up ground around a home: as terrain, as the bytes of a GeoTIFF, as Terrarium tiles, and a shelf for it."""

from __future__ import annotations

import io
import struct
import zlib
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from backend.terrain import Terrain
from hardware.readings import Place

HOME = Place(50.0, 7.0)
M_LAT = 111_195.0
M_LON = M_LAT * float(np.cos(np.radians(HOME.lat)))

Shape = Callable[[NDArray[np.float64], NDArray[np.float64]], NDArray[np.float64]]
"""Metres east and north of home to metres AMSL."""


def terrain(shape: Shape, spacing_m: float = 20.0, reach_m: float = 3000.0, name: str = "made") -> Terrain:
    count = round(2 * reach_m / spacing_m) + 1
    along = (np.arange(count) - count // 2) * spacing_m
    east, north = np.meshgrid(along, along[::-1])
    heights = shape(np.asarray(east, np.float64), np.asarray(north, np.float64)).astype(np.float32)
    lat, lon = spacing_m / M_LAT, spacing_m / M_LON
    first = count // 2
    return Terrain(HOME.lat + first * lat, HOME.lon - first * lon, lat, lon, heights, (name,))


class Shelf:
    """Terrain as it was brought, and what missions put aside of it. full: nothing more fits."""

    def __init__(self, found: Terrain | None) -> None:
        self.found = found
        self.stored: dict[str, Terrain] = {}
        self.full = False

    async def around(self, home: Place) -> Terrain | None:
        return self.found

    async def keep(self, terrain: Terrain) -> None:
        if self.full:
            raise OSError(28, "No space left on device")
        self.stored[terrain.digest] = terrain

    async def kept(self, digest: str) -> Terrain | None:
        return self.stored.get(digest)


def level(height_m: float = 100.0) -> Shape:
    return lambda east, north: np.full(np.broadcast(east, north).shape, height_m)


def hill(east_m: float, north_m: float, high_m: float, wide_m: float = 80.0, base_m: float = 100.0) -> Shape:
    """A hill (or, with a negative height, a hollow) in a plain."""

    def shape(east: NDArray[np.float64], north: NDArray[np.float64]) -> NDArray[np.float64]:
        return base_m + high_m * np.exp(-((east - east_m) ** 2 + (north - north_m) ** 2) / (2 * wide_m**2))

    return shape


def geotiff(
    heights: NDArray[np.generic],
    north_deg: float = 51.0,
    west_deg: float = 7.0,
    step_deg: float = 1 / 3600,
    *,
    epsg: int | None = 4326,
    no_data: str | None = None,
    point: bool = False,
    tile: int = 0,
    compressed: bool = False,
    predictor: int = 1,
    more_keys: tuple[tuple[int, int], ...] = (),
) -> bytes:
    """A little-endian GeoTIFF of one band; tile 0: in one strip. predictor: 2 and 3 as the TIFF specification has."""
    rows, columns = heights.shape
    if tile:
        down, right = -rows % tile, -columns % tile
        padded = np.pad(heights, ((0, down), (0, right)))
        blocks = [
            padded[r : r + tile, c : c + tile]
            for r in range(0, rows + down, tile)
            for c in range(0, columns + right, tile)
        ]
    else:
        blocks = [heights]
    packed = [_predicted(np.ascontiguousarray(block), predictor) for block in blocks]
    packed = [zlib.compress(block) for block in packed] if compressed else packed
    kind = {"i": 2, "u": 1, "f": 3}[heights.dtype.kind]
    keys = [(1024, 2), (1025, 2 if point else 1)] if epsg is not None else []
    keys += [(2048, epsg)] if epsg is not None else []
    keys += list(more_keys)
    directory = [1, 1, 0, len(keys), *(number for key, value in keys for number in (key, 0, 1, value))]
    half = 0.0 if point else 0.5
    ties = (0.0, 0.0, 0.0, west_deg - half * step_deg, north_deg + half * step_deg, 0.0)
    tags: list[tuple[int, str, tuple[float, ...] | bytes]] = [
        (256, "L", (columns,)), (257, "L", (rows,)), (258, "H", (heights.dtype.itemsize * 8,)),
        (259, "H", (8 if compressed else 1,)), (262, "H", (1,)), (277, "H", (1,)),
    ]  # fmt: skip
    sizes = tuple(float(len(block)) for block in packed)
    tags += (
        [(322, "L", (tile,)), (323, "L", (tile,)), (325, "L", sizes)]
        if tile
        else [(278, "L", (rows,)), (279, "L", sizes)]
    )
    tags += [(317, "H", (predictor,))] if predictor > 1 else []
    tags += [(339, "H", (kind,)), (33550, "d", (step_deg, step_deg, 0.0)), (33922, "d", ties)]
    tags += [(34735, "H", tuple(directory))] if keys else []
    tags += [] if no_data is None else [(42113, "s", no_data.encode() + b"\0")]
    return _tiff(tags, packed, 324 if tile else 273)


def _predicted(block: NDArray[np.generic], predictor: int) -> bytes:
    if predictor == 2:
        return np.concatenate((block[:, :1], np.diff(block, axis=1)), axis=1).astype(block.dtype).tobytes()
    if predictor == 3:
        size = block.dtype.itemsize
        planes = block.view(np.uint8).reshape(block.shape[0], -1, size)[..., ::-1].transpose(0, 2, 1)
        rows = planes.reshape(block.shape[0], -1)
        return np.concatenate((rows[:, :1], np.diff(rows, axis=1)), axis=1).astype(np.uint8).tobytes()
    return block.tobytes()


def _tiff(tags: list[tuple[int, str, tuple[float, ...] | bytes]], blocks: list[bytes], offsets_tag: int) -> bytes:
    forms = {"H": 3, "L": 4, "d": 12, "s": 2}
    tags = sorted([*tags, (offsets_tag, "L", tuple(0.0 for _ in blocks))])
    end_of_directory = 8 + 2 + 12 * len(tags) + 4

    def raw(form: str, values: tuple[float, ...] | bytes) -> bytes:
        if isinstance(values, bytes):
            return values
        return struct.pack(f"<{len(values)}{form}", *(value if form == "d" else int(value) for value in values))

    room = sum(len(found) for _, form, values in tags if len(found := raw(form, values)) > 4)
    at, offsets = end_of_directory + room, []
    for block in blocks:
        offsets.append(float(at))
        at += len(block)
    entries, beyond = b"", b""
    for tag, form, values in tags:
        found = raw(form, tuple(offsets) if tag == offsets_tag else values)
        if len(found) > 4:
            place = struct.pack("<L", end_of_directory + len(beyond))
            beyond += found
        else:
            place = found.ljust(4, b"\0")
        entries += struct.pack("<HHL", tag, forms[form], len(values)) + place
    return b"II*\0" + struct.pack("<LH", 8, len(tags)) + entries + b"\0\0\0\0" + beyond + b"".join(blocks)


def terrarium_tile(heights: NDArray[np.float64], form: str = "PNG") -> bytes:
    value = np.rint((heights + 32768.0) * 256.0).astype(np.int64)
    rgb = np.stack((value >> 16, (value >> 8) & 255, value & 255), axis=-1).astype(np.uint8)
    picture = io.BytesIO()
    Image.fromarray(rgb).save(picture, form, **({"lossless": True} if form == "WEBP" else {}))
    return picture.getvalue()
