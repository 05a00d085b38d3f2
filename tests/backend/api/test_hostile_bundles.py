"""Bundles that somebody spoiled: each is refused with a reason, and nothing of it is left."""

from __future__ import annotations

import base64
import json
import pickle
import re
import struct
import zlib
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from bundles import FLOWN, ID, SOUND, SWEEPS, added, files_of, packed, repacked, without

from backend.reasons.request import BundleFileWrong, BundleUnreadable
from backend.store.brought import BundleRefused, read_bundle


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


def of_an_emitter_that_nobody_looks_for(kind: str) -> Callable[[bytes], bytes]:
    def change(text: bytes) -> bytes:
        told = json.loads(text)
        fact = next(record["event"] for record in told["events"] if record["event"]["kind"] == kind)
        fact["emitter_id"] = "emitter-9"
        return json.dumps(told).encode()

    return changed("mission.json", change)


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
        (of_an_emitter_that_nobody_looks_for("bearing_measured"), "not_exported"),
        (of_an_emitter_that_nobody_looks_for("belief_updated"), "not_exported"),
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
