"""The 3D scene: what each viewer's scene shows, and viser's page and websocket on our own port under /scene/.

viser listens on a private loopback port. Its page and its websocket pass through here, so that they have the same
origin, the same access rules and the same port as everything else. `/scene/?mission=ID&seq=N` makes a view of its own.
"""

from __future__ import annotations

import asyncio
import hashlib
import socket
from secrets import token_urlsafe
from typing import Annotated

import websockets
from fastapi import APIRouter, Depends, FastAPI, Path, Query, Request, Response, WebSocket, WebSocketDisconnect
from fastapi.requests import HTTPConnection
from fastapi.responses import RedirectResponse
from websockets.asyncio.client import ClientConnection

from backend.api.dependencies import PrincipalDep, ServicesDep
from backend.api.problems import PROBLEM_RESPONSES, ApiProblem, not_found
from backend.api.services import Services
from backend.events import Recorded
from backend.ports import TrackPoint
from backend.reasons.request import SceneSilent, TooManyScenes
from backend.scene.views import SceneViews, TooManyViews
from backend.terrain import Terrain
from backend.wire.scene import SceneRequest, SceneView
from hardware.readings import Telemetry

router = APIRouter(prefix="/api/scene", tags=["scene"], responses=PROBLEM_RESPONSES)
pages = APIRouter(include_in_schema=False)

ViewId = Annotated[str, Path(pattern=r"^[A-Za-z0-9_-]{8,64}$", description="Made by the page, one a tab")]
MissionQuery = Annotated[str | None, Query(pattern=r"^[A-Za-z0-9_-]{1,64}$")]
SeqQuery = Annotated[int | None, Query(ge=1, le=2**31 - 1)]

CLOSED_BY_VISER = 1011


class ServicesSource:
    """backend.scene.sources.SceneSource on the application's services."""

    def __init__(self, services: Services) -> None:
        self._services = services

    def flying(self) -> str | None:
        """None when nothing flies."""
        active = self._services.missions.flights.active
        return None if active is None else active.mission_id

    def telemetry(self) -> Telemetry:
        """Of the first craft, the one that scenes show."""
        return self._services.missions.equipment.first.vehicle.telemetry()

    def now_s(self) -> float:
        """UTC epoch seconds of the mission's clock."""
        return self._services.now()

    async def last_seq(self, mission_id: str) -> int | None:
        """From the digest: cheap enough to be asked several times a second."""
        digest = await self._services.journal.mission(mission_id)
        return None if digest is None else digest.last_seq

    async def read(self, mission_id: str) -> list[Recorded]:
        """The whole journal of a mission."""
        return list(await self._services.journal.read(mission_id))

    async def track(self, mission_id: str) -> list[TrackPoint]:
        """Of all craft, one after the other."""
        tracks = await self._services.journal.tracks(mission_id)
        return [point for track in tracks.values() for point in track]

    async def ground(self, digest: str) -> Terrain | None:
        """What a mission was flown over; None when it is lost."""
        return await self._services.missions.equipment.grounds.kept(digest)


def scene_views(connection: HTTPConnection) -> SceneViews:
    """One for the application, made with the first 3D view; the application's end closes it."""
    state = connection.app.state
    if not hasattr(state, "scene_views"):
        state.scene_views = SceneViews(ServicesSource(state.services))
    return state.scene_views


async def close_scene_views(app: FastAPI) -> None:
    """At the application's end."""
    if hasattr(app.state, "scene_views"):
        await app.state.scene_views.close()


SceneViewsDep = Annotated[SceneViews, Depends(scene_views)]


async def _show(views: SceneViews, services: Services, view_id: str, request: SceneRequest) -> SceneView:
    if request.mission_id is not None and await services.journal.mission(request.mission_id) is None:
        raise not_found("mission", request.mission_id)
    try:
        return views.show(view_id, request)
    except TooManyViews as error:
        raise ApiProblem(409, TooManyScenes()) from error


@router.put("/views/{view_id}")
async def show_scene(
    view_id: ViewId, request: SceneRequest, views: SceneViewsDep, services: ServicesDep, principal: PrincipalDep
) -> SceneView:
    """Say what a view shows; an open frame changes at once."""
    return await _show(views, services, view_id, request)


@router.get("/views/{view_id}")
async def get_scene_view(view_id: ViewId, views: SceneViewsDep, principal: PrincipalDep) -> SceneView:
    """What a view shows now."""
    view = views.view(view_id)
    if view is None:
        raise not_found("scene", view_id)
    return view


