"""Motion only where something moved: a screen at rest draws nothing, and who asked for less motion gets none."""

from __future__ import annotations

import io
import os
import signal
import time

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import Page, expect
from screen import OpenScreen, Screen
from served import Server

from tests.browser.stock import stored
from tests.browser.sweep import SIZES

pytestmark = [pytest.mark.browser, pytest.mark.long, pytest.mark.timeout(480)]

COUNT_FRAMES = """
window.framesAsked = 0;
const ask = window.requestAnimationFrame;
window.requestAnimationFrame = (draw) => { window.framesAsked += 1; return ask.call(window, draw); };
"""

REST_MS = 2500
LATE = 5
"""Frames for what was heard just before."""

SHOWN = {
    "missions": "#/",
    "review": "#/mission/{flown}",
    "report": "#/report/{flown}",
    "compare": "#/compare/{flown}",
    "new": "#/new",
    "calibration": "#/calibration",
    "maps": "#/maps",
    "people": "#/people",
}
"""Screens on which nothing moves while nobody touches them: none of them shows a vehicle in flight."""

CLOCKS = "[data-testid=indicators], .state-more { visibility: hidden }"
"""What the vehicle tells, the age of that and the time: they change, and nothing else does."""


class Heard:
    """Counts what the server tells of its own accord: the vehicle on the ground, mostly."""

    def __init__(self, page: Page) -> None:
        self.messages = 0
        page.on("websocket", lambda socket: socket.on("framereceived", self._count))

    def _count(self, _frame: str | bytes) -> None:
        self.messages += 1


def picture(screen: Screen) -> np.ndarray:
    shot = screen.page.screenshot(animations="allow", caret="initial")
    return np.asarray(Image.open(io.BytesIO(shot)).convert("RGB")).astype(int)


def at_rest(screen: Screen) -> np.ndarray:
    """As soon as two pictures after one another are the same: a busy machine goes on drawing for seconds."""
    before, until = picture(screen), time.monotonic() + 120.0
    while time.monotonic() < until:
        screen.page.wait_for_timeout(500)
        now = picture(screen)
        if np.array_equal(now, before):
            return now
        before = now
    raise AssertionError("the page does not come to rest")


TRIES = 8
"""A busy machine may go on drawing after a pause; what is animated moves each time."""


def moves(screen: Screen, heard: Heard) -> str:
    """What does on a screen that nobody touches; empty when all stands still."""
    before = at_rest(screen)
    asked, told = screen.evaluate("framesAsked"), heard.messages
    screen.page.wait_for_timeout(REST_MS)
    if screen.evaluate("document.getAnimations().length") > 0:
        return "something is animated"
    rows, columns = np.nonzero(np.abs(picture(screen) - before).max(axis=2))
    if rows.size > 0:
        return f"x {columns.min()} to {columns.max()}, y {rows.min()} to {rows.max()}"
    drawn, told = screen.evaluate("framesAsked") - asked, heard.messages - told
    return "" if drawn <= told + LATE else f"{drawn} frames were asked for, and the server told {told} things"


@pytest.mark.parametrize("size", ["laptop", "tablet", "phone"])
def test_a_screen_at_rest_stays_as_it_is(server: Server, open_screen: OpenScreen, size: str) -> None:
    width, height = SIZES[size]
    flown = stored(server, "demo-px4-open")
    screen = open_screen(server, viewport={"width": width, "height": height}, every_frame=True)
    page = screen.page
    page.add_init_script(COUNT_FRAMES)
    heard = Heard(page)
    for name, address in SHOWN.items():
        screen.go("#/health")
        screen.go(address.format(flown=flown))
        page.reload()
        page.add_style_tag(content=CLOCKS)
        page.wait_for_load_state("networkidle")
        moved: list[str] = []
        while "" not in moved:
            assert len(moved) < TRIES, f"{name}: {moved}"
            moved.append(moves(screen, heard))


VEHICLE = """() => {
  const { x, y } = document.querySelector("[data-testid=vehicle]").getBoundingClientRect();
  return `${Math.round(x)} ${Math.round(y)}`;
}"""
"""Where it is seen on the screen."""


@pytest.mark.parametrize(("wish", "glides"), [("no-preference", True), ("reduce", False)])
def test_who_asks_for_less_motion_sees_the_map_jump(
    server: Server, open_screen: OpenScreen, wish: str, glides: bool
) -> None:
    screen = open_screen(server, f"#/mission/{stored(server, 'demo-px4-open')}", reduced_motion=wish, every_frame=True)
    page = screen.page
    page.clock.install()  # so that a busy machine does not leave the pictures between out
    page.reload()
    screen.map_ready()
    expect(screen.part("vehicle")).to_be_visible()
    page.mouse.move(*screen.map_point(0.5, 0.5))
    page.mouse.wheel(0, 400)
    page.wait_for_timeout(1500)
    page.clock.pause_at(screen.evaluate("Date.now()") / 1000 + 1)
    seen = [screen.evaluate(VEHICLE)]
    screen.part("map-fit").click()
    for span_ms in (120, 2000):
        page.clock.run_for(span_ms)
        seen.append(screen.evaluate(VEHICLE))
    before, on_its_way, after = seen
    assert before != after, "the map shows another part than before"
    assert (on_its_way not in (before, after)) == glides, seen
    assert glides or on_its_way == after


HEIGHTS = """
window.mapHeights = [];
setInterval(() => {
  const map = document.querySelector("[data-testid=map]");
  const lost = document.querySelector("[data-testid=state-words]")?.classList.contains("stale");
  const old = document.querySelectorAll(".indicator.old").length;
  if (map && !lost) mapHeights.push([old, map.clientHeight]);
}, 50);
"""
"""How high the map is while the page still hears the server, and how many values are old then."""


def test_the_map_of_a_phone_stays_as_high_when_telemetry_comes_late(server: Server, open_screen: OpenScreen) -> None:
    width, height = SIZES["phone"]
    screen = open_screen(
        server, f"#/mission/{server.draft()}", viewport={"width": width, "height": height}, every_frame=True
    )
    screen.map_ready()
    expect(screen.page.locator(".indicator.fresh")).to_have_count(5)
    screen.page.wait_for_timeout(1000)
    screen.evaluate(HEIGHTS)
    screen.page.wait_for_timeout(1000)
    os.kill(server.process.pid, signal.SIGSTOP)
    try:
        expect(screen.page.locator(".indicator.old").first).to_be_attached(timeout=20_000)
        screen.page.wait_for_timeout(1500)
    finally:
        os.kill(server.process.pid, signal.SIGCONT)
    heights = screen.evaluate("mapHeights")
    assert {old > 0 for old, _ in heights} == {True, False}, "some values became old"
    assert len({tall for _, tall in heights}) == 1, heights
