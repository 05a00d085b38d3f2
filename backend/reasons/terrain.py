"""Why a file is no terrain that can be used, and what the checklist says of the ground."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

from planner.reason import Words

GeoTiffFault = Literal[
    "damaged",
    "big_endian",
    "sample_type",
    "several_bands",
    "too_many_pixels",
    "too_large_tiles",
    "no_place",
    "rotated",
    "off_earth",
    "too_coarse",
    "ellipsoid",
    "feet",
    "no_heights",
]
TerrariumFault = Literal["vector", "picture_type", "tile_size", "damaged", "no_heights"]


@dataclass(frozen=True, slots=True)
class NotTerrain:
    code: Literal["not_terrain"] = "not_terrain"
    english: ClassVar[Words] = Words(
        "The file is neither a GeoTIFF nor a PMTiles archive.",
        "Upload a GeoTIFF of heights (Copernicus GLO-30, SRTM) or a PMTiles archive of Terrarium tiles.",
    )


@dataclass(frozen=True, slots=True)
class GeoTiffUnusable:
    fault: GeoTiffFault
    code: Literal["geotiff_unusable"] = "geotiff_unusable"
    english: ClassVar[Words] = Words(
        "The GeoTIFF cannot be used as terrain: {fault?damaged=it is damaged or cut off"
        "|big_endian=it is written in big-endian order|sample_type=its values are neither 16-bit integers nor 32-bit "
        "floats|several_bands=it has more than one band|too_many_pixels=it has more than 40 million pixels"
        "|too_large_tiles=its tiles are larger than 4096 pixels|no_place=it does not say where on earth it lies"
        "|rotated=its rows do not run from west to east|off_earth=its corners are not on the earth"
        "|too_coarse=its pixels are larger than a kilometre|ellipsoid=its heights are above the ellipsoid, not above "
        "mean sea level|feet=its heights are in feet|no_heights=it holds no height}.",
        "{fault?damaged=Copy or download the whole file again.|too_many_pixels=Cut out the part that you fly in, for "
        "example with `gdal_translate -projwin`.|ellipsoid=Use heights above the geoid (EGM96 or EGM2008).|no_heights="
        "Use a file that covers the area."
        "|*=Convert it with `gdalwarp -t_srs EPSG:4326 -ot Float32 -co COMPRESS=DEFLATE`.}",
    )


@dataclass(frozen=True, slots=True)
class OtherCoordinateSystem:
    """epsg None: not named by a number."""

    epsg: int | None
    code: Literal["other_coordinate_system"] = "other_coordinate_system"
    english: ClassVar[Words] = Words(
        "The GeoTIFF is not in longitude and latitude (EPSG:4326){epsg?none=|*=, but in another system}.",
        "Convert it with `gdalwarp -t_srs EPSG:4326`.",
    )


@dataclass(frozen=True, slots=True)
class TerrariumUnusable:
    fault: TerrariumFault
    code: Literal["terrarium_unusable"] = "terrarium_unusable"
    english: ClassVar[Words] = Words(
        "The PMTiles archive cannot be used as terrain: {fault?vector=it holds vector tiles|picture_type=its tiles are "
        "neither PNG nor lossless WebP|tile_size=its tiles are not squares of 256 or 512 pixels"
        "|damaged=a tile cannot be read|no_heights=its tiles hold no heights in the Terrarium encoding}.",
        "Upload an archive of Terrarium tiles (height = red * 256 + green + blue / 256 - 32768).",
    )


@dataclass(frozen=True, slots=True)
class HeightsImplausible:
    lowest_m: float
    highest_m: float
    code: Literal["heights_implausible"] = "heights_implausible"
    english: ClassVar[Words] = Words(
        "The file's heights go from {lowest_m} to {highest_m}, which is nowhere on earth.",
        "Check that it holds heights in metres, and names its value for no data.",
    )


@dataclass(frozen=True, slots=True)
class TerrainTooLarge:
    most_bytes: int
    code: Literal["terrain_too_large"] = "terrain_too_large"
    english: ClassVar[Words] = Words("The file is larger than {most_bytes}.", "Cut out the part that you fly in.")


@dataclass(frozen=True, slots=True)
class TerrainLabelDamaged:
    file: str
    code: Literal["terrain_label_damaged"] = "terrain_label_damaged"
    english: ClassVar[Words] = Words("{file}: this terrain can no longer be read.", "Delete it and upload it again.")


@dataclass(frozen=True, slots=True)
class NoTerrain:
    code: Literal["no_terrain"] = "no_terrain"
    english: ClassVar[Words] = Words(
        "No terrain: the ground is taken to be level with home.",
        "Upload terrain of the area, or make sure that nothing in it rises towards the flight altitude.",
    )


@dataclass(frozen=True, slots=True)
class TerrainCovers:
    spacing_m: float
    highest_above_home_m: float
    code: Literal["terrain_covers"] = "terrain_covers"
    english: ClassVar[Words] = Words(
        "Terrain covers the fence, a height every {spacing_m}; the highest ground is {highest_above_home_m} above home."
    )


@dataclass(frozen=True, slots=True)
class TerrainPartly:
    known_percent: float
    code: Literal["terrain_partly"] = "terrain_partly"
    english: ClassVar[Words] = Words(
        "Terrain covers only {known_percent} of the fence; ways over the rest are refused.",
        "Upload terrain for all of it, or remove it.",
    )


@dataclass(frozen=True, slots=True)
class HomeHeightDiffers:
    """Both AMSL."""

    terrain_m: float
    autopilot_m: float
    code: Literal["home_height_differs"] = "home_height_differs"
    english: ClassVar[Words] = Words(
        "The terrain has home at {terrain_m:0} above sea level, the autopilot at {autopilot_m:0}; each way keeps clear "
        "of the ground by either.",
        "Wait for a better GPS fix and arm again at the take-off place, or check that the terrain's heights are metres "
        "above mean sea level.",
    )


@dataclass(frozen=True, slots=True)
class GroundNotKept:
    detail: str
    code: Literal["ground_not_kept"] = "ground_not_kept"
    english: ClassVar[Words] = Words(
        "The terrain could not be stored with the mission: {detail}.", "Make room on the disk, then start again."
    )


TerrainReason = (
    NotTerrain
    | GeoTiffUnusable
    | OtherCoordinateSystem
    | TerrariumUnusable
    | HeightsImplausible
    | TerrainTooLarge
    | TerrainLabelDamaged
    | NoTerrain
    | TerrainCovers
    | TerrainPartly
    | HomeHeightDiffers
    | GroundNotKept
)
