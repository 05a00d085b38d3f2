"""What is typed and drawn in the editor is what is saved, whatever else happens meanwhile."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from playwright.sync_api import Locator, Route, expect
from screen import OpenScreen, Screen
from served import Server

pytestmark = [pytest.mark.browser, pytest.mark.timeout(480)]

MEADOW = "50.6234 7.2030\n50.6234 7.2060\n50.6250 7.2060\n50.6250 7.2030"
IN_SECONDS = "50°37′31.1″ N 7°12′13.1″ E\n50°37′31.1″ N 7°12′15.1″ E\n50°37′33.1″ N 7°12′15.1″ E"
TRIANGLE = '{"type": "Polygon", "coordinates": [[[7.203, 50.6234], [7.206, 50.6234], [7.206, 50.625]]]}'
ALTITUDE = "field-flight-altitude_relative_m"


def paste(editor: Screen, corners: str) -> None:
    if not editor.part("paste-area").is_visible():
        editor.page.get_by_text("Paste GeoJSON or corner").click()
    editor.part("paste-area").fill(corners)
    editor.part("paste-apply").click()


def spec_of(server: Server, editor: Screen) -> dict:
    expect(editor.part("preflight")).to_be_visible()
    return server.get(f"/api/missions/{editor.mission_id}")["spec"]


def test_no_fly_areas_outlast_the_moving_of_corners(server: Server, editor: Screen) -> None:
    editor.part("draw-what").select_option("noFly")
    paste(editor, IN_SECONDS)
    paste(editor, MEADOW)
    editor.part("draw-corners").click()
    expect(editor.part("draw-corners")).to_have_attribute("aria-pressed", "true")
    editor.part("save").click()
    assert [len(zone["coordinates"][0]) for zone in spec_of(server, editor)["flight"]["no_fly"]] == [4, 5]


def test_a_polygon_that_is_not_closed_is_not_forgotten(editor: Screen) -> None:
    editor.part("draw-polygon").click()
    for right, down in ((0.3, 0.3), (0.6, 0.3), (0.6, 0.6)):
        editor.page.mouse.click(*editor.map_point(right, down, "edit-map"))
    editor.part("save").click()
    expect(editor.part("edit-problem")).to_contain_text("press Enter to finish")
    expect(editor.part("area-size")).to_have_attribute("data-suggested", "true")
    expect(editor.page.locator("canvas:focus")).to_be_visible()
    editor.page.keyboard.press("Enter")
    expect(editor.part("area-size")).to_have_attribute("data-suggested", "false")


def test_saving_waits_for_a_file_that_is_being_read(server: Server, editor: Screen, tmp_path: Path) -> None:
    held: list[Route] = []
    editor.page.route("**/api/areas", lambda route: held.append(route))
    ring = [[7.2030, 50.6234], [7.2060, 50.6234], [7.2060, 50.6250], [7.2030, 50.6234]]
    file = tmp_path / "meadow.geojson"
    file.write_text(json.dumps({"type": "Polygon", "coordinates": [ring]}))
    with editor.page.expect_request("**/api/areas"):
        editor.part("import-file").set_input_files(file)
    editor.part("save").click()
    expect(editor.part("save")).to_be_disabled()
    for route in held:
        route.continue_()
    assert len(spec_of(server, editor)["area"]["coordinates"][0]) == 4


def test_a_file_that_cannot_be_read_keeps_the_mission_from_being_saved(editor: Screen, tmp_path: Path) -> None:
    held: list[Route] = []
    editor.page.route("**/api/areas", lambda route: held.append(route))
    file = tmp_path / "meadow.geojson"
    file.write_text("buy milk")
    with editor.page.expect_request("**/api/areas"):
        editor.part("import-file").set_input_files(file)
    editor.part("save").click()
    for route in held:
        route.continue_()
    expect(editor.part("area-message")).to_contain_text("meadow.geojson")
    expect(editor.part("edit-problem")).to_contain_text("meadow.geojson")
    expect(editor.part("save")).to_be_enabled()
    assert editor.page.url.endswith("#/new")


def test_a_mission_used_again_leaves_a_new_one_alone(server: Server, editor: Screen) -> None:
    again = server.draft()
    editor.part("field-name").fill("Half typed")
    editor.go(f"#/new/{again}")
    expect(editor.part("field-name")).not_to_have_value("Half typed")
    editor.part("field-name").fill("The same, further north")
    editor.page.reload()
    expect(editor.part("field-name")).to_have_value("The same, further north")
    editor.go("#/new")
    expect(editor.part("field-name")).to_have_value("Half typed")


def test_a_number_being_typed_outlasts_an_answer_and_a_reload(editor: Screen) -> None:
    held: list[Route] = []
    editor.page.route("**/api/areas", lambda route: held.append(route))
    with editor.page.expect_request("**/api/areas"):
        paste(editor, TRIANGLE)
    altitude = editor.part(ALTITUDE)
    altitude.fill("")
    altitude.press_sequentially("7")
    held[0].continue_()
    expect(editor.part("area-size")).to_have_attribute("data-suggested", "false")
    altitude.press_sequentially("5")
    expect(altitude).to_have_value("75")
    editor.page.reload()
    expect(altitude).to_have_value("75")
    altitude.fill("high")
    altitude.blur()
    expect(altitude).to_have_attribute("aria-invalid", "true")


def test_what_cannot_be_read_in_a_field_that_is_gone_is_asked_for_no_more(server: Server, editor: Screen) -> None:
    editor.part("field-emitters-0-kind").select_option("pulsed")
    list_of = editor.part("emitter-list")
    list_of.fill("150.1 lynx\nhigh up")
    list_of.blur()
    expect(editor.part("emitter-list-bad")).to_be_visible()
    editor.page.reload()
    expect(list_of).to_have_value("150.1 lynx\nhigh up")
    editor.part("field-emitters-0-kind").select_option("continuous")
    expect(list_of).to_have_count(0)
    editor.part("save").click()
    assert len(spec_of(server, editor)["emitters"]) == 1


def test_a_mission_saved_late_does_not_lead_away_from_the_next(server: Server, editor: Screen) -> None:
    held: list[Route] = []
    editor.page.route("**/api/missions?mission_id=*", lambda route: held.append(route))
    editor.part("field-name").fill("First")
    with editor.page.expect_request("**/api/missions?mission_id=*"):
        editor.part("save").click()
    editor.go("#/maps")
    editor.go("#/new")
    editor.part("field-name").fill("Second")
    with editor.page.expect_response("**/api/missions?mission_id=*"):
        held[0].continue_()
    assert "First" in [mission["name"] for mission in server.get("/api/missions")["missions"]]
    editor.page.reload()
    expect(editor.part("field-name")).to_have_value("Second")


def test_a_new_area_in_flight_is_not_asked_of_while_it_is_being_drawn(server: Server, screen: Screen) -> None:
    screen.go(f"#/mission/{server.draft()}/area")
    screen.map_ready("edit-map")
    expect(screen.part("area-size")).to_be_visible()
    screen.part("draw-polygon").click()
    for right, down in ((0.3, 0.3), (0.6, 0.3), (0.6, 0.6)):
        screen.page.mouse.click(*screen.map_point(right, down, "edit-map"))
    screen.part("outlook-ask").click()
    expect(screen.part("area-problem")).to_contain_text("press Enter to finish")
    expect(screen.part("outlook")).to_have_count(0)
    expect(screen.page.locator("canvas:focus")).to_be_visible()
    screen.page.keyboard.press("Enter")
    expect(screen.part("draw-polygon")).to_have_attribute("aria-pressed", "false")


def top(part: Locator) -> float:
    box = part.bounding_box()
    assert box is not None
    return box["y"]


def bottom(part: Locator) -> float:
    box = part.bounding_box()
    assert box is not None
    return box["y"] + box["height"]


def test_on_a_phone_an_answer_leaves_room_for_the_tools(server: Server, open_screen: OpenScreen) -> None:
    screen = open_screen(server, f"#/mission/{server.draft()}/area", viewport={"width": 360, "height": 740})
    margin = screen.part("field-flight-fence_margin_m")
    expect(margin).to_be_visible()
    screen.evaluate("() => { Storage.prototype.setItem = () => { throw new DOMException('full') } }")
    margin.fill("61")
    margin.blur()
    screen.part("outlook-ask").click()
    said, buttons = screen.part("outlook"), screen.page.locator(".edit-foot")
    expect(said).to_contain_text("is not flying")
    assert bottom(said) <= top(buttons) + 1, "what is said comes into sight"
    head = screen.page.locator(".edit-head")
    head.scroll_into_view_if_needed()
    assert top(buttons) - top(head) > 200
    assert bottom(screen.part("draw-polygon")) <= top(buttons)
    screen.part("draw-corners").click()
    expect(screen.part("draw-corners")).to_have_attribute("aria-pressed", "true")


def test_a_file_being_read_for_another_mission_does_not_keep_this_one_from_being_saved(
    server: Server, editor: Screen
) -> None:
    other = server.draft()
    editor.page.route("**/api/areas", lambda _route: None)
    with editor.page.expect_request("**/api/areas"):
        paste(editor, TRIANGLE)
    editor.go(f"#/mission/{other}/edit")
    editor.part("field-name").fill("Saved meanwhile")
    editor.part("save").click()
    assert spec_of(server, editor)["name"] == "Saved meanwhile"


def test_a_file_being_read_does_not_come_into_what_is_begun_after_discard(editor: Screen) -> None:
    held: list[Route] = []
    editor.part("field-name").fill("Half typed")
    editor.page.reload()
    editor.page.route("**/api/areas", lambda route: held.append(route))
    with editor.page.expect_request("**/api/areas"):
        paste(editor, TRIANGLE)
    editor.part("discard").click()
    expect(editor.part("field-name")).not_to_have_value("Half typed")
    with editor.page.expect_response("**/api/areas"):
        held[0].continue_()
    editor.page.wait_for_timeout(300)
    expect(editor.part("area-size")).to_have_attribute("data-suggested", "true")


def test_a_preset_takes_the_place_of_what_cannot_be_read_in_its_fields(server: Server, editor: Screen) -> None:
    editor.part("field-emitters-0-frequency_hz").fill("abc")
    editor.part("field-sensor-sigma_deg").fill("7x")
    editor.part("preset").select_option("beacon")
    expect(editor.part("field-emitters-0-frequency_hz")).to_have_value("121.5")
    expect(editor.part("field-sensor-sigma_deg")).to_have_value("7")
    editor.part("save").click()
    assert spec_of(server, editor)["emitters"][0]["frequency_hz"] == 121_500_000


def test_what_is_marked_is_shown_when_the_mission_cannot_be_saved(editor: Screen) -> None:
    speed, turn_rate = editor.part("field-planner-motion-speed_m_s"), editor.part("field-sensor-turn_rate_deg_s")
    more = editor.page.locator("details.more")
    more.filter(has=speed).locator("summary").click()
    speed.fill("1x2")
    speed.blur()
    editor.page.reload()
    expect(speed).to_be_visible()
    more.filter(has=speed).locator("summary").click()
    more.filter(has=turn_rate).locator("summary").click()
    turn_rate.fill("5x")
    more.filter(has=turn_rate).locator("summary").click()
    expect(turn_rate).to_be_hidden()
    editor.part("save").click()
    expect(editor.part("edit-problem")).to_contain_text("marked below")
    for field in (speed, turn_rate):
        expect(field).to_be_visible()
        expect(field).to_have_attribute("aria-invalid", "true")


def test_a_list_that_was_typed_is_taken_by_a_save_that_does_not_leave_it(server: Server, editor: Screen) -> None:
    editor.part("preset").select_option("wildlife")
    editor.part("emitter-list").fill("150.1 lynx\n150.2 hare")
    editor.evaluate("document.querySelector('form.side').requestSubmit()")
    assert len(spec_of(server, editor)["emitters"]) == 2


def test_what_is_wrong_with_one_mission_is_not_said_of_the_next(server: Server, screen: Screen) -> None:
    kept, wrong = server.draft(), server.draft()
    screen.go(f"#/mission/{kept}/edit")
    screen.part("field-name").fill("Half typed")
    screen.go(f"#/mission/{wrong}/edit")
    expect(screen.part("field-name")).not_to_have_value("Half typed")
    paste(screen, "nowhere")
    screen.part("area-clear").click()
    screen.part("save").click()
    expect(screen.part("edit-problem")).to_be_visible()
    expect(screen.part("area-message")).to_be_visible()
    screen.go(f"#/mission/{kept}/edit")
    expect(screen.part("field-name")).to_have_value("Half typed")
    expect(screen.part("edit-problem")).to_have_count(0)
    expect(screen.part("area-message")).to_have_count(0)


def test_a_profile_is_taken_as_another_tab_left_it(editor: Screen) -> None:
    editor.page.locator("details.more").filter(has=editor.part("profile-name")).locator("summary").click()
    editor.part("profile-name").fill("quad")
    editor.part("field-sensor-sigma_deg").fill("5")
    editor.part("profile-save").click()
    tab = editor.page.context.new_page()
    tab.goto(editor.page.url)
    tab.get_by_test_id("profile").wait_for()
    editor.part("field-sensor-sigma_deg").fill("20")
    editor.part("profile-save").click()
    tab.get_by_test_id("profile").select_option("quad")
    expect(tab.get_by_test_id("field-sensor-sigma_deg")).to_have_value("20")


def test_what_is_typed_into_a_full_browser_stays_and_that_is_said(editor: Screen) -> None:
    editor.evaluate("() => { Storage.prototype.setItem = () => { throw new DOMException('full') } }")
    altitude = editor.part(ALTITUDE)
    altitude.fill("33")
    altitude.blur()
    expect(altitude).to_have_value("33")
    expect(editor.part("not-stored")).to_be_visible()


def test_what_another_has_saved_meanwhile_is_not_replaced_unseen(
    server: Server, screen: Screen, open_screen: OpenScreen
) -> None:
    mission = server.draft()
    other = open_screen(server)
    for each, name in ((screen, "Mine"), (other, "Theirs")):
        each.go(f"#/mission/{mission}/edit")
        each.part("field-name").fill(name)
    other.part("save").click()
    expect(other.part("preflight")).to_be_visible()
    screen.part("save").click()
    expect(screen.part("edit-problem")).to_contain_text("saved since you opened it, by operator")
    assert server.get(f"/api/missions/{mission}")["name"] == "Theirs"
    screen.part("save").click()
    expect(screen.part("save-over")).to_be_enabled()
    screen.page.reload()
    expect(screen.part("field-name")).to_have_value("Mine")
    screen.part("save").click()
    screen.part("save-over").click()
    assert spec_of(server, screen)["name"] == "Mine"

    other.go(f"#/mission/{mission}/edit")
    expect(other.part("field-name")).to_have_value("Mine")
    other.part("field-name").fill("Theirs again")
    screen.go(f"#/mission/{mission}/edit")
    screen.part("field-name").fill("Mine again")
    other.part("save").click()
    expect(other.part("preflight")).to_be_visible()
    screen.part("save").click()
    screen.part("take-theirs").click()
    expect(screen.part("field-name")).to_have_value("Theirs again")
    screen.part("field-name").fill("Both")
    screen.part("save").click()
    assert spec_of(server, screen)["name"] == "Both"


def test_a_draft_whose_answer_is_lost_is_saved_once(server: Server, editor: Screen) -> None:
    def lose(route: Route) -> None:
        if route.request.method == "POST":
            route.fetch()
            route.abort()
        else:
            route.continue_()

    editor.page.route("**/api/missions?mission_id=*", lose, times=1)
    editor.part("field-name").fill("Lost")
    editor.part("save").click()
    expect(editor.part("edit-problem")).to_be_visible()
    assert [m["name"] for m in server.get("/api/missions?named=Lost")["missions"]] == ["Lost"]
    editor.page.reload()
    editor.map_ready("edit-map")
    expect(editor.part("field-name")).to_have_value("Lost")
    editor.part("save").click()
    assert spec_of(server, editor)["name"] == "Lost"
    assert [m["name"] for m in server.get("/api/missions?named=Lost")["missions"]] == ["Lost"]
