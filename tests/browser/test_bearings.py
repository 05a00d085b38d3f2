"""Bearings from a phone, into a search that flies and into one that has no craft; and advice where to listen."""

from __future__ import annotations

import json
import math
import re
import socket
import time
from pathlib import Path
from uuid import uuid4

import httpx
import pytest
from conftest import serving
from playwright.sync_api import Page, Position, expect
from screen import AIM_MAP, OpenScreen
from served import Server

pytestmark = [pytest.mark.browser, pytest.mark.slow, pytest.mark.timeout(300)]

PHONE = {"viewport": {"width": 390, "height": 844}, "has_touch": True, "is_mobile": True, "device_scale_factor": 2}
LEFT: Position = {"x": 70, "y": 250}
RIGHT: Position = {"x": 290, "y": 250}
TOP: Position = {"x": 180, "y": 90}


def hear(page: Page, stand: Position, towards: Position) -> None:
    """Tap where one stands, then where it comes from, then send."""
    page.get_by_test_id("report-mode-here").click()
    page.locator(AIM_MAP).click(position=stand)
    page.locator(AIM_MAP).click(position=towards)
    page.get_by_test_id("report-send").click()


def stages(page: Page) -> list[str | None]:
    return [one.get_attribute("data-stage") for one in page.locator("[data-testid=report-sent] li").all()]


def start(server: Server, mission: str) -> None:
    address = f"{server.url.rstrip('/')}/api/missions/{mission}"
    until = time.monotonic() + 90
    while not httpx.post(f"{address}/preflight", timeout=60).json()["passed"]:
        assert time.monotonic() < until, "preflight does not pass"
        time.sleep(0.5)
    order = {"command_id": str(uuid4()), "command": {"kind": "start"}}
    assert httpx.post(f"{address}/commands", json=order, timeout=60).json()["accepted"]


def test_a_phone_adds_two_bearings_to_a_flying_search_and_takes_one_back(
    server: Server, open_screen: OpenScreen
) -> None:
    mission = server.draft()
    start(server, mission)
    page = open_screen(server, f"#/mission/{mission}/bearings", **PHONE).page
    page.get_by_test_id("report-name").type("Ada")
    hear(page, LEFT, TOP)
    expect(page.locator("[data-testid=report-sent] li").first).to_have_attribute("data-stage", "sent")

    page.context.set_offline(True)
    hear(page, RIGHT, TOP)
    expect(page.get_by_test_id("report-waiting")).to_be_visible()
    assert stages(page) == ["waiting", "sent"]
    page.context.set_offline(False)
    expect(page.locator("[data-testid=report-sent] li").first).to_have_attribute("data-stage", "sent")

    page.get_by_test_id("report-back").click()
    expect(page.locator("[data-testid=report-sent] li").first).to_have_attribute("data-stage", "back")
    expect(page.get_by_test_id("report-waiting")).to_be_hidden()
    page.get_by_test_id("report-mute").click()
    expect(page.locator("[data-testid=report-sent] li").last).to_contain_text("does not count")
    page.get_by_test_id("report-mute").click()
    expect(page.locator("[data-testid=report-sent] li").last).to_contain_text("counted")
    events = server.events(mission)
    said = [e for e in events if e["kind"] == "bearing_measured" and e["source"]["kind"] == "person"]
    assert [one["source"]["name"] for one in said] == ["Ada", "Ada"]
    excluded = [e["bearing_id"] for e in events if e["kind"] == "bearing_excluded"]
    assert excluded == [said[1]["bearing_id"]]
    assert "hold" not in [e["after"] for e in events if e["kind"] == "phase_changed"], "the craft is not disturbed"
    page.get_by_test_id("hold").tap()
    expect(page.get_by_test_id("state-words")).to_have_attribute("data-phase", "hold")
    page.get_by_test_id("abort").tap()
    expect(page.get_by_test_id("state-words")).to_have_attribute("data-phase", re.compile("aborted|returning"))


