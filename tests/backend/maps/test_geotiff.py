"""GeoTIFFs as the usual products write them, and as an enemy would."""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from relief import geotiff

from backend.maps import geotiff as module
from backend.maps.geotiff import read_geotiff
from backend.maps.refusal import MapRefused
from backend.reasons.terrain import GeoTiffUnusable, HeightsImplausible, OtherCoordinateSystem
from planner.reason import text_of

ROWS, COLUMNS = np.mgrid[0:70, 0:50]
RELIEF = (300.0 + 3.25 * ROWS - 1.5 * COLUMNS).astype(np.float32)


def read(tmp_path: Path, content: bytes):
    path = tmp_path / "upload.part"
    path.write_bytes(content)
    return read_geotiff(path, "made", tmp_path / "heights.npy")


def why(tmp_path: Path, content: bytes):
    with pytest.raises(MapRefused) as refused:
        read(tmp_path, content)
    assert text_of(refused.value.reason)
    return refused.value.reason


@pytest.mark.parametrize("tile", [0, 16, 64])
@pytest.mark.parametrize(
    ("kind", "compressed", "predictor"),
    [("f4", False, 1), ("f4", True, 1), ("f4", True, 3), ("i2", False, 1), ("i2", True, 2), ("u2", True, 2)],
)
def test_what_products_use_is_read_exactly(
    tmp_path: Path, kind: str, compressed: bool, predictor: int, tile: int
) -> None:
    heights = RELIEF.astype(kind)
    found = read(tmp_path, geotiff(heights, compressed=compressed, predictor=predictor, tile=tile))
    assert np.array_equal(found.heights, heights.astype(np.float32))


def test_a_picture_is_kept_band_by_band(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "BAND", 16)
    heights = RELIEF.copy()
    heights[-1, -1] = np.nan
    assert np.array_equal(read(tmp_path, geotiff(heights)).heights, heights, equal_nan=True)
    heights[-1, -1] = module.HIGHEST_M + 1.0
    assert why(tmp_path, geotiff(heights)) == HeightsImplausible(float(np.nanmin(heights)), module.HIGHEST_M + 1.0)


def test_what_the_machine_lacks_is_not_said_of_the_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "upload.part"
    path.write_bytes(geotiff(RELIEF))
    with pytest.raises(FileNotFoundError):
        read_geotiff(path, "made", tmp_path / "nowhere" / "heights.npy")

    def exhausted(_: object) -> None:
        raise OSError("decoder error -9")

    monkeypatch.setattr("PIL.TiffImagePlugin.TiffImageFile.load", exhausted)
    with pytest.raises(MemoryError):
        read(tmp_path, path.read_bytes())


@pytest.mark.parametrize("point", [True, False])
def test_a_pixel_lies_where_its_file_says(tmp_path: Path, point: bool) -> None:
    found = read(tmp_path, geotiff(RELIEF, north_deg=50.7, west_deg=7.1, point=point))
    assert (found.north_deg, found.west_deg) == pytest.approx((50.7, 7.1), abs=1e-12)
    at = found.at(np.array([50.7 - 3 / 3600]), np.array([7.1 + 2 / 3600]))
    assert at[0] == pytest.approx(RELIEF[3, 2], abs=1e-3)


@pytest.mark.parametrize(("value", "no_data"), [(-9999.0, None), (-32768.0, None), (77.0, "77"), (np.nan, "nan")])
def test_no_data_is_unknown(tmp_path: Path, value: float, no_data: str | None) -> None:
    heights = RELIEF.copy()
    heights[4, 5] = value
    found = read(tmp_path, geotiff(heights, no_data=no_data))
    assert np.isnan(found.heights[4, 5])
    assert np.isfinite(found.heights).sum() == heights.size - 1


def test_another_coordinate_system_is_named(tmp_path: Path) -> None:
    assert why(tmp_path, geotiff(RELIEF, epsg=4258)) == OtherCoordinateSystem(4258)


@pytest.mark.parametrize(
    ("content", "fault"),
    [
        (geotiff(RELIEF, epsg=None), "no_place"),
        (geotiff(RELIEF.astype(np.float64)), "sample_type"),
        (geotiff(RELIEF, north_deg=120.0), "off_earth"),
        (geotiff(RELIEF, west_deg=float("nan")), "no_place"),
        (geotiff(RELIEF, step_deg=0.02, north_deg=50.0), "too_coarse"),
        (geotiff(RELIEF, step_deg=0.0), "no_place"),
        (geotiff(np.full((9, 9), np.nan, np.float32)), "no_heights"),
        (geotiff(np.full((1, 9), 3.0, np.float32)), "no_heights"),
        (geotiff(RELIEF, more_keys=((4096, 4979),)), "ellipsoid"),
        (geotiff(RELIEF, more_keys=((4099, 9002),)), "feet"),
        (b"MM\x00*" + geotiff(RELIEF)[4:], "big_endian"),
        (geotiff(RELIEF)[:3000], "damaged"),
        (geotiff(RELIEF, compressed=True, tile=16)[:-900], "damaged"),
    ],
)
def test_what_cannot_be_used_says_why(tmp_path: Path, content: bytes, fault: str) -> None:
    assert why(tmp_path, content) == GeoTiffUnusable(fault)  # type: ignore[arg-type]


@pytest.mark.parametrize("height", [20_000.0, -4_000.0, np.inf])
def test_heights_that_are_nowhere_on_earth_are_refused_or_unknown(tmp_path: Path, height: float) -> None:
    heights = RELIEF.copy()
    heights[1, 1] = height
    if np.isinf(height):
        assert np.isnan(read(tmp_path, geotiff(heights)).heights[1, 1])
    else:
        assert isinstance(why(tmp_path, geotiff(heights)), HeightsImplausible)


def resized(content: bytes, **sides: int) -> bytes:
    """The same bytes with other numbers in the directory."""
    numbers = {"width": 256, "height": 257, "tile_width": 322, "tile_height": 323}
    for name, value in sides.items():
        for at in range(10, 10 + 12 * 20, 12):
            if struct.unpack_from("<H", content, at)[0] == numbers[name]:
                content = content[: at + 8] + struct.pack("<L", value) + content[at + 12 :]
                break
    return content


def test_a_bomb_is_not_unpacked(tmp_path: Path) -> None:
    small = geotiff(RELIEF, compressed=True, tile=16)
    assert why(tmp_path, resized(small, width=50_000, height=50_000)) == GeoTiffUnusable("too_many_pixels")
    assert why(tmp_path, resized(small, width=7_000, height=7_000)) == GeoTiffUnusable("too_many_pixels")
    assert why(tmp_path, resized(small, tile_width=65_536)) == GeoTiffUnusable("too_large_tiles")


@settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.data())
def test_whatever_is_changed_in_a_file_it_is_read_or_refused(tmp_path: Path, data: st.DataObject) -> None:
    content = bytearray(geotiff(RELIEF[:20, :20], compressed=data.draw(st.booleans()), tile=16))
    for _ in range(data.draw(st.integers(1, 6))):
        content[data.draw(st.integers(4, len(content) - 1))] = data.draw(st.integers(0, 255))
    try:
        found = read(tmp_path, bytes(content))
    except MapRefused:
        return
    assert found.heights.size <= module.MOST_PIXELS
