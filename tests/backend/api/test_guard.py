"""Foreign pages and foreign names get nothing."""

from __future__ import annotations

import httpx
import pytest
import websockets
from narrowing import a
from websockets.typing import Origin

OWN = ["127.0.0.1", "127.0.0.1:8600", "localhost:8600", "[::1]:8600", "192.168.1.7:8600"]
FOREIGN = [
    "evil.example",
    "localhost.evil.example",
    "evil.example:8600",
    "",
    "a b",
    "127.0.0.1.evil.example",
    "[::1",
    "127.0.0.1:80;x",
    "127.0.0.1/x",
    "x;@127.0.0.1",
]


@pytest.mark.parametrize("host", OWN)
async def test_our_own_names_pass(client, host):
    assert (await client.get("/api/health", headers={"host": host})).status_code == 200


@pytest.mark.parametrize("host", FOREIGN)
async def test_a_rebound_name_is_refused(client, host):
    reply = await client.get("/api/health", headers={"host": host})
    assert reply.status_code == 421
    assert reply.headers["content-type"] == "application/problem+json"


NO_ADDRESS = ["http://[", "http://[::1", "http://a]b"]


@pytest.mark.parametrize(
    "origin", ["http://evil.example", "null", "http://127.0.0.1:9999", "http://localhost", *NO_ADDRESS]
)
async def test_a_foreign_page_changes_nothing(client, origin):
    reply = await client.post("/api/areas", json={"text": "{}"}, headers={"origin": origin})
    assert reply.status_code == 403
    assert (await client.get("/api/missions")).json() == {"missions": [], "next": None}


async def test_our_own_page_and_programs_may_write(client):
    for headers in ({}, {"origin": "http://127.0.0.1"}, {"origin": "https://127.0.0.1"}):
        assert (await client.post("/api/areas", json={"text": "{}"}, headers=headers)).status_code == 422


@pytest.mark.parametrize("origin", ["http://evil.example", *NO_ADDRESS])
async def test_a_foreign_page_gets_no_websocket(served, origin):
    with pytest.raises(websockets.InvalidStatus) as refused:
        await websockets.connect(f"ws://{served}/api/live", origin=Origin(origin))
    assert refused.value.response.status_code == 403
    async with websockets.connect(f"ws://{served}/api/live", origin=Origin(f"http://{served}")) as websocket:
        assert "hello" in a(str, await websocket.recv())


async def test_every_answer_carries_the_security_headers(client: httpx.AsyncClient):
    for path in ("/", "/api/health", "/api/nothing", "/assets/app-1a2b.js"):
        headers = (await client.get(path)).headers
        assert "script-src 'self'" in headers["content-security-policy"]
        assert "http:" not in headers["content-security-policy"]
        assert headers["x-content-type-options"] == "nosniff"
        assert headers["cross-origin-opener-policy"] == "same-origin"
    assert (await client.get("/api/health")).headers["cache-control"] == "no-store"
