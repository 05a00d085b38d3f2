"""Whether the page's memory stays flat while a flown mission is replayed at speed: one JSON object.

    python -m tests.benchmarks.page_replay --minutes 60

A mission is flown without a page, then opened and played at ten times its speed again and again. held: heap after a
collection, DOM nodes and listeners at every twentieth of the time, always at the same event; growth_mb_an_hour is the
slope of a straight line through the heaps after the first loops (the beliefs are kept once seen).
"""

from __future__ import annotations

import argparse
import json
import tempfile
import time
from pathlib import Path

import httpx
import numpy as np
from playwright.sync_api import Page, expect

from tests.benchmarks.figures.circumstances import begin
from tests.benchmarks.figures.record import Figure
from tests.benchmarks.figures.writer import add_out, plain, write
from tests.benchmarks.watched_page import Counters, watched_page
from tests.browser.conftest import serving
from tests.browser.screen import Screen
from tests.browser.served import Server

SAMPLES = 20


def fly(server: Server) -> str:
    """A whole mission by commands alone; its id."""
    mission_id, base = server.draft(), server.url.rstrip("/")
    until = time.monotonic() + 600
    while not httpx.post(f"{base}/api/missions/{mission_id}/preflight", timeout=30).json()["passed"]:
        time.sleep(0.5)
    command = {"command_id": "00000000-0000-4000-8000-000000000001", "command": {"kind": "start"}}
    answer = httpx.post(f"{base}/api/missions/{mission_id}/commands", json=command, timeout=30).json()
    assert answer["accepted"], answer
    with httpx.Client() as client:
        while server.get(f"/api/missions/{mission_id}")["phase"] not in ("done", "failed"):
            assert time.monotonic() < until, "the mission does not end"
            client.get(f"{base}/api/health")
            time.sleep(1)
    return mission_id


def play_through(page: Page) -> None:
    page.locator("[data-testid=event-row][data-kind=mission_started]").click()
    page.get_by_test_id("play").click()
    expect(page.get_by_test_id("play")).to_contain_text("10×", timeout=300_000)


def at_the_start(page: Page, counters: Counters) -> dict[str, float]:
    page.locator("[data-testid=event-row][data-kind=mission_started]").click()
    page.wait_for_timeout(1500)
    return counters.held()


def figures(held: list[dict[str, float]], loops: int, growth_mb_an_hour: float) -> list[Figure]:
    heap = [sample["heap_mb"] for sample in held]
    return [
        plain("replays", loops, ""),
        plain("growth of the heap, straight line", growth_mb_an_hour, "MB/h"),
        plain("heap, first sample", heap[0], "MB"),
        plain("heap, most", max(heap), "MB"),
        plain("DOM nodes at the end above those at the beginning", held[-1]["nodes"] - held[0]["nodes"], ""),
    ]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--minutes", type=float, default=60.0)
    add_out(parser)
    given = parser.parse_args()
    seconds, begun = 60.0 * given.minutes, begin(__file__)
    with tempfile.TemporaryDirectory() as folder, serving(Path(folder), speedup=5.0) as server, watched_page() as page:
        page.goto(f"{server.url}#/")
        mission_id = fly(server)
        screen = Screen(page, server.url)
        screen.open(mission_id)
        screen.map_ready()
        play_through(page)
        counters = Counters(page)
        began = time.monotonic()
        held = [at_the_start(page, counters)]
        at_s = [0.0]
        loops = 0
        while (now := time.monotonic() - began) < seconds:
            play_through(page)
            loops += 1
            if now >= at_s[-1] + seconds / SAMPLES:
                held.append(at_the_start(page, counters))
                at_s.append(time.monotonic() - began)
        held.append(at_the_start(page, counters))
        at_s.append(time.monotonic() - began)
    slope = np.polyfit(at_s, [sample["heap_mb"] for sample in held], 1)[0]
    growth = round(3600 * float(slope), 2)
    print(json.dumps({"loops": loops, "growth_mb_an_hour": growth, "held": held}))
    made = figures(held, loops, growth)
    write(given.out, "page_replay", "Replay for an hour", begun, made, page="page-speed.md#frames-and-memory")


if __name__ == "__main__":
    main()
