"""How quick and how light the page is, measured on a flying mission: one JSON object on standard output.

`python tests/browser/measure.py --minutes 2 [--lite]`. belief_ms: from the arrival of a bearing's event in the browser
to the frame that shows its belief (the server's update between them included); belief_drawing_ms: from the arrival
of the belief itself. frame_ms: times between drawn frames
while telemetry comes. Without a graphics card the map is drawn by the processor: frame times are then an upper bound.
"""

from __future__ import annotations

import argparse
import json
import shutil
import tempfile
from pathlib import Path
from typing import Any

from conftest import CHROMIUM, SETTINGS, serving
from playwright.sync_api import sync_playwright
from screen import Screen

WATCH = """
window.measured = {bearings: [], arrived: [], beliefs: [], frames: [], bytes: 0, telemetry: 0};
const Plain = window.WebSocket;
window.WebSocket = class extends Plain {
  constructor(...all) {
    super(...all);
    this.addEventListener('message', ({data}) => {
      measured.bytes += typeof data === 'string' ? data.length : data.byteLength;
      if (typeof data !== 'string') { measured.arrived.push(performance.now()); return; }
      if (data.includes('"bearing_measured"')) measured.bearings.push(performance.now());
      if (data.startsWith('{"type":"telemetry"')) measured.telemetry += 1;
    });
  }
};
let last = null;
let painted = null;
const tick = (now) => {
  if (last !== null) measured.frames.push(now - last);
  last = now;
  const belief = window.crossfixBeliefPainted;
  if (belief && belief !== painted) measured.beliefs.push([belief.bearings, belief.atMs]);
  painted = belief;
  requestAnimationFrame(tick);
};
requestAnimationFrame(tick);
"""


def share(values: list[float], part: float) -> float | None:
    ordered = sorted(values)
    return round(ordered[min(len(ordered) - 1, int(part * len(ordered)))], 1) if ordered else None


def heap_mb(screen: Screen) -> float:
    """What the page holds on to, after a collection."""
    screen.page.context.new_cdp_session(screen.page).send("HeapProfiler.collectGarbage")
    return round(screen.evaluate("performance.memory.usedJSHeapSize") / 2**20, 1)


def until_painted(came: list[float], beliefs: list[list[float]]) -> list[float]:
    """ms from each arrival to the first belief painted after it."""
    return [
        min(at - begin for _, at in beliefs if at >= begin) for begin in came if any(at >= begin for _, at in beliefs)
    ]


def report(measured: dict[str, Any], heaps: list[float]) -> dict[str, Any]:
    minutes = (sum(measured["frames"]) / 1000) / 60
    delays = until_painted(measured["bearings"], measured["beliefs"])
    drawing = until_painted(measured["arrived"], measured["beliefs"])
    frames = measured["frames"]
    return {
        "minutes": round(minutes, 2),
        "bearings": len(delays),
        "belief_ms": {"median": share(delays, 0.5), "worst": share(delays, 1.0)},
        "belief_drawing_ms": {"median": share(drawing, 0.5), "worst": share(drawing, 1.0)},
        "frame_ms": {"median": share(frames, 0.5), "p95": share(frames, 0.95), "p99": share(frames, 0.99)},
        "telemetry_hz": round(measured["telemetry"] / minutes / 60, 1),
        "kilobytes_a_minute": round(measured["bytes"] / minutes / 1000, 1),
        "heap_mb": heaps,
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--minutes", type=float, default=2.0)
    parser.add_argument("--lite", action="store_true")
    arguments = parser.parse_args()
    chromium = [*CHROMIUM, "--enable-precise-memory-info"]
    with tempfile.TemporaryDirectory() as folder, serving(Path(folder)) as server, sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=chromium)
        page = browser.new_page(viewport={"width": 1280, "height": 800})
        stored = json.dumps(SETTINGS | {"lite": arguments.lite})
        page.add_init_script(f"localStorage.setItem('crossfix.settings', {stored!r});{WATCH}")
        page.goto(server.url)
        screen = Screen(page, server.url)
        screen.fly(server.draft(expected_rmse_m=0.1, maximum_bearings=200))
        screen.map_ready()
        screen.evaluate("Object.assign(measured, {frames: [], bytes: 0, telemetry: 0})")
        heaps = [heap_mb(screen)]
        for _ in range(4):
            page.wait_for_timeout(arguments.minutes * 15_000)
            heaps.append(heap_mb(screen))
        measured = screen.evaluate("measured")
        screen.part("abort").click()
        browser.close()
    print(json.dumps(report(measured, heaps)))


if __name__ == "__main__":
    main()
