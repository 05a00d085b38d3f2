"""The page itself: nothing from outside, small, its safety bar first, legible, usable without pointer or WebGL."""

from __future__ import annotations

import gzip
import sqlite3
import subprocess
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from urllib.parse import urlsplit

import httpx
import pytest
from conftest import serving
from legible import serious
from playwright.sync_api import Browser, Response, Route, expect
from screen import AUTOMATIC, OpenScreen, Screen
from served import Server

from tests.benchmarks.page_weight import weights

pytestmark = [pytest.mark.browser, pytest.mark.timeout(480)]


EXAMPLE = "#/mission/example"
"""A recorded flight that the page plays: every panel filled, no vehicle needed."""

WEIGHT_LIMIT_BYTES = 600_000
BAR_LIMIT_BYTES = 60_000

NO_WEBGL = """
const plain = HTMLCanvasElement.prototype.getContext;
HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
  return /webgl/.test(kind) ? null : plain.call(this, kind, ...rest);
};
"""


@pytest.fixture
def loaded(server: Server, browser: Browser) -> Iterator[list[Response]]:
    """Everything a browser fetches until the example's map is drawn."""
    context = browser.new_context(viewport={"width": 1280, "height": 800})
    page = context.new_page()
    responses: list[Response] = []
    page.on("response", lambda response: responses.append(response))
    page.goto(f"{server.url}{EXAMPLE}")
    Screen(page, server.url).map_ready()
    page.wait_for_load_state("networkidle")
    yield responses
    context.close()


def test_no_request_leaves_the_machine(server: Server, loaded: list[Response]) -> None:
    ours = urlsplit(server.url).netloc
    foreign = [r.url for r in loaded if urlsplit(r.url).scheme.startswith("http") and urlsplit(r.url).netloc != ours]
    assert foreign == []
    assert [r.url for r in loaded if r.status >= 400] == []
    bodies = {r.url: r.body() for r in loaded if urlsplit(r.url).scheme.startswith("http") and "/api/" not in r.url}
    weight = {url: len(gzip.compress(body)) for url, body in bodies.items()}
    print(f"page weight {sum(weight.values())} bytes gzipped in {len(weight)} files")


def test_the_whole_page_is_light() -> None:
    """Every file that is built: editor, both languages and the example too, whoever opens them."""
    assert sum(weights().values()) < WEIGHT_LIMIT_BYTES


def test_the_safety_bar_is_small_and_needs_neither_webgl_nor_the_rest(server: Server, browser: Browser) -> None:
    context = browser.new_context(viewport={"width": 1280, "height": 800})
    context.add_init_script(NO_WEBGL)
    page = context.new_page()
    fetched: list[Response] = []
    page.on("response", lambda response: fetched.append(response))
    later = (
        "FlyPage",
        "FlyMap",
        "createMap",
        "reportBearings",
        "EditMap",
        "maplibre",
        "gridNotation",
        "reasons",
        "pages.en",
        "truth",
        "review",
    )

    def lose(route: Route) -> None:
        if any(name in route.request.url for name in later):
            route.abort()
        else:
            route.continue_()

    page.route("**/assets/*", lose)
    made = server.draft(expected_rmse_m=0.1, maximum_bearings=200)
    page.goto(f"{server.url}#/mission/{made}")
    expect(page.get_by_test_id("link")).to_contain_text("connected")
    expect(page.get_by_role("main").get_by_role("alert")).to_contain_text("could not be loaded")
    expect(page.get_by_test_id("problem-bar")).to_contain_text("could not be loaded: English")
    weight = sum(len(gzip.compress(r.body())) for r in fetched if "/assets/" in r.url and r.ok)
    print(f"safety bar {weight} bytes gzipped")
    assert weight < BAR_LIMIT_BYTES
    context.close()


def test_everything_but_the_map_works_without_webgl(server: Server, browser: Browser) -> None:
    context = browser.new_context(viewport={"width": 1280, "height": 800})
    context.add_init_script(NO_WEBGL)
    page = context.new_page()
    page.goto(f"{server.url}{EXAMPLE}")
    expect(page.get_by_text("no WebGL")).to_be_visible()
    expect(page.get_by_test_id("polar")).to_be_visible()
    page.get_by_test_id("hold").click()
    expect(page.get_by_test_id("problem-bar")).to_contain_text("This is a recording")
    context.close()


SHEETS = ("alerts", "menu", "settings", "keys", "instruments")
TARGET_PX = 44
FLIGHT_CRITICAL = (
    "abort",
    "hold",
    "return",
    "resume",
    "accept",
    "veto",
    "automatic",
    "alerts",
    "start",
    "start-slider",
    "resume-slider",
    "override-slider",
)


