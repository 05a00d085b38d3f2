"""A mission taken from one installation to another with a bundle: the same event for event, and the same review."""

from __future__ import annotations

import base64
import errno
import gzip
import io
import json
import pickle
import re
import struct
import zipfile
import zlib
from collections.abc import Callable
from typing import Any
from unittest.mock import Mock

import httpx
import numpy as np
import pytest

from backend.events import BearingMeasured, MissionDrafted, MissionEnded, NetsNoted, TruthNoted
from backend.maps.ways_folder import WaysFolder
from backend.ports import TrackPoint
from backend.reasons.request import BundleFileWrong, BundleUnreadable
from backend.settings import REPOSITORY
from backend.store.brought import BundleRefused, raw_files, read_bundle
from backend.store.entries import EventRow, sweep_entry, to_records
from backend.store.upgrade import FIRST_FORM
from backend.store.ways_files import WaysFiles
from backend.wire.bundle import bundle
from backend.wire.ways import MissionWays
from hardware.direction_finding.pattern_file import SMALL_YAGI, load_pattern
from hardware.fence import Nets
from hardware.readings import Sweep

STORED = json.loads(gzip.decompress((REPOSITORY / "tests/golden/journals/demo-px4-open.json.gz").read_bytes()))
FLOWN = to_records(
    STORED["mission_id"], [EventRow(seq, at_us, kind, FIRST_FORM, body) for seq, at_us, kind, body in STORED["rows"]]
)
ID = STORED["mission_id"]
PATH = [
    TrackPoint(1.7e9 + n / 3, 50.6 + n * 1e-5, 7.2, 140.1, 40.0, None if n == 1 else 90.0, 80.0, "AUTO")
    for n in range(3)
]
YAGI = load_pattern(SMALL_YAGI)


def sweep_of(fact: BearingMeasured) -> Sweep:
    """One turn with an emitter at the fact's bearing, heard by the small Yagi over the nose."""
    nose = np.arange(0.0, 360.0, 1.0)
    return Sweep(
        at_s=1.7e9 + nose / 30.0,
        heading_deg=nose,
        power_db=-60.0 + YAGI.gain_at(fact.bearing_deg - nose),
        frequency_hz=148.5e6,
        position=fact.place,
        altitude_amsl_m=140.0,
        noise_floor_db=-110.0,
    )


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


def files_of(content: bytes) -> dict[str, bytes]:
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def packed(files: dict[str, bytes]) -> bytes:
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            archive.writestr(name, content)
    return stream.getvalue()


def repacked(content: bytes, name: str, change: Callable[[bytes], bytes]) -> bytes:
    files = files_of(content)
    changed = change(files[name])
    assert changed != files[name]
    return packed(files | {name: changed})


def without(content: bytes, *names: str) -> bytes:
    return packed({name: text for name, text in files_of(content).items() if name not in names})


def added(name: str, text: bytes = b"x") -> Callable[[bytes], bytes]:
    return lambda content: packed(files_of(content) | {name: text})


def changed(name: str, change: Callable[[bytes], bytes]) -> Callable[[bytes], bytes]:
    return lambda content: repacked(content, name, change)


def bomb(content: bytes) -> bytes:
    return packed(files_of(content) | {"sweeps.jsonl": bytes(100 * 2**20)})


def lying_bomb(content: bytes) -> bytes:
    """Its head says that the file is short."""
    packed_bomb = bytearray(packed({"mission.json": b" " * (4 * 2**20)}))
    at = packed_bomb.index(b"PK\x01\x02")
    packed_bomb[at + 24 : at + 28] = struct.pack("<I", 100)
    return bytes(packed_bomb)


def swollen_sweep(content: bytes) -> bytes:
    """A sweep whose samples unpack to far more than any turn has."""
    line = json.loads(files_of(content)["sweeps.jsonl"].split(b"\n")[0])
    line["fields"]["samples"] = base64.b64encode(zlib.compress(bytes(24 * 2**20))).decode()
    return packed(files_of(content) | {"sweeps.jsonl": json.dumps(line).encode()})


SWEEPS = [
    sweep_entry(ID, record.event.sweep_id, "craft-1", record.event.emitter_id, 1, 1, sweep_of(record.event))
    for record in FLOWN
    if isinstance(record.event, BearingMeasured) and record.event.sweep_id
]
SOUND = bundle(FLOWN, {"craft-1": PATH}, raw_files(ID, SWEEPS, {"craft-1": PATH}))


