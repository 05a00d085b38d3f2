"""What answers from the first second on: the page at once, everything else as soon as the application is there.

Loading the application takes seconds, in which a browser fetches and reads the page.
"""

from __future__ import annotations

import asyncio
import socket
from collections.abc import AsyncGenerator, Generator
from contextlib import asynccontextmanager, contextmanager
from dataclasses import dataclass

import uvicorn
from starlette.datastructures import Headers
from starlette.responses import PlainTextResponse
from starlette.types import ASGIApp, Receive, Scope, Send

from backend.api.hosts import Hosts, secured
from backend.api.page_files import PageFiles, send_file
from backend.live.connections import Door, allow_descriptors, limited
from backend.live.protocol import LiveProtocol
from backend.settings import Settings
from hardware.payload.limits import MAXIMUM_MESSAGE_BYTES

HEAD_BYTES = 32 * 2**10
"""Of a request: its line and all its headers."""

OTHER_DESCRIPTORS = 200
"""For the database, the vehicle, files and logs."""
LEAST_CONNECTIONS = 50
LET_IN_AT_ONCE = 32
"""Connections in one turn of the event loop: a thousand at once do not hold up those who are inside."""
WAITING_TO_ENTER = 2048
"""Connections that the system keeps until they are let in: the event loop takes those of a crowd a few at a time."""


class CannotServe(RuntimeError):
    """The server cannot start; the message says why and what to try."""


class Front:
    """ASGI application in front of the one that is still being loaded. What it cannot answer waits for that one, which
    alone decides who may ask for what."""

    def __init__(self, settings: Settings) -> None:
        self._hosts = Hosts(settings.names)
        self._files = PageFiles(settings.page_dir)
        self._behind = asyncio.get_running_loop().create_future()

    def lead_to(self, application: ASGIApp) -> None:
        """From now on it answers everything."""
        self._behind.set_result(application)

    def give_up(self) -> None:
        """There will be no application: who waits for it is told."""
        if not self._behind.done():
            self._behind.set_result(_not_started)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """One request, or one websocket."""
        if not self._behind.done() and await self._early(scope, receive, send):
            return
        application: ASGIApp = await asyncio.shield(self._behind)
        await application(scope, receive, send)

    async def _early(self, scope: Scope, receive: Receive, send: Send) -> bool:
        """Answer with a file of the page, if that is asked for under one of our names."""
        if scope["type"] != "http" or scope["method"] not in {"GET", "HEAD"} or not self._files.built:
            return False
        host = Headers(scope=scope).get("host", "")
        found = await self._files.find(scope) if self._hosts.ours(host) else None
        if found is None:
            return False
        try:
            await send_file(found, scope, receive, secured(send, host, scope["path"]))
        except FileNotFoundError:
            return False
        return True


async def _not_started(scope: Scope, receive: Receive, send: Send) -> None:
    if scope["type"] == "websocket":
        await send({"type": "websocket.close", "code": 1013, "reason": "the server could not start"})
        return
    answer = PlainTextResponse("The server could not start. Its messages say why.", 503, {"cache-control": "no-store"})
    await answer(scope, receive, send)


class _Server(uvicorn.Server):
    """Says when it answers. Leaves signals to `stop_on_signals`: uvicorn would raise them again once it has stopped,
    and end the process before the vehicle and the journal are closed."""

    def __init__(self, config: uvicorn.Config) -> None:
        super().__init__(config)
        self.ready = asyncio.Event()

    @contextmanager
    def capture_signals(self) -> Generator[None]:
        yield

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        await super().startup(sockets)
        for bound in sockets or ():
            bound.listen(WAITING_TO_ENTER)
        self.ready.set()


@dataclass(frozen=True, slots=True)
class OpenedFront:
    """url: of the page, without a trailing slash. gone: when the server has ended."""

    url: str
    front: Front
    server: uvicorn.Server
    gone: asyncio.Task[None]

    async def end(self) -> None:
        """Answers to what is under way are waited for."""
        self.front.give_up()
        self.server.should_exit = True
        await asyncio.gather(self.gone, return_exceptions=True)


@asynccontextmanager
async def opened_front(settings: Settings) -> AsyncGenerator[OpenedFront]:
    """Answers inside the block, is down after it. Raises CannotServe."""
    bound = _bind(settings.host, settings.port)
    try:
        front = Front(settings)
        server = _Server(server_config(settings, front))
        gone = asyncio.create_task(server.serve(sockets=[bound]))
        ready = asyncio.create_task(server.ready.wait())
        await asyncio.wait({gone, ready}, return_when=asyncio.FIRST_COMPLETED)
        ready.cancel()
        if gone.done():
            raise CannotServe("the server stopped while it started")
        host = f"[{settings.host}]" if ":" in settings.host else settings.host
        shown = "127.0.0.1" if host in ("0.0.0.0", "[::]") else host
        opened = OpenedFront(f"http://{shown}:{bound.getsockname()[1]}", front, server, gone)
        try:
            yield opened
        finally:
            await opened.end()
    finally:
        bound.close()


def server_config(settings: Settings, application: ASGIApp) -> uvicorn.Config:
    """How uvicorn runs it: one process, since the vehicle has one commander; no compression on the live channel; only a
    trusted proxy may say who asks. Who gives the application runs its lifespan."""
    room = allow_descriptors() - settings.live_clients_max - OTHER_DESCRIPTORS
    door = Door(
        max(LEAST_CONNECTIONS, min(settings.connections_max, room)),
        settings.connections_each,
        settings.header_timeout_s,
        settings.trusted_proxies,
    )
    return uvicorn.Config(
        application,
        http=limited(door),  # type: ignore[arg-type]  # a factory does where uvicorn names a class
        lifespan="off",
        proxy_headers=bool(settings.trusted_proxies),
        forwarded_allow_ips=list(settings.trusted_proxies),
        h11_max_incomplete_event_size=HEAD_BYTES,
        host=settings.host,
        port=settings.port,
        backlog=LET_IN_AT_ONCE,
        ws=LiveProtocol,
        ws_max_size=MAXIMUM_MESSAGE_BYTES,
        ws_per_message_deflate=False,
        ws_ping_interval=settings.live_ping_interval_s,
        ws_ping_timeout=settings.live_ping_timeout_s,
        timeout_graceful_shutdown=5,
        access_log=False,
        server_header=False,
        log_level="warning",
    )


def _bind(host: str, port: int) -> socket.socket:
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    bound = socket.socket(family, socket.SOCK_STREAM)
    bound.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        bound.bind((host, port))
    except OSError as error:
        bound.close()
        raise CannotServe(
            f"cannot listen on {host} port {port}: {error.strerror}; choose another with "
            f"{'--host' if isinstance(error, socket.gaierror) else '--port'}"
        ) from error
    bound.set_inheritable(False)
    return bound
