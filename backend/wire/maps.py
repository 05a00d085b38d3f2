"""Offline maps and overlays, as the API tells of them. Boxes are GeoJSON bounding boxes: west, south, east, north."""

from __future__ import annotations

from datetime import datetime
from typing import Any, Literal

from pydantic import Field

from backend.reasons import Reason
from backend.spec import Area, Latitude, Longitude, Model, MultiPolygon

Box = tuple[Longitude, Latitude, Longitude, Latitude]

TileType = Literal["mvt", "png", "jpeg", "webp", "avif"]


class VectorLayer(Model):
    """One layer of a vector map; `fields`: the names of its attributes."""

    id: str
    description: str
    min_zoom: int | None
    max_zoom: int | None
    fields: list[str]


class MapPackage(Model):
    """One PMTiles archive. `map_id` is made from its content: the same file uploaded twice is one map.

    `kind`: raster tiles are pictures; vector tiles are drawn by the page as `/api/maps/{map_id}/layers` says.
    `attribution`: plain text, "" when the archive names none.
    """

    map_id: str
    name: str
    kind: Literal["raster", "vector"]
    tile_type: TileType
    bounds: Box
    centre: tuple[Longitude, Latitude]
    min_zoom: int
    max_zoom: int
    tiles: int
    size_bytes: int
    attribution: str
    vector_layers: list[VectorLayer]
    added_at_utc: datetime


class MapList(Model):
    """By name. `room_bytes`: how large an upload may be, from the free disk less the journal's reserve.
    `unusable`: files in the map folder that are no maps."""

    maps: list[MapPackage]
    room_bytes: int
    unusable: list[Reason]


class MapLayers(Model):
    """What the page adds to its style to show one map: one source named `source_id`, and layers from bottom to top.

    source: a MapLibre source of type raster or vector whose url is "pmtiles:///api/maps/{map_id}/tiles.pmtiles" (the
    page puts its origin in). Labels need no glyph server: MapLibre draws them from local fonts when its style has no
    `glyphs`. `notes`: what cannot be drawn as it should be.
    """

    source_id: str
    source: dict[str, Any]
    layers: list[dict[str, Any]]
    notes: list[Reason]


class CoverageRequest(Model):
    """Does a map cover this area, and how finely?"""

    area: Area


class ZoomCoverage(Model):
    """`fraction` of the area, 0..1, that lies on tiles the archive has at this zoom. `metres_per_pixel`: ground size of
    a pixel of a 256-pixel tile at the area."""

    zoom: int
    fraction: float
    tiles_needed: int
    tiles_present: int
    metres_per_pixel: float


class MapCoverage(Model):
    """`full_to_zoom`: the finest zoom at which the whole area is there, None when there is none.
    `missing`: the part of the area without tiles at the finest zoom looked at; None when nothing is missing."""

    map_id: str
    name: str
    zooms: list[ZoomCoverage]
    full_to_zoom: int | None
    metres_per_pixel: float | None
    missing: MultiPolygon | None


class Coverage(Model):
    """`covered`: the whole area lies on at least one map fine enough to fly by (10 m a pixel or finer).
    `missing`: what no map covers so."""

    covered: bool
    fraction: float
    missing: MultiPolygon | None
    summary: Reason
    maps: list[MapCoverage]


class Overlay(Model):
    """Points, lines and areas drawn over the map. `notes`: what was left out or changed while reading."""

    overlay_id: str
    name: str
    format: Literal["geojson", "kml", "kmz"]
    features: int
    bounds: Box
    notes: list[Reason]
    added_at_utc: datetime


class OverlayList(Model):
    """By name. `unusable`: files in the overlay folder that describe none."""

    overlays: list[Overlay]
    unusable: list[Reason]


class OverlayFeature(Model):
    """A GeoJSON feature with one plain geometry (no GeometryCollection), lon/lat, without heights.

    properties: `name` and `description` when the file has them, its own attributes, and the simplestyle names `stroke`,
    `stroke-width`, `stroke-opacity`, `fill`, `fill-opacity`, `marker-color` where the file says how it is drawn.
    """

    type: Literal["Feature"] = "Feature"
    geometry: dict[str, Any]
    properties: dict[str, Any]


class OverlayCollection(Model):
    """A GeoJSON FeatureCollection."""

    type: Literal["FeatureCollection"] = "FeatureCollection"
    features: list[OverlayFeature] = Field(default_factory=list[OverlayFeature])
