"""The server: settings in, a running application out."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncGenerator, Callable
from contextlib import AbstractAsyncContextManager, asynccontextmanager

import uvicorn
from fastapi import FastAPI

from backend.api.application import make_application
from backend.api.gate import lay_routes
from backend.api.scene import close_scene_views
from backend.api.services import Services
from backend.live.connections import Door, allow_descriptors, limited
from backend.live.protocol import LiveProtocol
from backend.settings import Settings
from backend.wiring import open_services
from hardware.payload.messages import MAXIMUM_MESSAGE_BYTES

HEAD_BYTES = 32 * 2**10
"""Of a request: its line and all its headers."""

OTHER_DESCRIPTORS = 200
"""For the database, the vehicle, files and logs."""
LEAST_CONNECTIONS = 50
LET_IN_AT_ONCE = 32
"""Connections in one turn of the event loop: a thousand at once do not hold up those who are inside."""

OpenServices = Callable[[Settings], AbstractAsyncContextManager[Services]]


def create_app(settings: Settings, opening: OpenServices = open_services) -> FastAPI:
    """`opening` makes the parts behind the API and takes them down again."""

    @asynccontextmanager
    async def lifespan(app: FastAPI) -> AsyncGenerator[None]:
        laying = asyncio.create_task(asyncio.to_thread(lay_routes, app))
        async with opening(settings) as services:
            app.state.services = services
            await laying
            try:
                async with app.state.meters.watched_loop():
                    yield
            finally:
                await close_scene_views(app)

    return make_application(settings, lifespan)


def server_config(settings: Settings, app: FastAPI) -> uvicorn.Config:
    """How uvicorn runs it: one process, since the vehicle has one commander; no compression on the live channel; only a
    trusted proxy may say who asks."""
    room = allow_descriptors() - settings.live_clients_max - OTHER_DESCRIPTORS
    door = Door(
        max(LEAST_CONNECTIONS, min(settings.connections_max, room)),
        settings.connections_each,
        settings.header_timeout_s,
        settings.trusted_proxies,
    )
    return uvicorn.Config(
        app,
        http=limited(door),  # type: ignore[arg-type]  # a factory does where uvicorn names a class
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
