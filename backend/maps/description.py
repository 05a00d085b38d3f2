"""What an archive says of itself, as the API tells it. Its metadata come from outside: only plain words are kept."""

from __future__ import annotations

import html
import re
from datetime import datetime
from typing import Any

from pmtiles.tile import TileType
from pydantic import JsonValue

from backend.maps.archive import TILE_NAMES, Archive, bounds
from backend.maps.features import MARKUP, MOST_NAME, storable
from backend.wire.maps import MapPackage, VectorLayer

MOST_VECTOR_LAYERS = 200
MOST_WORDS = 500
MOST_FIELDS = 200


def describe(archive: Archive, map_id: str, name: str, added_at: datetime) -> MapPackage:
    """What the API says of an archive."""
    header, metadata = archive.header, archive.metadata()
    west, south, east, north = bounds(header)
    centre = (header["center_lon_e7"] / 1e7, header["center_lat_e7"] / 1e7)
    if not (west <= centre[0] <= east and south <= centre[1] <= north):
        centre = ((west + east) / 2, (south + north) / 2)
    return MapPackage(
        map_id=map_id,
        name=name,
        kind="vector" if header["tile_type"] is TileType.MVT else "raster",
        tile_type=TILE_NAMES[header["tile_type"]],
        bounds=(west, south, east, north),
        centre=centre,
        min_zoom=header["min_zoom"],
        max_zoom=header["max_zoom"],
        tiles=header["addressed_tiles_count"],
        size_bytes=archive.size,
        attribution=plain_text(metadata.get("attribution")),
        vector_layers=vector_layers(metadata.get("vector_layers")),
        added_at_utc=added_at,
    )


def plain_text(markup: Any) -> str:
    """Attribution comes as HTML from an untrusted file: only its words are kept."""
    if not isinstance(markup, str):
        return ""
    return storable(re.sub(r"\s+", " ", html.unescape(MARKUP.sub("", markup))).strip()[:MOST_WORDS])


def vector_layers(stated: JsonValue) -> list[VectorLayer]:
    """The `vector_layers` of the metadata (MBTiles 1.3); entries without an id are left out."""
    layers: list[VectorLayer] = []
    for entry in stated if isinstance(stated, list) else []:
        if not (isinstance(entry, dict) and isinstance(layer_id := entry.get("id"), str)):
            continue
        low, high = (
            zoom if isinstance(zoom, int) and 0 <= zoom <= 30 else None
            for zoom in (entry.get("minzoom"), entry.get("maxzoom"))
        )
        fields = entry.get("fields")
        layers.append(
            VectorLayer(
                id=storable(layer_id[:MOST_WORDS]),
                description=storable(str(entry.get("description") or "")[:MOST_WORDS]),
                min_zoom=low,
                max_zoom=high,
                fields=sorted(storable(name[:MOST_NAME]) for name in list(fields)[:MOST_FIELDS])
                if isinstance(fields, dict)
                else [],
            )
        )
        if len(layers) == MOST_VECTOR_LAYERS:
            break
    return layers