def test_the_bundle_that_is_spoiled_below_is_sound():
    brought = read_bundle(SOUND)
    assert (brought.mission_id, len(brought.rows), brought.sweeps) == (ID, len(FLOWN), tuple(SWEEPS))


def other_schema(text: bytes) -> bytes:
    return json.dumps(json.loads(text) | {"schema": "holiday pictures"}).encode()


def later_schema(text: bytes) -> bytes:
    return json.dumps(json.loads(text) | {"version": 3}).encode()


def renumbered(text: bytes) -> bytes:
    told = json.loads(text)
    told["events"][3]["seq"] = 99
    return json.dumps(told).encode()


def of_two(text: bytes) -> bytes:
    told = json.loads(text)
    told["events"][3]["mission_id"] = "another"
    return json.dumps(told).encode()


def elsewhere_named(text: bytes) -> bytes:
    return text.replace(ID.encode(), b"../../../etc/passwd")


def still_flying(text: bytes) -> bytes:
    told = json.loads(text)
    end = next(at for at, record in enumerate(told["events"]) if record["event"]["kind"] == "mission_ended")
    return json.dumps(told | {"events": told["events"][:end]}).encode()


def sweeps_with(**changes: Any) -> Callable[[bytes], bytes]:
    def change(text: bytes) -> bytes:
        told = json.loads(text.split(b"\n")[0])
        return json.dumps(told | {"fields": told["fields"] | changes}).encode()

    return changed("sweeps.jsonl", change)


def samples_of(number: float) -> str:
    return base64.b64encode(zlib.compress(np.full(30, number).tobytes())).decode()


def point_with(**changes: Any) -> Callable[[bytes], bytes]:
    def change(text: bytes) -> bytes:
        told = json.loads(text.split(b"\n")[0])
        told["fields"]["points"][0] |= changes
        return json.dumps(told).encode()

    return changed("tracks.jsonl", change)


def at(moment: Any) -> Callable[[bytes], bytes]:
    """The mission's first fact is of that time."""

    def change(text: bytes) -> bytes:
        told = json.loads(text)
        told["events"][0]["at_utc"] = moment
        return json.dumps(told).encode()

    return changed("mission.json", change)


def as_long_as(axis_m: str) -> Callable[[bytes], bytes]:
    """The region of an estimate."""
    return changed(
        "mission.json", lambda text: re.sub(rb'"major_axis_m": [0-9.e-]+', f'"major_axis_m": {axis_m}'.encode(), text)
    )


@pytest.mark.parametrize(
    "moment", ["9999-12-31T23:59:59-14:00", "9999-12-31T23:59:59Z", "0001-01-01T00:00:00Z", -1, -62135596800]
)
def test_facts_of_a_time_that_no_clock_shows_are_refused(moment):
    """Such a mission could not be read again, or not be exported."""
    with pytest.raises(BundleRefused) as refused:
        read_bundle(at(moment)(SOUND))
    assert refused.value.reason == BundleFileWrong("not_exported", "mission.json")


def test_a_mission_of_a_clock_that_was_never_set_is_brought_in():
    assert read_bundle(at("1970-01-01T00:00:07Z")(SOUND)).rows[0].at_us == 7_000_000


@pytest.mark.parametrize("axis_m", ["1e308", "-1e308", "1e101", "1" + "0" * 300, "1e999"])
def test_numbers_whose_squares_are_not_finite_are_refused(axis_m):
    with pytest.raises(BundleRefused) as refused:
        read_bundle(as_long_as(axis_m)(SOUND))
    assert refused.value.reason == BundleFileWrong("damaged", "mission.json")


@pytest.mark.parametrize(
    "wrong",
    [
        {"attempt": 1.5}, {"attempt": "one"}, {"attempt": -1}, {"place_number": 10**30},
        {"clipped_samples": 2**63}, {"frequency_hz": 1e308}, {"frequency_hz": -1.0},
        {"altitude_amsl_m": 1e308}, {"noise_floor_db": float("nan")}, {"tag": "x" * 201}, {"tag": "\x00"},
        {"emitter_id": "\x00"}, {"craft_id": "../x"}, {"samples": samples_of(1e308)}, {"samples": samples_of(-1e308)},
    ],
)  # fmt: skip
def test_a_sweep_with_wrong_values_is_refused(wrong):
    with pytest.raises(BundleRefused) as refused:
        read_bundle(sweeps_with(**wrong)(SOUND))
    assert refused.value.reason == BundleFileWrong("damaged", "sweeps.jsonl")


