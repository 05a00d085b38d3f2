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

from backend.maps.refusal import MapRefused
from backend.wire.maps import TileType as TileName

HEADER_BYTES = 127
MOST_DIRECTORY_BYTES = 64 * 2**20
MOST_METADATA_BYTES = 16 * 2**20
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

PARTS = {
    "root directory": "root",
    "metadata": "metadata",
    "leaf directories": "leaf_directory",
    "tiles": "tile_data",
}

MAKE_AGAIN = "Export or extract the map again, for example with `pmtiles extract`, and upload the new file."
NOT_PMTILES = (
    "Only PMTiles archives (.pmtiles, version 3) can be used. MBTiles files are converted with `pmtiles convert`."
)


@dataclass(frozen=True, slots=True)
class Directory:
    """Entries in ascending tile id. run_length 0: the entry points to a leaf directory. Arrays (n,) int64."""

    tile_id: NDArray[np.int64]
    run_length: NDArray[np.int64]
    length: NDArray[np.int64]
    offset: NDArray[np.int64]


def read_header(first_bytes: bytes) -> HeaderDict:
    """The header of an archive that this program can show. MapRefused names what is not understood."""
    if first_bytes[:7] != b"PMTiles":
        kind = _what_it_is(first_bytes)
        raise MapRefused(f"The file is not a PMTiles archive{kind}.", NOT_PMTILES)
    if len(first_bytes) < HEADER_BYTES:
        raise MapRefused("The PMTiles archive ends inside its header.", MAKE_AGAIN)
    if first_bytes[7] != 3:
        raise MapRefused(f"The PMTiles archive has version {first_bytes[7]}; version 3 is needed.", NOT_PMTILES)
    try:
        header = deserialize_header(first_bytes[:HEADER_BYTES])
    except ValueError as error:
        raise MapRefused(f"The PMTiles header is not valid: {error}.", MAKE_AGAIN) from error
    if header["tile_type"] not in TILE_NAMES:
        raise MapRefused(
            f"The archive's tiles are of type {header['tile_type'].name.lower()}, which the map cannot draw.",
            "Vector tiles must be MVT, pictures PNG, JPEG, WebP or AVIF.",
        )
    for part in ("internal_compression", "tile_compression"):
        if header[part] not in (Compression.NONE, Compression.GZIP, Compression.UNKNOWN):
            raise MapRefused(
                f"The archive is compressed with {header[part].name.lower()}, which a browser cannot unpack.",
                "Make it with gzip compression, the default of the PMTiles tools.",
            )
    if not header["min_zoom"] <= header["max_zoom"] <= FINEST_ZOOM:
        raise MapRefused(
            f"The archive names zooms {header['min_zoom']} to {header['max_zoom']}, which makes no sense.", MAKE_AGAIN
        )
    west, south, east, north = bounds(header)
    if not (-180 <= west < east <= 180 and -90 <= south < north <= 90):
        raise MapRefused(
            f"The archive's bounds (west {west}, south {south}, east {east}, north {north}) are not a box on Earth.",
            MAKE_AGAIN,
        )
    return header


