"""The server: settings in, a running application out."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncGenerator, Callable
from contextlib import AbstractAsyncContextManager, asynccontextmanager

from fastapi import FastAPI

from backend.api.application import make_application
from backend.api.gate import lay_routes
from backend.api.scene import close_scene_views
from backend.api.services import Services
from backend.settings import Settings
from backend.wiring import open_services

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