@pages.get("/scene", response_class=Response)
@pages.get("/scene/", response_class=Response)
async def new_scene(
    views: SceneViewsDep,
    services: ServicesDep,
    principal: PrincipalDep,
    mission: MissionQuery = None,
    seq: SeqQuery = None,
) -> Response:
    """A view of its own for whoever comes by the address alone."""
    view = await _show(views, services, token_urlsafe(12), SceneRequest(mission_id=mission, seq=seq))
    return RedirectResponse(view.url, status_code=303, headers={"cache-control": "no-store"})


@pages.get("/scene/{view_id}/", response_class=Response)
async def scene_page(
    view_id: ViewId, request: Request, views: SceneViewsDep, services: ServicesDep, principal: PrincipalDep
) -> Response:
    """viser's page, one file that holds all it needs. A view that is not known follows the live mission."""
    if views.view(view_id) is None:
        await _show(views, services, view_id, SceneRequest())
    try:
        page = await views.page()
    except OSError as error:
        raise ApiProblem(503, SceneSilent()) from error
    tag = f'"{hashlib.sha256(page).hexdigest()[:16]}"'
    headers = {"etag": tag, "cache-control": "no-cache", "content-security-policy": _policy(request)}
    if request.headers.get("if-none-match") == tag:
        return Response(status_code=304, headers=headers)
    return Response(page, media_type="text/html; charset=utf-8", headers=headers)


def _policy(request: Request) -> str:
    """viser unpacks its own script and WASM inside the page; nothing comes from another machine."""
    host = request.headers.get("host", "")
    return (
        "default-src 'none'; script-src 'unsafe-inline' 'unsafe-eval' blob:; worker-src blob: data:; "
        "style-src 'unsafe-inline'; img-src data: blob:; font-src data:; "
        f"connect-src ws://{host} wss://{host} data: blob:; frame-ancestors 'self'; base-uri 'none'; form-action 'none'"
    )


@pages.websocket("/scene/{view_id}")
async def scene_socket(websocket: WebSocket, view_id: ViewId, views: SceneViewsDep, principal: PrincipalDep) -> None:
    """viser's websocket, passed through in both directions."""
    server = await views.server()
    if server.subprotocol not in websocket.scope["subprotocols"]:
        await websocket.close(1002, f"the page is not of this server's version ({server.subprotocol}): load it again")
        return
    if views.view(view_id) is None:
        try:
            views.show(view_id, SceneRequest())
        except TooManyViews:
            await websocket.close(1013, "too many 3D views are open")
            return
    port = server.port
    with socket.socket() as own:
        own.setblocking(False)
        own.bind(("127.0.0.1", 0))
        local_port = own.getsockname()[1]
        server.announce(local_port, view_id)
        try:
            await asyncio.get_running_loop().sock_connect(own, ("127.0.0.1", port))
            async with websockets.connect(
                f"ws://127.0.0.1:{port}/",
                sock=own,
                subprotocols=[websockets.Subprotocol(server.subprotocol)],
                compression=None,
                max_size=None,
                proxy=None,
            ) as upstream:
                await websocket.accept(server.subprotocol)
                await _pass_through(websocket, upstream)
        finally:
            server.forget(local_port)


async def _pass_through(websocket: WebSocket, upstream: ClientConnection) -> None:
    """Until one side is gone. A slow browser slows its own window down: nothing is read from viser meanwhile."""

    async def inwards() -> None:
        while True:
            message = await websocket.receive()
            if message["type"] == "websocket.disconnect":
                return
            content = message.get("bytes")
            await upstream.send(message.get("text", "") if content is None else content)

    async def outwards() -> None:
        async for content in upstream:
            if isinstance(content, bytes):
                await websocket.send_bytes(content)
            else:
                await websocket.send_text(content)
        await websocket.close(CLOSED_BY_VISER, "the 3D server went away")

    tasks = [asyncio.create_task(inwards()), asyncio.create_task(outwards())]
    try:
        await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
    finally:
        for task in tasks:
            task.cancel()
        results = await asyncio.gather(*tasks, return_exceptions=True)
    for result in results:
        expected = (asyncio.CancelledError, WebSocketDisconnect, websockets.ConnectionClosed)
        if isinstance(result, Exception) and not isinstance(result, expected):
            raise result
