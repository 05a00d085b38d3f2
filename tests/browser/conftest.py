"""A real server with a simulated vehicle in a process of its own, and Chromium looking at its page."""

from __future__ import annotations

import json
import shutil
import sys
from collections.abc import Generator, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Browser, BrowserContext, Page, expect, sync_playwright

sys.path.insert(0, str(Path(__file__).parent))

from screen import FEW_FRAMES, OpenScreen, Screen
from served import Server, started, url_of

SPEEDUP = 3.0

# Debian's launcher forces rasterization onto a graphics card; without one Chromium itself would do it on the processor.
CHROMIUM = [
    "--no-sandbox",
    "--disable-background-networking",
    "--disable-component-update",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--ignore-gpu-blocklist",
    "--disable-gpu-rasterization",
    "--autoplay-policy=no-user-gesture-required",
]

RESULTS = Path(__file__).resolve().parents[2] / "test-results"
FAILED = pytest.StashKey[bool]()

SETTINGS = {"theme": "outdoor", "tourSeen": True, "tones": False, "language": "en"}


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item: pytest.Item) -> Generator[None, pytest.TestReport, pytest.TestReport]:
    """A failed test leaves a picture of each page in test-results."""
    report = yield
    item.stash[FAILED] = item.stash.get(FAILED, False) or report.failed
    return report


@contextmanager
def serving(data_dir: Path, speedup: float = SPEEDUP, emitters: Sequence[str] = (), seed: int = 3) -> Iterator[Server]:
    """emitters: in the simulated world besides those of the presets, as `crossfix serve --emitter` takes them."""
    arguments = ["--data-dir", str(data_dir), "--speedup", str(speedup), "--seed", str(seed)]
    for one in emitters:
        arguments += ["--emitter", one]
    process = started([*arguments, "--port", "0"])
    made = Server(url_of(process), data_dir, arguments, process)
    try:
        yield made
    finally:
        made.stop()


@pytest.fixture
def unhurried_server(tmp_path: Path) -> Iterator[Server]:
    """In real time: the vehicle's own failsafe must not act while the server starts again."""
    with serving(tmp_path, speedup=1.0) as made:
        yield made


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Server]:
    """One for a whole module: a test that flies leaves the vehicle where the next one wants it."""
    with serving(tmp_path_factory.mktemp("served")) as made:
        yield made


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    path = shutil.which("chromium")
    if path is None:
        pytest.skip("no chromium on this machine: make browser")
    with sync_playwright() as playwright:
        chromium = playwright.chromium.launch(executable_path=path, args=CHROMIUM)
        yield chromium
        chromium.close()


@pytest.fixture
def open_screen(request: pytest.FixtureRequest, browser: Browser) -> Iterator[OpenScreen]:
    """Opens a page as another device would: own storage. Faults of the page fail the test."""
    contexts: list[BrowserContext] = []
    faults: list[str] = []

    def make(
        server: Server,
        path: str = "",
        settings: dict[str, Any] | None = None,
        every_frame: bool = False,
        **options: Any,
    ) -> Screen:
        wanted: dict[str, Any] = {"viewport": {"width": 1280, "height": 800}} | options
        context = browser.new_context(**wanted)
        contexts.append(context)
        stored = json.dumps(SETTINGS | (settings or {}))
        context.add_init_script(
            f"if (!localStorage.getItem('crossfix.settings')) localStorage.setItem('crossfix.settings', {stored!r})"
        )
        if not every_frame:
            context.add_init_script(FEW_FRAMES)
        page: Page = context.new_page()
        page.set_default_timeout(30_000)
        page.on("pageerror", lambda error: faults.append(str(error)))
        page.goto(server.url.rstrip("/") + "/" + path)
        return Screen(page, server.url)

    yield make
    for number, context in enumerate(contexts):
        if request.node.stash.get(FAILED, False):
            RESULTS.mkdir(exist_ok=True)
            for page in context.pages:
                page.screenshot(path=RESULTS / f"{request.node.name}-{number}.png")
        context.close()
    assert faults == []


@pytest.fixture
def screen(server: Server, open_screen: OpenScreen) -> Screen:
    return open_screen(server)


@pytest.fixture
def editor(screen: Screen) -> Screen:
    """A new mission, with the area that is suggested."""
    screen.go("#/new")
    screen.map_ready("edit-map")
    expect(screen.part("area-size")).to_have_attribute("data-suggested", "true")
    return screen
