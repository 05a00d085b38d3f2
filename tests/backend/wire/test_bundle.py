"""One zip with every file, each readable."""

from __future__ import annotations

import csv
import io
import json
import zipfile
from xml.etree import ElementTree

from backend.wire.bundle import FILES, bundle


def test_every_file_is_in_it_and_named_in_the_readme(recorded, track) -> None:
    with zipfile.ZipFile(io.BytesIO(bundle(recorded, track))) as archive:
        assert archive.testzip() is None
        assert set(archive.namelist()) == {"README.txt", *FILES}
        readme = archive.read("README.txt").decode()
        assert all(name in readme for name in FILES)
        assert len(json.loads(archive.read("mission.json"))["events"]) == len(recorded)
        assert json.loads(archive.read("mission.geojson"))["type"] == "FeatureCollection"
        assert ElementTree.fromstring(archive.read("mission.kml")).tag.endswith("kml")
        assert len(list(csv.reader(io.StringIO(archive.read("bearings.csv").decode())))) == 2
        assert archive.read("mission.mcap").startswith(b"\x89MCAP0")
        assert zipfile.is_zipfile(io.BytesIO(archive.read("tak.zip")))


def test_the_same_mission_gives_the_same_bytes(recorded, track) -> None:
    assert bundle(recorded, track) == bundle(recorded, track)


def test_a_draft_can_be_taken_away_too(recorded) -> None:
    assert zipfile.is_zipfile(io.BytesIO(bundle(recorded[:1], ())))
