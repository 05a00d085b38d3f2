"""A GeoTIFF of heights, read once when it is uploaded: whole, as untrusted input, into a grid of our own on disk.

Pillow decodes it (libtiff: tiles and strips, deflate, LZW, Zstandard, predictors 2 and 3); where it lies is read from
its GeoKeys (OGC GeoTIFF 1.1). Pillow misreads big-endian samples through libtiff, so those are refused.
"""

from __future__ import annotations

import contextlib
import math
import os
import warnings
from pathlib import Path
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray
from PIL import Image, UnidentifiedImageError
from PIL.TiffImagePlugin import TiffImageFile

from backend.maps.refusal import MapRefused
from backend.reasons.terrain import GeoTiffFault, GeoTiffUnusable, HeightsImplausible, OtherCoordinateSystem
from backend.terrain import Terrain

MOST_PIXELS = 40_000_000
MOST_TILE_SIDE = 4096
OUT_OF_MEMORY = ("decoder error -9", "out of memory")
"""As Pillow's decoders say it."""
BAND = 128
"""Rows that are looked at together: beside the picture itself little must lie in memory."""
COARSEST_DEG = 0.01
LOWEST_M, HIGHEST_M = -500.0, 9_000.0
NO_DATA = (-32768.0, -32767.0, -9999.0, 32767.0)
"""Values for no data of the usual products, for files that do not name theirs."""

MODES = {"F", "I", "I;16"}
TILE_WIDTH, TILE_LENGTH = 322, 323
PIXEL_SCALE, TIE_POINT, TRANSFORMATION, GEO_KEYS, GDAL_NO_DATA = 33550, 33922, 34264, 34735, 42113
MODEL_TYPE, RASTER_TYPE, GEOGRAPHIC_TYPE, VERTICAL_TYPE, VERTICAL_UNIT = 1024, 1025, 2048, 4096, 4099
GEOGRAPHIC, PIXEL_IS_POINT, WGS_84, METRE, USER_DEFINED = 2, 2, 4326, 9001, 32767
ELLIPSOIDAL = {4979, 5030}


def refused(fault: GeoTiffFault) -> MapRefused:
    """As the upload is answered."""
    return MapRefused(GeoTiffUnusable(fault))


def read_geotiff(path: Path, name: str, heights: Path) -> Terrain:
    """Its heights, unknown ones as NaN, written to `heights` (npy) and read from there. Raises MapRefused. Takes
    seconds, five bytes a pixel: not on an event loop."""
    with path.open("rb") as file:
        if file.read(2) == b"MM":
            raise refused("big_endian")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # Pillow's, about what is checked here
        try:
            with Image.open(path, formats=("TIFF",)) as opened:
                picture = cast(TiffImageFile, opened)
                tags = dict(picture.tag_v2)
                _check_form(picture, tags)
                north, west, lat_step, lon_step = _where(tags, picture.width, picture.height)
                picture.load()
        except MapRefused:
            raise
        except UnidentifiedImageError as error:
            raise refused("sample_type") from error
        except OSError as error:
            if any(words in str(error) for words in OUT_OF_MEMORY):
                raise MemoryError from error
            raise refused("damaged") from error
        except (
            ValueError,
            TypeError,
            KeyError,
            IndexError,
            SyntaxError,
            OverflowError,
            ArithmeticError,
        ) as error:
            raise refused("damaged") from error
        except Image.DecompressionBombError as error:
            raise refused("too_many_pixels") from error
    _keep(picture, tags.get(GDAL_NO_DATA), heights)
    return Terrain(north, west, lat_step, lon_step, np.load(heights, mmap_mode="r"), (name,))


def _check_form(picture: TiffImageFile, tags: dict[int, Any]) -> None:
    if picture.width * picture.height > MOST_PIXELS:
        raise refused("too_many_pixels")
    if picture.width < 2 or picture.height < 2:
        raise refused("no_heights")
    if picture.mode not in MODES:
        raise refused("several_bands" if len(picture.getbands()) > 1 else "sample_type")
    if max(int(tags.get(side, 0)) for side in (TILE_WIDTH, TILE_LENGTH)) > MOST_TILE_SIDE:
        raise refused("too_large_tiles")


