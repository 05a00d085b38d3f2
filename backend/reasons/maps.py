"""Why a map, an overlay or an area in a file cannot be used, and what of it was left out."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, ClassVar, Literal

from pydantic import Field

from hardware.reasons.table import FileUnreadable
from planner.reason import Words

OverlayFormat = Literal["geojson", "kml", "kmz"]
OverlayFault = Literal[
    "empty",
    "other_format",
    "not_json",
    "no_type",
    "no_features",
    "not_xml",
    "document_type",
    "other_xml",
    "not_unpacked",
    "no_kml_inside",
    "too_large",
]
GeometryFault = Literal[
    "missing",
    "type_unknown",
    "nested_too_deep",
    "no_position",
    "not_numbers",
    "swapped",
    "in_metres",
    "too_few_positions",
]
ArchivePart = Literal["header", "metadata", "directories", "tiles", "first_tile"]
ArchiveFault = Literal["cut_off", "unreadable", "senseless", "too_large", "missing", "endless", "not_as_stated"]
LooksLike = Literal["empty", "sqlite", "zip", "gzip", "tiff", "png", "jpeg", "json", "xml"]
NotDrawn = Literal["NetworkLink", "GroundOverlay", "ScreenOverlay", "PhotoOverlay", "Model", "Tour"]

_USE_PMTILES = (
    "Only PMTiles archives (.pmtiles, version 3) can be used. MBTiles files are converted with `pmtiles convert`."
)


@dataclass(frozen=True, slots=True)
class NotAnArchive:
    """looks_like: what the file's first bytes are, None when they are like nothing known."""

    looks_like: LooksLike | None
    code: Literal["not_an_archive"] = "not_an_archive"
    english: ClassVar[Words] = Words(
        "The file is not a PMTiles archive{looks_like?none=|empty=: it is empty"
        "|sqlite=, it looks like an MBTiles or another SQLite file|zip=, it is a zip file"
        "|gzip=, it is gzip-compressed|tiff=, it is a TIFF picture|png=, it is a PNG picture"
        "|jpeg=, it is a JPEG picture|json=, it looks like JSON|xml=, it looks like XML or a web page}.",
        _USE_PMTILES,
    )


@dataclass(frozen=True, slots=True)
class OldArchive:
    version: int
    code: Literal["old_archive"] = "old_archive"
    english: ClassVar[Words] = Words("The PMTiles archive has version {version}; version 3 is needed.", _USE_PMTILES)


@dataclass(frozen=True, slots=True)
class TilesNotDrawable:
    """tile_type: as the PMTiles specification names it."""

    tile_type: str
    code: Literal["tiles_not_drawable"] = "tiles_not_drawable"
    english: ClassVar[Words] = Words(
        "The archive's tiles are of type {tile_type}, which the map cannot draw.",
        "Vector tiles must be MVT, pictures PNG, JPEG, WebP or AVIF.",
    )


@dataclass(frozen=True, slots=True)
class CompressionNotRead:
    """compression: as the PMTiles specification names it."""

    compression: str
    code: Literal["compression_not_read"] = "compression_not_read"
    english: ClassVar[Words] = Words(
        "The archive is compressed with {compression}, which a browser cannot unpack.",
        "Make it with gzip compression, the default of the PMTiles tools.",
    )


@dataclass(frozen=True, slots=True)
class ArchiveDamaged:
    """cut_off: the file ends before the part does, or the part lies outside of it."""

    part: ArchivePart
    fault: ArchiveFault
    code: Literal["archive_damaged"] = "archive_damaged"
    english: ClassVar[Words] = Words(
        "The PMTiles archive is damaged in its {part?header=header|metadata=metadata|directories=directories"
        "|tiles=tiles|first_tile=first tile}: {fault?cut_off=there is less than it states|unreadable=it cannot be read"
        "|senseless=the values make no sense|too_large=there is more than any map needs|missing=there is nothing"
        "|endless=it points to itself without end|not_as_stated=the picture is not of the type that it says}.",
        "{fault?cut_off=Copy or download the whole file again.|*=Export or extract the map again, for example with "
        "`pmtiles extract`, and upload the new file.}",
    )


@dataclass(frozen=True, slots=True)
class MapLabelDamaged:
    code: Literal["map_label_damaged"] = "map_label_damaged"
    english: ClassVar[Words] = Words("The map's label is missing or damaged.", "Upload the map again.")


@dataclass(frozen=True, slots=True)
class PutByHand:
    code: Literal["put_by_hand"] = "put_by_hand"
    english: ClassVar[Words] = Words("It was put into the map folder by hand.", "Upload it on the page instead.")


