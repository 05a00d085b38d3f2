"""What watching a mission costs: processor time of Chromium's drawing and page processes, one JSON object.

    python -m tests.benchmarks.page_power --seconds 60

Shares of one core, in %: of the process that draws (without a graphics card the processor does) and of the page's own,
with a draft on the ground, over a stretch of real-time flight that begins with a turn, and in hold.
"""

from __future__ import annotations

import argparse
import json
import os
import tempfile
import time
from pathlib import Path

from tests.benchmarks.figures.circumstances import begin
from tests.benchmarks.figures.record import Figure
from tests.benchmarks.figures.writer import add_out, plain, write
from tests.benchmarks.page_bytes import command, start
from tests.benchmarks.watched_page import watched_page
from tests.browser.conftest import serving
from tests.browser.screen import Screen
from tests.browser.served import Server

KINDS = {"drawing": "--type=gpu-process", "page": "--type=renderer"}


def children(root: int) -> list[int]:
    """Process ids of everything that `root` started, itself included."""
    started: dict[int, list[int]] = {}
    for stat in Path("/proc").glob("[0-9]*/stat"):
        try:
            parent = int(stat.read_text().rsplit(")", 1)[1].split()[1])
        except FileNotFoundError:  # ended meanwhile
            continue
        started.setdefault(parent, []).append(int(stat.parent.name))
    found = [root]
    for process in found:
        found += started.get(process, [])
    return found


def spent_s(option: str) -> float:
    """Processor seconds so far of Chromium's processes that were started with this option."""
    ticks = 0
    for process in children(os.getpid()):
        try:
            if option not in Path(f"/proc/{process}/cmdline").read_text():
                continue
            user, system = Path(f"/proc/{process}/stat").read_text().rsplit(")", 1)[1].split()[11:13]
        except FileNotFoundError:
            continue
        ticks += int(user) + int(system)
    return ticks / os.sysconf("SC_CLK_TCK")


def shares(seconds: float) -> dict[str, float]:
    began = time.monotonic()
    before = {kind: spent_s(option) for kind, option in KINDS.items()}
    time.sleep(seconds)
    took = time.monotonic() - began
    return {kind: round(100 * (spent_s(option) - before[kind]) / took, 1) for kind, option in KINDS.items()}


def measured(server: Server, seconds: float) -> dict[str, dict[str, float]]:
    ground = server.draft()
    with watched_page() as page:
        screen = Screen(page, server.url)
        screen.open(ground)
        screen.map_ready()
        page.wait_for_timeout(3000)
        told = {"ground": shares(seconds / 4)}
        mission_id = start(server)
        screen.open(mission_id)
        screen.expect_phase("measuring")
        told["flight"] = shares(seconds)
        screen.hold()
        page.wait_for_timeout(3000)
        told["hold"] = shares(seconds / 4)
        command(server, mission_id, "abort")
    return told


def figures(found: dict[str, dict[str, float]]) -> list[Figure]:
    return [
        plain(f"{moment}, {'drawing process' if kind == 'drawing' else 'page process'}, of one core", share, "%")
        for moment, spent in found.items()
        for kind, share in spent.items()
    ]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--seconds", type=float, default=60.0)
    add_out(parser)
    arguments = parser.parse_args()
    begun = begin(__file__)
    with tempfile.TemporaryDirectory() as folder, serving(Path(folder), 1.0) as server:
        found = measured(server, arguments.seconds)
    print(json.dumps(found | {"load": round(os.getloadavg()[0], 1)}))
    title, page = "What watching a mission costs", "page-speed.md#what-drawing-costs"
    write(arguments.out, "page_power", title, begun, figures(found), page=page)


if __name__ == "__main__":
    main()
