"""Times between drawn frames while a mission flies, and what one message costs the page: one JSON object.

    python -m tests.benchmarks.page_frames --minutes 10

The page shows an endless simulated flight: telemetry ten times a second, sweeps, beliefs and plans at their true sizes.
The server and its vehicle work beside it on the same machine. frame_ms: between two drawn frames; without a graphics
card the processor draws the map and they are an upper bound. work_ms_a_value: of the page's main thread for each
telemetry value. held: heap after a collection; it grows by the facts that the timeline keeps (`kept_events`), and by
nothing else.
"""

from __future__ import annotations

import argparse
import json
import tempfile
from pathlib import Path
from typing import Any

from tests.benchmarks.figures.circumstances import begin
from tests.benchmarks.figures.record import Figure
from tests.benchmarks.figures.writer import add_out, plain, write
from tests.benchmarks.watched_page import Counters, share, watched_page
from tests.browser.conftest import serving
from tests.browser.screen import Screen

WATCH = """
window.frames = [];
let last = null;
const tick = (now) => {
  if (last !== null) frames.push(now - last);
  last = now;
  requestAnimationFrame(tick);
};
requestAnimationFrame(tick);
"""
HERTZ = 10
LONG_MS = 50.0


def figures(found: dict[str, Any]) -> list[Figure]:
    return [
        *(
            plain(f"between two drawn frames, {words}", found["frame_ms"][part], "ms")
            for words, part in (("median", "0.5"), ("95 %", "0.95"), ("99 %", "0.99"), ("worst", "1.0"))
        ),
        plain("frames longer than 50 ms", round(100.0 * found["frames_longer_than_50_ms"], 2), "%"),
        plain("main thread for a telemetry value", found["work_ms_a_value"]["all"], "ms"),
        plain("heap at the beginning", found["held"][0]["heap_mb"], "MB"),
        plain("heap at the end", found["held"][-1]["heap_mb"], "MB", note=f"{found['kept_events']} events kept"),
    ]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--minutes", type=float, default=10.0)
    add_out(parser)
    given = parser.parse_args()
    minutes, begun = given.minutes, begin(__file__)
    with tempfile.TemporaryDirectory() as folder, serving(Path(folder)) as server, watched_page(WATCH) as page:
        page.goto(server.url)
        screen = Screen(page, server.url)
        screen.fly(server.draft(expected_rmse_m=0.1, maximum_bearings=200))
        screen.map_ready()
        page.wait_for_timeout(3000)
        counters = Counters(page)
        held = [counters.held()]
        frames: list[float] = []
        page.evaluate("frames.length = 0")
        before = counters.seconds()
        for _ in range(10):
            page.wait_for_timeout(minutes * 6_000)
            frames += page.evaluate("frames.splice(0)")
            held.append(counters.held())
        after = counters.seconds()
        kept = page.get_by_test_id("event-row").count()
    values = HERTZ * sum(frames) / 1000
    found = {
        "minutes": round(sum(frames) / 60_000, 2),
        "frame_ms": {str(part): share(frames, part) for part in (0.5, 0.95, 0.99, 1.0)},
        "frames_longer_than_50_ms": round(sum(frame > LONG_MS for frame in frames) / len(frames), 4),
        "work_ms_a_value": {name: round(1e3 * (after[name] - before[name]) / values, 3) for name in after},
        "held": held,
        "kept_events": kept,
    }
    print(json.dumps(found))
    write(given.out, "page_frames", "Frames in flight", begun, figures(found), page="page-speed.md#frames-and-memory")


if __name__ == "__main__":
    main()