def _what_it_is(first_bytes: bytes) -> str:
    known = (
        (b"SQLite format 3", ", it looks like an MBTiles or another SQLite file"),
        (b"PK\x03\x04", ", it is a zip file"),
        (b"\x1f\x8b", ", it is gzip-compressed"),
        (b"II*\x00", ", it is a TIFF picture"),
        (b"MM\x00*", ", it is a TIFF picture"),
        (b"\x89PNG", ", it is a PNG picture"),
        (b"\xff\xd8\xff", ", it is a JPEG picture"),
        (b"{", ", it looks like JSON"),
        (b"<", ", it looks like XML or a web page"),
    )
    if not first_bytes:
        return ": it is empty"
    return next((words for magic, words in known if first_bytes.startswith(magic)), "")


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
        for words, part in PARTS.items():
            end = self.header[f"{part}_offset"] + self.header[f"{part}_length"]
            if end > self.size:
                raise MapRefused(
                    f"The archive is incomplete: its {words} end at byte {end}, the file at byte {self.size}.",
                    "Copy or download the whole file again.",
                )
        self.metadata()
        first = next(self.tiles(), None)
        if first is None:
            raise MapRefused("The archive holds no tile.", MAKE_AGAIN)
        self._check_tile(first)

    def metadata(self) -> dict[str, Any]:
        """The JSON metadata; an object."""
        raw = self._unpack(
            self._read(self.header["metadata_offset"], self.header["metadata_length"], "metadata"),
            MOST_METADATA_BYTES,
            "metadata",
        )
        try:
            data = json.loads(raw) if raw else {}
        except ValueError as error:
            raise MapRefused(f"The archive's metadata are not valid JSON ({error}).", MAKE_AGAIN) from error
        if not isinstance(data, dict):
            raise MapRefused("The archive's metadata are not a JSON object.", MAKE_AGAIN)
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
        tile_id = zxy_to_tileid(zoom, x, y)
        offset, length = self.header["root_offset"], self.header["root_length"]
        for _ in range(DEEPEST_DIRECTORY):
            directory = self._directory(offset, length)
            at = int(np.searchsorted(directory.tile_id, tile_id, side="right")) - 1
            if at < 0:
                return False
            run = int(directory.run_length[at])
            if run > 0:
                return tile_id - int(directory.tile_id[at]) < run
            offset = self.header["leaf_directory_offset"] + int(directory.offset[at])
            length = int(directory.length[at])
        return False

    def _tiles(self, offset: int, length: int, depth: int) -> Iterator[bytes]:
        if depth >= DEEPEST_DIRECTORY:
            raise MapRefused("The archive's directories point to each other without end.", MAKE_AGAIN)
        directory = self._directory(offset, length)
        for run, at, size in zip(directory.run_length, directory.offset, directory.length, strict=True):
            if run == 0:
                yield from self._tiles(self.header["leaf_directory_offset"] + int(at), int(size), depth + 1)
            elif size > MOST_TILE_BYTES:
                raise MapRefused(f"A tile of the archive has {size} bytes; more than any map needs.", MAKE_AGAIN)
            else:
                yield self._read(self.header["tile_data_offset"] + int(at), int(size), "tiles")

    def _check_tile(self, tile: bytes) -> None:
        if self.header["tile_type"] is TileType.MVT:
            if self.header["tile_compression"] is Compression.GZIP:
                _gunzip(tile, MOST_TILE_BYTES, "first tile")
            return
        try:
            with Image.open(BytesIO(tile)) as picture:
                found = (picture.format or "").lower()
        except (UnidentifiedImageError, OSError, Image.DecompressionBombError) as error:
            raise MapRefused("The archive's first tile is not a picture that can be read.", MAKE_AGAIN) from error
        stated = TILE_NAMES[self.header["tile_type"]]
        if found != stated:
            raise MapRefused(f"The archive says its tiles are {stated}, but the first one is {found}.", MAKE_AGAIN)

    def _load_directory(self, offset: int, length: int) -> Directory:
        raw = self._unpack(self._read(offset, length, "directories"), MOST_DIRECTORY_BYTES, "directories")
        return parse_directory(raw)

    def _unpack(self, data: bytes, most: int, what: str) -> bytes:
        return _gunzip(data, most, what) if self.header["internal_compression"] is Compression.GZIP else data

    def _read(self, offset: int, length: int, what: str) -> bytes:
        if offset < 0 or not 0 <= length <= MOST_DIRECTORY_BYTES or offset + length > self.size:
            raise MapRefused(f"The archive is damaged: its {what} lie outside of the file.", MAKE_AGAIN)
        with self.path.open("rb") as file:
            file.seek(offset)
            return file.read(length)


def _gunzip(data: bytes, most: int, what: str) -> bytes:
    unpacker = zlib.decompressobj(wbits=31)
    try:
        unpacked = unpacker.decompress(data, most)
    except zlib.error as error:
        raise MapRefused(f"The archive is damaged: its {what} cannot be unpacked.", MAKE_AGAIN) from error
    if unpacker.unconsumed_tail or not unpacker.eof:
        raise MapRefused(f"The archive is damaged: its {what} are cut off or far too large.", MAKE_AGAIN)
    return unpacked


def parse_directory(raw: bytes) -> Directory:
    """An unpacked directory: a count, then tile id differences, run lengths, lengths and offsets, all varints.

    An offset of 0 means "right behind the tile before", else it is one more than the offset (spec v3, section 4).
    """
    numbers = parse_varints(raw)
    count = int(numbers[0]) if len(numbers) else -1
    if count < 1 or len(numbers) != 1 + 4 * count:
        raise MapRefused("The archive is damaged: one of its directories cannot be read.", MAKE_AGAIN)
    difference, run_length, length, stored = numbers[1:].reshape(4, count)
    behind = np.concatenate(([0], np.cumsum(length)[:-1]))
    anchor = np.maximum.accumulate(np.where(stored > 0, np.arange(count), 0))
    offset = stored[anchor] - 1 + behind - behind[anchor]
    if stored[0] == 0:
        raise MapRefused("The archive is damaged: one of its directories has no first offset.", MAKE_AGAIN)
    return Directory(np.cumsum(difference), run_length, length, offset)


def parse_varints(raw: bytes) -> NDArray[np.int64]:
    """All unsigned LEB128 numbers in `raw`: seven bits a byte, lowest first, the high bit says that more follow."""
    data = np.frombuffer(raw, np.uint8)
    last = np.flatnonzero(data < 0x80)
    if len(last) == 0 or last[-1] != len(data) - 1:
        raise MapRefused("The archive is damaged: a directory ends inside a number.", MAKE_AGAIN)
    first = np.concatenate(([0], last[:-1] + 1))
    place = np.arange(len(data)) - np.repeat(first, last - first + 1)
    if place.max() > 8:
        raise MapRefused("The archive is damaged: a directory holds a number that is too large.", MAKE_AGAIN)
    parts = (data & 0x7F).astype(np.int64) << (7 * place)
    return np.add.reduceat(parts, first)
