"""Tiny PMTiles archives, made with the reference writer."""

from __future__ import annotations

import gzip
import io
from collections.abc import Callable, Iterable
from pathlib import Path

import mapbox_vector_tile
import pytest
from PIL import Image
from pmtiles.tile import Compression, TileType, zxy_to_tileid
from pmtiles.writer import Writer

Tile = tuple[int, int, int]
MakeArchive = Callable[..., Path]

BOX = (7.19, 50.61, 7.22, 50.64)


def png_tile(side: int = 256, colour: tuple[int, int, int] = (90, 140, 90)) -> bytes:
    stream = io.BytesIO()
    Image.new("RGB", (side, side), colour).save(stream, "PNG")
    return stream.getvalue()


def vector_tile(name: str = "water") -> bytes:
    square = {"geometry": "POLYGON ((0 0, 4096 0, 4096 4096, 0 4096, 0 0))", "properties": {"name": "lake"}}
    return gzip.compress(mapbox_vector_tile.encode([{"name": name, "features": [square]}]))


def write_archive(
    path: Path,
    tiles: Iterable[Tile],
    *,
    vector: bool = False,
    box: tuple[float, float, float, float] = BOX,
    metadata: dict[str, object] | None = None,
    side: int = 256,
    contents: Callable[[int], bytes] | None = None,
) -> Path:
    with path.open("wb") as file:
        writer = Writer(file)
        for number, tile in enumerate(sorted(tiles, key=lambda zxy: zxy_to_tileid(*zxy))):
            if contents is not None:
                content = contents(number)
            else:
                content = vector_tile() if vector else png_tile(side, (number % 256, 120, 90))
            writer.write_tile(zxy_to_tileid(*tile), content)
        west, south, east, north = (round(value * 1e7) for value in box)
        header = {
            "tile_type": TileType.MVT if vector else TileType.PNG,
            "tile_compression": Compression.GZIP if vector else Compression.NONE,
            "min_lon_e7": west,
            "min_lat_e7": south,
            "max_lon_e7": east,
            "max_lat_e7": north,
        }
        writer.finalize(header, {"name": "test map"} if metadata is None else metadata)
    return path


@pytest.fixture
def make_archive(tmp_path: Path) -> MakeArchive:
    def make(tiles: Iterable[Tile] = ((0, 0, 0),), name: str = "made.pmtiles", **options: object) -> Path:
        return write_archive(tmp_path / name, tiles, **options)  # type: ignore[arg-type]

    return make
