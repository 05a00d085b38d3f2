"""Before the flight: files, typed corners, recordings, the antenna; refusals in plain words, nothing typed is lost."""

from __future__ import annotations

import json
import math
from pathlib import Path

import pytest
from playwright.sync_api import Route, expect
from screen import Screen
from served import Server
from shapely.geometry import box, shape

pytestmark = [pytest.mark.browser, pytest.mark.timeout(480)]


RING = [[7.2030, 50.6234], [7.2060, 50.6234], [7.2060, 50.6250], [7.2030, 50.6250], [7.2030, 50.6234]]
KML = """<?xml version="1.0"?><kml xmlns="http://www.opengis.net/kml/2.2"><Placemark><Polygon><outerBoundaryIs>
<LinearRing><coordinates>{}</coordinates></LinearRing></outerBoundaryIs></Polygon></Placemark></kml>"""


def write(tmp_path: Path, name: str, text: str) -> Path:
    path = tmp_path / name
    path.write_text(text)
    return path


def saved(server: Server, editor: Screen) -> dict:
    editor.part("save").click()
    expect(editor.part("preflight")).to_be_visible()
    return server.get(f"/api/missions/{editor.mission_id}")["spec"]


def test_an_area_comes_from_a_geojson_file(server: Server, editor: Screen, tmp_path: Path) -> None:
    area = json.dumps({"type": "Polygon", "coordinates": [RING]})
    editor.part("import-file").set_input_files(write(tmp_path, "meadow.geojson", area))
    expect(editor.part("area-size")).to_have_attribute("data-suggested", "false")
    corners = saved(server, editor)["area"]["coordinates"][0]
    assert {tuple(c) for c in corners} == {tuple(c) for c in RING}


@pytest.mark.long
def test_an_area_comes_from_a_kml_file(server: Server, editor: Screen, tmp_path: Path) -> None:
    text = KML.format(" ".join(f"{lon},{lat},0" for lon, lat in RING))
    editor.part("import-file").set_input_files(write(tmp_path, "meadow.kml", text))
    expect(editor.part("area-size")).to_have_attribute("data-suggested", "false")
    assert len(saved(server, editor)["area"]["coordinates"][0]) == 5


@pytest.mark.long
def test_a_fence_and_its_holes_come_from_a_qgroundcontrol_plan(server: Server, editor: Screen, tmp_path: Path) -> None:
    outer = [[50.6220, 7.2010], [50.6220, 7.2080], [50.6265, 7.2080], [50.6265, 7.2010]]
    inner = [[50.6258, 7.2020], [50.6258, 7.2030], [50.6262, 7.2030]]
    fence = {"polygons": [{"inclusion": True, "polygon": outer}, {"inclusion": False, "polygon": inner}]}
    plan = json.dumps({"fileType": "Plan", "geoFence": fence})
    editor.part("import-file").set_input_files(write(tmp_path, "field.plan", plan))
    expect(editor.part("area-section")).to_contain_text("drawn:")
    flight = saved(server, editor)["flight"]
    assert flight["fence"]["coordinates"][0][0] == [7.2010, 50.6220]
    assert len(flight["no_fly"]) == 1


def test_the_corners_of_an_area_with_a_hole_are_moved_and_the_hole_stays(
    server: Server, editor: Screen, tmp_path: Path
) -> None:
    hole = [[7.2040, 50.6238], [7.2050, 50.6238], [7.2050, 50.6244], [7.2040, 50.6244], [7.2040, 50.6238]]
    area = json.dumps({"type": "Polygon", "coordinates": [RING, hole]})
    editor.part("import-file").set_input_files(write(tmp_path, "clearing.geojson", area))
    expect(editor.part("area-size")).to_contain_text("8 corners")
    for pressed in ("true", "false"):
        editor.part("draw-corners").click()
        expect(editor.part("draw-corners")).to_have_attribute("aria-pressed", pressed)
    rings = saved(server, editor)["area"]["coordinates"]
    assert [len(ring) for ring in rings] == [5, 5]
    assert {tuple(c) for c in rings[1]} == {tuple(c) for c in hole}


