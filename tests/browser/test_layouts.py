"""The page on the devices it is taken to: what invites, what leads, what fits."""

from __future__ import annotations

import io
import time

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import FloatRect, Position, expect
from screen import AIM_MAP, OpenScreen, Screen
from served import Server

from tests.browser.sweep import SIZES

pytestmark = [pytest.mark.browser, pytest.mark.long, pytest.mark.timeout(300)]

EXAMPLE = "#/mission/example"


def sized(size: str) -> dict[str, object]:
    width, height = SIZES[size]
    return {"viewport": {"width": width, "height": height}}


def box(screen: Screen, name: str) -> FloatRect:
    found = screen.part(name).first.bounding_box()
    assert found is not None, f"{name} is not shown"
    return found


def test_the_first_page_invites_and_then_shows_where_missions_are(server: Server, open_screen: OpenScreen) -> None:
    screen = open_screen(server)
    expect(screen.part("welcome")).to_be_visible()
    screen.map_ready("library-map")
    screen.part("welcome-new").click()
    expect(screen.part("area-size")).to_be_visible()
    server.draft()
    screen.go("#/")
    expect(screen.part("mission-row")).to_have_count(1)
    expect(screen.part("welcome")).to_have_count(0)
    screen.map_ready("library-map")
    screen.page.mouse.click(*screen.map_point(0.5, 0.5, "library-map"))
    screen.page.wait_for_url("**#/mission/*")


def test_a_phone_shows_the_map_and_one_card_and_its_orders_lie_at_the_thumb(
    server: Server, open_screen: OpenScreen
) -> None:
    screen = open_screen(server, EXAMPLE, **sized("phone"))
    screen.map_ready()
    screen.expect_phase("flying", "measuring")
    _, height = SIZES["phone"]
    assert box(screen, "map")["height"] > 0.25 * height
    for order in ("abort", "hold", "return"):
        at = box(screen, order)
        assert at["y"] > 0.88 * height
        assert at["y"] + at["height"] <= height
    for card, part in (("plan", "plan"), ("sweep", "sweep"), ("events", "event-log"), ("estimate", "estimate")):
        screen.part(f"card-{card}").click()
        expect(screen.part(part)).to_be_in_viewport()
        assert [other for other in ("plan", "sweep", "estimate") if screen.part(other).is_visible()] == [
            one for one in (card,) if one != "events"
        ]
    screen.part("menu").click()
    expect(screen.part("menu-health")).to_be_visible()
    screen.go("#/health")
    expect(screen.part("menu-health")).to_have_count(0)


FITS = """(select) => {
  const { font, paddingLeft, paddingRight, appearance } = getComputedStyle(select);
  const pen = document.createElement("canvas").getContext("2d");
  pen.font = font;
  const arrow = appearance === "none" ? 0 : 16;
  const room = select.clientWidth - parseFloat(paddingLeft) - parseFloat(paddingRight) - arrow;
  return pen.measureText(select.selectedOptions[0].textContent).width <= room + 1;
}"""

OVERFLOWING = """() => [...document.querySelectorAll("button.urgent")]
  .filter((one) => one.scrollWidth > one.clientWidth || one.scrollHeight > one.clientHeight)
  .map((one) => one.textContent)"""


@pytest.mark.parametrize("size", ["tablet", "phone"])
def test_the_words_of_the_orders_stay_within_their_buttons_in_large_german(
    server: Server, open_screen: OpenScreen, size: str
) -> None:
    screen = open_screen(server, EXAMPLE, {"language": "de", "scale": 1.3}, **sized(size))
    screen.expect_phase("flying", "measuring")
    expect(screen.part("land")).to_be_visible()
    assert screen.evaluate(OVERFLOWING) == []
    if size == "phone":
        screen.part("card-events").click()
    expect(screen.part("jump")).to_be_in_viewport(ratio=1)
    assert screen.part("jump").evaluate(FITS), "what the select is for can be read"


def test_on_a_tablet_the_map_has_half_the_screen(server: Server, open_screen: OpenScreen) -> None:
    screen = open_screen(server, EXAMPLE, **sized("tablet"))
    screen.map_ready()
    screen.expect_phase("flying", "measuring")
    assert box(screen, "map")["height"] >= 0.5 * SIZES["tablet"][1]
    draft = open_screen(server, f"#/mission/{server.draft()}", **sized("tablet"))
    draft.map_ready()
    expect(draft.part("check").first).to_be_visible()
    assert box(draft, "map")["height"] >= 0.5 * SIZES["tablet"][1], "before the start too"
    expect(draft.part("start")).to_be_in_viewport(ratio=1)
    too_wide = "[...document.querySelectorAll('.panel')].filter((one) => one.scrollWidth > one.clientWidth + 1).length"
    assert screen.evaluate(too_wide) == 0


