"""A PMTiles v3 archive on disk: checked as untrusted input, described, and asked which tiles it has.

Format: PMTiles version 3 specification (protomaps/PMTiles, spec/v3): a 127-byte header, a root directory, JSON
metadata, leaf directories, tile data. Tile ids run along a Hilbert curve, zoom after zoom. Every offset is checked
against the file's size and every decompression is bounded, since the file comes from outside.
"""

from __future__ import annotations

import json
import zlib
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image, UnidentifiedImageError
from pmtiles.tile import Compression, HeaderDict, TileType, deserialize_header, zxy_to_tileid
from pydantic import JsonValue

from backend.maps.refusal import ArchiveUnusable
from backend.reasons.maps import (
    ArchiveDamaged,
    ArchiveFault,
    ArchivePart,
    CompressionNotRead,
    LooksLike,
    NotAnArchive,
    OldArchive,
    TilesNotDrawable,
)
from backend.wire.maps import TileType as TileName

HEADER_BYTES = 127
MOST_DIRECTORY_BYTES = 4 * 2**20
"""Unpacked; 400,000 tiles. Those of a map of the whole planet have some hundred kilobytes."""
MOST_METADATA_BYTES = 4 * 2**20
MOST_TILE_BYTES = 16 * 2**20
DEEPEST_DIRECTORY = 4
FINEST_ZOOM = 24

TILE_NAMES: dict[TileType, TileName] = {
    TileType.MVT: "mvt",
    TileType.PNG: "png",
    TileType.JPEG: "jpeg",
    TileType.WEBP: "webp",
    TileType.AVIF: "avif",
}

PARTS: dict[str, ArchivePart] = {
    "root": "directories",
    "metadata": "metadata",
    "leaf_directory": "directories",
    "tile_data": "tiles",
}
"""How the header's fields begin, and what they speak of."""

MAGIC: tuple[tuple[bytes, LooksLike], ...] = (
    (b"SQLite format 3", "sqlite"),
    (b"PK\x03\x04", "zip"),
    (b"\x1f\x8b", "gzip"),
    (b"II*\x00", "tiff"),
    (b"MM\x00*", "tiff"),
    (b"\x89PNG", "png"),
    (b"\xff\xd8\xff", "jpeg"),
    (b"{", "json"),
    (b"<", "xml"),
)


@dataclass(frozen=True, slots=True)
class Directory:
    """Entries in ascending tile id. run_length 0: the entry points to a leaf directory. Arrays (n,) int64."""

    tile_id: NDArray[np.int64]
    run_length: NDArray[np.int64]
    length: NDArray[np.int64]
    offset: NDArray[np.int64]


def read_header(first_bytes: bytes) -> HeaderDict:
    """The header of an archive that this program can show. ArchiveUnusable names what is not understood."""
    if first_bytes[:7] != b"PMTiles":
        raise ArchiveUnusable(NotAnArchive(_what_it_is(first_bytes)))
    if len(first_bytes) < HEADER_BYTES:
        raise _damaged("header", "cut_off")
    if first_bytes[7] != 3:
        raise ArchiveUnusable(OldArchive(first_bytes[7]))
    try:
        header = deserialize_header(first_bytes[:HEADER_BYTES])
    except ValueError as error:
        raise _damaged("header", "unreadable") from error
    if header["tile_type"] not in TILE_NAMES:
        raise ArchiveUnusable(TilesNotDrawable(header["tile_type"].name.lower()))
    for part in ("internal_compression", "tile_compression"):
        if header[part] not in (Compression.NONE, Compression.GZIP, Compression.UNKNOWN):
            raise ArchiveUnusable(CompressionNotRead(header[part].name.lower()))
    west, south, east, north = bounds(header)
    on_earth = -180 <= west < east <= 180 and -90 <= south < north <= 90
    if not on_earth or not header["min_zoom"] <= header["max_zoom"] <= FINEST_ZOOM:
        raise _damaged("header", "senseless")
    return header


