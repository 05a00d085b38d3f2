"""What other programs learn of emitters: which one, how important, and only where somebody measured it."""

from __future__ import annotations

import csv
import io
import json
from pathlib import Path
from xml.etree import ElementTree

import pytest
from narrowing import a, known
from small_missions import AREA, FOX, TAG, bearing, mission, numbered

from backend.bearing_file import read_bearing_file
from backend.events import (
    BeliefUpdated,
    CraftSource,
    HeardOnTheWay,
    ImportSource,
    MissionDrafted,
    MissionLabelled,
    MissionStarted,
    PersonSource,
    StretchFact,
)
from backend.spec import EmitterSpec, Place, Polygon
from backend.wire.cot_export import cot_events
from backend.wire.export import bearings_csv, geojson, kml

KML = "{http://www.opengis.net/kml/2.2}"
HOME = Place(lat=50.62, lon=7.205)


def features(recorded, tracks=None) -> list[dict]:
    return json.loads(geojson(recorded, tracks or {}))["features"]


def rows(recorded) -> list[list[str]]:
    return list(csv.reader(io.StringIO(bearings_csv(recorded, {}))))


def callsigns(recorded) -> list[str]:
    return [contact.get("callsign", "") for event in cot_events(recorded) for contact in event.iter("contact")]


def by(source, number: int = 1, altitude_amsl_m: float = 0.0):
    changed = {"source": source, "altitude_amsl_m": altitude_amsl_m}
    return bearing(number, 50.622, 7.202, 45.0).model_copy(update=changed)


def started(craft_id: str, home_amsl_m: float) -> MissionStarted:
    return MissionStarted(craft_id=craft_id, by="op", home=HOME, home_amsl_m=home_amsl_m, software="test")


def test_the_order_of_importance_stands_with_what_is_told_of_an_emitter(of_two_emitters, fox_first, tracks) -> None:
    before, after = (features(told, tracks) for told in (of_two_emitters, fox_first))
    assert not any("priority" in one["properties"] for one in before)
    told = {one["properties"].get("emitter"): one["properties"].get("priority") for one in after}
    assert told == {None: None, "fox & <hound>": 1, "tag": None}
    kept = [one["properties"] for one in after]
    for properties in kept:
        properties.pop("priority", None)
    assert kept == [one["properties"] for one in before]
    assert '<Data name="priority"><value>1</value></Data>' in kml(fox_first, tracks)
    assert "priority" not in kml(of_two_emitters, tracks)
    remarks = [event.findtext("detail/remarks") or "" for event in cot_events(fox_first)]
    assert sum("priority 1" in text for text in remarks) == 1
    assert bearings_csv(fox_first, tracks) == bearings_csv(of_two_emitters, tracks), "numbers of tags stay"


def test_the_middle_of_an_area_where_nobody_measured_is_no_estimate(of_the_prior) -> None:
    assert {one["properties"]["what"] for one in features(of_the_prior)} == {"area", "place", "bearing"}
    assert "95 % region" not in kml(of_the_prior, {})
    assert cot_events(of_the_prior) == []


def test_a_mission_is_called_what_it_was_renamed_to(recorded) -> None:
    label = MissionLabelled(name="Owl 7", tags=[], notes="", by="op")
    renamed = numbered([*(record.event for record in recorded), label])
    assert features(renamed)[0]["properties"] == {"what": "area", "name": "Owl 7"}
    assert ElementTree.fromstring(kml(renamed, {})).findtext(f"{KML}Document/{KML}name") == "Owl 7"


def test_emitters_that_are_called_alike_are_told_apart() -> None:
    alike = [EmitterSpec(emitter_id="fox"), EmitterSpec(emitter_id="tag", frequency_hz=150e6)]
    of_tag = bearing(1, 50.622, 7.202, 90.0).model_copy(update={"emitter_id": "tag", "bearing_id": "t1"})
    recorded = numbered([*mission(*alike), of_tag])
    names = [one["properties"].get("emitter") for one in features(recorded)]
    assert set(names) == {None, "emitter 1", "emitter 2"}
    assert callsigns(recorded) == [
        "emitter 1",
        "emitter 1 95 %",
        "emitter 1 bearing 1",
        "emitter 1 bearing 2",
        "emitter 2 bearing 1",
    ]


