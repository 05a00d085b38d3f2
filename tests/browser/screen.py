"""The page in the words of its operator."""

from __future__ import annotations

import re
import time
from collections.abc import Callable
from typing import Any

from playwright.sync_api import Locator, Page, expect

expect.set_options(timeout=60_000)

AIM_MAP = "[data-testid=aim-map][aria-busy=false]"
"""The map for one thumb, once it shows a search: before that it takes no taps."""

FEW_FRAMES = """
(() => {
  const nextFrame = window.requestAnimationFrame.bind(window), cancelled = new Set();
  let asked = 0;
  window.requestAnimationFrame = (draw) => {
    const id = ++asked;
    setTimeout(() => nextFrame((now) => cancelled.delete(id) || draw(now)), 250);
    return id;
  };
  window.cancelAnimationFrame = (id) => cancelled.add(id);
})();
"""
"""For stories: four frames a second at most. Without a graphics card each takes 34 ms of a core, however small the page
is; on a slow machine more, so that each also waits for the browser's next frame: drawn by the clock alone they pile up,
and nothing holds still enough to be clicked for half a minute."""

AUTOMATIC = ("taking_off", "planning", "flying", "measuring")


class Screen:
    def __init__(self, page: Page, url: str) -> None:
        self.page = page
        self.url = url.rstrip("/")
        self.refusals: list[str] = []

    def part(self, name: str) -> Locator:
        return self.page.get_by_test_id(name)

    def go(self, path: str) -> None:
        self.page.goto(f"{self.url}/{path}")

    @property
    def mission_id(self) -> str:
        found = re.search(r"#/mission/([^/]+)", self.page.url)
        assert found, f"{self.page.url} shows no mission"
        return found.group(1)

    def expect_phase(self, *phases: str, seconds: float = 90) -> None:
        wanted = re.compile("|".join(f"^{phase}$" for phase in phases))
        expect(self.part("state-words")).to_have_attribute("data-phase", wanted, timeout=seconds * 1000)

    def phase(self) -> str | None:
        return self.part("state-words").get_attribute("data-phase")

    def slide(self, name: str) -> None:
        """Hold the space bar on the slider until it has confirmed."""
        self.part(name).focus()
        self.page.keyboard.down(" ")
        full = f"[data-testid={name}]:not([aria-valuenow='100'])"
        expect(self.page.locator(full)).to_have_count(0)
        self.page.keyboard.up(" ")

    def drag_slider(self, name: str, share: float) -> None:
        """Drag the knob by a share of its way."""
        box = self.part(name).bounding_box()
        assert box is not None
        y = box["y"] + box["height"] / 2
        x = box["x"] + box["height"] / 2
        self.page.mouse.move(x, y)
        self.page.mouse.down()
        self.page.mouse.move(x + share * (box["width"] - box["height"]), y, steps=8)
        self.page.mouse.up()

    def map_ready(self, name: str = "map") -> None:
        expect(self.part(name)).to_have_attribute("data-ready", "true")

    def hold(self) -> None:
        self.page.keyboard.press("Alt+Shift+H")
        self.expect_phase("hold")

    def offer_resume(self) -> None:
        """Ask for its slider, again where a value was too old for a moment: the page takes the slider back then."""
        slider = self.part("resume-slider")
        for _ in range(10):
            self.part("resume").click()
            try:
                expect(slider).to_be_visible(timeout=1000)
                self.page.wait_for_timeout(100)
            except AssertionError:
                continue
            if slider.is_visible():
                return
        expect(slider).to_be_visible()

    def resume(self) -> None:
        self.offer_resume()
        self.slide("resume-slider")
        while self.refused("problem-bar"):
            self.page.wait_for_timeout(1000)
            self.offer_resume()
            self.slide("resume-slider")

    def refused(self, problem: str) -> bool:
        """Was the start or the resume refused (on a busy machine a value may be too old), or does it fly?"""
        flies = ", ".join(f"[data-testid=state-words][data-phase={phase}]" for phase in AUTOMATIC)
        expect(self.page.locator(f"{flies}, [data-testid={problem}]").first).to_be_visible(timeout=90_000)
        told = self.part(problem)
        if not told.is_visible():
            return False
        self.refusals.append(told.inner_text())
        assert len(self.refusals) < 10, self.refusals
        return True

    def map_point(self, right: float, down: float, name: str = "map") -> tuple[float, float]:
        """Pixels of a place on the map, by shares of its width and height."""
        box = self.part(name).bounding_box()
        assert box is not None
        return box["x"] + right * box["width"], box["y"] + down * box["height"]

    def draw(self, corners: list[tuple[float, float]]) -> None:
        """Draw a polygon on the editor's map; the last click is on the first corner."""
        self.part("draw-polygon").click()
        for right, down in [*corners, corners[0]]:
            x, y = self.map_point(right, down, "edit-map")
            self.page.mouse.move(x, y)
            self.page.mouse.click(x, y)

    def checked(self) -> None:
        """Check until everything passes: on a busy machine a value may be too old at the first try."""
        for _ in range(10):
            expect(self.part("preflight")).to_have_attribute("data-passed", re.compile("true|false"))
            if self.part("preflight").get_attribute("data-passed") == "true":
                return
            self.page.wait_for_timeout(1000)
            self.part("preflight-run").click()
        expect(self.part("preflight")).to_have_attribute("data-passed", "true")

    def open(self, mission_id: str) -> None:
        self.go(f"#/mission/{mission_id}")

    def start(self) -> None:
        self.part("start").click()
        self.slide("start-slider")
        while self.refused("problem-start"):
            self.checked()
            self.part("start").click()
            self.slide("start-slider")

    def fly(self, mission_id: str) -> None:
        self.open(mission_id)
        self.checked()
        self.start()

    def expect_belief(self, bearings: int) -> None:
        """The map shows the belief after this number of bearings."""
        until = time.monotonic() + 60
        while self.evaluate("window.crossfixBeliefPainted?.bearings") != bearings:
            assert time.monotonic() < until, f"the belief after {bearings} bearings was not painted"
            self.page.wait_for_timeout(100)

    def row(self, kind: str) -> Locator:
        """The timeline's rows of this kind of event."""
        return self.page.locator(f"[data-testid=event-row][data-kind={kind}]")

    def evaluate(self, script: str) -> Any:
        return self.page.evaluate(script)


OpenScreen = Callable[..., Screen]
"""Opens the page of a server as another device would."""
