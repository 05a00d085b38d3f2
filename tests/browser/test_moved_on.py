"""What is answered, or ordered elsewhere, after the page has moved on: another console, another tab, another row."""

from __future__ import annotations

import json
import re
from pathlib import Path
from uuid import uuid4

import httpx
import pytest
from playwright.sync_api import Locator, Page, Route, WebSocketRoute, expect
from screen import OpenScreen, Screen
from served import QUICK, Server

pytestmark = [pytest.mark.browser, pytest.mark.slow, pytest.mark.timeout(240)]

IDS = ("one", "two", "three")


def three_emitters(server: Server) -> str:
    """A drafted mission; its id."""
    spec = server.get("/api/defaults")["spec"]
    for section, values in (QUICK | {"localization": {"expected_rmse_m": 0.1, "maximum_bearings": 200}}).items():
        spec[section] |= values
    first = spec["emitters"][0]
    spec["emitters"] = [
        first | {"emitter_id": name, "label": name, "frequency_hz": first["frequency_hz"] + 1e6 * number}
        for number, name in enumerate(IDS)
    ]
    return server.make(spec)


class Tap:
    """Holds back what the server tells the page by its websocket."""

    def __init__(self, page: Page) -> None:
        self.held = False
        self.kept: list[tuple[WebSocketRoute, str | bytes]] = []
        page.route_web_socket(re.compile(r"/api/live"), self.join)

    def join(self, to_page: WebSocketRoute) -> None:
        def told(message: str | bytes) -> None:
            if self.held:
                self.kept.append((to_page, message))
            else:
                to_page.send(message)

        to_page.connect_to_server().on_message(told)

    def let_go(self) -> None:
        self.held = False
        for to_page, message in self.kept:
            to_page.send(message)


def test_an_order_from_another_console_stands_and_the_next_press_goes_on_from_it(
    server: Server, open_screen: OpenScreen
) -> None:
    mission = three_emitters(server)
    screen = open_screen(server)
    tap = Tap(screen.page)
    screen.fly(mission)
    screen.hold()
    screen.part("order").click()
    tap.held = True
    with screen.page.expect_response("**/commands"):
        screen.part("first-one").click()
    order = {"command_id": str(uuid4()), "command": {"kind": "set_priorities", "priorities": {"three": 1, "two": 2}}}
    answer = httpx.post(f"{screen.url}/api/missions/{mission}/commands", json=order, timeout=20).json()
    assert answer["accepted"]
    screen.page.wait_for_timeout(500)
    tap.let_go()
    expect(screen.part("place-three")).to_have_text("first")
    with screen.page.expect_request("**/commands") as pressed:
        screen.part("sooner-one").click()
    assert (pressed.value.post_data_json or {})["command"]["priorities"] == {"three": 1}, "like two"
    screen.part("abort").click()


@pytest.fixture
def rows(server: Server, screen: Screen) -> tuple[Locator, Locator]:
    """Of two missions."""
    ids = server.draft(), server.draft()
    screen.go("#/")
    first, second = (screen.page.locator(f"[data-mission='{one}']") for one in ids)
    expect(first).to_be_visible()
    return first, second


def first_of(page: Page, asked: list[Route]) -> Route:
    while not asked:
        page.wait_for_timeout(50)
    return asked[0]


def save(page: Page, row: Locator, notes: str) -> Route:
    """Type notes and save them; the request, which waits."""
    asked: list[Route] = []
    page.route("**/labels", lambda route: asked.append(route), times=1)
    row.get_by_test_id("label-mission").click()
    row.get_by_test_id("label-notes").fill(notes)
    row.get_by_test_id("label-save").click()
    return first_of(page, asked)


def test_a_row_that_was_saved_closes_no_other_and_one_that_was_not_says_so(
    screen: Screen, rows: tuple[Locator, Locator]
) -> None:
    first, second = rows
    asked = save(screen.page, first, "at the oak")
    second.get_by_test_id("label-mission").click()
    second.get_by_test_id("label-notes").fill("half a sen")
    asked.continue_()
    expect(first.locator(".notes")).to_have_text("at the oak")
    expect(second.get_by_test_id("label-notes")).to_have_value("half a sen")
    second.get_by_test_id("label-mission").click()
    asked = save(screen.page, first, "at the beech")
    second.get_by_test_id("label-mission").click()
    asked.abort()
    expect(screen.part("problem-bar")).to_contain_text("Save:")


