"""Handing over in one flight that holds: what is offered is what would be accepted, who has control is what the facts
say, nothing lies over what warns, and no number is less than nothing. The last two stories end the flight."""

from __future__ import annotations

import re
import time
from typing import Any
from uuid import uuid4

import httpx
import pytest
from playwright.sync_api import FloatRect, Locator, expect
from screen import OpenScreen, Screen
from served import Server

from tests.browser.by_thumb import EVERY_SIZE, card, touched
from tests.browser.sweep import SIZES

pytestmark = [pytest.mark.browser, pytest.mark.slow, pytest.mark.timeout(300)]

PILOTS = "POSCTL"
WITHOUT_LINK_S = 45
"""Simulated, 15 s of the wall clock: the autopilot's failsafe acts after 10."""


def order(server: Server, mission: str, kind: str) -> dict[str, Any]:
    """As the button gives it; the server's answer."""
    body = {"command_id": str(uuid4()), "command": {"kind": kind}}
    return httpx.post(f"{server.url.rstrip('/')}/api/missions/{mission}/commands", json=body, timeout=60).json()


def until_told(server: Server, mission: str, kind: str) -> None:
    until = time.monotonic() + 120
    while kind not in {event["kind"] for event in server.events(mission)}:
        assert time.monotonic() < until, f"{kind} was not recorded"
        time.sleep(0.5)


@pytest.fixture(scope="module")
def held(server: Server) -> str:
    """A mission that holds after its first place was chosen."""
    mission = server.draft(expected_rmse_m=0.1, maximum_bearings=200)
    address = f"{server.url.rstrip('/')}/api/missions/{mission}/preflight"
    until = time.monotonic() + 90
    while not httpx.post(address, timeout=60).json()["passed"]:
        assert time.monotonic() < until, "preflight does not pass"
        time.sleep(0.5)
    assert order(server, mission, "start")["accepted"]
    until_told(server, mission, "flight_started")
    assert order(server, mission, "hold")["accepted"]
    return mission


ON_EVERY_SIZE = pytest.mark.parametrize("screen", EVERY_SIZE, indirect=True)


@pytest.fixture
def screen(request: pytest.FixtureRequest, server: Server, open_screen: OpenScreen, held: str) -> Screen:
    made = open_screen(server, f"#/mission/{held}", **touched(getattr(request, "param", "laptop")))
    made.map_ready()
    made.expect_phase("hold")
    return made


@ON_EVERY_SIZE
def test_resume_is_offered_only_while_it_would_be_accepted(server: Server, held: str, screen: Screen) -> None:
    resume = screen.part("resume")

    def is_refused(code: str) -> None:
        expect(resume).to_be_disabled()
        expect(resume).not_to_have_attribute("title", "Resume …")
        answer = order(server, held, "resume")
        assert (answer["accepted"], answer["reason"]["code"]) == (False, code)
        resume.click(force=True)
        expect(screen.part("resume-slider")).to_have_count(0)

    expect(resume).to_be_enabled()
    server.order("pilot_mode", mode=PILOTS)
    screen.expect_phase("manual")
    is_refused("not_given_back")
    server.order("give_back")
    expect(resume).to_be_enabled()
    screen.resume()
    screen.expect_phase("planning", "flying", "measuring")
    expect(resume).to_have_count(0)
    screen.hold()


@ON_EVERY_SIZE
def test_who_has_control_is_what_the_facts_say_after_the_pilot_gave_back(server: Server, screen: Screen) -> None:
    control = screen.part("control")
    expect(control).to_have_text("Crossfix has control")
    server.order("pilot_mode", mode=PILOTS)
    expect(control).to_have_text(f"The pilot has control ({PILOTS})")
    expect(screen.part("waits-for")).to_contain_text("pilot")
    card(screen, "events")
    taken = screen.row("authority_changed").last
    expect(taken).to_contain_text("The pilot has control")
    number = taken.get_attribute("data-seq")
    server.order("give_back")
    expect(control).to_have_text("The pilot has given control back: you may resume")
    screen.page.reload()
    expect(control).to_have_text("The pilot has given control back: you may resume")

    card(screen, "events")
    screen.page.locator(f"[data-testid=event-row][data-seq='{number}']").click()
    expect(control).to_have_text(f"The pilot has control ({PILOTS})")
    screen.part("go-live").click()
    expect(control).to_have_text("The pilot has given control back: you may resume")
    screen.resume()
    expect(control).to_have_text("Crossfix has control")
    screen.hold()
    expect(control).to_have_text("Crossfix has control")


