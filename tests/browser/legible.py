"""What keeps a screen from being read: what axe finds serious, and what is cut off."""

from __future__ import annotations

from playwright.sync_api import Page, expect
from screen import Screen
from served import REPOSITORY

from tests.browser.sweep import SIZES, Shown, faults, screens

AXE = (REPOSITORY / "frontend" / "node_modules" / "axe-core" / "axe.min.js").read_text()
THEMES = {"indoor": "runOnly: ['color-contrast'],", "outdoor": ""}
"""The other theme changes the style sheet's colours and nothing else that axe reads."""
QUICKLY = "resultTypes: ['violations'], selectors: false, preload: false"
"""A selector of each part and all style sheets once more, which nothing here reads, took half of axe's time."""


def serious(page: Page) -> list[str]:
    """In both themes, on what is shown now; empty when all is well."""
    if not page.evaluate("'axe' in window"):
        page.evaluate(AXE)
    found: list[str] = []
    for theme, rules in THEMES.items():
        page.evaluate(f"document.documentElement.dataset.theme = '{theme}'")
        result = page.evaluate(f"axe.run(document, {{{rules} {QUICKLY}}})")
        found += [
            f"{theme}, {v['id']}: {v['nodes'][0]['html'][:120]}"
            for v in result["violations"]
            if v["impact"] in ("serious", "critical")
        ]
    return found


def wrong(screen: Screen, shown: Shown, name: str) -> list[str]:
    """With one screen, on three devices. The page is left as wide as a laptop's."""
    address, prepare = screens(shown)[name]
    screen.go("#/health")
    screen.go(address)
    expect(screen.page.get_by_role("heading").or_(screen.part("state-words")).first).to_be_visible()
    prepare(screen)
    screen.page.wait_for_timeout(300)
    found = [f"{name}: {one}" for one in serious(screen.page)]
    for size in reversed(SIZES):
        width, height = SIZES[size]
        screen.page.set_viewport_size({"width": width, "height": height})
        screen.page.wait_for_timeout(100)  # the page is laid out, and its maps, twice
        found += [f"{name}, {size}: {one}" for one in faults(screen.page)]
    screen.page.keyboard.press("Escape")
    return found
