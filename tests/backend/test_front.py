"""Before the application is there its page is, and whoever asks for more waits, as long as it takes."""

from __future__ import annotations

import asyncio
from pathlib import Path

import httpx
import pytest
from starlette.responses import PlainTextResponse

from backend.front import CannotServe, Front, opened_front
from backend.settings import Settings

behind = PlainTextResponse("the application")
EARLY = ["/", "/index.html", "/assets/index-1.js"]
LATE = ["/api/missions", "/missing.js", "/some/page", "/assets/../../secret", "/assets", "//assets/index-1.js/"]


@pytest.fixture
def settings(tmp_path: Path) -> Settings:
    page = tmp_path / "page"
    (page / "assets").mkdir(parents=True)
    (page / "index.html").write_text("<!doctype html><title>Crossfix</title>")
    (page / "assets" / "index-1.js").write_text("export {}")
    (tmp_path / "secret").write_text("secret")
    return Settings(data_dir=tmp_path, page_dir=page, port=0)


def client_of(front: Front, host: str = "127.0.0.1") -> httpx.AsyncClient:
    return httpx.AsyncClient(transport=httpx.ASGITransport(front), base_url=f"http://{host}")


async def waits(asked: asyncio.Task[httpx.Response]) -> bool:
    await asyncio.sleep(0.05)
    return not asked.done()


@pytest.mark.parametrize("path", EARLY)
async def test_a_file_of_the_page_is_there_at_once(settings: Settings, path: str) -> None:
    front = Front(settings)
    async with client_of(front) as client:
        found = await client.get(path)
        again = await client.get(path, headers={"if-none-match": found.headers["etag"]})
    assert found.status_code == 200
    assert again.status_code == 304
    assert "default-src 'self'" in found.headers["content-security-policy"]
    assert ("immutable" in found.headers["cache-control"]) == path.startswith("/assets/")


@pytest.mark.parametrize(
    ("method", "path", "host"),
    [
        *(("GET", path, "127.0.0.1") for path in LATE),
        ("POST", "/", "127.0.0.1"),
        ("DELETE", "/assets/index-1.js", "127.0.0.1"),
        *(("GET", path, "rebound.example") for path in EARLY),
    ],
)
async def test_everything_else_is_decided_by_the_application(
    settings: Settings, method: str, path: str, host: str
) -> None:
    front = Front(settings)
    async with client_of(front, host) as client:
        asked = asyncio.create_task(client.request(method, path))
        assert await waits(asked)
        front.lead_to(behind)
        assert (await asked).text == "the application"


async def test_the_application_answers_for_the_page_as_soon_as_it_is_there(settings: Settings) -> None:
    front = Front(settings)
    front.lead_to(behind)
    async with client_of(front) as client:
        assert (await client.get("/")).text == "the application"


async def test_a_page_that_is_not_built_is_told_by_the_application(settings: Settings) -> None:
    (settings.page_dir / "index.html").unlink()
    front = Front(settings)
    async with client_of(front) as client:
        asked = asyncio.create_task(client.get("/assets/index-1.js"))
        assert await waits(asked)
        front.lead_to(behind)
        assert (await asked).text == "the application"


async def test_one_who_leaves_takes_nobody_along(settings: Settings) -> None:
    front = Front(settings)
    async with client_of(front) as client:
        leaving, staying = (asyncio.create_task(client.get("/api/missions")) for _ in range(2))
        assert await waits(leaving)
        leaving.cancel()
        assert await waits(staying)
        front.lead_to(behind)
        assert (await staying).text == "the application"


async def test_a_start_that_fails_ends_the_waiting(settings: Settings) -> None:
    async with opened_front(settings) as opened, httpx.AsyncClient(base_url=opened.url) as client:
        assert (await client.get("/")).status_code == 200
        asked = asyncio.create_task(client.get("/api/missions"))
        assert await waits(asked)
        await opened.end()
        refused = await asked
    assert refused.status_code == 503
    assert "could not start" in refused.text


async def test_a_port_that_is_taken_is_said(settings: Settings) -> None:
    async with opened_front(settings) as opened:
        taken = settings.model_copy(update={"port": int(opened.url.rsplit(":", 1)[1])})
        with pytest.raises(CannotServe, match="choose another with --port"):
            async with opened_front(taken):
                pass
