"""A mission taken from one installation to another with a bundle: the same event for event, and the same review."""

from __future__ import annotations

import errno
import json
from typing import Any
from unittest.mock import Mock

import httpx
import pytest
from bundles import FLOWN, ID, PATH, SOUND, SWEEPS, added, files_of, repacked, sweep_of, without

from backend.events import BearingMeasured, MissionDrafted, MissionEnded, NetsNoted, TruthNoted
from backend.maps.ways_folder import WaysFolder
from backend.store.brought import read_bundle
from backend.store.ways_files import WaysFiles
from backend.wire.ways import MissionWays
from hardware.fence import Nets


@pytest.fixture
async def flown(services) -> str:
    """The recorded flight with its sweeps and its path, checked against the truth."""
    await services.journal.append(ID, [record.event for record in FLOWN])
    for record in FLOWN:
        fact = record.event
        if isinstance(fact, BearingMeasured) and fact.sweep_id:
            number, sweep = fact.place_number, sweep_of(fact)
            await services.journal.save_sweep(ID, fact.sweep_id, "craft-1", fact.emitter_id, number, 1, sweep)
    await services.journal.save_track(ID, "craft-1", PATH)
    emitter_id = next(r.event.emitter_id for r in FLOWN if isinstance(r.event, BearingMeasured))
    place = next(r.event.place for r in FLOWN if isinstance(r.event, BearingMeasured))
    await services.journal.append(
        ID, [TruthNoted(emitter_id=emitter_id, place=place, accuracy_m=3.0, how="phone", by="Ada")]
    )
    return ID


async def exported(client: httpx.AsyncClient, mission_id: str) -> bytes:
    reply = await client.get(f"/api/missions/{mission_id}/export/bundle")
    assert reply.status_code == 200, reply.text
    return reply.content


async def reviewed(client: httpx.AsyncClient) -> dict[str, Any]:
    """All that a review shows."""
    base = f"/api/missions/{ID}"
    summary = (await client.get(base)).json()
    events = (await client.get(f"{base}/events", params={"limit": 5000})).json()["events"]
    sweep_ids = sorted(e["event"]["sweep_id"] for e in events if e["event"]["kind"] == "bearing_measured")
    supposed = {"bearings": summary["bearings"], "sigma_deg": 12.0, "method": "base_policy", "base_policy": "ellipse"}
    turned = {"bearings": 2, "offset_to_nose_deg": 10.0, "method": "base_policy", "base_policy": "ellipse"}
    answers = [await client.post(f"{base}/what-if", json=asked) for asked in (supposed, turned)]
    assert [answer.status_code for answer in answers] == [200, 200], [answer.text for answer in answers]
    answered = [answer.json() for answer in answers]
    for told in answered:
        told["plan"].pop("plan_ms")  # how long it took this time
    return {
        "summary": {name: value for name, value in summary.items() if name != "last_seq"},
        "events": events,
        "belief": (await client.get(f"{base}/beliefs", params={"seq": len(FLOWN)})).content,
        "track": (await client.get(f"{base}/track")).json(),
        "sweeps": [(await client.get(f"{base}/sweeps/{each}")).json() for each in sweep_ids],
        "what_if": answered,
        "antenna": (await client.get(f"{base}/antenna")).json(),
        "files": [(await client.get(f"{base}/export/{each}")).content for each in ("geojson", "kml", "csv")],
        "calibration": (await client.get("/api/calibration")).json(),
    }


async def test_a_mission_is_reviewed_elsewhere_as_it_is_at_home(client, flown, elsewhere):
    there, other = elsewhere
    reply = await there.post("/api/bundles", content=await exported(client, flown))
    assert reply.status_code == 201, reply.text
    told = {"mission_id": ID, "already": False, "events": len(FLOWN) + 1, "sweeps": len(SWEEPS)}
    assert reply.json() == told
    at_home, brought = await reviewed(client), await reviewed(there)
    *events, last = brought.pop("events")
    assert events == at_home.pop("events"), "event for event, with numbers, times and values"
    assert last["event"]["kind"] == "mission_brought_in"
    assert last["event"]["software"].startswith("crossfix ")
    for part, shown in at_home.items():
        assert brought[part] == shown, part
    assert await other.journal.unfinished() == [], "no restart takes it for a flight of its own"


async def test_the_same_bundle_again_changes_nothing_and_one_that_differs_is_refused(client, flown, elsewhere):
    there, _ = elsewhere
    content = await exported(client, flown)
    assert (await there.post("/api/bundles", content=content)).status_code == 201
    before = (await there.get(f"/api/missions/{ID}/events", params={"limit": 5000})).json()
    again = await there.post("/api/bundles", content=content)
    assert (again.status_code, again.json()["already"]) == (200, True)
    assert (await client.post("/api/bundles", content=content)).status_code == 200, "at home nothing is brought in"
    changed = repacked(content, "mission.json", lambda text: text.replace(b'"bearing_deg": ', b'"bearing_deg": 1', 1))
    reply = await there.post("/api/bundles", content=changed)
    assert (reply.status_code, reply.json()["reason"]["fault"]) == (409, "differs")
    assert (await there.get(f"/api/missions/{ID}/events", params={"limit": 5000})).json() == before


async def test_a_mission_that_was_deleted_elsewhere_is_in_the_list_here(client, flown, elsewhere):
    """And not buried with the next look of retention."""
    there, other = elsewhere
    await client.delete(f"/api/missions/{flown}")
    assert (await there.post("/api/bundles", content=await exported(client, flown))).status_code == 201
    listed = (await there.get("/api/missions")).json()["missions"]
    assert [one["mission_id"] for one in listed] == [ID]
    assert [r.event.kind for r in await other.journal.read(ID)][-3:] == [
        "mission_deleted", "mission_brought_in", "mission_restored"
    ]  # fmt: skip


