"""docs/install-for-a-team.md from the link that the box prints to the flight: two phones, and every tap counted.

CROSSFIX_INSTALL_OUT names the folder for a record of the count.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import pytest
from playwright.sync_api import expect
from screen import AUTOMATIC, OpenScreen, Screen
from team import PASSWORD, PHONE, Shared, team_server

from tests.benchmarks.figures.circumstances import begin
from tests.benchmarks.figures.writer import plain, wanted, write

SCRIPT = 1
"""deploy/for-a-team.sh."""
WARNINGS_A_PHONE = 2
"""Chrome's *Advanced* and *Proceed*: no phone trusts the box's own authority yet."""
PAGE = "install-for-a-team.md"
DOCS = Path(__file__).parents[2] / "docs"
OUT = os.environ.get("CROSSFIX_INSTALL_OUT")


@dataclass
class Hands:
    """Does what a person does, and counts it. What is typed is not counted, the key that sends it off is."""

    open_screen: OpenScreen
    shared: Shared
    taps: int = 0

    def scan(self, path: str) -> Screen:
        self.taps += 1
        return self.open_screen(self.shared.server, path, **PHONE)

    def enter(self, screen: Screen, name: str) -> None:
        screen.part("entry-name").fill(name)
        screen.part("entry-password").fill(PASSWORD)
        self.taps += 1
        screen.part("entry-password").press("Enter")

    def slide(self, screen: Screen, part: str) -> None:
        self.taps += 1
        screen.drag_slider(part, 1.0)


@pytest.fixture
def shared(tmp_path: Path) -> Iterator[Shared]:
    with team_server(tmp_path) as made:
        yield made


@pytest.mark.browser
def test_two_phones_sign_in_and_fly_within_the_taps_that_the_page_names(
    shared: Shared, open_screen: OpenScreen
) -> None:
    hands = Hands(open_screen, shared)
    first = hands.scan(f"#/first-admin/{shared.code}")
    hands.enter(first, "Ada")
    expect(first.part("made-invitation")).to_have_count(1)
    expect(first.part("made-invitation").get_by_role("img")).to_be_in_viewport()

    link = first.part("invitation-link").input_value()
    second = hands.scan(link.split("/", 3)[3])
    hands.enter(second, "Ben")
    expect(second.part("preflight")).to_have_attribute("data-passed", "true")
    second.expect_phase("ready")
    hands.slide(second, "start-slider")
    second.expect_phase(*AUTOMATIC)

    taps = SCRIPT + hands.taps + 2 * WARNINGS_A_PHONE
    named = re.search(r"(\d+) commands and taps", (DOCS / PAGE).read_text())
    assert named is not None
    assert taps == int(named[1])
    figures = [
        wanted("install_commands", taps, note="typing aside"),
        plain("of them the browsers' warnings of an authority that no phone trusts yet", 2 * WARNINGS_A_PHONE, ""),
    ]
    begun = replace(begin(__file__), command="pytest tests/browser/test_install.py")
    write(Path(OUT) if OUT else None, "install", "Installing for a team", begun, figures, page=PAGE)
