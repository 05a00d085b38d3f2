"""What a season of checked missions says, by vehicle and by antenna."""

from __future__ import annotations

import pytest
from playwright.sync_api import expect
from screen import OpenScreen
from served import Server

from backend.events import Recorded
from tests.browser.test_after_flight import bring_in, checked

pytestmark = [pytest.mark.browser, pytest.mark.slow, pytest.mark.timeout(480)]


def test_a_season_is_told_by_vehicle_and_by_antenna(server: Server, open_screen: OpenScreen) -> None:
    def of_craft(recorded: list[Recorded], craft: str) -> list[Recorded]:
        return [Recorded.model_validate_json(r.model_dump_json().replace('"craft-1"', f'"{craft}"')) for r in recorded]

    for number, (craft, off_deg) in enumerate((("owl-finder", 0.0), ("owl-finder", 0.0), ("fox-finder", 40.0))):
        bring_in(server, of_craft(checked(f"of-{craft}-{number}", off_deg), craft))
    screen = open_screen(server, "#/calibration")
    two_sigma = screen.part("reliability").nth(1)
    for craft, bearings, held in (("owl-finder", "6", "100 %"), ("fox-finder", "3", "0 %")):
        screen.page.get_by_label("Vehicle").select_option(craft)
        expect(two_sigma).to_have_attribute("data-of", bearings)
        expect(two_sigma.locator("td").first).to_have_text(held)
    (antenna,) = server.get("/api/calibration?craft=fox-finder")["antennas"]
    screen.page.get_by_label("Antenna").select_option(antenna)
    expect(two_sigma).to_have_attribute("data-of", "3")
