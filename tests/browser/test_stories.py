"""What happens around one flight: flown by keyboard, looked ahead, sent elsewhere, taken over, cut off and found again.

All tests share one mission; each begins and leaves it in hold.
"""

from __future__ import annotations

import json
import math
import re
import time
from collections.abc import Iterator
from pathlib import Path
from urllib.parse import urlsplit

import pytest
from conftest import SETTINGS, serving
from legible import wrong
from playwright.sync_api import Browser, FloatRect, Page, expect
from radio_link import RadioLink, radio_link
from screen import FEW_FRAMES, Screen
from served import Server

from tests.browser.sweep import HELD, SIZES, Shown

pytestmark = [pytest.mark.browser, pytest.mark.slow, pytest.mark.timeout(480)]

SPIES = """
window.tones = [];
window.spoken = [];
const make = AudioContext.prototype.createOscillator;
AudioContext.prototype.createOscillator = function () {
  const tone = make.call(this);
  const start = tone.start.bind(tone);
  tone.start = (at) => { tones.push(tone.frequency.value); start(at); };
  return tone;
};
speechSynthesis.speak = (utterance) => spoken.push([utterance.lang, utterance.text]);
"""


class Flight:
    """One mission in hold, and its page with tones and speech on, seen through a link that can be disturbed."""

    def __init__(self, server: Server, browser: Browser, link: RadioLink) -> None:
        self.server = server
        self.link = link
        self._browser = browser
        self.screen = self.watch(tones=True, speech=True)

    def watch(self, **settings: object) -> Screen:
        context = self._browser.new_context(viewport={"width": 1280, "height": 800})
        stored = json.dumps(SETTINGS | settings)
        context.add_init_script(f"localStorage.setItem('crossfix.settings', {stored!r});{SPIES}{FEW_FRAMES}")
        page: Page = context.new_page()
        page.set_default_timeout(30_000)
        url = f"http://127.0.0.1:{self.link.port}/"
        page.goto(url)
        return Screen(page, url)

    @property
    def events(self) -> list[dict]:
        return self.server.events(self.screen.mission_id)

    def kinds(self) -> list[str]:
        return [event["kind"] for event in self.events]

    def ordered(self) -> list[str]:
        """What anybody ordered and where the craft was sent; that a hold has settled is neither."""
        deeds = {"plan_chosen", "plan_vetoed", "phase_changed", "command_accepted", "command_refused"}
        return [kind for kind in self.kinds() if kind in deeds or kind.endswith("_ordered")]

    def recorded_again(self, kind: str, before: int) -> None:
        """Waits until the server has recorded one more of this kind, whatever the page knows."""
        until = time.monotonic() + 60
        while self.kinds().count(kind) == before:
            assert time.monotonic() < until, f"{kind} was not recorded"
            time.sleep(0.2)


@pytest.fixture(scope="module")
def flight(browser: Browser, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Flight]:
    folder: Path = tmp_path_factory.mktemp("served")
    with serving(folder) as server, radio_link(urlsplit(server.url).port or 0) as link:
        made = Flight(server, browser, link)
        fly_by_keyboard(made.screen, server.draft(maximum_bearings=200))
        yield made


@pytest.fixture(autouse=True)
def charged(flight: Flight) -> None:
    """Or a slow machine tells the last of these stories of a craft that had to go home."""
    flight.server.order("battery", percent=100)


@pytest.fixture
def second(flight: Flight) -> Iterator[Screen]:
    """The same server in another browser, muted."""
    screen = flight.watch()
    yield screen
    screen.page.context.close()


def reach(screen: Screen, name: str) -> None:
    """By the tabulator alone."""
    for _ in range(120):
        if screen.evaluate("document.activeElement?.dataset?.testid ?? ''") == name:
            return
        screen.page.keyboard.press("Tab")
    raise AssertionError(f"{name} cannot be reached by the tabulator")


