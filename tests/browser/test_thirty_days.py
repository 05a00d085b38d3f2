"""A mission that was deleted on the page: brought back until the thirtieth day, gone after it."""

from __future__ import annotations

import json
import sqlite3
from datetime import UTC, datetime, timedelta
from pathlib import Path

import httpx
import pytest
from conftest import serving
from playwright.sync_api import Locator, expect
from screen import OpenScreen, Screen
from served import Server

pytestmark = [pytest.mark.browser, pytest.mark.long, pytest.mark.timeout(480)]

GONE_WITHIN_MS = 180_000
"""The server looks for what is to go a minute after its start."""


def row(screen: Screen, mission_id: str) -> Locator:
    return screen.page.locator(f"[data-testid=mission-row][data-mission='{mission_id}']")


def deleted_on_the_page(screen: Screen, *mission_ids: str) -> None:
    for mission_id in mission_ids:
        row(screen, mission_id).get_by_test_id("label-mission").click()
        expect(screen.part("label-form")).to_contain_text("thirty days")
        screen.part("delete-mission").click()
        expect(row(screen, mission_id)).to_have_count(0)


def show_deleted(screen: Screen) -> None:
    screen.part("library-filter").locator("summary").click()
    screen.part("filter-deleted").check()


def aged(server: Server, days: dict[str, float]) -> None:
    """While the server is away: as if they had been deleted that many days ago, and it had run on each since."""
    with sqlite3.connect(server.data_dir / "crossfix.sqlite") as database:
        for mission_id, ago in days.items():
            at_us = round((datetime.now(UTC) - timedelta(days=ago)).timestamp() * 1e6)
            changed = database.execute(
                "UPDATE missions SET deleted_at_us = ? WHERE mission_id = ? AND deleted_at_us IS NOT NULL",
                (at_us, mission_id),
            )
            assert changed.rowcount == 1
    database.close()
    ran = {mission_id: [int(ago), "2026-11-01"] for mission_id, ago in days.items()}
    (server.data_dir / "deleted.json").write_text(json.dumps(ran))


def test_a_deleted_mission_comes_back_until_the_thirtieth_day_and_is_gone_after_it(
    open_screen: OpenScreen, tmp_path: Path
) -> None:
    with serving(tmp_path) as server:
        kept, young, old = (server.draft() for _ in range(3))
        screen = open_screen(server)
        deleted_on_the_page(screen, young, old)
        expect(row(screen, kept)).to_be_visible()
        show_deleted(screen)
        on = [(datetime.now(UTC) + timedelta(days=30, minutes=late)).date().isoformat() for late in (-5, 0)]
        for mission_id in (young, old):
            until = row(screen, mission_id).get_by_test_id("gone-at").inner_text()
            assert any(day in until for day in on), until

        server.stop()
        aged(server, {young: 29.9, old: 30.1})
        server.start_again()
        screen.page.reload()
        show_deleted(screen)
        expect(row(screen, young)).to_be_visible()
        expect(row(screen, old)).to_have_count(0, timeout=GONE_WITHIN_MS)
        expect(row(screen, young)).to_be_visible()
        for gone in ("", "/events"):
            assert httpx.get(f"{server.url.rstrip('/')}/api/missions/{old}{gone}", timeout=20).status_code == 404

        row(screen, young).get_by_test_id("label-mission").click()
        screen.part("restore-mission").click()
        expect(row(screen, young)).to_have_count(0)
        screen.part("filter-clear").click()
        expect(row(screen, young)).to_be_visible()
        expect(row(screen, young).get_by_test_id("gone-at")).to_have_count(0)
        expect(row(screen, kept)).to_be_visible()
        screen.open(young)
        expect(screen.part("preflight")).to_be_visible()
