"""Small files that cost much: each held up an abort, filled the memory or broke a list before readers were confined."""

from __future__ import annotations

import io
import json
import math
import zipfile
from typing import NamedTuple

from pmtiles.tile import Compression, TileType, zxy_to_tileid
from pmtiles.writer import Writer

MEGABYTE = 10**6


class HostileFile(NamedTuple):
    """path: where it is posted to. accepted: it is harmless once it is read with care."""

    name: str
    path: str
    content: bytes
    accepted: bool


def kml(inside: str) -> bytes:
    return f'<kml xmlns="http://www.opengis.net/kml/2.2"><Document>{inside}</Document></kml>'.encode()


def zipped(content: bytes) -> bytes:
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("doc.kml", content)
    return stream.getvalue()


def point(coordinates: str) -> str:
    return f"<Placemark><Point><coordinates>{coordinates}</coordinates></Point></Placemark>"


def long_line(positions: int) -> bytes:
    line = [[round(7 + k / positions, 7), round(50 + 0.1 * math.sin(k), 7)] for k in range(positions)]
    return json.dumps({"type": "LineString", "coordinates": line}).encode()


def archive(metadata: bytes) -> bytes:
    """A PMTiles archive of one tile whose metadata are these bytes."""
    stream = io.BytesIO()
    writer = Writer(stream)
    writer.write_tile(zxy_to_tileid(3, 4, 2), b"\x1a\x00")
    header = {"tile_type": TileType.MVT, "tile_compression": Compression.NONE}
    box = {"min_lon_e7": 0, "min_lat_e7": 0, "max_lon_e7": 71_000_000, "max_lat_e7": 505_500_000}
    writer.finalize({**header, **box, "internal_compression": Compression.NONE}, json.loads(metadata))
    return stream.getvalue()


def hostile_files() -> list[HostileFile]:
    blanks = kml(point(f"7,50{' ' * 300_000}"))
    polygon = kml(
        "<Placemark><Polygon><outerBoundaryIs><LinearRing><coordinates>7.2,50.62 7.21,50.62 7.21,50.63"
        f"{' ' * 300_000}7.2,50.62</coordinates></LinearRing></outerBoundaryIs></Polygon></Placemark>"
    )
    return [
        HostileFile("blanks in a KML", "/api/overlays", blanks, True),
        HostileFile("blanks in an area", "/api/areas", json.dumps({"text": polygon.decode()}).encode(), True),
        HostileFile("a million placemarks in a small KMZ", "/api/overlays", zipped(kml(point("7,50") * 10**6)), False),
        HostileFile("a line of 700,000 positions", "/api/overlays", long_line(700_000), True),
        HostileFile("arrays in arrays", "/api/overlays", b'{"type": ' + b"[" * MEGABYTE, False),
        HostileFile("elements in elements", "/api/overlays", b"<kml>" * MEGABYTE, False),
        HostileFile("half a surrogate pair", "/api/maps", archive(b'{"name": "\\ud800"}'), True),
    ]
