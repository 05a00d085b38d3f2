"""Times between drawn frames at 20 Hz telemetry, and what one message costs the page: one JSON object.

    python -m tests.benchmarks.page_frames --minutes 10

The page flies its built-in endless example (no server beside it): telemetry, sweeps, beliefs and plans at their true
sizes, twenty values a second. frame_ms: between two drawn frames; without a graphics card the processor draws the map
and they are an upper bound. work_ms_a_value: of the page's main thread for each telemetry value. held: heap after a
collection; it grows by the facts that the timeline keeps (`kept_events`), and by nothing else.
"""

from __future__ import annotations

import argparse
import json
import tempfile
from pathlib import Path

from playwright.sync_api import expect

from tests.benchmarks.watched_page import Counters, share, watched_page
from tests.browser.conftest import serving

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
HERTZ = 20
LONG_MS = 50.0


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--minutes", type=float, default=10.0)
    minutes: float = parser.parse_args().minutes
    with tempfile.TemporaryDirectory() as folder, serving(Path(folder)) as server, watched_page(WATCH) as page:
        page.goto(f"{server.url}?fixture=endless#/mission/example")
        expect(page.get_by_test_id("map")).to_have_attribute("data-ready", "true", timeout=60_000)
        server.stop()
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
    print(
        json.dumps(
            {
                "minutes": round(sum(frames) / 60_000, 2),
                "frame_ms": {str(part): share(frames, part) for part in (0.5, 0.95, 0.99, 1.0)},
                "frames_longer_than_50_ms": round(sum(frame > LONG_MS for frame in frames) / len(frames), 4),
                "work_ms_a_value": {name: round(1e3 * (after[name] - before[name]) / values, 3) for name in after},
                "held": held,
                "kept_events": kept,
            }
        )
    )


if __name__ == "__main__":
    main()
