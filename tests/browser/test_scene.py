"""The 3D scene in a real browser: drawn, following, changed from outside, and nothing leaves the machine."""

from __future__ import annotations

import io
import time
from collections.abc import Callable, Iterator
from urllib.parse import urlsplit
from uuid import uuid4

import httpx
import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import Browser, Page
from served import Server

pytestmark = [pytest.mark.browser, pytest.mark.long]

PATIENCE_S = 120.0
"""Software rendering on a busy machine takes its time."""


class SceneTab:
    """A browser tab with the scene, and every address it asked for."""

    def __init__(self, browser: Browser, server: Server) -> None:
        self.server = server
        self.context = browser.new_context(viewport={"width": 900, "height": 600})
        self.page: Page = self.context.new_page()
        self.page.set_default_timeout(PATIENCE_S * 1000)
        self.asked: list[str] = []
        self.faults: list[str] = []
        self.page.on("request", lambda request: self.asked.append(request.url))
        self.page.on("websocket", lambda socket: self.asked.append(socket.url))
        self.page.on("pageerror", lambda error: self.faults.append(str(error)))

    def open(self, **query: str) -> str:
        """The id of the view it came to."""
        self.page.goto(f"{self.server.url.rstrip('/')}/scene/?{httpx.QueryParams(query)}")
        return urlsplit(self.page.url).path.split("/")[2]

    def show(self, view_id: str, **request: object) -> None:
        answer = httpx.put(f"{self.server.url.rstrip('/')}/api/scene/views/{view_id}", json=request, timeout=20)
        answer.raise_for_status()

    def picture(self) -> np.ndarray:
        """(height, width, 3) of the left two thirds, where no panel is."""
        picture = np.asarray(Image.open(io.BytesIO(self.page.screenshot())).convert("RGB"))
        return picture[150:, :600].astype(int)

    def wait_for(self, condition: Callable[[], bool], what: str) -> None:
        until = time.monotonic() + PATIENCE_S
        while not condition():
            assert time.monotonic() < until, f"{what} did not come"
            self.page.wait_for_timeout(250)


@pytest.fixture
def tab(browser: Browser, server: Server) -> Iterator[SceneTab]:
    tab = SceneTab(browser, server)
    yield tab
    tab.context.close()
    assert tab.faults == []
    hosts = {urlsplit(url).hostname for url in tab.asked if not url.startswith(("data:", "blob:"))}
    assert hosts == {"127.0.0.1"}


def outlined(picture: np.ndarray) -> bool:
    """The light ink that outlines the area on the dark ground; a page that is still empty is white all over."""
    return bool(np.median(picture) < 60 and (picture.min(axis=2) > 190).sum() > 300)


def test_a_draft_is_drawn_and_changes_with_what_it_is_told(server: Server, tab: SceneTab) -> None:
    view_id = tab.open(mission=(mission_id := server.draft()))
    tab.wait_for(lambda: outlined(tab.picture()), "the area's outline on dark ground")
    view = server.get(f"/api/scene/views/{view_id}")
    assert (view["mission_id"], view["watchers"]) == (mission_id, 1)

    tab.show(view_id, mission_id=mission_id, theme="light")
    tab.wait_for(lambda: np.median(tab.picture()) > 200, "the light theme")
    with_belief = tab.picture()
    tab.show(view_id, mission_id=mission_id, theme="light", hidden=["belief"])
    tab.wait_for(lambda: (np.abs(tab.picture() - with_belief).max(axis=2) > 20).sum() > 2000, "the hidden belief")


def test_it_follows_the_flight_and_a_second_viewer_looks_back(server: Server, tab: SceneTab, browser: Browser) -> None:
    mission_id = server.draft(expected_rmse_m=0.1)
    view_id = tab.open()
    start(server, mission_id)

    def told() -> dict:
        return server.get(f"/api/scene/views/{view_id}")

    def bearings() -> int:
        return server.get(f"/api/missions/{mission_id}")["bearings"]

    tab.wait_for(lambda: told()["mission_id"] == mission_id, "the mission")
    tab.wait_for(lambda: bearings() >= 1, "the first bearing")
    last = server.get(f"/api/missions/{mission_id}")["last_seq"]
    tab.wait_for(lambda: told()["shown_seq"] >= last, "the newest event")
    tab.wait_for(lambda: roses(tab.picture()) > 200, "the rose of the sweep")

    tab.page.close()  # the processor draws one scene at a time
    before = SceneTab(browser, server)
    try:
        then = before.open(mission=mission_id, seq="1")
        before.wait_for(lambda: outlined(before.picture()), "the draft")
        assert server.get(f"/api/scene/views/{then}")["shown_seq"] == 1
        assert roses(before.picture()) < 20
    finally:
        before.context.close()


def roses(picture: np.ndarray) -> int:
    """Pixels in the roses' teal."""
    red, green, blue = picture[..., 0], picture[..., 1], picture[..., 2]
    return int(((green > red + 50) & (blue > red + 50) & (abs(green - blue) < 40)).sum())


def start(server: Server, mission_id: str) -> None:
    base = server.url.rstrip("/")
    until = time.monotonic() + PATIENCE_S
    while not httpx.post(f"{base}/api/missions/{mission_id}/preflight", timeout=30).json()["passed"]:
        assert time.monotonic() < until, "the checklist does not pass"
        time.sleep(0.5)
    answer = {"accepted": False}
    while not answer["accepted"]:
        assert time.monotonic() < until, answer
        command = {"command_id": str(uuid4()), "command": {"kind": "start"}}
        answer = httpx.post(f"{base}/api/missions/{mission_id}/commands", json=command, timeout=30).json()
        time.sleep(0.2)