def test_a_tap_marks_the_place_under_the_thumb_on_a_low_screen_too(server: Server, open_screen: OpenScreen) -> None:
    low = {"viewport": {"width": 375, "height": 560}}
    screen = open_screen(server, f"#/mission/{server.draft()}/bearings", **low)
    screen.page.locator(AIM_MAP).wait_for()
    chart = box(screen, "aim-map")
    assert chart["width"] > 1.2 * chart["height"], "the square of the map leaves ground on both sides"
    thumb: Position = {"x": 0.35 * chart["width"], "y": 0.4 * chart["height"]}
    screen.part("aim-map").click(position=thumb)
    mark = box(screen, "aim-here")
    assert mark["x"] + mark["width"] / 2 == pytest.approx(chart["x"] + thumb["x"], abs=2)
    assert mark["y"] + mark["height"] / 2 == pytest.approx(chart["y"] + thumb["y"], abs=2)


OVER_THE_MAP = ".map-tools > *, .readout, .maplibregl-ctrl, .map-area .banner"
"""What lies there besides what is drawn."""
ROSES = "(boxes) => boxes[3].click()"
"""Their switch among the layers, in whatever language."""


def covered(screen: Screen) -> list[FloatRect]:
    """Parts of the map, px from its corner."""
    corner = box(screen, "map")
    found = [one.bounding_box() for one in screen.page.locator(OVER_THE_MAP).all() if one.is_visible()]
    return [{**one, "x": one["x"] - corner["x"], "y": one["y"] - corner["y"]} for one in found if one is not None]


def map_picture(screen: Screen) -> np.ndarray:
    """(height, width, 3), without what lies over it."""
    hide = screen.page.add_style_tag(
        content=".map-area > :not(.map), .maplibregl-control-container {visibility: hidden}"
    )
    shot = screen.part("map").screenshot()
    hide.evaluate("(tag) => tag.remove()")
    return np.asarray(Image.open(io.BytesIO(shot)).convert("RGB")).astype(int)


def still_picture(screen: Screen) -> np.ndarray:
    """The map's, as soon as two after one another are the same: a busy machine goes on drawing for seconds."""
    before, until = map_picture(screen), time.monotonic() + 60.0
    while time.monotonic() < until:
        screen.page.wait_for_timeout(400)
        now = map_picture(screen)
        if now.shape == before.shape and np.array_equal(now, before):
            return now
        before = now
    raise AssertionError("the map does not come to rest")


def rose_pixels(screen: Screen) -> np.ndarray:
    """(n, 2), row and column of the map: what the switch of the roses shows and hides. Compared again where the bar
    has grown by a line of text meanwhile, as it does where telemetry comes late."""
    boxes, until = screen.page.locator(".map-layers input"), time.monotonic() + 60.0
    while time.monotonic() < until:
        shown = still_picture(screen)
        boxes.evaluate_all(ROSES)
        screen.page.wait_for_timeout(400)
        hidden = still_picture(screen)
        boxes.evaluate_all(ROSES)
        screen.page.wait_for_timeout(400)
        if shown.shape == hidden.shape == still_picture(screen).shape:
            return np.argwhere(np.abs(shown - hidden).max(axis=2) > 12)
    raise AssertionError("the map keeps changing its size")


def test_legends_cover_neither_a_rose_nor_the_vehicle(server: Server, open_screen: OpenScreen) -> None:
    screen = open_screen(server, EXAMPLE, **sized("laptop"))
    page = screen.page
    screen.map_ready()
    screen.expect_belief(1)
    screen.row("bearing_measured").first.click()  # stands still from here on
    expect(page.locator(".map-layers input")).to_have_count(7)
    for size, (width, height) in SIZES.items():
        page.set_viewport_size({"width": width, "height": height})
        page.wait_for_timeout(800)
        expect(screen.part("legend")).to_be_hidden()
        middle, corner = box(screen, "vehicle"), box(screen, "map")
        vehicle = (middle["y"] + middle["height"] / 2 - corner["y"], middle["x"] + middle["width"] / 2 - corner["x"])
        roses = rose_pixels(screen)
        assert len(roses) > 100, f"{size}: no rose is drawn"
        for part in covered(screen):
            low = np.array([part["y"], part["x"]])
            high = low + np.array([part["height"], part["width"]])
            seen = np.vstack([roses, np.array(vehicle)])
            assert not ((seen >= low) & (seen < high)).all(axis=1).any(), f"{size}: {part} covers it"
        if size == "phone":
            screen.part("card-sweep").click()
        plot, legend = box(screen, "polar"), page.locator(".sweep .legend")
        if legend.is_visible():
            at = legend.bounding_box()
            assert at is not None
            assert at["y"] + at["height"] <= plot["y"], f"{size}: the plot's legend lies over its rose"