def test_a_search_without_a_craft_is_advised_until_it_is_localized(server: Server, open_screen: OpenScreen) -> None:
    """The advice is asked on the phone; a script that knows the emitter says what is heard there."""
    mission = server.draft(expected_rmse_m=20.0)
    address = f"{server.url.rstrip('/')}/api/missions/{mission}/bearings"
    page = open_screen(server, f"#/mission/{mission}/bearings", **PHONE).page
    page.get_by_test_id("report-name").fill("Ada")
    expect(page.get_by_test_id("advice-walking")).to_be_disabled()
    page.locator(AIM_MAP).click(position=LEFT)
    ring = server.get(f"/api/missions/{mission}")["spec"]["area"]["coordinates"][0]
    lon, lat = (sum(corner[i] for corner in ring[:4]) / 4 for i in (0, 1))
    east = math.cos(math.radians(lat))
    for number in range(10):
        with page.expect_response("**/advice") as answered:
            page.get_by_test_id("advice-walking").click()
        told = answered.value.json()
        if told["localized"]:
            break
        expect(page.get_by_test_id("advice-said")).to_have_attribute("data-state", "holds")
        at = told["place"]
        bearing = math.degrees(math.atan2((lon - at["lon"]) * east, lat - at["lat"])) % 360.0
        report = {"bearing_id": f"phone-{number:04d}", "by": "Ada", "place": at, "bearing_deg": bearing, "sigma_deg": 4}
        assert httpx.post(address, json=report, timeout=20).status_code == 201
        expect(page.get_by_test_id("advice-said")).to_have_attribute("data-state", "outrun")
    expect(page.get_by_test_id("advice-done")).to_be_visible()


def test_a_double_tap_takes_one_bearing_back(server: Server, open_screen: OpenScreen) -> None:
    page = open_screen(server, f"#/mission/{server.draft()}/bearings", **PHONE).page
    page.get_by_test_id("report-name").type("Ada")
    for count, stand in enumerate((LEFT, RIGHT), 1):
        hear(page, stand, TOP)
        expect(page.locator("[data-testid=report-sent] [data-stage=sent]")).to_have_count(count)
    box = page.get_by_test_id("report-back").bounding_box()
    assert box is not None
    for _ in range(2):  # nothing is waited for in between, as it is by `tap` of a locator
        page.touchscreen.tap(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    page.wait_for_timeout(1000)
    assert stages(page) == ["back", "sent"]
    page.get_by_test_id("report-back").tap()
    expect(page.locator("[data-testid=report-sent] [data-stage=back]")).to_have_count(2)


def test_health_says_what_was_refused_of_what_came_by_udp(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, open_screen: OpenScreen
) -> None:
    monkeypatch.setenv("CROSSFIX_BEARINGS_UDP_PORT", "0")
    with serving(tmp_path) as server:
        said = server.get("/api/health")["bearings_udp"]
        screen = open_screen(server, "#/health")
        german = open_screen(server, "#/health", {"language": "de"})
        expect(screen.part("udp-counts")).to_contain_text(f"port {said['port']}. Taken since the start: 0; refused: 0.")
        expect(screen.part("udp-refused")).to_have_count(0)
        bearing = {"latitude": 50.6, "longitude": 7.2, "bearing": 90, "source": "yagi-1"}
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
            for data in (b"noise", json.dumps({"type": "BEARING", "bearing_type": "absolute", **bearing}).encode()):
                sender.sendto(data, (said["host"], said["port"]))
        refused = screen.part("udp-refused")
        expect(refused).to_contain_text("yagi-1 (127.0.0.1): 2 refused, the last at")
        expect(refused).to_contain_text("No search flies.")
        expect(screen.part("udp-counts")).to_contain_text("refused: 2.")
        expect(german.part("udp-refused")).to_contain_text("2 abgelehnt")
        expect(german.part("udp-refused")).to_contain_text("Keine Suche fliegt.")