def test_a_colon_is_part_of_an_emitters_name() -> None:
    recorded = numbered(mission(EmitterSpec(emitter_id="fox", label="Fox: red")))
    assert callsigns(recorded) == ["Fox: red", "Fox: red 95 %", "bearing 1", "bearing 2"]
    assert cot_events(recorded)[0].findtext("detail/remarks") == "Fox: red: not yet localized, expected error 9.8 m"


@pytest.mark.parametrize("character", ["\uffff", "\ufffe", "\x1b", "\x01", "\ud800"])
def test_what_xml_does_not_have_is_left_out_of_names(character) -> None:
    fox = FOX.model_copy(update={"label": f"fo{character}x"})
    label = MissionLabelled.model_construct(name=f"Owl{character} 7", tags=[], notes="", by="op")
    recorded = numbered(mission(fox, TAG))
    recorded.append(recorded[-1].model_construct(**{**dict(recorded[-1]), "event": label}))
    document = ElementTree.fromstring(kml(recorded, {}).encode())
    assert document.findtext(f"{KML}Document/{KML}name") == "Owl 7"
    events = [ElementTree.fromstring(ElementTree.tostring(event, encoding="UTF-8")) for event in cot_events(recorded)]
    assert known(events[0].find("detail/contact")).get("callsign") == "fox"


def test_altitudes_are_above_the_home_of_the_craft_that_measured() -> None:
    taken = by(CraftSource(craft_id="craft-2"), 2, 340.0)
    recorded = numbered([mission(FOX)[0], started("craft-1", 100.0), started("craft-2", 300.0), by(
        CraftSource(craft_id="craft-1"), 1, 140.0), taken])  # fmt: skip
    assert [row[6:8] for row in rows(recorded)] == [["40.000", "140.000"], ["40.000", "340.000"]]


@pytest.mark.parametrize("source", [PersonSource(name="Ada"), ImportSource(recording_id="r1")])
def test_an_altitude_that_nobody_knows_is_not_sea_level(source) -> None:
    before = [mission(FOX)[0], by(source), started("craft-1", 200.0), by(source, 2, 200.0)]
    recorded = numbered(before)
    assert [row[6:8] for row in rows(recorded)] == [["", ""], ["0.000", "200.000"]]
    heights = [[told.get("value") for told in event.iter("height_amsl")] for event in cot_events(recorded)]
    assert heights == [[], ["200.0"]]


@pytest.mark.parametrize("source", [PersonSource(name="Ada"), ImportSource(recording_id="r1")])
def test_the_homes_altitude_is_not_that_of_a_bearing_without_a_sweep(source) -> None:
    """A bearing that comes without an altitude has its mission's home's."""
    told = by(source, 1, 200.0).model_copy(update={"sweep_id": None})
    recorded = numbered([mission(FOX)[0], started("craft-1", 200.0), told])
    assert [row[6:8] for row in rows(recorded)] == [["", ""]]
    assert not [told for event in cot_events(recorded) for told in event.iter("height_amsl")]


def test_bearings_that_were_exported_without_a_quality_are_read_again(tmp_path: Path) -> None:
    told = by(PersonSource(name="Ada")).model_copy(update={"sweep_id": None, "quality": 1.0})
    (tmp_path / "bearings.csv").write_text(bearings_csv(numbered([mission(FOX)[0], told]), {}))
    read = known(read_bearing_file(tmp_path / "bearings.csv", None))
    assert [(one.bearing_deg, one.place) for one in read.bearings] == [(told.bearing_deg, told.place)]


def test_an_altitude_of_a_recording_is_known_without_a_home() -> None:
    recorded = numbered([mission(FOX)[0], by(ImportSource(recording_id="r1"), 1, 240.0)])
    assert [row[6:8] for row in rows(recorded)] == [["", "240.000"]]


def test_a_bearing_without_a_sweep_has_no_quality_and_the_time_at_which_it_was_taken() -> None:
    taken = by(PersonSource(name="Ada")).model_copy(update={"sweep_id": None, "quality": 1.0, "taken_at_s": 1.7e9})
    recorded = numbered([mission(FOX)[0], taken, by(PersonSource(name="Ben"), 2)])
    drawn = [told["properties"] for told in features(recorded) if told["properties"]["what"] == "bearing"]
    assert [told["quality"] for told in drawn] == [None, 0.9]
    remarks = [told.text or "" for event in cot_events(recorded) for told in event.iter("remarks")]
    assert ["quality" in remark for remark in remarks] == [False, True]
    assert [row[3] for row in rows(recorded)] == ["", "0.900000"]
    assert rows(recorded)[0][8:] == ["1700000000.000000"] * 2
    assert [told["at_utc"] for told in drawn] == ["2023-11-14T22:13:20+00:00", recorded[2].at_utc.isoformat()]