def place_of(one: Locator) -> FloatRect:
    found = one.bounding_box()
    assert found is not None, f"{one} is not shown"
    return found


def share(first: FloatRect, second: FloatRect) -> bool:
    """Whether they have more than a pixel of the screen in common."""

    def along(axis: str, length: str) -> float:
        ends = (one[axis] + one[length] for one in (first, second))
        return min(ends) - max(first[axis], second[axis])

    return along("x", "width") > 1 and along("y", "height") > 1


BANNER_MAKES_ROOM = """() => {
  const edges = (name) => document.querySelector(`[data-testid=${name}]`)?.getBoundingClientRect();
  return edges("alert-banner")?.top >= edges("problem-bar")?.bottom;
}"""


def test_what_was_refused_and_what_is_cautioned_lie_beside_each_other(
    server: Server, held: str, screen: Screen
) -> None:
    page, banner = screen.page, screen.part("alert-banner")
    server.order("pilot_mode", mode=PILOTS)
    expect(banner).to_contain_text("pilot")
    for button in ("hold", "return"):
        expect(screen.part(button)).to_have_css("border-top-style", "dashed")
    expect(screen.part("abort")).not_to_have_css("border-top-style", "dashed")
    for width, height in SIZES.values():
        page.set_viewport_size({"width": width, "height": height})
        screen.part("hold").click()
        note = screen.part("problem-bar")
        expect(note).to_contain_text("pilot")
        page.wait_for_function(BANNER_MAKES_ROOM, timeout=60_000)
        others = [note, screen.part("alerts"), *page.locator(".indicator.caution, .indicator.warning").all()]
        tools = page.locator(".map-tools > *, .maplibregl-ctrl-group, .scene-switch").filter(visible=True).all()
        over = [one for one in (*others, *tools) if share(place_of(banner), place_of(one))]
        assert [one.evaluate("(e) => e.outerHTML.slice(0, 120)") for one in over] == [], f"{width} px"
        cut = "(e) => e.scrollHeight > e.clientHeight + 1 || e.scrollWidth > e.clientWidth + 1"
        assert not banner.evaluate(cut), f"the caution is cut off at {width} px"
        within = place_of(banner)
        assert within["x"] >= 0
        assert within["x"] + within["width"] <= width
    server.order("give_back")
    expect(screen.part("resume")).to_be_enabled()
    assert order(server, held, "resume")["accepted"]
    screen.hold()


def test_a_vehicle_that_its_failsafe_flies_is_not_said_to_be_the_pilots(
    server: Server, held: str, screen: Screen
) -> None:
    """It was out of reach for longer than it waits, and is on its way home."""
    control, resume = screen.part("control"), screen.part("resume")
    server.order("link_loss", seconds=WITHOUT_LINK_S)
    expect(resume).to_be_disabled()
    answer = order(server, held, "resume")
    assert (answer["accepted"], answer["reason"]["code"]) == (False, "no_link")
    expect(control).to_contain_text("The autopilot's failsafe has control")
    expect(control).not_to_contain_text("pilot has control")
    told = [event["authority"] for event in server.events(held) if event["kind"] == "authority_changed"]
    assert told[-1]["who"] == "failsafe"


WRONG = re.compile(r"would be left|(?<!\d)[-−]\d+ ?%")


def test_a_battery_that_does_not_reach_home_leaves_no_less_than_nothing(
    server: Server, held: str, open_screen: OpenScreen
) -> None:
    screen = open_screen(server, f"#/mission/{held}")
    screen.map_ready()
    battery = screen.part("battery")
    expect(battery).to_contain_text("home needs")
    seen = set[str]()
    for percent in (12, 4, 1):
        server.order("battery", percent=percent)
        expect(battery).to_contain_text(re.compile(rf"\D{percent} %"))
        seen.add(screen.page.locator("body").inner_text())
    expect(battery).not_to_contain_text("leaves")
    seen.add(screen.page.locator("body").inner_text())
    assert [found.group() for text in seen for found in WRONG.finditer(text)] == []
