from __future__ import annotations

import io
from collections.abc import Sequence
from pathlib import Path
from typing import TypeVar

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image
from pmtiles.tile import Compression, TileType, zxy_to_tileid
from pmtiles.writer import Writer
from relief import terrarium_tile

from backend.maps.refusal import MapRefused
from backend.maps.relief import relief_tile
from backend.maps.terrain_cut import around
from backend.maps.terrarium import Terrarium, decode
from backend.reasons.terrain import TerrariumUnusable
from backend.terrain import Terrain
from hardware.readings import Place

ZOOM = 12
HOME = Place(50.62, 7.2)


Pixels = TypeVar("Pixels", float, NDArray[np.floating])


def slope(x: Pixels, y: Pixels) -> Pixels:
    """Over the pixels of the whole world at ZOOM."""
    return 200.0 + 0.5 * (x - 2130 * 256) - 0.25 * (y - 1377 * 256)


def archive(
    path: Path, make=terrarium_tile, form: TileType = TileType.PNG, tiles: Sequence[int] = range(2127, 2134)
) -> Path:
    pixels = np.arange(256) + 0.5
    with path.open("wb") as file:
        writer = Writer(file)
        for x, y in sorted(((x, y) for x in tiles for y in range(1374, 1381)), key=lambda at: zxy_to_tileid(ZOOM, *at)):
            east, south = np.meshgrid(x * 256 + pixels, y * 256 + pixels)
            writer.write_tile(zxy_to_tileid(ZOOM, x, y), make(slope(east, south)))
        box = {"min_lon_e7": 69_500_000, "min_lat_e7": 503_000_000, "max_lon_e7": 75_500_000, "max_lat_e7": 509_000_000}
        writer.finalize({"tile_type": form, "tile_compression": Compression.NONE, **box}, {})
    return path


def pixel(lat: float, lon: float) -> tuple[float, float]:
    n = 2**ZOOM * 256
    return (lon + 180) / 360 * n, (1 - np.arcsinh(np.tan(np.radians(lat))) / np.pi) / 2 * n


@pytest.mark.parametrize("form", ["PNG", "WEBP"])
def test_a_tile_is_read_as_it_was_written(form: str) -> None:
    heights = np.random.default_rng(1).uniform(-400.0, 8_000.0, (256, 256))
    assert np.abs(decode(terrarium_tile(heights, form)) - heights).max() <= 1 / 256


def test_heights_are_those_of_the_place_across_the_edges_of_tiles(tmp_path: Path) -> None:
    source = Terrarium(archive(tmp_path / "a.pmtiles"), "made")
    source.check()
    lat, lon = np.linspace(50.55, 50.7, 400), np.linspace(7.1, 7.3, 400)
    expected = np.array([slope(*pixel(*at)) for at in zip(lat, lon, strict=True)])
    assert np.abs(source.at(lat, lon) - expected).max() < 0.1


def test_the_ground_around_a_home_is_cut_out_of_it(tmp_path: Path) -> None:
    ground = around(HOME, [Terrarium(archive(tmp_path / "a.pmtiles"), "made")])
    assert ground is not None
    assert ground.sources == ("made",)
    assert 15.0 < ground.spacing_m < 30.0
    found = ground.at(np.array([HOME.lat]), np.array([HOME.lon]))[0]
    assert found == pytest.approx(slope(*pixel(HOME.lat, HOME.lon)), abs=0.3)
    assert around(Place(10.0, 10.0), [Terrarium(tmp_path / "a.pmtiles", "made")]) is None


def test_the_finer_file_counts_and_the_coarser_fills_its_gaps(tmp_path: Path) -> None:
    fine = Terrain(50.65, 7.15, 1e-4, 1e-4, np.full((600, 500), 500.0, np.float32), ("fine",))
    ground = around(HOME, [Terrarium(archive(tmp_path / "a.pmtiles"), "coarse"), fine])
    assert ground is not None
    assert ground.sources == ("fine", "coarse")
    inside, beside = ground.at(np.array([50.62, 50.62]), np.array([7.16, 7.24]))
    assert inside == pytest.approx(500.0)
    assert beside == pytest.approx(slope(*pixel(50.62, 7.24)), abs=0.5)


def test_a_tile_of_the_map_shows_it_and_nothing_where_nothing_is_known(tmp_path: Path) -> None:
    sources = [Terrarium(archive(tmp_path / "a.pmtiles"), "made")]
    tile = relief_tile(sources, ZOOM, 2130, 1377)
    assert tile is not None
    expected = slope(*np.meshgrid(2130 * 256 + np.arange(256) + 0.5, 1377 * 256 + np.arange(256) + 0.5))
    assert np.abs(decode(tile) - expected).max() < 0.01
    assert relief_tile(sources, ZOOM, 100, 100) is None


def picture(heights: np.ndarray) -> bytes:
    found = io.BytesIO()
    Image.new("RGB", (256, 256), (240, 240, 230)).save(found, "PNG")
    return found.getvalue()


@pytest.mark.parametrize(
    ("make", "form", "fault"),
    [
        (picture, TileType.PNG, "no_heights"),
        (lambda heights: terrarium_tile(heights[:100, :100]), TileType.PNG, "tile_size"),
        (terrarium_tile, TileType.JPEG, "picture_type"),
        (terrarium_tile, TileType.MVT, "vector"),
        (lambda heights: terrarium_tile(heights)[:400], TileType.PNG, "damaged"),
    ],
)
def test_other_archives_are_refused(tmp_path: Path, make, form: TileType, fault: str) -> None:
    with pytest.raises(MapRefused) as refused:
        Terrarium(archive(tmp_path / "a.pmtiles", make, form, tiles=range(2130, 2131)), "made").check()
    assert refused.value.reason == TerrariumUnusable(fault)  # type: ignore[arg-type]


@pytest.mark.parametrize("lon", [179.995, -179.995])
def test_the_ground_goes_on_across_180_degrees(tmp_path: Path, lon: float) -> None:
    """Of places with longitudes from -180 to 180, whichever side the home is on."""
    west = Terrain(-16.75, 179.9, 1e-4, 1e-4, np.full((1000, 1001), 300.0, np.float32), ("west",))
    east = Terrain(-16.75, -180.0, 1e-4, 1e-4, np.full((1000, 1001), 500.0, np.float32), ("east",))
    ground = around(Place(-16.8, lon), [west, east])
    assert ground is not None
    assert set(ground.sources) == {"west", "east"}
    found = ground.at(np.full(3, -16.8), np.array([179.99, -179.99, 180.01]))
    assert found == pytest.approx([300.0, 500.0, 500.0])


def test_tiles_go_on_across_180_degrees(tmp_path: Path) -> None:
    ends = [0, 2**ZOOM - 1]
    flat = archive(tmp_path / "a.pmtiles", lambda heights: terrarium_tile(np.full_like(heights, 300.0)), tiles=ends)
    source = Terrarium(flat, "made")
    for lon in ([179.99, 180.0, 180.01], [-179.99, -180.0, -180.01]):
        assert source.at(np.full(3, 50.62), np.array(lon)) == pytest.approx([300.0] * 3)


def test_the_ground_is_pictured_on_both_sides_of_180_degrees() -> None:
    """Of a file that goes on to 180.05."""
    across = Terrain(-16.75, 179.95, 1e-3, 1e-3, np.full((100, 101), 300.0, np.float32), ("across",))
    row = 560  # at zoom 10, from 16.6 to 17.0 degrees south
    assert all(relief_tile([across], 10, column, row) is not None for column in (0, 1023))
    assert all(relief_tile([across], 10, column, row) is None for column in (1, 512, 1022))
