"""An exported mission is read back, whichever Crossfix exported it; anything else is refused with a reason."""

from __future__ import annotations

import gzip
import json
from datetime import timedelta
from typing import Any

import pytest

from backend.api import bodies
from backend.events import FORM
from backend.ports import TrackPoint
from backend.settings import REPOSITORY
from backend.store.digest import EPOCH
from backend.store.entries import EventRow, to_records
from backend.store.upgrade import FIRST_FORM
from backend.wire.export import journal_json
from backend.wire.resources import ExportedMission

STORED = json.loads(gzip.decompress((REPOSITORY / "tests/golden/journals/imported.json.gz").read_bytes()))
RECORDED = to_records(
    STORED["mission_id"], [EventRow(seq, at_us, kind, FIRST_FORM, body) for seq, at_us, kind, body in STORED["rows"]]
)
FLOWN = [TrackPoint(1.7e9 + n, 50.6 + n * 1e-5, 7.2, 140.0, 40.0, 90.0, 80.0, "AUTO") for n in range(3)]
TODAY = json.loads(journal_json(RECORDED, {"craft-1": FLOWN}))


def exported_before() -> dict[str, Any]:
    """As Crossfix 0.1.0 exported it: one track, reasons in sentences."""
    events = [
        {
            "seq": seq,
            "mission_id": STORED["mission_id"],
            "at_utc": (EPOCH + timedelta(microseconds=at_us)).isoformat(),
            "event": json.loads(body),
        }
        for seq, at_us, _, body in STORED["rows"]
    ]
    return {"mission_id": STORED["mission_id"], "events": events, "track": TODAY["tracks"]["craft-1"]}


async def read(client, content: Any):
    text = content if isinstance(content, bytes) else json.dumps(content).encode()
    return await client.post("/api/recordings/read", content=text)


@pytest.mark.parametrize("exported", [TODAY, exported_before()], ids=["today", "before"])
async def test_an_export_of_any_age_is_told_in_the_form_of_today(client, exported):
    reply = await read(client, exported)
    assert reply.status_code == 200, reply.text
    told = ExportedMission.model_validate_json(reply.content)
    assert told.mission_id == STORED["mission_id"]
    assert told.events == RECORDED
    (track,) = told.tracks
    assert (track.mission_id, track.craft_id) == (STORED["mission_id"], "craft-1")
    assert [point.lat for point in track.points] == [point.lat_deg for point in FLOWN]
    assert [point.heading_deg for point in track.points] == [90.0] * 3


async def test_what_the_server_exports_it_reads(client):
    spec = (await client.get("/api/defaults")).json()["spec"]
    mission_id = (await client.post("/api/missions", json=spec)).json()["mission_id"]
    exported = await client.get(f"/api/missions/{mission_id}/export/json")
    told = (await read(client, exported.content)).json()
    assert told["events"] == (await client.get(f"/api/missions/{mission_id}/events")).json()["events"]
    assert told["tracks"] == []


async def test_nothing_is_stored(client):
    assert (await read(client, TODAY)).status_code == 200
    assert (await client.get("/api/missions")).json() == {"missions": [], "next": None}


async def test_points_of_a_path_without_a_place_are_left_out(client):
    path = [["2026-05-01T10:00:00Z", float("nan"), 7.2, 140.0, 0.0], ["2026-05-01T10:00:01Z", 50.6, 7.2, None, None]]
    told = (await read(client, TODAY | {"tracks": {"craft-2": path}})).json()
    assert [point["lat"] for point in told["tracks"][0]["points"]] == [50.6]


WITHOUT_DRAFT = TODAY | {"events": TODAY["events"][1:]}
OF_NO_KIND = TODAY | {"events": [TODAY["events"][0] | {"event": {"kind": "flown_away"}}]}
ODD_CHECK = {"kind": "preflight_checked", "passed": True, "checks": [{"name": "what", "detail": "", "remedy": ""}]}
UNKNOWN_BEFORE = exported_before() | {"events": [exported_before()["events"][0] | {"event": ODD_CHECK}]}


@pytest.mark.parametrize(
    ("content", "fault"),
    [
        (b"", "not_json"),
        (b"\xff\xfe", "not_json"),
        (b"[" * 200_000, "not_json"),
        (b'{"mission_id": ', "not_json"),
        (3, "not_exported"),
        ([], "not_exported"),
        ({}, "not_exported"),
        ({"type": "FeatureCollection", "features": []}, "not_exported"),
        (TODAY | {"events": []}, "not_exported"),
        (TODAY | {"events": 3}, "not_exported"),
        (TODAY | {"mission_id": None}, "not_exported"),
        (TODAY | {"tracks": {"craft-1": [[1, 2]]}}, "not_exported"),
        (TODAY | {"tracks": {"craft-1": [["yesterday", 50.6, 7.2, None, None]]}}, "not_exported"),
        (WITHOUT_DRAFT, "not_exported"),
        (OF_NO_KIND, "not_exported"),
        (UNKNOWN_BEFORE, "not_exported"),
        (TODAY | {"form": FORM + 1}, "later"),
    ],
)
async def test_anything_else_is_refused(client, content, fault):
    reply = await read(client, content)
    assert reply.status_code == 422, reply.text
    assert reply.json()["reason"] == {"fault": fault, "code": "export_unreadable"}


@pytest.mark.parametrize(
    "half",
    [{"mission_id": "a\ud800"}, {"tracks": {"a\ud800": []}}, {"tracks": {"a\ud800": TODAY["tracks"]["craft-1"]}}],
)
async def test_half_a_surrogate_pair_is_no_text_to_tell(client, half):
    reply = await read(client, TODAY | half)
    assert reply.status_code == 422, reply.text
    assert reply.json()["reason"] == {"fault": "not_exported", "code": "export_unreadable"}


@pytest.mark.parametrize("path", ["/api/recordings/read", "/api/bundles"])
async def test_what_fits_a_mission_too_large_is_said_of_it(client, monkeypatch, path):
    monkeypatch.setattr(bodies, "EXPORT_BYTES", 1_000)
    for content_type in ("application/json", "application/zip"):
        reply = await client.post(path, content=b" " * 2_000, headers={"content-type": content_type})
        told = {"most_bytes": 1_000, "what": "mission", "code": "body_too_large"}
        assert (reply.status_code, reply.json()["reason"]) == (413, told)
        assert "geometry" not in reply.json()["remedy"]


async def test_an_export_of_many_emitters_is_read(client):
    """As large as what a flight for 32 emitters gives."""
    bearing = next(one for one in TODAY["events"] if one["event"]["kind"] == "bearing_measured")
    rich = bearing["event"] | {"binned_db": [-60.123456789012] * 180, "fitted_db": [-60.123456789012] * 180}
    first = len(TODAY["events"]) + 1
    more = [bearing | {"seq": first + n, "event": rich | {"bearing_id": f"b{n}"}} for n in range(2_600)]
    content = json.dumps(TODAY | {"events": TODAY["events"] + more}).encode()
    assert 16 * 2**20 < len(content) < bodies.EXPORT_BYTES
    reply = await read(client, content)
    assert reply.status_code == 200, reply.text[:300]
    assert reply.content.count(b'"bearing_measured"') == 2_600 + sum(
        one["event"]["kind"] == "bearing_measured" for one in TODAY["events"]
    )


async def test_a_mission_longer_than_any_is_refused_before_it_is_read(client, monkeypatch):
    monkeypatch.setattr(bodies, "EXPORT_BYTES", 1_000)
    reply = await read(client, TODAY)
    assert (reply.status_code, reply.json()["reason"]["code"]) == (413, "body_too_large")