class Legible:
    """What axe finds serious on what is shown, in both themes, and flight-critical controls too small to hit."""

    def __init__(self, screen: Screen) -> None:
        self.screen = screen

    def check(self, name: str) -> None:
        assert serious(self.screen.page) == [], name
        self.targets(name)

    def targets(self, name: str) -> None:
        for control in FLIGHT_CRITICAL:
            for part in self.screen.part(control).filter(visible=True).all():
                box = part.bounding_box()
                if box is not None:
                    assert min(box["width"], box["height"]) >= TARGET_PX, f"{control} of {name} is too small to hit"


@pytest.mark.long
def test_a_refused_area_is_legible(server: Server, open_screen: OpenScreen) -> None:
    screen = open_screen(server, f"#/mission/{server.draft()}/area")
    screen.map_ready("edit-map")
    screen.part("outlook-ask").click()
    expect(screen.part("outlook")).to_contain_text("is not flying")
    Legible(screen).check("area")


@pytest.mark.long
def test_the_checklist_is_legible(server: Server, open_screen: OpenScreen) -> None:
    screen = open_screen(server, f"#/mission/{server.draft()}")
    screen.checked()
    expect(screen.part("check").first).to_be_visible()
    screen.part("start").click()
    expect(screen.part("start-slider")).to_be_visible()
    screen.map_ready()
    Legible(screen).check("preflight")


@pytest.mark.long
def test_the_flight_and_its_sheets_are_legible(server: Server, open_screen: OpenScreen) -> None:
    screen = open_screen(server)
    screen.fly(server.draft(expected_rmse_m=0.1, maximum_bearings=200))
    screen.map_ready()
    expect(screen.part("sweep-bearing")).to_be_visible(timeout=120_000)
    everything_is_on_one_screen(screen)
    legible = Legible(screen)
    legible.check("flying")
    screen.hold()
    screen.offer_resume()
    legible.targets("resume")
    screen.page.mouse.click(*screen.map_point(0.5, 0.5))
    expect(screen.part("override-slider")).to_be_visible()
    legible.targets("proposal")
    for sheet in SHEETS:
        _show(screen, sheet)
        legible.check(sheet)
    screen.page.keyboard.press("Escape")
    screen.part("abort").click()
    vehicle_comes_down(server)


def vehicle_comes_down(server: Server) -> None:
    """So that the next test may start."""
    until = time.monotonic() + 120
    while server.get("/api/vehicle")["in_air"]:
        assert time.monotonic() < until, "the vehicle is still in the air"
        time.sleep(0.5)


def everything_is_on_one_screen(screen: Screen) -> None:
    """Of 1280 x 800, without scrolling: the first five candidates too."""
    for part in (*map(screen.part, ("map", "estimate", "sweep", "timeline")), screen.part("candidate").nth(4)):
        expect(part).to_be_in_viewport(ratio=1)


SHOWN_AS = {"alerts": "alerts-panel", "menu": "menu-settings", "keys": "key-sheet"}


def _show(screen: Screen, sheet: str) -> None:
    screen.page.keyboard.press("Escape")
    if sheet in ("alerts", "menu"):
        screen.part(sheet).click()
    elif sheet == "instruments":
        screen.part("indicators").click()
    else:
        screen.part("menu").click()
        screen.part(f"menu-{sheet}").click()
    expect(screen.part(SHOWN_AS.get(sheet, sheet))).to_be_visible()


def test_a_database_that_waits_for_another_writer_is_not_said_to_be_away(
    server: Server, open_screen: OpenScreen
) -> None:
    mission = server.draft()
    screen = open_screen(server, "#/health")
    database = screen.part("health-part").filter(has_text="Database")
    expect(database).to_have_attribute("data-good", "true")
    other = sqlite3.connect(server.data_dir / "crossfix.sqlite", isolation_level=None)
    other.execute("BEGIN IMMEDIATE")
    labels = {"name": "written meanwhile", "tags": [], "notes": ""}
    address = f"{server.url.rstrip('/')}/api/missions/{mission}/labels"
    assert httpx.put(address, json=labels, timeout=30).status_code == 200
    expect(database).to_contain_text("Something else is writing to the database's file.")
    expect(database).to_contain_text("wait on the disk")
    expect(database).not_to_contain_text("does not answer")
    other.execute("ROLLBACK")
    other.close()
    expect(database).to_contain_text("SQLite answers.")
    expect(database).not_to_contain_text("wait on the disk")
    assert server.get(f"/api/missions/{mission}")["name"] == "written meanwhile"


def forbid_writing(folder: Path, sign: str) -> None:
    """As a disk that became read-only does, and allows it again; see tests/backend/store/test_disk.py."""
    held = [str(path) for path in folder.iterdir() if not path.name.endswith("-shm")]
    done = subprocess.run(["chattr", sign, *held, str(folder)], capture_output=True)
    if done.returncode and sign == "+i":
        forbid_writing(folder, "-i")
        pytest.skip("files cannot be made immutable here: " + done.stderr.decode().strip())


