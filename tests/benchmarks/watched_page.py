"""The page under measurement: Chromium with its counters, for the page benchmarks beside this file."""

from __future__ import annotations

import json
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from playwright.sync_api import CDPSession, Page, sync_playwright

from tests.browser.conftest import CHROMIUM, SETTINGS


@contextmanager
def watched_page(script: str = "", **settings: Any) -> Iterator[Page]:
    """A page 1280 x 800 that runs `script` before its own; settings: of the console, as the operator would set them."""
    stored = json.dumps(SETTINGS | settings)
    with sync_playwright() as playwright:
        chromium = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=CHROMIUM)
        page = chromium.new_page(viewport={"width": 1280, "height": 800})
        page.add_init_script(f"localStorage.setItem('crossfix.settings', {stored!r});{script}")
        yield page
        chromium.close()


def share(values: list[float], part: float) -> float | None:
    """The value that `part` of them do not exceed."""
    ordered = sorted(values)
    return round(ordered[min(len(ordered) - 1, int(part * len(ordered)))], 2) if ordered else None


def spread(values: list[float]) -> dict[str, float | int | None]:
    return {"median": share(values, 0.5), "p95": share(values, 0.95), "worst": share(values, 1.0), "of": len(values)}


class Counters:
    """What Chromium counts of one page."""

    def __init__(self, page: Page) -> None:
        self._session: CDPSession = page.context.new_cdp_session(page)
        self._session.send("Performance.enable")

    def held(self) -> dict[str, float]:
        """What the page holds on to after a collection: heap in MB, DOM nodes, event listeners."""
        self._session.send("HeapProfiler.collectGarbage")
        heap = self._session.send("Runtime.getHeapUsage")
        counted = self._session.send("Memory.getDOMCounters")
        return {
            "heap_mb": round(heap["usedSize"] / 2**20, 2),
            "nodes": counted["nodes"],
            "listeners": counted["jsEventListeners"],
        }

    def seconds(self) -> dict[str, float]:
        """Seconds of the page's main thread so far, by what they went to."""
        told = {m["name"]: m["value"] for m in self._session.send("Performance.getMetrics")["metrics"]}
        names = {
            "script": "ScriptDuration",
            "layout": "LayoutDuration",
            "style": "RecalcStyleDuration",
            "all": "TaskDuration",
        }
        return {name: told[metric] for name, metric in names.items()}
