"""What a season of checked missions says, by vehicle and by antenna."""

from __future__ import annotations

import httpx
import pytest
from playwright.sync_api import Route, expect
from screen import OpenScreen
from served import Server

from backend.events import Recorded
from tests.browser.stock import stored
from tests.browser.test_after_flight import bring_in, checked

pytestmark = [pytest.mark.browser, pytest.mark.long, pytest.mark.timeout(480)]


def test_it_says_that_it_loads_and_then_that_there_is_nothing(server: Server, open_screen: OpenScreen) -> None:
    screen = open_screen(server, "#/health")
    held: list[Route] = []
    screen.page.route("**/api/calibration*", lambda route: held.append(route), times=1)
    screen.go("#/calibration")
    expect(screen.part("calibration-loading")).to_be_visible()
    expect(screen.part("calibration-nothing")).to_have_count(0)
    held[0].continue_()
    expect(screen.part("calibration-nothing")).to_contain_text("Nothing is checked yet.")
    expect(screen.part("calibration-loading")).to_have_count(0)
    flown = stored(server, "aborted")
    lost = {"emitter_id": "emitter-1", "place": None, "accuracy_m": None, "how": "typed"}
    httpx.put(f"{server.url.rstrip('/')}/api/missions/{flown}/truth", json=lost, timeout=60).raise_for_status()
    screen.page.reload()
    expect(screen.part("calibration-nothing")).to_contain_text("Missions checked: 1; not found: 1.")


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
