"""What a server holds before its screens are looked at: flown missions, a search of eight tags, ways."""

from __future__ import annotations

import gzip
import json

import httpx

from backend.store.brought import raw_files
from backend.store.entries import EventRow, to_records
from backend.store.upgrade import FIRST_FORM
from backend.wire.bundle import bundle
from tests.browser.served import REPOSITORY, Server

JOURNALS = ("demo-px4-open", "demo-ardupilot-multipath", "aborted", "links")
"""Flown once and stored: what the library shows before anybody flies."""

COMPILING_S = 240
"""What a new server is asked first waits until the planner is compiled where nobody did that before: on a busy machine
for minutes."""

TAGS = "\n".join(f"150.{number} hare {number}" for number in range(1, 9))

ROADS = {"kind": "road"}, [[-0.004, -0.0012], [0.004, -0.0009], [0.006, 0.001]]
RIVER = {"kind": "barrier"}, [[-0.004, 0.0002], [-0.001, 0.0004], [0.004, 0.0001]]
BRIDGE = {"kind": "path"}, [[0.001, -0.001], [0.0012, 0.0012]]


def ways(at: tuple[float, float]) -> bytes:
    """A road, a river and a path over it, around a place (lon, lat), as GeoJSON."""
    features = [
        {
            "type": "Feature",
            "properties": kind,
            "geometry": {"type": "LineString", "coordinates": [[at[0] + x, at[1] + y] for x, y in corners]},
        }
        for kind, corners in (ROADS, RIVER, BRIDGE)
    ]
    return json.dumps({"type": "FeatureCollection", "features": features}).encode()


def search_of_tags(server: Server) -> str:
    """A draft of eight tags, the first three heard twice by somebody with an antenna in their hand."""
    address = server.url.rstrip("/") + "/api/missions"
    spec = server.get("/api/defaults")["spec"]
    first = spec["emitters"][0] | {"kind": "pulsed"}
    named = (line.split(" ", 1) for line in TAGS.splitlines())
    spec["emitters"] = [
        first | {"emitter_id": f"emitter-{number}", "frequency_hz": float(mhz) * 1e6, "label": label}
        for number, (mhz, label) in enumerate(named, 1)
    ]
    drafted = httpx.post(address, json=spec, timeout=COMPILING_S)
    drafted.raise_for_status()
    mission = drafted.json()["mission_id"]
    lon, lat = spec["area"]["coordinates"][0][0]
    for number in range(6):
        report = {
            "bearing_id": f"by-hand-{number}",
            "by": "Ada",
            "emitter_id": f"emitter-{number // 2 + 1}",
            "place": {"lon": lon + 0.003 * (number % 2), "lat": lat},
            "bearing_deg": (60.0, 320.0)[number % 2] - 6 * number,
            "sigma_deg": 8,
        }
        httpx.post(f"{address}/{mission}/bearings", json=report, timeout=COMPILING_S).raise_for_status()
    return mission


def stored(server: Server, name: str) -> str:
    """A stored journal as a mission of this server; its id."""
    kept = json.loads(gzip.decompress((REPOSITORY / f"tests/golden/journals/{name}.json.gz").read_bytes()))
    rows = [EventRow(seq, at_us, kind, FIRST_FORM, body) for seq, at_us, kind, body in kept["rows"]]
    mission = kept["mission_id"]
    body = bundle(to_records(mission, rows), {}, raw_files(mission, (), {}))
    address = server.url.rstrip("/") + "/api/bundles"
    httpx.post(address, content=body, timeout=COMPILING_S, headers={"Content-Type": "application/zip"})
    return mission


def brought(server: Server) -> list[str]:
    """Several stored journals as missions of this server; their ids."""
    return [stored(server, name) for name in JOURNALS]