@pytest.mark.parametrize("is_left_first", [False, True])
def test_a_corner_that_was_moved_is_saved_while_others_could_still_be_moved(
    server: Server, editor: Screen, is_left_first: bool
) -> None:
    editor.draw([(0.3, 0.3), (0.7, 0.3), (0.7, 0.7), (0.3, 0.7)])
    expect(editor.part("area-size")).to_have_attribute("data-suggested", "false")
    editor.part("draw-corners").click()
    mouse = editor.page.mouse
    mouse.move(*editor.map_point(0.3, 0.3, "edit-map"))
    mouse.down()
    mouse.move(*editor.map_point(0.1, 0.1, "edit-map"), steps=5)
    mouse.up()
    if is_left_first:
        editor.go("#/")
        editor.go("#/new")
        expect(editor.part("area-size")).to_have_attribute("data-suggested", "false")
    moved = shape(saved(server, editor)["area"])
    assert moved.area == pytest.approx(2 / 3 * moved.envelope.area, rel=0.05)


def test_a_file_that_is_no_area_is_named_with_its_reason(editor: Screen, tmp_path: Path) -> None:
    editor.part("import-file").set_input_files(write(tmp_path, "notes.geojson", "buy milk"))
    message = editor.part("area-message")
    expect(message).to_contain_text("notes.geojson")
    expect(editor.part("area-size")).to_have_attribute("data-suggested", "true")


def test_corners_are_typed_in_mixed_notations(server: Server, editor: Screen) -> None:
    editor.page.get_by_text("Paste GeoJSON or corner").click()
    editor.part("paste-area").fill("50.6234 N 7.2030 E\n50.6234, 7.2060\n50°37′30.0″ N 7°12′21.6″ E\n50.625 7.203")
    editor.part("paste-apply").click()
    expect(editor.part("area-size")).to_contain_text("4 corners")
    assert len(saved(server, editor)["area"]["coordinates"][0]) == 5


MEADOW = (7.2030, 50.6234, 7.2060, 50.6250)
POND = (7.2040, 50.6238, 7.2050, 50.6242)
SLOPE = (7.2050, 50.6240, 7.2070, 50.6260)
"""West, south, east, north: a field, a piece of it, and one that it overlaps."""


def test_ground_in_two_parts_of_an_area_counts_once(server: Server, editor: Screen) -> None:
    size, replaces = editor.part("area-size"), editor.part("draw-replaces")

    def add(west: float, south: float, east: float, north: float) -> None:
        corners = ((south, west), (south, east), (north, east), (north, west))
        editor.part("paste-area").fill("\n".join(f"{lat} {lon}" for lat, lon in corners))
        editor.part("paste-apply").click()

    editor.page.get_by_text("Paste GeoJSON or corner").click()
    add(*MEADOW)
    expect(size).to_contain_text("4 corners")
    once = size.inner_text()
    add(*POND)
    expect(size).to_have_text(once, use_inner_text=True)
    replaces.check()
    add(*SLOPE)
    expect(size).not_to_have_text(once, use_inner_text=True)
    add(*MEADOW)
    expect(size).to_have_text(once, use_inner_text=True)
    replaces.uncheck()

    def answer_late(route: Route) -> None:
        editor.page.wait_for_timeout(1000)
        route.continue_()

    editor.page.route("**/api/areas", answer_late)
    add(*SLOPE)
    area = saved(server, editor)["area"]
    assert area["type"] == "Polygon"
    assert shape(area).equals(box(*MEADOW).union(box(*SLOPE)))


def test_what_the_server_refuses_stands_at_the_form_and_nothing_is_lost(editor: Screen) -> None:
    editor.part("field-name").fill("Quarry, second search")
    editor.page.get_by_text("Paste GeoJSON or corner").click()
    editor.part("paste-area").fill("50.6234 7.2030\n50.6250 7.2060\n50.6234 7.2060\n50.6250 7.2030")
    editor.part("paste-apply").click()
    editor.part("save").click()
    expect(editor.part("edit-problem")).to_be_visible()
    expect(editor.part("edit-problem")).to_contain_text("What to do")
    expect(editor.part("field-name")).to_have_value("Quarry, second search")
    editor.page.reload()
    expect(editor.part("field-name")).to_have_value("Quarry, second search")