def _where(tags: dict[int, Any], width: int, height: int) -> tuple[float, float, float, float]:
    """Latitude and longitude of the first pixel's centre, and the steps, degrees."""
    keys = _geo_keys(tags.get(GEO_KEYS, ()))
    if not keys:
        raise refused("no_place")
    system = keys.get(GEOGRAPHIC_TYPE)
    if keys.get(MODEL_TYPE) != GEOGRAPHIC or system != WGS_84:
        raise MapRefused(OtherCoordinateSystem(system if system not in (None, WGS_84, USER_DEFINED) else None))
    if keys.get(VERTICAL_TYPE) in ELLIPSOIDAL:
        raise refused("ellipsoid")
    if keys.get(VERTICAL_UNIT, METRE) not in (0, METRE, USER_DEFINED):
        raise refused("feet")
    if TRANSFORMATION in tags:
        raise refused("rotated")
    if PIXEL_SCALE not in tags or TIE_POINT not in tags:
        raise refused("no_place")
    lon_step, lat_step = (float(value) for value in tags[PIXEL_SCALE][:2])
    column, row, _, lon, lat = (float(value) for value in tags[TIE_POINT][:5])
    half = 0.0 if keys.get(RASTER_TYPE) == PIXEL_IS_POINT else 0.5
    north, west = lat + (row - half) * lat_step, lon - (column - half) * lon_step
    corners = (north, west, north - lat_step * (height - 1), west + lon_step * (width - 1))
    if not all(math.isfinite(value) for value in (*corners, lat_step, lon_step)) or min(lat_step, lon_step) < 1e-7:
        raise refused("no_place")
    if max(lat_step, lon_step) > COARSEST_DEG:
        raise refused("too_coarse")
    if max(abs(corners[0]), abs(corners[2])) > 90.0 or max(abs(corners[1]), abs(corners[3])) > 180.0:
        raise refused("off_earth")
    return north, west, lat_step, lon_step


def _geo_keys(directory: Any) -> dict[int, int]:
    """Those with a short value of their own: rows of (key, 0, 1, value) after a row of four."""
    numbers = [int(value) for value in directory]
    rows = (numbers[at : at + 4] for at in range(4, len(numbers) - 3, 4))
    return {key: value for key, location, _, value in rows if location == 0}


def _keep(picture: TiffImageFile, named: Any, heights: Path) -> None:
    """Band by band, unknown values as NaN. Raises MapRefused for values that are no heights."""
    width, height = picture.size
    about = {"descr": np.lib.format.dtype_to_descr(np.dtype(np.float32)), "fortran_order": False}
    lowest, highest = math.inf, -math.inf
    with heights.open("wb") as file:
        np.lib.format.write_array_header_2_0(file, {**about, "shape": (height, width)})
        for top in range(0, height, BAND):
            band = np.array(picture.crop((0, top, width, min(top + BAND, height))), dtype=np.float32)
            known = _known(band, named)
            band[~known] = np.nan
            lowest = min(lowest, float(band.min(where=known, initial=np.inf)))
            highest = max(highest, float(band.max(where=known, initial=-np.inf)))
            file.write(band.tobytes())
        file.flush()
        os.fsync(file.fileno())
    if highest < lowest:
        raise refused("no_heights")
    if lowest < LOWEST_M or highest > HIGHEST_M:
        raise MapRefused(HeightsImplausible(lowest, highest))


def _known(band: NDArray[np.float32], named: Any) -> NDArray[np.bool_]:
    known = np.isfinite(band) & (np.abs(band) <= 1e30)
    for value in _no_data(named):
        known &= band != value
    return known


def _no_data(named: Any) -> list[np.float32]:
    """The usual values, and the one that the file names."""
    found = [np.float32(value) for value in NO_DATA]
    with contextlib.suppress(ValueError):
        found.append(np.float32(str(named).strip("\0 ")))
    return found
