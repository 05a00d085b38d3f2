"""What happens around one flight: flown by keyboard, looked ahead, warned, cut off and found again.

All tests share one mission; each begins and leaves it in hold.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from pathlib import Path
from urllib.parse import urlsplit

import pytest
from conftest import SETTINGS, serving
from playwright.sync_api import Browser, Page, expect
from radio_link import RadioLink, radio_link
from screen import Screen
from served import Server

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
        context.add_init_script(f"localStorage.setItem('crossfix.settings', {stored!r});{SPIES}")
        page: Page = context.new_page()
        page.set_default_timeout(30_000)
        url = f"http://127.0.0.1:{self.link.port}/"
        page.goto(url)
        return Screen(page, url)

    @property
    def events(self) -> list[dict]:
        return self.server.get(f"/api/missions/{self.screen.mission_id}/events")["events"]

    def kinds(self) -> list[str]:
        return [recorded["event"]["kind"] for recorded in self.events]


@pytest.fixture(scope="module")
def flight(browser: Browser, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Flight]:
    folder: Path = tmp_path_factory.mktemp("served")
    with serving(folder) as server, radio_link(urlsplit(server.url).port or 0) as link:
        made = Flight(server, browser, link)
        fly_by_keyboard(made.screen)
        yield made
        link.restore()
        made.screen.page.keyboard.press("Alt+Shift+A")
        made.screen.expect_phase("aborted", "returning", "landing", "done", seconds=60)


def reach(screen: Screen, name: str) -> None:
    """By the tabulator alone."""
    for _ in range(120):
        if screen.evaluate("document.activeElement?.dataset?.testid ?? ''") == name:
            return
        screen.page.keyboard.press("Tab")
    raise AssertionError(f"{name} cannot be reached by the tabulator")


def fly_by_keyboard(screen: Screen) -> None:
    """Plan, check, start and hold without a pointer."""
    keyboard = screen.page.keyboard
    expect(screen.part("new-mission")).to_be_visible()
    reach(screen, "new-mission")
    keyboard.press("Enter")
    expect(screen.part("area-size")).to_have_attribute("data-suggested", "true")
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
    screen.page.wait_for_timeout(1900)
    keyboard.up(" ")
    screen.expect_phase("flying", "measuring")
    keyboard.press("Alt+Shift+H")
    screen.expect_phase("hold", seconds=30)
    screen.map_ready()


def test_a_mission_is_planned_started_and_held_by_keyboard_alone(flight: Flight) -> None:
    kinds = flight.kinds()
    assert kinds.count("mission_started") == 1
    assert kinds.count("hold_ordered") == 1
    assert flight.screen.phase() == "hold"


def test_a_resting_pointer_asks_for_the_expected_time_and_moves_nothing(flight: Flight) -> None:
    screen, before = flight.screen, len(flight.events)
    screen.page.mouse.move(*screen.map_point(0.45, 0.4))
    expect(screen.part("hover-time")).to_contain_text(re.compile(r"\d:\d\d"))
    screen.page.mouse.move(*screen.map_point(0.55, 0.45))
    expect(screen.part("hover-time")).to_be_visible()
    assert len(flight.events) == before


def test_the_next_place_is_dragged_and_its_cost_seen_before_it_is_confirmed(flight: Flight) -> None:
    screen, before = flight.screen, flight.kinds().count("plan_chosen")
    expect(screen.part("battery-then")).to_contain_text("%")
    box = screen.part("next-place").bounding_box()
    assert box is not None
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    screen.page.mouse.move(x, y)
    screen.page.mouse.down()
    screen.page.mouse.move(*screen.map_point(0.5, 0.5), steps=6)
    screen.page.mouse.up()
    expect(screen.part("proposal")).to_have_attribute("data-allowed", "true")
    expect(screen.part("proposal-cost")).to_contain_text("Localized in about")
    expect(screen.part("proposal")).to_contain_text(
        re.compile("(longer than|shorter than|as long as) the planner's place")
    )
    assert flight.kinds().count("plan_chosen") == before, "what is dragged is flown to only after the slide"
    screen.page.keyboard.press("Escape")


def test_an_alert_sounds_and_speaks_where_it_is_not_muted(flight: Flight) -> None:
    loud, quiet = flight.screen, flight.watch()
    quiet.open(loud.mission_id)
    expect(quiet.part("alerts")).to_contain_text("muted")
    quiet.expect_phase("hold")
    flight.server.order("pilot_mode", mode="POSCTL")
    for screen in (loud, quiet):
        expect(screen.part("alert-banner")).to_contain_text("pilot")
    assert loud.evaluate("tones") == [660, 660]
    ((language, text),) = loud.evaluate("spoken")
    assert language == "en"
    assert text.startswith("Caution")
    assert (quiet.evaluate("tones"), quiet.evaluate("spoken")) == ([], [])
    quiet.page.context.close()
    loud.page.keyboard.press("m")
    expect(loud.part("alerts")).to_contain_text("muted")
    flight.server.order("give_back")
    loud.page.wait_for_timeout(1500)
    loud.part("resume").click()
    loud.slide("resume-slider")
    loud.expect_phase("planning", "flying", "measuring", seconds=40)
    loud.page.keyboard.press("Alt+Shift+H")
    loud.expect_phase("hold", seconds=30)


def test_the_link_goes_silent_and_comes_back_and_no_event_is_missed(flight: Flight) -> None:
    screen = flight.screen
    flight.link.silence()
    expect(screen.part("state-words")).to_have_text(re.compile("No connection to the server"), timeout=30_000)
    expect(screen.part("battery")).to_have_attribute("data-state", "old")
    expect(screen.part("abort")).to_be_enabled()
    flight.server.order("pilot_mode", mode="POSCTL")
    screen.page.wait_for_timeout(1500)
    flight.link.restore()
    screen.expect_phase("manual", seconds=60)
    expect(screen.part("battery")).to_have_attribute("data-state", "fresh")
    screen.page.get_by_label("every event").or_(screen.page.locator(".timeline-controls input")).first.check()
    expect(screen.part("event-row")).to_have_count(len(flight.events))
    numbers = [int(row.get_attribute("data-seq") or 0) for row in screen.part("event-row").all()]
    assert numbers == list(range(1, len(numbers) + 1))
    assert "server_restarted" not in flight.kinds()