def _damaged(part: ArchivePart, fault: ArchiveFault) -> ArchiveUnusable:
    return ArchiveUnusable(ArchiveDamaged(part, fault))


def _what_it_is(first_bytes: bytes) -> LooksLike | None:
    if not first_bytes:
        return "empty"
    return next((kind for magic, kind in MAGIC if first_bytes.startswith(magic)), None)


def bounds(header: HeaderDict) -> tuple[float, float, float, float]:
    """West, south, east, north, degrees."""
    west, south, east, north = (header[name] / 1e7 for name in ("min_lon_e7", "min_lat_e7", "max_lon_e7", "max_lat_e7"))
    return west, south, east, north


class Archive:
    """An archive opened for reading; every method reads from disk, none keeps the file open."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.size = path.stat().st_size
        self.header = read_header(self._read(0, min(HEADER_BYTES, self.size), "header"))
        self._directory = lru_cache(maxsize=32)(self._load_directory)

    def check(self) -> None:
        """Refuse an archive that is cut off or whose first tiles are not what its header says."""
        for name, part in PARTS.items():
            if self.header[f"{name}_offset"] + self.header[f"{name}_length"] > self.size:
                raise _damaged(part, "cut_off")
        self.metadata()
        first = next(self.tiles(), None)
        if first is None:
            raise _damaged("tiles", "missing")
        self._check_tile(first)

    def metadata(self) -> dict[str, Any]:
        """The JSON metadata; an object."""
        raw = self._unpack(
            self._read(self.header["metadata_offset"], self.header["metadata_length"], "metadata"),
            MOST_METADATA_BYTES,
            "metadata",
        )
        try:
            data: JsonValue = json.loads(raw) if raw else {}
        except (ValueError, RecursionError) as error:
            raise _damaged("metadata", "unreadable") from error
        if not isinstance(data, dict):
            raise _damaged("metadata", "senseless")
        return data

    def tiles(self) -> Iterator[bytes]:
        """Tile contents in the directory's order, as stored (maybe compressed)."""
        yield from self._tiles(self.header["root_offset"], self.header["root_length"], 0)

    def tile_pixels(self) -> int | None:
        """Width of a raster tile in pixels; None for vector tiles."""
        if self.header["tile_type"] is TileType.MVT:
            return None
        with Image.open(BytesIO(next(self.tiles()))) as picture:
            return picture.width

    def has(self, zoom: int, x: int, y: int) -> bool:
        """Whether the tile at zoom/x/y (XYZ scheme) is in the archive."""
        return self._place_of(zoom, x, y) is not None

    def tile(self, zoom: int, x: int, y: int) -> bytes | None:
        """The tile at zoom/x/y as stored, None when there is none. ArchiveUnusable when it is damaged."""
        found = self._place_of(zoom, x, y)
        if found is None:
            return None
        at, size = found
        if size > MOST_TILE_BYTES:
            raise _damaged("tiles", "too_large")
        return self._read(self.header["tile_data_offset"] + at, size, "tiles")

    def _place_of(self, zoom: int, x: int, y: int) -> tuple[int, int] | None:
        """Offset in the tile data, and length."""
        tile_id = zxy_to_tileid(zoom, x, y)
        offset, length = self.header["root_offset"], self.header["root_length"]
        for _ in range(DEEPEST_DIRECTORY):
            directory = self._directory(offset, length)
            at = int(np.searchsorted(directory.tile_id, tile_id, side="right")) - 1
            if at < 0:
                return None
            run = int(directory.run_length[at])
            if run > 0:
                inside = tile_id - int(directory.tile_id[at]) < run
                return (int(directory.offset[at]), int(directory.length[at])) if inside else None
            offset = self.header["leaf_directory_offset"] + int(directory.offset[at])
            length = int(directory.length[at])
        return None

    def _tiles(self, offset: int, length: int, depth: int) -> Iterator[bytes]:
        if depth >= DEEPEST_DIRECTORY:
            raise _damaged("directories", "endless")
        directory = self._directory(offset, length)
        for run, at, size in zip(directory.run_length, directory.offset, directory.length, strict=True):
            if run == 0:
                yield from self._tiles(self.header["leaf_directory_offset"] + int(at), int(size), depth + 1)
            elif size > MOST_TILE_BYTES:
                raise _damaged("tiles", "too_large")
            else:
                yield self._read(self.header["tile_data_offset"] + int(at), int(size), "tiles")

    def _check_tile(self, tile: bytes) -> None:
        if self.header["tile_type"] is TileType.MVT:
            if self.header["tile_compression"] is Compression.GZIP:
                _gunzip(tile, MOST_TILE_BYTES, "first_tile")
            return
        try:
            with Image.open(BytesIO(tile)) as picture:
                found = (picture.format or "").lower()
        except (UnidentifiedImageError, OSError, Image.DecompressionBombError) as error:
            raise _damaged("first_tile", "unreadable") from error
        if found != TILE_NAMES[self.header["tile_type"]]:
            raise _damaged("first_tile", "not_as_stated")

    def _load_directory(self, offset: int, length: int) -> Directory:
        raw = self._unpack(self._read(offset, length, "directories"), MOST_DIRECTORY_BYTES, "directories")
        return parse_directory(raw)

    def _unpack(self, data: bytes, most: int, part: ArchivePart) -> bytes:
        return _gunzip(data, most, part) if self.header["internal_compression"] is Compression.GZIP else data

    def _read(self, offset: int, length: int, part: ArchivePart) -> bytes:
        if offset < 0 or not 0 <= length <= MOST_TILE_BYTES or offset + length > self.size:
            raise _damaged(part, "cut_off")
        with self.path.open("rb") as file:
            file.seek(offset)
            return file.read(length)