def test_words_that_were_not_saved_can_be_discarded_for_a_colleague_s(
    screen: Screen, rows: tuple[Locator, Locator]
) -> None:
    row, _ = rows
    row.get_by_test_id("label-mission").click()
    row.get_by_test_id("label-notes").fill("old words")
    row.get_by_test_id("label-mission").click()
    labels = {"name": "N", "tags": [], "notes": "what a colleague wrote"}
    mission = row.get_attribute("data-mission")
    httpx.put(f"{screen.url}/api/missions/{mission}/labels", json=labels, timeout=20).raise_for_status()
    expect(row.locator(".notes")).to_have_text("what a colleague wrote")
    row.get_by_test_id("label-mission").click()
    expect(row.get_by_test_id("label-notes")).to_have_value("old words")
    row.get_by_test_id("label-discard").click()
    row.get_by_test_id("label-mission").click()
    expect(row.get_by_test_id("label-notes")).to_have_value("what a colleague wrote")


def choose(page: Page, name: str, value: str) -> None:
    page.get_by_test_id("menu").click()
    page.get_by_text("Settings", exact=True).first.click()
    page.get_by_test_id(f"setting-{name}").select_option(value)


def test_two_tabs_keep_each_other_s_settings(screen: Screen) -> None:
    other = screen.page.context.new_page()
    other.goto(screen.url + "/")
    expect(other.get_by_test_id("menu")).to_be_visible()
    choose(screen.page, "theme", "indoor")
    expect(other.locator("html")).to_have_attribute("data-theme", "indoor")
    choose(other, "units", "imperial")
    kept = json.loads(screen.evaluate("localStorage.getItem('crossfix.settings')"))
    assert (kept["theme"], kept["units"]) == ("indoor", "imperial")


@pytest.fixture
def exported(server: Server, tmp_path: Path) -> tuple[str, Path]:
    """A mission of the server, and its journal as a file."""
    mission = server.draft()
    file = tmp_path / "mission.json"
    file.write_bytes(httpx.get(f"{server.url}/api/missions/{mission}/export/json", timeout=20).content)
    return mission, file


def choose_recording(screen: Screen, file: Path) -> None:
    screen.page.locator("input[type=file][accept*='json']").set_input_files(file)


def test_a_recording_that_was_left_hides_the_server_s_mission_no_longer(
    screen: Screen, exported: tuple[str, Path]
) -> None:
    mission, file = exported
    choose_recording(screen, file)
    expect(screen.part("fly")).to_be_visible()
    expect(screen.part("preflight")).to_have_count(0)
    screen.go("#/")
    screen.page.locator(f"[data-mission='{mission}']").get_by_test_id("open-mission").click()
    expect(screen.part("preflight")).to_be_visible()


def test_one_comes_back_to_a_recording_of_another_installation(
    screen: Screen, exported: tuple[str, Path], tmp_path: Path
) -> None:
    mission, file = exported
    elsewhere = tmp_path / "elsewhere.json"
    elsewhere.write_text(file.read_text().replace(mission, str(uuid4())))
    choose_recording(screen, elsewhere)
    expect(screen.row("mission_drafted")).to_be_visible()
    screen.go("#/health")
    expect(screen.part("fly")).to_have_count(0)
    screen.page.go_back()
    expect(screen.row("mission_drafted")).to_be_visible()


def test_a_recording_that_is_read_too_late_hides_nothing(screen: Screen, exported: tuple[str, Path]) -> None:
    mission, file = exported
    held: list[Route] = []
    screen.page.route("**/recordings/read", lambda route: held.append(route))
    choose_recording(screen, file)
    late = first_of(screen.page, held)
    screen.go("#/health")
    expect(screen.part("missions")).to_have_count(0)
    with screen.page.expect_response("**/recordings/read"):
        late.continue_()
    screen.page.wait_for_timeout(500)
    screen.open(mission)
    expect(screen.part("preflight")).to_be_visible()


def test_an_area_that_was_changed_late_does_not_lead_away_from_the_next_page(
    server: Server, open_screen: OpenScreen
) -> None:
    mission = three_emitters(server)
    screen = open_screen(server)
    screen.fly(mission)
    screen.hold()
    screen.part("change-area").click()
    screen.part("outlook-ask").click()
    expect(screen.part("area-slider")).to_be_visible()
    held: list[Route] = []
    screen.page.route("**/commands", lambda route: held.append(route), times=1)
    screen.slide("area-slider")
    late = first_of(screen.page, held)
    screen.go("#/new")
    screen.part("field-name").fill("Typed meanwhile")
    with screen.page.expect_response("**/commands"):
        late.continue_()
    screen.page.wait_for_timeout(1000)
    expect(screen.part("field-name")).to_have_value("Typed meanwhile")
    screen.open(mission)
    screen.part("abort").click()
