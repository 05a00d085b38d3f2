"""What costs much to read: each held up an abort, filled the memory or broke a list before readers were bounded."""

from __future__ import annotations

import io
import json
import math
import tarfile
import zipfile
from typing import NamedTuple
from unittest.mock import patch

import numpy as np
from pmtiles.tile import Compression, TileType, zxy_to_tileid
from pmtiles.writer import Writer

MEGABYTE = 10**6


BOUNDARY = "crossfix-hostile"
RECORDINGS, WAYS = "/api/missions/{mission}/recordings", "/api/missions/{mission}/ways"
KINDS = {
    **dict.fromkeys(("/api/overlays", "/api/maps", "/api/terrain", WAYS), "application/octet-stream"),
    RECORDINGS: f"multipart/form-data; boundary={BOUNDARY}",
    "/api/bundles": "application/zip",
}


class HostileFile(NamedTuple):
    """path: where it is posted to, as `kind` says. accepted: it is harmless once it is read with care."""

    name: str
    path: str
    content: bytes
    accepted: bool

    @property
    def kind(self) -> str:
        """Of its content."""
        return KINDS.get(self.path, "application/json")

    def to(self, mission_id: str) -> str:
        """The path with this mission in it."""
        return self.path.format(mission=mission_id)


def recording(name: str, filename: str, content: bytes, **beside: bytes) -> HostileFile:
    """Refused. beside: other files of the form by their field."""
    parts = [("files", filename, content), *((field, f"{field}.csv", other) for field, other in beside.items())]
    body = b"".join(
        f'--{BOUNDARY}\r\nContent-Disposition: form-data; name="{field}"; filename="{called}"\r\n\r\n'.encode()
        + inside
        + b"\r\n"
        for field, called, inside in parts
    )
    return HostileFile(name, RECORDINGS, body + f"--{BOUNDARY}--\r\n".encode(), False)


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


def log_of_turns(rows: int) -> bytes:
    """Heading and power ten times a second, at a new place every 72 seconds."""
    turning = [
        f"{1.7e9 + 0.1 * k:.1f},{0.5 * k % 360:.1f},{-60 + 10 * math.cos(math.radians(0.5 * k)):.2f},"
        f"{50 + 0.0005 * (k // 720):.6f},7.0"
        for k in range(rows)
    ]
    return "\n".join(["time_s,heading_deg,power_db,lat,lon", *turning]).encode()


def bearings(count: int) -> bytes:
    taken = [f"{1.7e9 + k},{50 + 0.00001 * (k % 100):.6f},7.0,{k % 360},7" for k in range(count)]
    return "\n".join(["time_s,lat,lon,bearing_deg,sigma_deg", *taken]).encode()


def noise_iq(size: int) -> bytes:
    """A SigMF archive of a turn in which nothing is heard, one byte for each half of a sample."""
    told = {
        "global": {"core:datatype": "ci8", "core:sample_rate": 1e6, "core:version": "1.0.0"},
        "captures": [{"core:sample_start": 0, "core:frequency": 150e6}],
        "annotations": [
            {"core:sample_start": k * size // 144, "core:sample_count": size // 144, "antenna:azimuth_angle": 5 * k}
            for k in range(72)
        ],
    }
    data = np.random.default_rng(1).integers(-20, 20, size, dtype=np.int8).tobytes()
    stream = io.BytesIO()
    with tarfile.open(fileobj=stream, mode="w") as tar:
        for name, content in (("noise.sigmf-meta", json.dumps(told).encode()), ("noise.sigmf-data", data)):
            member = tarfile.TarInfo(name)
            member.size = len(content)
            tar.addfile(member, io.BytesIO(content))
    return stream.getvalue()


def bundle_of(size: int) -> bytes:
    """A bundle whose mission is this many bytes of numbers."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as box:
        box.writestr("mission.json", b"[" + b"1," * (size // 2) + b"1]")
    return stream.getvalue()


def paths(count: int) -> bytes:
    line = b"""{"type": "Feature", "properties": {"highway": "path"},
     "geometry": {"type": "LineString", "coordinates": [[7.0, 50.0], [7.001, 50.001]]}}"""
    return b'{"type": "FeatureCollection", "features": [' + b",".join([line] * count) + b"]}"


def large_files() -> list[HostileFile]:
    """As large as files may be, or larger than theirs may."""
    size = 50 * MEGABYTE
    random = np.random.default_rng(2).bytes(size)
    return [
        recording("a log of 50 MB", "log.csv", log_of_turns(1_200_000)),
        recording("a million bearings", "bearings.csv", bearings(10**6)),
        recording("ends of lines", "log.csv", b"\n" * size),
        recording("comments", "log.csv", b"#1\n" * (size // 3) + b"1,2"),
        recording("one cell", "log.csv", b"1" * size),
        recording("no text", "log.csv", random),
        recording("IQ of 50 MB", "noise.sigmf", noise_iq(size)),
        recording("a pattern of 50 MB", "log.csv", log_of_turns(1000), antenna=b"1,2\n" * (size // 4)),
        HostileFile("a bundle of 90 MB unpacked", "/api/bundles", bundle_of(90 * MEGABYTE), False),
        HostileFile("150,000 paths", WAYS, paths(150_000), False),
        HostileFile("no GeoTIFF", "/api/terrain", b"II*\x00" + random, False),
        HostileFile("no map", "/api/maps", b"PMTiles\x03" + random, False),
    ]


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
            "as many as an export may have", "/api/recordings/read", b"[" + b"1," * 10 * MEGABYTE + b"1]", False
        ),
        recording("30,000 bearings", "bearings.csv", bearings(30_000)),
    ]