def fly_by_keyboard(screen: Screen, patient: str) -> None:
    """Plan, check, start and hold without a pointer; `patient`: a mission whose timers bear a busy machine."""
    keyboard = screen.page.keyboard
    expect(screen.part("new-mission")).to_be_visible()
    reach(screen, "new-mission")
    keyboard.press("Enter")
    expect(screen.part("area-size")).to_have_attribute("data-suggested", "true")
    screen.go(f"#/new/{patient}")
    expect(screen.part("field-localization-maximum_bearings")).to_have_value("200")
    reach(screen, "field-localization-expected_rmse_m")
    keyboard.press("Control+A")
    keyboard.type("0.1")
    reach(screen, "save")
    keyboard.press("Enter")
    expect(screen.part("preflight")).to_be_visible()
    screen.checked()
    reach(screen, "start")
    keyboard.press("Enter")
    expect(screen.part("start-slider")).to_be_focused()
    keyboard.down(" ")
    refused = screen.refused("problem-start")
    keyboard.up(" ")
    if refused:
        screen.checked()
        screen.start()
    screen.expect_phase("flying", "measuring")
    screen.hold()
    screen.map_ready()


BANNER_COVERS_NO_TOOL = """() => {
  const edges = (name) => document.querySelector(`[data-testid=${name}]`)?.getBoundingClientRect();
  return edges("alert-banner")?.bottom <= edges("map-fit")?.top;
}"""


def test_a_mission_is_planned_started_and_held_by_keyboard_alone(flight: Flight) -> None:
    kinds = flight.kinds()
    assert kinds.count("mission_started") == 1
    assert kinds.count("hold_ordered") == 1
    assert flight.screen.phase() == "hold"


def test_a_resting_pointer_asks_for_the_expected_time_and_moves_nothing(flight: Flight) -> None:
    screen, before = flight.screen, flight.ordered()
    screen.page.mouse.move(*screen.map_point(0.45, 0.4))
    expect(screen.part("hover-time")).to_contain_text(re.compile(r"\d:\d\d"))
    screen.page.mouse.move(*screen.map_point(0.55, 0.45))
    expect(screen.part("hover-time")).to_be_visible()
    assert flight.ordered() == before


def resting(screen: Screen, name: str) -> FloatRect:
    """Where it is once the map has glided there: 0.4 s, longer on a busy machine."""
    screen.page.wait_for_timeout(600)
    before, until = screen.part(name).bounding_box(), time.monotonic() + 60.0
    while time.monotonic() < until:
        screen.page.wait_for_timeout(400)
        now = screen.part(name).bounding_box()
        if now is not None and now == before:
            return now
        before = now
    raise AssertionError(f"{name} does not come to rest")


def test_the_next_place_is_dragged_and_its_cost_seen_before_it_is_confirmed(flight: Flight) -> None:
    screen, before = flight.screen, flight.kinds().count("plan_chosen")
    expect(screen.part("battery-then")).to_contain_text("%")
    screen.part("map-fit").click()
    box = resting(screen, "next-place")
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    screen.page.mouse.move(x, y)
    screen.page.mouse.down()
    screen.page.mouse.move(*screen.map_point(0.5, 0.5), steps=6)
    screen.page.mouse.up()
    expect(screen.part("proposal")).to_have_attribute("data-allowed", "true")
    expect(screen.part("proposal-cost")).to_contain_text("Localized in about")
    expect(screen.part("proposal")).to_contain_text(
        re.compile("(longer than|quicker than|as quick as) the planner's place")
    )
    compared = screen.part("proposal-compared").inner_text()
    assert ("quicker than" in compared) == (screen.part("proposal-rule").count() > 0), "a quicker place says why not"
    assert flight.kinds().count("plan_chosen") == before, "what is dragged is flown to only after the slide"
    screen.page.keyboard.press("Escape")
    expect(screen.part("proposal")).to_have_count(0)


def test_the_map_stays_still_when_the_bar_grows(flight: Flight) -> None:
    """In hold the bar has a row more: the ground under a resting pointer is the same, to two pixels."""
    screen = flight.screen
    bar = screen.page.locator("header.safety")
    x, y = screen.map_point(0.5, 0.6)

    def ground(down_px: float = 0.0) -> tuple[float, float]:
        screen.page.mouse.move(x + 30, y)
        screen.page.mouse.move(x, y + down_px)
        north, east = re.findall(r"\d+\.\d+", screen.part("cursor-coordinates").inner_text())
        return float(north), float(east)

    screen.resume()
    screen.expect_phase("flying", "measuring")
    low, at, ten_px_on = bar.bounding_box(), ground(), ground(10.0)
    screen.hold()
    expect(screen.part("resume")).to_be_visible()
    high = bar.bounding_box()
    assert low is not None
    assert high is not None
    assert high["height"] > low["height"] + 10
    pixel_deg = math.dist(at, ten_px_on) / 10
    assert math.dist(at, ground()) < 2 * pixel_deg