async def test_a_mission_that_was_deleted_here_comes_back_with_its_bundle(client, flown):
    content = await exported(client, flown)
    assert (await client.delete(f"/api/missions/{flown}")).status_code == 204
    again = await client.post("/api/bundles", content=content)
    assert (again.status_code, again.json()["already"]) == (200, True)
    assert [one["mission_id"] for one in (await client.get("/api/missions")).json()["missions"]] == [ID]


async def test_a_bundle_of_a_bundle_is_the_same_mission(client, flown, elsewhere):
    """Brought in a second time, with the fact of the first in it."""
    there, _ = elsewhere
    await there.post("/api/bundles", content=await exported(client, flown))
    reply = await client.post("/api/bundles", content=await exported(there, ID))
    assert reply.status_code == 409, "the other installation has said more of it since"
    brought = read_bundle(await exported(there, ID))
    assert brought.rows[-1].kind == "mission_brought_in"


async def test_nets_of_a_foreign_vehicle_are_never_put_back_here(services, client, elsewhere):
    there, other = elsewhere
    spec = next(r.event.spec for r in FLOWN if isinstance(r.event, MissionDrafted))
    noted = NetsNoted(craft_id="craft-1", before=Nets(), after=Nets())
    ended = next(r.event for r in FLOWN if isinstance(r.event, MissionEnded))
    await services.journal.append("m-nets", [MissionDrafted(spec=spec), noted, ended])
    assert [r.event for r in await services.journal.of_nets()] == [noted]
    reply = await there.post("/api/bundles", content=await exported(client, "m-nets"))
    assert reply.status_code == 201, reply.text
    assert await other.journal.of_nets() == []


async def test_a_bundle_from_before_brings_the_path_that_it_has(client, flown, elsewhere):
    there, _ = elsewhere
    content = without(await exported(client, flown), "bundle.json", "sweeps.jsonl", "tracks.jsonl")
    reply = await there.post("/api/bundles", content=content)
    assert (reply.status_code, reply.json()["sweeps"]) == (201, 0)
    points = (await there.get(f"/api/missions/{ID}/track")).json()["points"]
    assert [point["lat"] for point in points] == [point.lat_deg for point in PATH]


RIVER = {"type": "MultiPolygon", "coordinates": [[[[7.19, 50.61], [7.22, 50.61], [7.22, 50.6101], [7.19, 50.61]]]]}
ROAD = {"type": "MultiLineString", "coordinates": [[[7.2, 50.6], [7.21, 50.6]]]}


def ways_of(**changes: Any) -> bytes:
    features = [
        {"type": "Feature", "geometry": ROAD, "properties": {"kind": "road"}},
        {"type": "Feature", "geometry": RIVER, "properties": {"kind": "barrier"}},
    ]
    return MissionWays.model_validate({"name": "roads", "features": features} | changes).model_dump_json().encode()


async def test_ways_come_in_a_bundle_which_without_them_is_as_it_was(client, flown, elsewhere, settings):
    there, _ = elsewhere
    assert json.loads(files_of(await exported(client, flown))["bundle.json"])["version"] == 1
    files = WaysFiles.of_settings(settings)
    files.directory.mkdir()
    files.path(ID).write_bytes(ways_of())
    content = await exported(client, flown)
    assert json.loads(files_of(content)["bundle.json"])["version"] == 2
    assert (await there.post("/api/bundles", content=content)).status_code == 201
    at_home, brought = [(await each.get(f"/api/missions/{ID}/ways")).json() for each in (client, there)]
    assert brought == at_home
    assert [one["properties"]["kind"] for one in brought["features"]] == ["road", "barrier"]
    await there.delete(f"/api/missions/{ID}/ways")
    assert (await there.post("/api/bundles", content=content)).status_code == 200
    assert (await there.get(f"/api/missions/{ID}/ways")).json()["features"] == [], "the same again changes nothing"


async def test_a_mission_whose_ways_find_no_room_comes_in_whole_later(client, flown, elsewhere, settings, monkeypatch):
    there, _ = elsewhere
    files = WaysFiles.of_settings(settings)
    files.directory.mkdir()
    files.path(ID).write_bytes(ways_of())
    content = await exported(client, flown)
    with monkeypatch.context() as disk:
        disk.setattr(WaysFolder, "keep", Mock(side_effect=OSError(errno.ENOSPC, "No space left on device")))
        assert (await there.post("/api/bundles", content=content)).status_code == 507
    assert (await there.get("/api/missions")).json()["missions"] == []
    assert (await there.post("/api/bundles", content=content)).status_code == 201
    assert len((await there.get(f"/api/missions/{ID}/ways")).json()["features"]) == 2


FAR = {"type": "MultiLineString", "coordinates": [[[7.2, 1e308], [7.21, 50.6]]]}
DEEP = {"type": "GeometryCollection", "geometries": [ROAD]}
CROSSED = {"type": "MultiPolygon", "coordinates": [[[[0, 0], [1, 1], [1, 0], [0, 1], [0, 0]]]]}


@pytest.mark.parametrize("geometry", [FAR, DEEP, CROSSED, RIVER, {"type": "Point", "coordinates": [7, 50]}, {}])
async def test_hostile_ways_are_refused_with_the_whole_bundle(client, geometry):
    road = {"type": "Feature", "geometry": geometry, "properties": {"kind": "road"}}
    for content in (ways_of(features=[road]), b"[" * 100_000, b'{"features": 1e999}'):
        reply = await client.post("/api/bundles", content=added("ways.geojson", content)(SOUND))
        assert (reply.status_code, reply.json()["reason"]["name"]) == (422, "ways.geojson"), reply.text
    assert (await client.get("/api/missions")).json()["missions"] == []