def _gunzip(data: bytes, most: int, part: ArchivePart) -> bytes:
    unpacker = zlib.decompressobj(wbits=31)
    try:
        unpacked = unpacker.decompress(data, most)
    except zlib.error as error:
        raise _damaged(part, "unreadable") from error
    if unpacker.unconsumed_tail or not unpacker.eof:
        raise _damaged(part, "too_large" if unpacker.unconsumed_tail else "cut_off")
    return unpacked


def parse_directory(raw: bytes) -> Directory:
    """An unpacked directory: a count, then tile id differences, run lengths, lengths and offsets, all varints.

    An offset of 0 means "right behind the tile before", else it is one more than the offset (spec v3, section 4).
    """
    numbers = parse_varints(raw)
    count = int(numbers[0]) if len(numbers) else -1
    if count < 1 or len(numbers) != 1 + 4 * count:
        raise _damaged("directories", "unreadable")
    difference, run_length, length, stored = numbers[1:].reshape(4, count)
    behind = np.concatenate(([0], np.cumsum(length)[:-1]))
    anchor = np.maximum.accumulate(np.where(stored > 0, np.arange(count), 0))
    offset = stored[anchor] - 1 + behind - behind[anchor]
    if stored[0] == 0:
        raise _damaged("directories", "senseless")
    return Directory(np.cumsum(difference), run_length, length, offset)


def parse_varints(raw: bytes) -> NDArray[np.int64]:
    """All unsigned LEB128 numbers in `raw`: seven bits a byte, lowest first, the high bit says that more follow."""
    data = np.frombuffer(raw, np.uint8)
    last = np.flatnonzero(data < 0x80)
    if len(last) == 0 or last[-1] != len(data) - 1:
        raise _damaged("directories", "cut_off")
    first = np.concatenate(([0], last[:-1] + 1))
    place = np.arange(len(data)) - np.repeat(first, last - first + 1)
    if place.max() > 8:
        raise _damaged("directories", "senseless")
    parts = (data & 0x7F).astype(np.int64) << (7 * place)
    return np.add.reduceat(parts, first)
