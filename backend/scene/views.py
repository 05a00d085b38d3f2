"""Which viewer watches what: views with their windows, each kept up to date at the pace its window takes.

A view belongs to one tab of a browser. It follows the live mission or stands at one event of a stored one; what it
shows may be changed at any time, the newest wish wins. Everything here runs on the application's event loop; composing
and drawing run in threads.
"""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from backend.scene.composer import Composer, Take
from backend.scene.drawer import Drawer
from backend.scene.sources import SceneSource
from backend.wire.scene import SceneRequest, SceneView

if TYPE_CHECKING:  # loaded with the first view
    import viser

    from backend.scene.server import Closed, Opened, SceneServer

log = logging.getLogger("crossfix.scene")

LIVE_TICK_S, TICK_S = 0.2, 1.0
"""How often the scene of a flying mission, and of any other, looks for something new."""

KEPT_S = 600.0
MOST_VIEWS = 64


class TooManyViews(RuntimeError):
    """More 3D views are watched than are allowed."""


@dataclass(eq=False)
class View:
    """take: what was shown last. idle_since: loop time since when nobody watches. faults: failed refreshes in a row."""

    view_id: str
    request: SceneRequest
    idle_since: float
    windows: dict[int, Drawer] = field(default_factory=dict[int, Drawer])
    take: Take | None = None
    last_mission_id: str | None = None
    wake: asyncio.Event = field(default_factory=asyncio.Event)
    task: asyncio.Task[None] | None = None
    faults: int = 0


class SceneViews:
    """The viser server starts with the first view."""

    def __init__(self, source: SceneSource) -> None:
        self._source = source
        self._composer = Composer(source)
        self._views: dict[str, View] = {}
        self._server: SceneServer | None = None
        self._starting = asyncio.Lock()
        self._page: bytes | None = None

    async def server(self) -> SceneServer:
        """Started at the first call; callers at the same time get the same one."""
        async with self._starting:
            if self._server is None:
                loop = asyncio.get_running_loop()
                opened, closed = _called_on(loop, self._opened), _called_on(loop, self._closed)
                self._server = await asyncio.to_thread(_start, opened, closed)
            return self._server

    async def page(self) -> bytes:
        """viser's client page, as its server gives it."""
        server = await self.server()
        if self._page is None:
            self._page = await asyncio.to_thread(server.page)
        return self._page

    async def close(self) -> None:
        """Ends every view and the server."""
        tasks = [view.task for view in self._views.values() if view.task is not None]
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)
        self._views.clear()
        if self._server is not None:
            await asyncio.to_thread(self._server.stop)
            self._server = None

    def show(self, view_id: str, request: SceneRequest) -> SceneView:
        """Make or change a view. TooManyViews when there is no room for another."""
        view = self._views.get(view_id)
        if view is None:
            self._make_room()
            view = self._views[view_id] = View(view_id, request, idle_since=asyncio.get_running_loop().time())
        view.request = request
        view.wake.set()
        return self._told(view)

    def view(self, view_id: str) -> SceneView | None:
        """None for an unknown id, or a view that was forgotten."""
        view = self._views.get(view_id)
        return None if view is None else self._told(view)

    def _told(self, view: View) -> SceneView:
        return SceneView(
            view_id=view.view_id,
            url=f"/scene/{view.view_id}/",
            mission_id=self._mission_of(view),
            seq=view.request.seq,
            shown_seq=view.take.story.seq if view.take else 0,
            watchers=len(view.windows),
        )

    def _make_room(self) -> None:
        """Views nobody has watched for a while are forgotten; when there are too many, the longest idle one."""
        now = asyncio.get_running_loop().time()
        idle = sorted((view for view in self._views.values() if not view.windows), key=lambda view: view.idle_since)
        for view in idle:
            if len(self._views) >= MOST_VIEWS or now - view.idle_since > KEPT_S:
                del self._views[view.view_id]
        if len(self._views) >= MOST_VIEWS:
            raise TooManyViews

    def _mission_of(self, view: View) -> str | None:
        """A view that follows whatever flies keeps showing the last mission when it is over."""
        return view.request.mission_id or self._source.flying() or view.last_mission_id

    # Windows

    def _opened(self, view_id: str, window: viser.ClientHandle) -> None:
        view = self._views.get(view_id)
        if view is None:
            return
        view.windows[window.client_id] = Drawer(window)
        view.wake.set()
        if view.task is None or view.task.done():
            view.task = asyncio.create_task(self._keep_up(view))

    def _closed(self, view_id: str, number: int) -> None:
        view = self._views.get(view_id)
        if view is None:
            return
        view.windows.pop(number, None)
        if not view.windows:
            view.idle_since = asyncio.get_running_loop().time()
        view.wake.set()

    # Keeping up

    async def _keep_up(self, view: View) -> None:
        while view.windows:
            again = view.wake.is_set()
            view.wake.clear()
            try:
                await self._refresh(view)
                if again or view.take is not None:
                    await self._draw(view)
                view.faults = 0
            except (OSError, RuntimeError, ValueError) as error:
                view.faults += 1
                if view.faults == 1:
                    log.warning("the scene of view %s stays as it is: %s", view.view_id, error)
            try:
                tick_s = LIVE_TICK_S if view.take is not None and view.take.live else TICK_S
                async with asyncio.timeout(tick_s * min(10, 1 + view.faults)):
                    await view.wake.wait()
            except TimeoutError:
                continue

    async def _refresh(self, view: View) -> None:
        """Compose again when the request, the mission or its events changed; else only move the vehicle."""
        request, mission_id = view.request, self._mission_of(view)
        if mission_id is None:
            view.take = None
            return
        view.last_mission_id = mission_id
        if view.take is not None and view.take.request == request and view.take.story.seq == request.seq:
            return
        last_seq = await self._source.last_seq(mission_id)
        if last_seq is None:
            view.take = None
            return
        take = view.take
        wanted = last_seq if request.seq is None else min(request.seq, last_seq)
        live = request.seq is None and mission_id == self._source.flying()
        known = take is not None and (take.mission_id, take.request, take.live) == (mission_id, request, live)
        if take is None or not known or take.story.seq != wanted:
            view.take = await self._composer.take(mission_id, request)
        elif live and (now := self._composer.now()) is not None:
            view.take = self._composer.moved(take, now)

    async def _draw(self, view: View) -> None:
        """In all windows of the view, in threads."""
        take, windows = view.take, list(view.windows.values())
        for window in windows:
            if take is None:
                await asyncio.to_thread(window.clear)
            else:
                await asyncio.to_thread(window.draw, take.scene)


def _start(opened: Opened, closed: Closed) -> SceneServer:
    """Blocks: viser and httpx take an eighth of a second to load, which only a server pays whose 3D view is opened."""
    from backend.scene.server import SceneServer

    return SceneServer(opened, closed)


def _called_on(loop: asyncio.AbstractEventLoop, function: Callable[..., None]) -> Callable[..., None]:
    """A function for other threads that runs `function` on the loop; nothing once the loop is over."""

    def call(*arguments: object) -> None:
        if not loop.is_closed():
            loop.call_soon_threadsafe(function, *arguments)

    return call
