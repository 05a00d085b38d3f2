"""Tables that are wider than what they stand in: a report on a phone, candidates in large German."""

from __future__ import annotations

import pytest
from playwright.sync_api import FloatRect, Locator, expect
from screen import OpenScreen
from served import Server

from backend.events import Event, PlanChosen
from tests.browser.sweep import SIZES
from tests.browser.test_after_flight import bring_in, checked

pytestmark = [pytest.mark.browser, pytest.mark.long, pytest.mark.timeout(480)]


def box(part: Locator) -> FloatRect:
    found = part.bounding_box()
    assert found is not None
    return found


ONE_LINE = """(cells) => cells.filter((cell) => {
  const { height, right } = cell.getBoundingClientRect();
  return height > 1.8 * parseFloat(getComputedStyle(cell).fontSize) || right > innerWidth;
}).map((cell) => cell.textContent)"""
"""What is broken into lines or runs off the screen."""


def test_each_value_of_a_bearing_stands_in_one_line_on_a_phone(server: Server, open_screen: OpenScreen) -> None:
    flown = bring_in(server, checked("report-on-a-phone", 0.0))
    screen = open_screen(
        server, f"#/report/{flown}", {"language": "de", "scale": 1.3}, viewport={"width": 390, "height": 844}
    )
    expect(screen.part("report-bearings").locator("tbody tr")).to_have_count(3)
    cells = screen.part("report-bearings").locator("tbody td")
    assert cells.evaluate_all(ONE_LINE) == []
    labels = screen.page.locator("[data-testid=report-map] text")
    top = box(screen.part("report-map"))["y"]
    assert [one.inner_html() for one in labels.all() if box(one)["y"] < top] == [], "nothing is cut at its upper edge"


def in_hours(event: Event) -> Event:
    """Every candidate takes four hours longer, and its standard error is ten minutes more."""
    if not isinstance(event, PlanChosen):
        return event
    longer = [
        one.model_copy(update={"value_s": one.value_s + 4 * 3600, "std_error_s": (one.std_error_s or 0.0) + 600})
        for one in event.candidates
    ]
    return event.model_copy(update={"candidates": longer})


@pytest.mark.parametrize("size", ["laptop", "tablet"])
def test_candidates_that_take_hours_are_whole_in_large_german(
    server: Server, open_screen: OpenScreen, size: str
) -> None:
    flown = [r.model_copy(update={"event": in_hours(r.event)}) for r in checked(f"of-hours-{size}", 0.0)]
    width, height = SIZES[size]
    screen = open_screen(
        server,
        f"#/mission/{bring_in(server, flown)}",
        {"language": "de", "scale": 1.3},
        viewport={"width": width, "height": height},
    )
    table = screen.part("candidates")
    expect(table).to_contain_text("4:01:")
    expect(table.locator("tbody td:last-child").first).to_have_text("gewählt")
    inside, around = box(table), box(screen.part("plan"))
    assert inside["x"] + inside["width"] <= around["x"] + around["width"]
    assert table.evaluate("(one) => one.scrollWidth <= one.parentElement.clientWidth"), "nothing of it is cut"
