"""A library of more missions than a page of it holds."""

from __future__ import annotations

import httpx
import pytest
from playwright.sync_api import expect
from screen import Screen
from served import Server

pytestmark = [pytest.mark.browser, pytest.mark.long, pytest.mark.timeout(240)]

PAGE = 100
MISSIONS = 130


def test_a_long_library_is_read_page_by_page_and_searched_as_a_whole(server: Server, screen: Screen) -> None:
    spec = server.get("/api/defaults")["spec"]
    with httpx.Client(base_url=server.url, timeout=60) as client:
        for number in range(MISSIONS):
            client.post("/api/missions", json=spec | {"name": f"search {number:03d}"}).raise_for_status()
    rows, names = screen.part("mission-row"), screen.part("mission-row").locator("strong")
    screen.go("#/health")
    screen.go("#/")
    expect(rows).to_have_count(PAGE)
    expect(names.first).to_have_text(f"search {MISSIONS - 1}")
    screen.part("more-missions").click()
    expect(rows).to_have_count(MISSIONS)
    expect(screen.part("more-missions")).to_have_count(0)
    newest_first = [f"search {number:03d}" for number in reversed(range(MISSIONS))]
    expect(names).to_have_text(newest_first)

    screen.page.reload()
    expect(rows).to_have_count(PAGE)
    screen.page.get_by_role("searchbox").fill("search 007")
    expect(names).to_have_text(["search 007"])
