"""One zip with every file, each readable."""

from __future__ import annotations

import csv
import io
import json
import zipfile
from xml.etree import ElementTree

from backend.wire.bundle import FILES, RAW, WAYS, bundle

NAMED = {*FILES, *RAW} - {WAYS}
"""In a bundle of a mission without ways."""


def test_every_file_is_in_it_and_named_in_the_readme(recorded, tracks) -> None:
    with zipfile.ZipFile(io.BytesIO(bundle(recorded, tracks))) as archive:
        assert archive.testzip() is None
        assert set(archive.namelist()) == {"README.txt", *NAMED}
        readme = archive.read("README.txt").decode()
        assert all(name in readme for name in NAMED)
        assert len(json.loads(archive.read("mission.json"))["events"]) == len(recorded)
        assert json.loads(archive.read("mission.geojson"))["type"] == "FeatureCollection"
        assert ElementTree.fromstring(archive.read("mission.kml")).tag.endswith("kml")
        assert len(list(csv.reader(io.StringIO(archive.read("bearings.csv").decode())))) == 2
        assert archive.read("mission.mcap").startswith(b"\x89MCAP0")
        assert zipfile.is_zipfile(io.BytesIO(archive.read("tak.zip")))


def test_the_same_mission_gives_the_same_bytes(recorded, tracks) -> None:
    assert bundle(recorded, tracks) == bundle(recorded, tracks)


def test_a_draft_can_be_taken_away_too(recorded) -> None:
    assert zipfile.is_zipfile(io.BytesIO(bundle(recorded[:1], {})))


def test_it_holds_every_emitter(of_two_emitters, tracks) -> None:
    with zipfile.ZipFile(io.BytesIO(bundle(of_two_emitters, tracks))) as archive:
        rows = csv.reader(io.StringIO(archive.read("bearings.csv").decode()))
        assert [row[0] for row in rows] == ["1", "1", "2"]
        features = json.loads(archive.read("mission.geojson"))["features"]
        bearings = [f["properties"] for f in features if f["properties"]["what"] == "bearing"]
        assert [(b["name"], b["emitter"]) for b in bearings] == [
            ("bearing 1", "fox & <hound>"),
            ("bearing 2", "fox & <hound>"),
            ("bearing 3", "fox & <hound>"),
            ("bearing 1", "tag"),
        ]
        assert json.loads(archive.read("mission.json"))["tracks"].keys() == {"craft-1"}


def test_one_emitter_needs_no_name_beside_its_bearings(recorded, tracks) -> None:
    with zipfile.ZipFile(io.BytesIO(bundle(recorded, tracks))) as archive:
        features = json.loads(archive.read("mission.geojson"))["features"]
        assert not any("emitter" in f["properties"] for f in features)
