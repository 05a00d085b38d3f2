"""The page on the devices it is taken to: what invites, what leads, what fits."""

from __future__ import annotations

import pytest
from playwright.sync_api import FloatRect, Position, expect
from screen import OpenScreen, Screen
from served import Server

from tests.browser.sweep import SIZES, faults

pytestmark = [pytest.mark.browser, pytest.mark.timeout(300)]

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


def test_on_a_tablet_the_map_has_half_the_screen(server: Server, open_screen: OpenScreen) -> None:
    screen = open_screen(server, EXAMPLE, **sized("tablet"))
    screen.map_ready()
    screen.expect_phase("flying", "measuring")
    assert box(screen, "map")["height"] >= 0.5 * SIZES["tablet"][1]
    too_wide = "[...document.querySelectorAll('.panel')].filter((one) => one.scrollWidth > one.clientWidth + 1).length"
    assert screen.evaluate(too_wide) == 0


def test_a_tap_marks_the_place_under_the_thumb_on_a_low_screen_too(server: Server, open_screen: OpenScreen) -> None:
    low = {"viewport": {"width": 375, "height": 560}}
    screen = open_screen(server, f"#/mission/{server.draft()}/bearings", **low)
    chart = box(screen, "aim-map")
    assert chart["width"] > 1.2 * chart["height"], "the square of the map leaves ground on both sides"
    thumb: Position = {"x": 0.35 * chart["width"], "y": 0.4 * chart["height"]}
    screen.part("aim-map").click(position=thumb)
    mark = box(screen, "aim-here")
    assert mark["x"] + mark["width"] / 2 == pytest.approx(chart["x"] + thumb["x"], abs=2)
    assert mark["y"] + mark["height"] / 2 == pytest.approx(chart["y"] + thumb["y"], abs=2)


@pytest.mark.parametrize("size", SIZES)
def test_german_at_130_percent_is_cut_off_nowhere(server: Server, open_screen: OpenScreen, size: str) -> None:
    server.draft()
    screen = open_screen(server, "", {"language": "de", "scale": 1.3}, **sized(size))
    expect(screen.part("mission-row").first).to_be_visible()
    found = {"missions": faults(screen.page)}
    for name, ready in (("new", "edit-map"), ("mission/example", "map")):
        screen.go(f"#/{name}")
        screen.map_ready(ready)
        found[name] = faults(screen.page)
    for name in ("maps", "calibration", "people", "health"):
        screen.go(f"#/{name}")
        expect(screen.page.get_by_role("heading", level=1).first).to_be_visible()
        found[name] = faults(screen.page)
    assert {name: wrong for name, wrong in found.items() if wrong} == {}