@pytest.mark.parametrize("at_s", [-1.0, 0.0, 1e300])
def test_a_time_that_cannot_be_is_not_exported(at_s: float) -> None:
    """A bundle of another's making may say it."""
    recorded = numbered([mission(FOX)[0], by(PersonSource(name="Ada")).model_copy(update={"taken_at_s": at_s})])
    (told,) = (one["properties"] for one in features(recorded) if one["properties"]["what"] == "bearing")
    assert told["at_utc"] == recorded[1].at_utc.isoformat()
    assert float(rows(recorded)[0][9]) == recorded[1].at_utc.timestamp()


@pytest.mark.parametrize("sweep_id", ['=HYPERLINK("http://x")', "+1", "-1", "@SUM(A1)", "\t=1"])
def test_no_cell_is_a_formula(sweep_id) -> None:
    fact = bearing(1, 50.622, 7.202, 45.0).model_copy(update={"sweep_id": sweep_id})
    (row,) = rows(numbered([mission(FOX)[0], fact]))
    assert row[1] == f"'{sweep_id}"


def of_a_leg() -> HeardOnTheWay:
    stretch = StretchFact(begin=HOME, end=Place(lat=50.621, lon=7.205), turned_deg=40.0)
    return HeardOnTheWay(
        emitter_id="fox", source=CraftSource(craft_id="craft-1"), leg_id="leg-1", place_number=1, counted=20,
        left_out=[], nose=[], stretches=[stretch], origin=HOME, readings="packed", gain_db=[0.0], sigma_deg=7.0,
    )  # fmt: skip


def test_every_placemark_has_a_style_of_the_document(recorded, tracks) -> None:
    text = kml(numbered([*(record.event for record in recorded), of_a_leg()]), tracks)
    document = ElementTree.fromstring(text)
    styles = {style.get("id") for style in document.iter(f"{KML}Style")}
    used = {(url.text or "")[1:] for url in document.iter(f"{KML}styleUrl")}
    assert "listened" in used <= styles
    for style in document.iter(f"{KML}PolyStyle"):
        assert [child.tag for child in style] == [f"{KML}color", f"{KML}fill"], "the order of the schema"


def test_what_lies_across_the_antimeridian_is_cut_there() -> None:
    corners = [(179.995, 50.62), (179.995, 50.63), (-179.995, 50.63), (-179.995, 50.62), (179.995, 50.62)]
    across = Polygon(coordinates=[corners])
    first, start, *_ = mission(FOX)
    draft = a(MissionDrafted, first)
    spec = draft.spec.model_copy(update={"area": across})
    taken = bearing(1, 50.625, 179.999, 90.0)
    belief = next(event for event in mission(FOX) if isinstance(event, BeliefUpdated))
    estimate = known(belief.estimate).model_copy(update={"lat": 50.625, "lon": -179.999, "c95": across})
    found = belief.model_copy(update={"estimate": estimate, "bearings": 1})
    recorded = numbered([draft.model_copy(update={"spec": spec}), start, taken, found])
    kinds = {one["properties"]["what"]: one["geometry"]["type"] for one in features(recorded)}
    assert (kinds["area"], kinds["c95"], kinds["bearing"]) == ("MultiPolygon", "MultiPolygon", "MultiLineString")
    drawn = list(ElementTree.fromstring(kml(recorded, {})).iter(f"{KML}MultiGeometry"))
    assert [[child.tag.removeprefix(KML) for child in geometry] for geometry in drawn] == [
        ["Polygon", "Polygon"],
        ["LineString", "LineString"],
        ["Polygon", "Polygon"],
    ]


def test_points_of_a_path_without_a_place_are_left_out(recorded, tracks) -> None:
    (track,) = (one for one in features(recorded, tracks) if one["properties"]["what"] == "track")
    assert track["geometry"]["coordinates"] == [[7.205, 50.6201], [7.205, 50.6202]]


def test_an_area_is_drawn_counter_clockwise(recorded) -> None:
    clockwise = Polygon(coordinates=[AREA.coordinates[0][::-1]])
    draft = a(MissionDrafted, recorded[0].event)
    turned = draft.model_copy(update={"spec": draft.spec.model_copy(update={"area": clockwise})})
    assert features(numbered([turned]))[0] == features(recorded)[0]
