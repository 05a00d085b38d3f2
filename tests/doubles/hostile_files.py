"""What costs much to read: each held up an abort, filled the memory or broke a list before readers were bounded."""

from __future__ import annotations

import io
import json
import math
import zipfile
from typing import NamedTuple
from unittest.mock import patch

from pmtiles.tile import Compression, TileType, zxy_to_tileid
from pmtiles.writer import Writer

MEGABYTE = 10**6


class HostileFile(NamedTuple):
    """path: where it is posted to, as `kind` says. accepted: it is harmless once it is read with care."""

    name: str
    path: str
    content: bytes
    accepted: bool

    @property
    def kind(self) -> str:
        """Of its content."""
        return "application/octet-stream" if self.path in ("/api/overlays", "/api/maps") else "application/json"


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


HALF_A_PAIR = b"""{"type": "Feature", "properties": {"name": "\\ud800"},
 "geometry": {"type": "Point", "coordinates": [7, 50]}}"""


def wrong_positions(size: int) -> bytes:
    body = b'{"name": "x", "area": {"type": "Polygon", "coordinates": [[' + b"0," * (size // 2)
    return body + b"0]]}}"


def unknown_fields(count: int) -> bytes:
    return json.dumps({f"k{number}": 0 for number in range(count)}).encode()


def archive(metadata: bytes) -> bytes:
    """A PMTiles archive of one tile whose metadata are these bytes."""
    stream = io.BytesIO()
    writer = Writer(stream)
    writer.write_tile(zxy_to_tileid(3, 4, 2), b"\x1a\x00")
    header = {"tile_type": TileType.MVT, "tile_compression": Compression.NONE}
    box = {"min_lon_e7": 0, "min_lat_e7": 0, "max_lon_e7": 71_000_000, "max_lat_e7": 505_500_000}
    writer.finalize({**header, **box, "internal_compression": Compression.NONE}, json.loads(metadata))
    return stream.getvalue()


def deep_metadata(depth: int) -> bytes:
    """An archive whose metadata are arrays in arrays, which no writer can be asked for."""
    with patch("pmtiles.writer.json.dumps", return_value='{"name": ' + "[" * depth):
        return archive(b"{}")


def hostile_files() -> list[HostileFile]:
    """What is sent, and to where: files, and requests whose JSON is the burden."""
    few_blanks, blanks = (kml(point(f"7,50{' ' * count}")) for count in (40_000, 300_000))
    polygon = kml(
        "<Placemark><Polygon><outerBoundaryIs><LinearRing><coordinates>7.2,50.62 7.21,50.62 7.21,50.63"
        f"{' ' * 300_000}7.2,50.62</coordinates></LinearRing></outerBoundaryIs></Polygon></Placemark>"
    )
    return [
        HostileFile("blanks in a small KML", "/api/overlays", few_blanks, True),
        HostileFile("blanks in a KML", "/api/overlays", blanks, True),
        HostileFile("blanks in an area", "/api/areas", json.dumps({"text": polygon.decode()}).encode(), True),
        HostileFile("a million placemarks in a small KMZ", "/api/overlays", zipped(kml(point("7,50") * 10**6)), False),
        HostileFile("a line of 700,000 positions", "/api/overlays", long_line(700_000), True),
        HostileFile("arrays in arrays", "/api/overlays", b'{"type": ' + b"[" * MEGABYTE, False),
        HostileFile("elements in elements", "/api/overlays", b"<kml>" * MEGABYTE, False),
        HostileFile("half a surrogate pair", "/api/maps", archive(b'{"name": "\\ud800"}'), True),
        HostileFile("half a surrogate pair in an overlay", "/api/overlays", HALF_A_PAIR, True),
        HostileFile("arrays in the metadata of a map", "/api/maps", deep_metadata(100_000), False),
        HostileFile("wrong positions in a mission", "/api/missions", wrong_positions(3 * MEGABYTE), False),
        HostileFile("as many as a mission may have", "/api/missions", wrong_positions(90_000), False),
        HostileFile("unknown fields", "/api/missions", unknown_fields(500_000), False),
        HostileFile("a sign-in of unknown fields", "/api/session", unknown_fields(500_000), False),
        HostileFile("numbers in an area", "/api/areas", b'{"text": [' + b"1," * 3 * MEGABYTE + b"1]}", False),
        HostileFile(
            "numbers in an exported mission", "/api/recordings/read", b"[" + b"1," * 15 * MEGABYTE + b"1]", False
        ),
        HostileFile(
            "as many as an export may have", "/api/recordings/read", b"[" + b"1," * 8 * MEGABYTE + b"1]", False
        ),
    ]
