"""Cursor on Target events and the data package around them."""

from __future__ import annotations

import io
import zipfile
from datetime import datetime
from xml.etree import ElementTree

import pytest
from narrowing import known
from small_missions import numbered

from backend.events import MissionLabelled
from backend.wire.cot_export import cot_events, cot_package


def by_type(recorded) -> dict[str, list[ElementTree.Element]]:
    found: dict[str, list[ElementTree.Element]] = {}
    for event in cot_events(recorded):
        found.setdefault(event.get("type", ""), []).append(event)
    return found


def number(element: ElementTree.Element, path: str, name: str) -> float:
    return float(known(known(element.find(path)).get(name)))


def test_the_emitter_is_a_point_with_its_error(recorded) -> None:
    (emitter,) = by_type(recorded)["a-u-G"]
    assert (number(emitter, "point", "lat"), number(emitter, "point", "lon")) == (50.625, 7.205)
    assert number(emitter, "point", "ce") == pytest.approx(2.4477 * 20, abs=0.01)
    assert known(emitter.find("detail/contact")).get("callsign") == "fox & <hound>"
    assert "not yet localized" in known(emitter.findtext("detail/remarks"))


def test_the_ellipse_holds_95_percent(recorded) -> None:
    (event,) = by_type(recorded)["u-d-c-e"]
    assert [number(event, "detail/shape/ellipse", name) for name in ("major", "minor", "angle")] == pytest.approx(
        [48.95, 12.24, 30.0], abs=0.01
    )


def test_each_bearing_that_counts_is_a_line_towards_the_estimate(recorded) -> None:
    lines = by_type(recorded)["u-rb-a"]
    assert [number(line, "detail/bearing", "value") for line in lines] == [45.0, 315.0]
    assert all(300 < number(line, "detail/range", "value") < 600 for line in lines)


def test_times_are_ordered_and_in_utc(recorded) -> None:
    for event in cot_events(recorded):
        start, stale = (
            datetime.strptime(known(event.get(name)), "%Y-%m-%dT%H:%M:%S.%fZ") for name in ("start", "stale")
        )
        assert (stale - start).days == 1
        assert event.get("version") == "2.0"


def test_the_same_mission_keeps_its_uids_and_bytes(recorded) -> None:
    assert cot_package(recorded, {}) == cot_package(recorded, {})
    uids = [event.get("uid") for event in cot_events(recorded)]
    assert len(set(uids)) == len(uids)


def test_the_package_names_every_file_it_holds(recorded) -> None:
    with zipfile.ZipFile(io.BytesIO(cot_package(recorded, {}))) as archive:
        manifest = ElementTree.fromstring(archive.read("MANIFEST/manifest.xml"))
        entries = {content.get("zipEntry") for content in manifest.iter("Content")}
        assert entries == set(archive.namelist()) - {"MANIFEST/manifest.xml"}
        assert len(entries) == 4
        for name in entries:
            assert ElementTree.fromstring(archive.read(known(name))).tag == "event"
        names = {each.get("name"): each.get("value") for each in manifest.iter("Parameter")}
        assert names["name"] == 'Meadow "A" & <B>'


def test_the_package_is_called_what_the_mission_was_renamed_to(recorded) -> None:
    label = MissionLabelled(name="Owl\uffff 7", tags=[], notes="", by="op")
    renamed = numbered([*(record.event for record in recorded), label])
    with zipfile.ZipFile(io.BytesIO(cot_package(renamed, {}))) as archive:
        manifest = ElementTree.fromstring(archive.read("MANIFEST/manifest.xml"))
    assert "Owl 7" in [each.get("value") for each in manifest.iter("Parameter")]


def test_without_an_estimate_there_are_bearings_only(recorded) -> None:
    assert set(by_type(recorded[:4])) == {"u-rb-a"}
    assert cot_events(recorded[:1]) == []


def test_each_emitter_has_events_of_its_own(recorded, of_two_emitters) -> None:
    found = by_type(of_two_emitters)
    assert [number(line, "detail/bearing", "value") for line in found["u-rb-a"]] == [45.0, 315.0, 90.0]
    assert len(found["a-u-G"]) == len(found["u-d-c-e"]) == 1
    uids = [event.get("uid") for event in cot_events(of_two_emitters)]
    assert len(set(uids)) == len(uids)
    assert [event.get("uid") for event in cot_events(recorded)] == uids[:-1]