ArchiveReason = Annotated[
    NotAnArchive
    | OldArchive
    | TilesNotDrawable
    | CompressionNotRead
    | ArchiveDamaged
    | MapLabelDamaged
    | PutByHand
    | FileUnreadable,
    Field(discriminator="code"),
]


@dataclass(frozen=True, slots=True)
class MapUnusable:
    """A file in the map folder."""

    file: str
    because: ArchiveReason
    code: Literal["map_unusable"] = "map_unusable"
    english: ClassVar[Words] = Words("Map {file}: {because}", "{because!remedy}")


@dataclass(frozen=True, slots=True)
class UploadIncomplete:
    arrived_bytes: int
    announced_bytes: int
    code: Literal["upload_incomplete"] = "upload_incomplete"
    english: ClassVar[Words] = Words(
        "Only {arrived_bytes} of {announced_bytes} arrived.", "Upload it again; nothing was kept."
    )


@dataclass(frozen=True, slots=True)
class NoRoomForMap:
    """reserve_bytes: stay free for the journal."""

    needed_bytes: int
    room_bytes: int
    reserve_bytes: int
    code: Literal["no_room_for_map"] = "no_room_for_map"
    english: ClassVar[Words] = Words(
        "The file does not fit: {needed_bytes} more are needed, {room_bytes} may be used.",
        "Delete maps or overlays that are not needed. {reserve_bytes} stay free for the journal.",
    )


@dataclass(frozen=True, slots=True)
class MapDrawnPlainly:
    """Nobody knows what the layers of a vector map mean."""

    because: Literal["layers_not_named", "schema_unknown"]
    code: Literal["map_drawn_plainly"] = "map_drawn_plainly"
    english: ClassVar[Words] = Words(
        "{because?layers_not_named=The archive does not say which layers its tiles have, so nothing of it can be drawn"
        "|schema_unknown=The map's layers follow no schema that is known here; all of them are drawn alike}."
    )


@dataclass(frozen=True, slots=True)
class AreaOnMaps:
    """How much of an area the maps show finely enough to fly by."""

    shown: Literal["whole", "partly", "not_finely", "no_map"]
    shown_percent: float
    code: Literal["area_on_maps"] = "area_on_maps"
    english: ClassVar[Words] = Words(
        "{shown?whole=The whole area is on the offline maps|partly=Only a part of the area is on the offline maps; the "
        "rest is plain grid|not_finely=No offline map shows the area finely enough to fly by: the plain grid is shown"
        "|no_map=There is no offline map: the plain grid is shown} ({shown_percent})."
    )


@dataclass(frozen=True, slots=True)
class BeyondWebMaps:
    code: Literal["beyond_web_maps"] = "beyond_web_maps"
    english: ClassVar[Words] = Words(
        "The area lies beyond 85 degrees of latitude, where web maps end.", "Fly with the plain grid."
    )


@dataclass(frozen=True, slots=True)
class NotReadableAs:
    """format None: what it is to be is not known, none of the formats fits."""

    format: OverlayFormat | None
    fault: OverlayFault
    code: Literal["not_readable_as"] = "not_readable_as"
    english: ClassVar[Words] = Words(
        "The file cannot be read as {format?geojson=GeoJSON|kml=KML|kmz=KMZ|none=GeoJSON, KML or KMZ}: "
        "{fault?empty=it is empty|other_format=it is something else|not_json=it is not valid JSON"
        "|no_type=it is JSON without a `type`|no_features=its FeatureCollection has no list of `features`"
        "|not_xml=it is not valid XML|document_type=it holds a document type definition"
        "|other_xml=its first element is not <kml>|not_unpacked=it cannot be unpacked"
        "|no_kml_inside=there is no KML file in it|too_large=it is far too large when unpacked}.",
        "Export it as GeoJSON in WGS84 (longitude, latitude), or as KML or KMZ with placemarks.",
    )


@dataclass(frozen=True, slots=True)
class OtherCoordinates:
    """system: as the file names it."""

    system: str
    code: Literal["other_coordinates"] = "other_coordinates"
    english: ClassVar[Words] = Words(
        "The file uses the coordinate system {system}, not WGS84.", "Export it in WGS84 (longitude, latitude)."
    )


@dataclass(frozen=True, slots=True)
class TooManyFeatures:
    most: int
    code: Literal["too_many_features"] = "too_many_features"
    english: ClassVar[Words] = Words(
        "The overlay has more than {most} features.",
        "Leave out what is not needed, or make a map package (PMTiles) of it.",
    )


