"""From a whole start of the server until its page can be used (figure 21).

    python -m tests.benchmarks.page_start --starts 10

The server is killed (kill -9) while a craft is in flight, started again as a whole, and its page opened in a running
Chromium as soon as it answers. The page can be used when its safety bar says that the craft holds, and its map is
drawn: the later of both. Without a graphics card the processor draws the map.
"""

from __future__ import annotations

import argparse
import json
import statistics
import tempfile
import time
from pathlib import Path

from playwright.sync_api import Page, expect

from tests.benchmarks.figures.circumstances import begin
from tests.benchmarks.figures.record import Figure
from tests.benchmarks.figures.writer import add_out, plain, wanted, write
from tests.benchmarks.watched_page import watched_page
from tests.browser.conftest import serving
from tests.browser.screen import Screen
from tests.browser.served import Server

BETWEEN_S = 5.0
"""A server lives for so long before the next kill."""
STAGES = ("the server answers", "the bar says HOLD", "the map is drawn")


def started_again(server: Server, page: Page, mission: str) -> dict[str, float]:
    """Seconds from the start of the server to each stage."""
    page.goto("about:blank")
    server.kill()
    began = time.monotonic()
    server.start_again()
    after = [time.monotonic() - began]
    page.goto(f"{server.url}#/mission/{mission}", wait_until="commit")
    screen = Screen(page, server.url)
    expect(page.locator("[data-testid=state-words][data-phase=hold]")).to_be_visible()
    after.append(time.monotonic() - began)
    screen.map_ready()
    after.append(time.monotonic() - began)
    return dict(zip(STAGES, after, strict=True))


def starts(count: int) -> list[dict[str, float]]:
    with (
        tempfile.TemporaryDirectory() as folder,
        serving(Path(folder), speedup=1.0) as server,
        watched_page() as page,
    ):
        page.goto(server.url)
        mission = server.draft()
        Screen(page, server.url).fly(mission)
        found: list[dict[str, float]] = []
        for _ in range(count):
            page.wait_for_timeout(1000 * BETWEEN_S)
            found.append(started_again(server, page, mission))
        return found


def figures(found: list[dict[str, float]]) -> list[Figure]:
    usable = [max(stages.values()) for stages in found]
    median = statistics.median(usable)
    medians = {stage: round(statistics.median(one[stage] for one in found), 2) for stage in STAGES}
    return [
        wanted("page_start", round(max(usable), 2), note=f"at most, of {len(usable)} starts; median {median:.2f} s"),
        *(plain(f"{stage}, median", seconds, "s") for stage, seconds in medians.items()),
    ]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--starts", type=int, default=10)
    add_out(parser)
    arguments = parser.parse_args()
    begun = begin(__file__)
    found = starts(arguments.starts)
    print(json.dumps(found))
    title = "The page after a whole start"
    write(arguments.out, "page_start", title, begun, figures(found), page="page-speed.md#after-a-whole-start")


if __name__ == "__main__":
    main()
