"""The application around a real journal, hub and mission room; its vehicle is paper and never flies."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from functools import cache
from pathlib import Path

import httpx
import pytest
import uvicorn
from equipment import FlatVehicle, HummingReceiver
from fastapi import FastAPI
from starlette.routing import BaseRoute
from stepped_clock import SteppedClock

from backend.api.application import make_application
from backend.api.gate import lay_routes
from backend.api.services import Services
from backend.auth.access import Access
from backend.auth.audit import AuditLog
from backend.craft.equipment import CraftEquipment
from backend.events import FIRST_CRAFT
from backend.live.hub import Hub
from backend.live.protocol import LiveProtocol
from backend.mission.equipment import MissionEquipment
from backend.mission.room import mission_room
from backend.settings import Settings
from backend.store.engine import make_engine, migrate
from backend.store.journal import SqlJournal
from backend.store.lessons_folder import LessonsFolder
from backend.store.spool import Spool
from backend.workers import Workers
from hardware.direction_finding.estimate import SparseDirectionFinder
from hardware.direction_finding.pattern_file import SMALL_YAGI, load_pattern
from hardware.payload.session import PayloadHub
from hardware.readings import Place, Telemetry

TOKEN = "a token of sixteen letters or more"
NOW_S = 1_700_000_000.0


class PaperVehicle(FlatVehicle):
    """Heard as `heard` says."""

    def __init__(self) -> None:
        super().__init__(SteppedClock(NOW_S))
        self.heard_last = Telemetry(connected=True, at_s=NOW_S, home=Place(50.6, 7.2), autopilot="px4")

    def telemetry(self) -> Telemetry:
        return self.heard_last


@pytest.fixture
def settings(tmp_path: Path) -> Settings:
    page = tmp_path / "page"
    (page / "assets").mkdir(parents=True)
    (page / "index.html").write_text("<!doctype html><title>Crossfix</title>")
    (page / "assets" / "app-1a2b.js").write_text("0")
    return Settings(data_dir=tmp_path / "data", page_dir=page)


@asynccontextmanager
async def running_services(settings: Settings, vehicle: PaperVehicle, workers: Workers) -> AsyncIterator[Services]:
    await migrate(settings.async_database_url)
    spool = Spool(settings.spool_path, 64 * 1024)
    journal = SqlJournal(make_engine(settings.async_database_url, 2.0), spool, lambda: NOW_S)
    hub, clock = Hub(journal.read_texts, lambda: NOW_S), SteppedClock(NOW_S)
    finder, pattern = SparseDirectionFinder(), load_pattern(SMALL_YAGI)
    craft = CraftEquipment(FIRST_CRAFT, vehicle, HummingReceiver(clock), finder, pattern, clock, hub)
    lessons = LessonsFolder(settings.data_dir / "lessons")
    room = mission_room(MissionEquipment({FIRST_CRAFT: craft}, journal, hub, clock, "test", lessons=lessons))
    try:
        payload = PayloadHub((TOKEN,), lambda: NOW_S)
        access = Access(None, AuditLog(None, lambda: NOW_S), people_expected=False)
        services = Services(
            room, journal, hub, settings, lambda: NOW_S, payload, workers,
            access=access, finder=finder, pattern=pattern, wall=lambda: NOW_S,
        )  # fmt: skip
        yield services
        for stock in services.stocks.values():
            await stock.close()
    finally:
        await journal.close()


@pytest.fixture
def vehicle() -> PaperVehicle:
    return PaperVehicle()


@pytest.fixture
async def services(settings: Settings, vehicle: PaperVehicle, workers: Workers) -> AsyncIterator[Services]:
    async with running_services(settings, vehicle, workers) as services:
        yield services


@asynccontextmanager
async def nothing(_: FastAPI) -> AsyncIterator[None]:
    """The services are there already."""
    yield


@cache
def laid_routes() -> list[BaseRoute]:
    """The application's, which do not depend on its settings. FastAPI lays them out with the models of their requests
    when it first looks at them, which takes a tenth of a second: once for all tests."""
    app = make_application(Settings(), nothing)
    lay_routes(app)
    return app.router.routes


def application(services: Services, settings: Settings) -> FastAPI:
    app = make_application(settings, nothing)
    app.router.routes[:] = laid_routes()
    app.state.services = services
    return app


@pytest.fixture
def app(services: Services, settings: Settings) -> FastAPI:
    return application(services, settings)


@pytest.fixture
async def client(app: FastAPI) -> AsyncIterator[httpx.AsyncClient]:
    transport = httpx.ASGITransport(app, raise_app_exceptions=False)
    async with httpx.AsyncClient(transport=transport, base_url="http://127.0.0.1") as client:
        yield client


@pytest.fixture
async def elsewhere(tmp_path: Path, workers: Workers) -> AsyncIterator[tuple[httpx.AsyncClient, Services]]:
    """Another installation: its own database, its own vehicle."""
    settings = Settings(data_dir=tmp_path / "elsewhere", page_dir=tmp_path)
    async with running_services(settings, PaperVehicle(), workers) as services:
        transport = httpx.ASGITransport(application(services, settings), raise_app_exceptions=False)
        async with httpx.AsyncClient(transport=transport, base_url="http://127.0.0.1") as client:
            yield client, services


@pytest.fixture
async def served(app: FastAPI) -> AsyncIterator[str]:
    """host:port of the application on a real socket."""
    config = uvicorn.Config(
        app, port=0, ws=LiveProtocol, ws_ping_interval=0.5, ws_ping_timeout=1.0, log_level="warning", lifespan="off"
    )
    server = uvicorn.Server(config)
    running = asyncio.create_task(server.serve())
    while not server.started:  # noqa: ASYNC110 (uvicorn has no event for it)
        await asyncio.sleep(0.01)
    yield f"127.0.0.1:{server.servers[0].sockets[0].getsockname()[1]}"
    server.should_exit = True
    await running