@dataclass(frozen=True, slots=True)
class PartLeftOut:
    """which: its number in the file, from 1, and in quotes its name when it has one."""

    part: Literal["feature", "placemark"]
    which: str
    fault: GeometryFault
    code: Literal["part_left_out"] = "part_left_out"
    english: ClassVar[Words] = Words(
        "{part?feature=Feature|placemark=Placemark} {which} is left out: {fault?missing=it has no geometry that can be "
        "drawn|type_unknown=its type of geometry is not known|nested_too_deep=its geometries are nested too deep"
        "|no_position=a position lacks its longitude or latitude|not_numbers=its coordinates are not numbers"
        "|swapped=a position is not on Earth; longitude and latitude may be swapped"
        "|in_metres=a position is not on Earth; it may be in metres"
        "|too_few_positions=a line needs two positions and a ring three corners}."
    )


@dataclass(frozen=True, slots=True)
class FileLeftOut:
    """A further file in a KMZ archive."""

    file: str
    code: Literal["file_left_out"] = "file_left_out"
    english: ClassVar[Words] = Words("The archive also holds {file}, which is left out.")


@dataclass(frozen=True, slots=True)
class KindLeftOut:
    """What a file holds and is not taken: of KML what the map cannot draw, by the name of its element; bearings
    that the mission has already."""

    kind: NotDrawn | Literal["known_bearing"]
    count: int
    code: Literal["kind_left_out"] = "kind_left_out"
    english: ClassVar[Words] = Words(
        "{kind?NetworkLink=Links to other files|GroundOverlay=Pictures on the ground"
        "|ScreenOverlay=Pictures on the screen|PhotoOverlay=Photos|Model=3D models|Tour=Tours"
        "|known_bearing=Known bearings} are left out ({count})."
    )


@dataclass(frozen=True, slots=True)
class MoreLeftOut:
    """Besides those that are named one by one."""

    parts: int
    code: Literal["more_left_out"] = "more_left_out"
    english: ClassVar[Words] = Words("{parts|more part was|more parts were} left out.")


@dataclass(frozen=True, slots=True)
class NotAreas:
    """In a file that is read for an area."""

    count: int
    code: Literal["not_areas"] = "not_areas"
    english: ClassVar[Words] = Words("{count|point or line was|points or lines were} left out.")


@dataclass(frozen=True, slots=True)
class PolygonsUnited:
    polygons: int
    areas: int
    code: Literal["polygons_united"] = "polygons_united"
    english: ClassVar[Words] = Words("{polygons} polygons that touch or overlap were merged into {areas}.")


@dataclass(frozen=True, slots=True)
class PositionsThinned:
    """tolerance_m: how far a line may lie from where it was; for a large overlay, drawn at every look at the map."""

    before: int
    after: int
    tolerance_m: float
    code: Literal["positions_thinned"] = "positions_thinned"
    english: ClassVar[Words] = Words(
        "Of {before} positions {after} are drawn; lines lie within {tolerance_m:1} of the file's."
    )


@dataclass(frozen=True, slots=True)
class OverlayUnusable:
    """A description in the overlay folder."""

    file: str
    code: Literal["overlay_unusable"] = "overlay_unusable"
    english: ClassVar[Words] = Words("Overlay {file}: its description is damaged.", "Upload the overlay again.")


LeftOut = Annotated[
    PartLeftOut | FileLeftOut | KindLeftOut | MoreLeftOut | NotAreas | PolygonsUnited | PositionsThinned,
    Field(discriminator="code"),
]
"""What was left out or changed while a file was read."""


@dataclass(frozen=True, slots=True)
class NothingToDraw:
    left_out: tuple[LeftOut, ...] = ()
    code: Literal["nothing_to_draw"] = "nothing_to_draw"
    english: ClassVar[Words] = Words("The file holds nothing that can be drawn. {left_out}", "Use another file.")


@dataclass(frozen=True, slots=True)
class NoPolygon:
    """lines: it holds other geometries."""

    lines: bool
    code: Literal["no_polygon"] = "no_polygon"
    english: ClassVar[Words] = Words(
        "The file holds no polygon.",
        "{lines?true=A line is not an area: close it into a polygon."
        "|false=Draw the area as one or more polygons and export "
        "it as GeoJSON (WGS84) or KML.}",
    )


MapReason = (
    NotAnArchive
    | OldArchive
    | TilesNotDrawable
    | CompressionNotRead
    | ArchiveDamaged
    | MapLabelDamaged
    | PutByHand
    | MapUnusable
    | UploadIncomplete
    | NoRoomForMap
    | MapDrawnPlainly
    | AreaOnMaps
    | BeyondWebMaps
    | NotReadableAs
    | OtherCoordinates
    | TooManyFeatures
    | PartLeftOut
    | FileLeftOut
    | KindLeftOut
    | MoreLeftOut
    | NothingToDraw
    | NotAreas
    | PolygonsUnited
    | PositionsThinned
    | OverlayUnusable
    | NoPolygon
)