@pytest.mark.parametrize(
    "wrong",
    [{"at_s": "x"}, {"at_s": 9e10}, {"lat_deg": None}, {"mode": 5}, {"heading_deg": "east"}, {"battery_percent": []}],
)
def test_a_path_with_wrong_values_is_refused(wrong):
    with pytest.raises(BundleRefused) as refused:
        read_bundle(point_with(**wrong)(SOUND))
    assert refused.value.reason == BundleFileWrong("damaged", "tracks.jsonl")


@pytest.mark.parametrize(
    ("spoil", "fault"),
    [
        (lambda content: b"", "not_zip"),
        (lambda content: b"PK\x03\x04" + bytes(100), "not_zip"),
        (lambda content: content[: len(content) // 2], "not_zip"),
        (lambda content: packed({}), "not_exported"),
        (lambda content: without(content, "mission.json"), "not_exported"),
        (added("../../../../tmp/evil.sh"), "foreign"),
        (added("/etc/cron.d/evil"), "foreign"),
        (added("..\\evil.exe"), "foreign"),
        (added("nested.zip"), "foreign"),
        (bomb, "too_large"),
        (lying_bomb, "damaged"),
        (swollen_sweep, "damaged"),
        (changed("mission.json", lambda text: b"[" * 100_000), "damaged"),
        (changed("mission.json", lambda text: b"{}"), "not_exported"),
        (changed("mission.json", renumbered), "not_exported"),
        (changed("mission.json", of_two), "not_exported"),
        (changed("mission.json", elsewhere_named), "not_exported"),
        (changed("mission.json", still_flying), "under_way"),
        (changed("bundle.json", other_schema), "not_exported"),
        (changed("bundle.json", later_schema), "later"),
        (changed("bundle.json", lambda text: b"\xff"), "damaged"),
        (changed("sweeps.jsonl", lambda text: text.replace(b'"lat_deg":', b'"lat_deg":9')), "damaged"),
        (changed("sweeps.jsonl", lambda text: text.replace(b'"entry":"sweep"', b'"entry":"track"')), "damaged"),
        (changed("tracks.jsonl", lambda text: text.replace(b'"at_s":1', b'"at_s":-1')), "damaged"),
        (changed("tracks.jsonl", lambda text: text.replace(b'"craft-1"', b'"../x"')), "damaged"),
        (
            changed("tracks.jsonl", lambda text: text.replace(b'"altitude_amsl_m":1', b'"altitude_amsl_m":1e99')),
            "damaged",
        ),
        (changed("tracks.jsonl", lambda text: text.replace(b'"mode":"', b'"mode":"' + b"M" * 99)), "damaged"),
    ],
)
def test_a_hostile_bundle_is_refused_with_a_reason(spoil, fault):
    with pytest.raises(BundleRefused) as refused:
        read_bundle(spoil(SOUND))
    assert isinstance(refused.value.reason, BundleUnreadable | BundleFileWrong)
    assert refused.value.reason.fault == fault


@pytest.mark.parametrize(
    ("spoil", "code"),
    [
        (bomb, "bundle_unreadable"),
        (added("../../evil.sh"), "bundle_file_wrong"),
        (changed("bundle.json", later_schema), "bundle_unreadable"),
    ],
)
async def test_a_refused_bundle_leaves_nothing(client, spoil, code):
    reply = await client.post("/api/bundles", content=spoil(SOUND))
    assert (reply.status_code, reply.json()["reason"]["code"]) == (422, code)
    assert reply.json()["detail"].strip()
    assert reply.json()["remedy"].strip()
    assert (await client.get("/api/missions")).json()["missions"] == []


def test_a_refusal_comes_out_of_the_worker_as_it_went_in():
    with pytest.raises(BundleRefused) as refused:
        read_bundle(b"")
    again = pickle.loads(pickle.dumps(refused.value))
    assert again.reason == refused.value.reason
