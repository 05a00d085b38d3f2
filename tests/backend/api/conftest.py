"""The application around a real journal and hub, with a mission room of facts only (no vehicle)."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path
from uuid import uuid4

import httpx
import pytest
import uvicorn
from fastapi import FastAPI

from backend.api.application import make_application
from backend.api.services import Services
from backend.commands import CommandReply, CommandRequest
from backend.events import MissionDrafted, MissionEdited, PreflightChecked
from backend.live.hub import Hub
from backend.live.protocol import LiveProtocol
from backend.mission.errors import MissionConflict, MissionNotFound
from backend.settings import Settings
from backend.spec import MissionSpec
from backend.store.engine import make_engine, migrate
from backend.store.journal import SqlJournal
from backend.store.spool import Spool
from hardware.direction_finding.estimate import SparseDirectionFinder
from hardware.direction_finding.pattern_file import SMALL_YAGI, load_pattern
from hardware.payload.session import PayloadHub
from hardware.readings import GeoPoint, Telemetry

TOKEN = "a token of sixteen letters or more"
NOW_S = 1_700_000_000.0


class PaperMissions:
    """Keeps drafts; refuses every command, since nothing flies here."""

    def __init__(self, journal: SqlJournal, hub: Hub) -> None:
        self.journal, self.hub = journal, hub
        self.asked: list[CommandRequest] = []
        self.heard = Telemetry(connected=True, at_s=NOW_S, home=GeoPoint(50.6, 7.2), autopilot="px4")

    async def create(self, spec: MissionSpec, by: str) -> str:
        mission_id = uuid4().hex
        self.hub.events(await self.journal.append(mission_id, [MissionDrafted(spec=spec)]))
        return mission_id

    async def edit(self, mission_id: str, spec: MissionSpec, by: str) -> None:
        digest = await self.journal.mission(mission_id)
        if digest is None:
            raise MissionNotFound(mission_id)
        if digest.phase != "draft":
            raise MissionConflict("the mission has started", "draft a new one")
        self.hub.events(await self.journal.append(mission_id, [MissionEdited(spec=spec)]))

    async def command(self, mission_id: str, request: CommandRequest, by: str) -> CommandReply:
        digest = await self.journal.mission(mission_id)
        if digest is None:
            raise MissionNotFound(mission_id)
        self.asked.append(request)
        reason = "nothing flies here"
        return CommandReply(
            command_id=request.command_id, accepted=False, reason=reason, remedy="", seq=digest.last_seq
        )

    async def preflight(self, mission_id: str) -> PreflightChecked:
        if await self.journal.mission(mission_id) is None:
            raise MissionNotFound(mission_id)
        return PreflightChecked(passed=False, checks=[])

    def telemetry(self) -> Telemetry:
        return self.heard


@pytest.fixture
def settings(tmp_path: Path) -> Settings:
    page = tmp_path / "page"
    (page / "assets").mkdir(parents=True)
    (page / "index.html").write_text("<!doctype html><title>Crossfix</title>")
    (page / "assets" / "app-1a2b.js").write_text("0")
    return Settings(data_dir=tmp_path / "data", page_dir=page)


@asynccontextmanager
async def running_services(settings: Settings) -> AsyncIterator[Services]:
    await migrate(settings.async_database_url)
    spool = Spool(settings.spool_path, 64 * 1024)
    journal = SqlJournal(make_engine(settings.async_database_url, 2.0), spool, lambda: NOW_S)
    hub = Hub(journal.read, lambda: NOW_S)
    try:
        payload = PayloadHub((TOKEN,), lambda: NOW_S)
        yield Services(
            PaperMissions(journal, hub),
            journal,
            hub,
            settings,
            lambda: NOW_S,
            payload,
            finder=SparseDirectionFinder(),
            pattern=load_pattern(SMALL_YAGI),
        )
    finally:
        await journal.close()


@pytest.fixture
async def services(settings: Settings) -> AsyncIterator[Services]:
    async with running_services(settings) as services:
        yield services


@pytest.fixture
def app(services: Services, settings: Settings) -> FastAPI:
    @asynccontextmanager
    async def nothing(_: FastAPI) -> AsyncIterator[None]:
        yield

    app = make_application(settings, nothing)
    app.state.services = services
    return app


@pytest.fixture
async def client(app: FastAPI) -> AsyncIterator[httpx.AsyncClient]:
    transport = httpx.ASGITransport(app, raise_app_exceptions=False)
    async with httpx.AsyncClient(transport=transport, base_url="http://127.0.0.1") as client:
        yield client


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