def test_a_place_outside_the_fence_cannot_be_slid_to(flight: Flight) -> None:
    screen = flight.screen
    screen.page.mouse.click(*screen.map_point(0.02, 0.5))
    expect(screen.part("proposal")).to_have_attribute("data-allowed", "false")
    expect(screen.part("override-slider")).to_have_count(0)
    screen.part("proposal").get_by_role("button").click()
    expect(screen.part("proposal")).to_have_count(0)


def test_the_operator_sends_it_elsewhere_and_resumes(flight: Flight) -> None:
    screen, before = flight.screen, flight.kinds().count("plan_chosen")
    screen.page.mouse.click(*screen.map_point(0.5, 0.5))
    expect(screen.part("proposal")).to_have_attribute("data-allowed", "true")
    expect(screen.part("proposal-cost")).to_contain_text("Localized in about")
    assert flight.kinds().count("plan_chosen") == before, "a click alone flies nowhere"
    screen.slide("override-slider")
    expect(screen.part("proposal")).to_have_count(0)
    chosen = [event for event in flight.events if event["kind"] == "plan_chosen"]
    assert chosen[-1]["source"] == "operator"
    expect(screen.part("time-left")).to_be_visible()
    expect(screen.row("plan_chosen").last).not_to_contain_text(re.compile("operator.*operator"))
    if screen.phase() == "hold":
        screen.resume()
    expect(screen.part("sweep-bearing")).to_be_visible()
    screen.part("hold").click()
    screen.expect_phase("hold")


def test_the_search_area_is_changed_by_a_slide_and_the_bearings_count_on(flight: Flight) -> None:
    screen, before = flight.screen, flight.kinds()
    screen.part("change-area").click()
    screen.map_ready("edit-map")
    screen.draw([(0.8, 0.3), (0.95, 0.3), (0.95, 0.6), (0.8, 0.6)])
    expect(screen.part("area-size")).to_contain_text("8 corners")
    screen.part("draw-replaces").check()
    screen.draw([(0.15, 0.15), (0.85, 0.15), (0.85, 0.85), (0.15, 0.85)])
    expect(screen.part("area-size")).to_contain_text("4 corners")
    screen.part("outlook-ask").click()
    expect(screen.part("outlook-time")).to_contain_text("Localized in about")
    expect(screen.part("outlook-error")).to_contain_text("expected error")
    assert "area_changed" not in flight.kinds(), "nothing changes before the slide"
    screen.slide("area-slider")
    screen.map_ready()
    expect(screen.row("area_changed")).to_be_visible()
    (changed,) = [event for event in flight.events if event["kind"] == "area_changed"]
    assert len(changed["search"]["area"]["coordinates"][0]) == 5, "the area was replaced, not joined"
    flight.recorded_again("belief_updated", before.count("belief_updated"))
    assert flight.kinds().count("bearing_measured") == before.count("bearing_measured")
    assert screen.phase() == "hold"


def test_an_area_away_from_the_vehicle_is_refused_before_it_can_be_slid_to(flight: Flight) -> None:
    screen = flight.screen
    screen.part("change-area").click()
    screen.map_ready("edit-map")
    screen.part("area-clear").click()
    expect(screen.part("outlook-ask")).to_be_disabled()
    screen.draw([(0.02, 0.02), (0.1, 0.02), (0.1, 0.1)])
    screen.part("outlook-ask").click()
    expect(screen.part("outlook-refused")).to_contain_text("outside the fence")
    expect(screen.part("area-slider")).to_have_count(0)
    screen.part("area-cancel").click()
    screen.map_ready()
    assert flight.kinds().count("area_changed") == 1


def test_the_screens_of_a_flight_are_legible_and_cut_off_nowhere_in_german(flight: Flight) -> None:
    width, height = SIZES["laptop"]
    screen = flight.watch(language="de", scale=1.3)
    screen.page.set_viewport_size({"width": width, "height": height})
    mission = flight.screen.mission_id
    shown = Shown(flight.server, mission, mission, mission, mission)
    assert [one for name in sorted(HELD) for one in wrong(screen, shown, name)] == []
    screen.page.context.close()
    assert flight.screen.phase() == "hold"


