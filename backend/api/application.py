"""The FastAPI application around given services."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractAsyncContextManager

from fastapi import Depends, FastAPI

from backend.api import live, payload, probes, problems, scene
from backend.api.bodies import Bodies
from backend.api.dependencies import passed_the_gate
from backend.api.gate import Gate
from backend.api.guard import Guard
from backend.api.meters import Metered, Meters
from backend.api.page import Page
from backend.api.schema import ROUTERS, operation_id
from backend.settings import Settings
from backend.version import VERSION

Lifespan = Callable[[FastAPI], AbstractAsyncContextManager[None]]


def make_application(settings: Settings, lifespan: Lifespan) -> FastAPI:
    """`lifespan` puts the services into app.state.services before the first request."""
    app = FastAPI(
        title="Crossfix",
        version=VERSION,
        lifespan=lifespan,
        docs_url=None,
        redoc_url=None,
        openapi_url=None,
        redirect_slashes=False,
        generate_unique_id_function=operation_id,
        dependencies=[Depends(passed_the_gate)],
    )
    problems.install(app)
    for router in ROUTERS:
        app.include_router(router)
    app.include_router(probes.router)
    app.include_router(live.router)
    app.include_router(payload.router)
    app.include_router(scene.pages)
    app.router.default = Page(settings.page_dir)
    app.state.meters = Meters()
    app.state.meters.watch(lambda: app.state.services)
    app.add_middleware(Bodies)
    app.add_middleware(Metered, meters=app.state.meters)
    app.add_middleware(Gate)
    app.add_middleware(Guard, allowed_hosts=settings.names)
    return app
