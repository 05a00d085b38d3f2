"""Every screen: nothing that axe calls serious, and nothing cut off in German at 130 %, on three devices."""

from __future__ import annotations

import pytest
from legible import wrong
from screen import OpenScreen
from served import Server

from tests.browser.stock import brought, search_of_tags
from tests.browser.sweep import HELD, SIZES, Shown, screens

pytestmark = [pytest.mark.browser, pytest.mark.long, pytest.mark.timeout(300)]

NOT_OURS = {"scene"}
"""What viser draws."""


def test_every_screen_but_those_of_a_flight(server: Server, open_screen: OpenScreen) -> None:
    flown = brought(server)[0]
    draft = server.draft()
    shown = Shown(server, draft, flown, draft, search_of_tags(server))
    width, height = SIZES["laptop"]
    screen = open_screen(server, "", {"language": "de", "scale": 1.3}, viewport={"width": width, "height": height})
    names = screens(shown).keys() - HELD - NOT_OURS
    assert [one for name in sorted(names) for one in wrong(screen, shown, name)] == []