def test_a_number_that_is_none_is_marked_and_kept(server: Server, editor: Screen) -> None:
    altitude = editor.part("field-flight-altitude_relative_m")
    altitude.fill("high up")
    altitude.blur()
    expect(altitude).to_have_attribute("aria-invalid", "true")
    editor.part("save").click()
    expect(editor.part("edit-problem")).to_be_visible()
    expect(altitude).to_have_value("high up")
    altitude.fill("55,5")
    assert saved(server, editor)["flight"]["altitude_relative_m"] == 55.5


def test_a_value_out_of_its_limits_is_refused_at_its_field(editor: Screen) -> None:
    sigma = editor.part("field-sensor-sigma_deg")
    sigma.fill("400")
    sigma.blur()
    editor.part("save").click()
    expect(editor.page.locator("#field-sensor-sigma_deg-message")).to_be_visible()


def test_the_preview_tells_the_time_before_take_off(editor: Screen) -> None:
    editor.part("preview-run").click()
    expect(editor.part("preview-time")).to_contain_text("Localized in about", timeout=120_000)


def test_a_mission_is_used_again_and_edited(server: Server, editor: Screen) -> None:
    editor.part("field-name").fill("First")
    saved(server, editor)
    first = editor.mission_id
    editor.part("edit").click()
    editor.part("field-name").fill("First, corrected")
    editor.part("save").click()
    expect(editor.part("preflight")).to_be_visible()
    assert server.get(f"/api/missions/{first}")["name"] == "First, corrected"
    editor.go(f"#/new/{first}")
    expect(editor.part("field-name")).to_have_value("First, corrected")
    saved(server, editor)
    names = [m["name"] for m in server.get("/api/missions")["missions"]]
    assert names.count("First, corrected") == 2


@pytest.fixture
def draft(server: Server, screen: Screen) -> Screen:
    screen.open(server.draft())
    expect(screen.part("preflight")).to_have_attribute("data-passed", "true")
    return screen


def test_a_recorded_rotation_is_imported_and_what_was_not_understood_is_named(
    server: Server, draft: Screen, tmp_path: Path
) -> None:
    rows = [f"{heading},{-60 + 9 * math.cos(math.radians(heading - 70)):.2f}" for heading in range(0, 360, 3)]
    rotation = write(tmp_path, "hilltop.csv", "\n".join(["heading_deg,power_db", *rows, "north,loud"]))
    draft.part("recording").locator("summary").first.click()
    draft.part("recording-send").click()
    expect(draft.part("recording-problem")).to_contain_text("Choose a file first")
    draft.part("recording-files").set_input_files(rotation)
    draft.part("recording-place").fill("50.6240, 7.2040")
    draft.part("recording-at").fill("2026-05-01T10:00:30")
    draft.part("recording").locator("summary").last.click()
    draft.part("recording-tag").fill("lynx 4")
    draft.part("recording-offset_deg").fill("90")
    draft.part("recording-send").click()
    found = draft.part("recording-found")
    expect(found).to_contain_text("±")
    expect(draft.part("recording-remarks")).to_contain_text("north")
    (bearing,) = [e["bearing_deg"] for e in server.events(draft.mission_id) if e["kind"] == "bearing_measured"]
    assert abs(bearing - 160) < 5, "the antenna looked 90 degrees to the right of the nose"
    expect(draft.part("sweep-bearing")).to_have_attribute("data-value", str(bearing))


def test_an_antenna_that_was_not_turned_refuses_the_start(draft: Screen) -> None:
    def at_once(route: Route) -> None:
        route.continue_(post_data=json.dumps({**(route.request.post_data_json or {}), "wait_s": 1}))

    draft.page.route("**/antenna-check", at_once)
    draft.part("antenna").locator("summary").click()
    draft.part("antenna-emitter").fill("behind the barn")
    draft.part("antenna-listen").click()
    expect(draft.part("antenna-problem")).to_contain_text("Write a bearing like 120")
    draft.part("antenna-emitter").fill("120")
    draft.part("antenna-listen").click()
    expect(draft.part("preflight")).to_have_attribute("data-passed", "false")
    expect(draft.part("check").filter(has_text="around the circle")).to_have_attribute("data-ok", "false")
    expect(draft.part("start")).to_be_disabled()