def test_a_flight_whose_facts_cannot_be_stored_says_so_and_is_held_all_the_same(
    tmp_path: Path, open_screen: OpenScreen
) -> None:
    with serving(tmp_path) as server:
        screen = open_screen(server)
        screen.fly(server.draft())
        screen.expect_phase("flying", "measuring")
        expect(screen.part("unstored")).to_have_count(0)
        forbid_writing(tmp_path, "+i")
        try:
            expect(screen.part("unstored")).to_contain_text("Nothing can be stored.")
            expect(screen.part("unstored")).to_be_in_viewport(ratio=1)
            screen.page.keyboard.press("Alt+Shift+H")
            expect(screen.part("indicators")).to_contain_text("HOLD")
        finally:
            forbid_writing(tmp_path, "-i")
        screen.expect_phase("hold")
        expect(screen.part("unstored")).to_have_count(0)
        held = [event for event in server.events(screen.mission_id) if event["kind"] == "hold_ordered"]
        assert len(held) == 1, "it waited in memory, and is stored once"


@contextmanager
def kept_down(screen: Screen, *keys: str) -> Iterator[None]:
    """The last one repeats for two seconds, as a held key does."""
    keyboard = screen.page.keyboard
    for key in (*keys, *keys[-1:] * 20):
        keyboard.down(key)
        screen.page.wait_for_timeout(100)
    yield
    for key in keys:
        keyboard.up(key)


@pytest.mark.long
def test_a_mission_is_flown_with_the_keyboard_alone(server: Server, open_screen: OpenScreen) -> None:
    screen = open_screen(server, f"#/mission/{server.draft()}")
    keyboard = screen.page.keyboard
    screen.part("preflight-run").focus()
    keyboard.press("Enter")
    screen.checked()
    for _ in range(40):
        if screen.evaluate("document.activeElement.dataset.testid") == "start":
            break
        keyboard.press("Tab")
    keyboard.press("Enter")
    expect(screen.part("start-slider")).to_be_focused()
    keyboard.down(" ")
    screen.expect_phase(*AUTOMATIC)
    keyboard.up(" ")
    screen.expect_phase("flying", "measuring")
    screen.hold()
    keyboard.press("?")
    expect(screen.part("key-sheet")).to_be_visible()
    keyboard.press("Escape")
    expect(screen.part("key-sheet")).to_have_count(0)
    keyboard.press("Alt+Shift+A")
    screen.expect_phase("aborted")
    with kept_down(screen, "Alt", "Shift", "H"):
        expect(screen.row("hold_ordered")).to_have_count(2)
    screen.part("hold").focus()
    with kept_down(screen, "Enter"):
        expect(screen.row("hold_ordered")).to_have_count(3)
    keyboard.press("Alt+Shift+R")
    expect(screen.row("return_ordered")).to_be_visible()
    expect(screen.row("hold_ordered")).to_have_count(3)
    vehicle_comes_down(server)


def test_a_single_stray_key_flies_nothing(server: Server, open_screen: OpenScreen) -> None:
    screen = open_screen(server, EXAMPLE)
    flying = "() => document.querySelector('[data-testid=state-words][data-phase=flying]')"
    screen.page.wait_for_function(flying, polling=100, timeout=90_000)  # its legs last a second or two of the replay
    for key in "ahr?":
        screen.page.keyboard.press(key)
    expect(screen.part("key-sheet")).to_be_visible()
    assert screen.part("event-log").locator("[data-kind=hold_ordered], [data-kind=abort_ordered]").count() == 0


@pytest.mark.long
def test_the_page_speaks_german_and_remembers_it(server: Server, open_screen: OpenScreen) -> None:
    screen = open_screen(server, EXAMPLE)
    screen.part("menu").click()
    screen.part("menu-settings").click()
    screen.part("setting-language").select_option("de")
    screen.part("setting-coordinates").select_option("mgrs")
    screen.page.keyboard.press("Escape")
    expect(screen.part("abort")).to_have_text("Abbruch")
    expect(screen.part("estimate-coordinates")).to_contain_text("32U")
    screen.page.reload()
    expect(screen.part("abort")).to_have_text("Abbruch")
    assert screen.evaluate("document.documentElement.lang") == "de"


def test_the_tour_shows_every_part_and_ends(server: Server, open_screen: OpenScreen) -> None:
    screen = open_screen(server, "", {"tourSeen": False})
    screen.part("tour-take").click()
    expect(screen.part("tour")).to_be_visible()
    for _ in range(5):
        screen.part("tour-next").click()
    screen.part("tour-end").click()
    expect(screen.part("missions")).to_be_visible()
    expect(screen.part("tour-offer")).to_have_count(0)