def test_a_second_browser_sees_the_same(flight: Flight, second: Screen) -> None:
    screen = flight.screen
    flying = second.page.locator(f"[data-testid=mission-row][data-mission='{screen.mission_id}']")
    flying.get_by_test_id("open-mission").click()
    second.expect_phase("hold")
    expect(second.part("sweep-bearing")).to_have_text(screen.part("sweep-bearing").inner_text())
    stated = screen.part("expected-rmse").get_attribute("data-value") or ""
    expect(second.part("expected-rmse")).to_have_attribute("data-value", stated)
    expect(second.part("event-row")).to_have_text(screen.part("event-row").all_inner_texts(), use_inner_text=True)
    second.resume()
    screen.expect_phase("planning", "flying", "measuring")
    screen.part("hold").click()
    second.expect_phase("hold")


def test_a_reload_in_flight_shows_the_same_and_stops_nothing(flight: Flight) -> None:
    screen, before = flight.screen, flight.kinds()
    bearing = screen.part("sweep-bearing").get_attribute("data-value")
    screen.resume()
    screen.page.reload()
    screen.map_ready()
    expect(screen.part("sweep-bearing")).to_be_visible()
    assert bearing is not None
    kinds = flight.kinds()
    assert kinds.count("mission_started") == 1
    assert kinds.count("hold_ordered") == before.count("hold_ordered")
    screen.part("hold").click()
    screen.expect_phase("hold")


def test_the_pilot_takes_over_and_keeps_control_and_the_alert_sounds_where_it_is_not_muted(
    flight: Flight, second: Screen
) -> None:
    loud, quiet = flight.screen, second
    quiet.open(loud.mission_id)
    expect(quiet.part("alerts")).to_contain_text("muted")
    quiet.expect_phase("hold")
    before = len(flight.events)
    flight.server.order("pilot_mode", mode="POSCTL")
    for screen in (loud, quiet):
        expect(screen.part("alert-banner")).to_contain_text("pilot")
        screen.expect_phase("manual")
        expect(screen.part("control")).to_contain_text("pilot has control")
        screen.page.wait_for_function(BANNER_COVERS_NO_TOOL)
        expect(screen.part("hold")).to_have_class(re.compile("refused-now"))
    assert loud.evaluate("tones") == [660, 660]
    ((language, text),) = loud.evaluate("spoken")
    assert language == "en"
    assert text.startswith("Caution")
    assert (quiet.evaluate("tones"), quiet.evaluate("spoken")) == ([], [])
    loud.page.keyboard.press("m")
    expect(loud.part("alerts")).to_contain_text("muted")

    expect(loud.part("vehicle-link")).to_contain_text("POSCTL")
    flight.server.order("give_back")
    expect(loud.part("vehicle-link")).not_to_contain_text("POSCTL")
    expect(loud.part("control")).not_to_contain_text("pilot has control")
    loud.resume()
    kinds = [event["kind"] for event in flight.events[before:]]
    flown = {"flight_started", "sweep_started", "plan_chosen"}
    assert not flown & set(kinds[: kinds.index("resume_ordered")]), "nothing flies until an operator resumes"
    loud.hold()


def test_the_link_goes_silent_and_comes_back_and_no_event_is_missed(flight: Flight) -> None:
    screen = flight.screen
    taken = flight.kinds().count("authority_changed")
    flight.link.silence()
    expect(screen.part("state-words")).to_have_text(re.compile("No connection to the server"))
    expect(screen.part("battery")).to_have_attribute("data-state", "old")
    expect(screen.part("abort")).to_be_enabled()
    flight.server.order("pilot_mode", mode="POSCTL")
    flight.recorded_again("authority_changed", taken)
    flight.link.restore()
    screen.expect_phase("manual")
    expect(screen.part("battery")).to_have_attribute("data-state", "fresh")
    screen.page.get_by_label("every event").or_(screen.page.locator(".timeline-controls input")).first.check()
    expect(screen.part("event-row")).to_have_count(len(flight.events))
    numbers = [int(row.get_attribute("data-seq") or 0) for row in screen.part("event-row").all()]
    assert numbers == list(range(1, len(numbers) + 1))
    assert "server_restarted" not in flight.kinds()
