"""Before anybody is let in, what the first request needs is there: an order behind it would wait for that."""

from __future__ import annotations

import threading
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager

import httpx
import pytest
from fastapi.dependencies.utils import get_dependant

from backend import main
from backend.api.services import Services
from backend.settings import Settings


async def test_routes_are_laid_out_in_a_thread_before_the_first_request(
    tmp_path, monkeypatch: pytest.MonkeyPatch
) -> None:
    analysed = list[int]()

    def noted(**given):
        analysed.append(threading.get_ident())
        return get_dependant(**given)

    @asynccontextmanager
    async def opening(_: Settings) -> AsyncIterator[Services]:
        yield object.__new__(Services)

    app = main.create_app(Settings(data_dir=tmp_path, page_dir=tmp_path), opening)
    monkeypatch.setattr("fastapi.routing.get_dependant", noted)
    async with app.router.lifespan_context(app):
        assert len(analysed) > 50
        assert threading.get_ident() not in analysed
        laid = len(analysed)
        transport = httpx.ASGITransport(app)
        async with httpx.AsyncClient(transport=transport, base_url="http://127.0.0.1") as client:
            assert (await client.get("/api/unknown")).status_code == 404
        assert len(analysed) == laid
