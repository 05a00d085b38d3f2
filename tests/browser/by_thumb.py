"""A tablet and a phone in the hand: their screens, what one card shows, and a finger that slides."""

from __future__ import annotations

from typing import Any

import pytest
from playwright.sync_api import expect
from screen import Screen

from tests.browser.sweep import SIZES, TOO_WIDE

HELD_IN_HAND = ("tablet", "phone")
EVERY_HAND = (pytest.param("tablet", marks=pytest.mark.long), "phone")
"""For stories: `make test` has them on a phone, where there is least room."""
EVERY_SIZE = ("laptop", *EVERY_HAND)
FINGER_MOVES_MS = 1500
"""From a slide to what is tapped next."""
TAPPED_MS = 500
"""From a tap to what it shows, on a slow machine."""


def touched(size: str) -> dict[str, Any]:
    """How a browser shows it; a laptop has no touches."""
    width, height = SIZES[size]
    return {
        "viewport": {"width": width, "height": height},
        "has_touch": size in HELD_IN_HAND,
        "is_mobile": size in HELD_IN_HAND,
    }


def card(screen: Screen, name: str) -> None:
    """A phone shows one card at a time."""
    tab = screen.part(f"card-{name}")
    if tab.is_visible():
        tab.tap()
        screen.page.wait_for_timeout(TAPPED_MS)
        if tab.get_attribute("aria-pressed") == "false":  # of a tap after a slide Chromium made no click
            tab.tap()
        expect(tab).to_have_attribute("aria-pressed", "true")
    assert not screen.evaluate(TOO_WIDE), f"{name} is wider than the screen"


def slide(screen: Screen, name: str) -> None:
    """With one finger, from the knob to the end; it is not elsewhere at once. Of a tap in the moment after a slide
    Chromium may make no click, though it tells the page of the touch."""
    knob = screen.part(name)
    knob.scroll_into_view_if_needed()
    box = knob.bounding_box()
    assert box is not None
    y, half = box["y"] + box["height"] / 2, box["height"] / 2
    finger = screen.page.context.new_cdp_session(screen.page)

    def at(x: float) -> list[dict[str, float]]:
        return [{"x": x, "y": y}]

    finger.send("Input.dispatchTouchEvent", {"type": "touchStart", "touchPoints": at(box["x"] + half)})
    for step in range(1, 11):
        x = box["x"] + half + step / 10 * (box["width"] - box["height"])
        finger.send("Input.dispatchTouchEvent", {"type": "touchMove", "touchPoints": at(x)})
    finger.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})
    finger.detach()
    screen.page.wait_for_timeout(FINGER_MOVES_MS)
