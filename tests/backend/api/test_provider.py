"""The way to the sign-in provider and back, as a browser goes it: addresses, cookies, the audit log."""

from __future__ import annotations

import json
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from dataclasses import replace
from pathlib import Path

import httpx
from fastapi import FastAPI
from sign_in_provider import CLIENT, SECRET, SignInProvider, sign_in_provider

from backend.api.application import make_application
from backend.api.gate import SECURE_COOKIE
from backend.api.provider import SECURE_COOKIE as PROVIDER_COOKIE
from backend.api.services import Services
from backend.auth.access import Access, Visit
from backend.auth.audit import AuditLog
from backend.auth.provided import Rules
from backend.auth.provider import Provider
from backend.settings import Settings

BASE = "https://10.0.0.1"


def browser(app: FastAPI, base: str = BASE) -> httpx.AsyncClient:
    transport = httpx.ASGITransport(app, raise_app_exceptions=False, client=("10.0.0.7", 1))
    return httpx.AsyncClient(transport=transport, base_url=base, headers={"origin": base})


async def begun(client: httpx.AsyncClient, there: SignInProvider) -> str:
    """What the provider sends the browser back with."""
    reply = await client.get("/api/provider/begin")
    cookie = reply.headers["set-cookie"]
    assert cookie.startswith(f"{PROVIDER_COOKIE}=")
    for part in ("HttpOnly", "Secure", "SameSite=lax", "Path=/"):
        assert part in cookie
    return there.agree(reply.headers["location"])


async def come_back(client: httpx.AsyncClient, query: str) -> str:
    """Where the browser ends up."""
    reply = await client.get(f"/api/provider/return?{query}")
    assert reply.status_code == 303
    return reply.headers["location"]


async def test_a_browser_goes_there_and_comes_back_signed_in(
    services: Services, settings: Settings, tmp_path: Path
) -> None:
    """One story: a server with all that it needs takes seconds to make."""

    @asynccontextmanager
    async def nothing(_: FastAPI) -> AsyncIterator[None]:
        yield

    app = make_application(settings, nothing)
    access = Access(None, AuditLog(tmp_path / "audit.jsonl", lambda: 1_700_000_000.0), people_expected=True)
    async with sign_in_provider() as there:
        provider = Provider(there.issuer, CLIENT, SECRET, Rules())
        app.state.services = replace(services, access=access, provider=provider)
        async with browser(app) as client:
            for call in ("/api/provider/begin", "/api/provider/return?code=a&state=b"):
                assert (await client.get(call)).json()["reason"]["code"] == "first_admin_needed"
        await access.make_first_admin(access.begin_first_admin() or "", "Ada", "correct horse battery", Visit("a", ""))

        async with browser(app) as client, browser(app) as other:
            assert (await client.get("/api/session")).json()["provider"] == "127.0.0.1"
            query = await begun(client, there)
            await begun(other, there)
            assert await come_back(other, query) == "/#/sign-in/return", "it began in another browser"
            cookies = dict(client.cookies)
            query = await begun(client, there)
            cookies |= dict(client.cookies)
            assert there.redirect_uri == f"{BASE}/api/provider/return"
            assert await come_back(client, query) == "/"
            assert SECURE_COOKIE in client.cookies
            assert PROVIDER_COOKIE not in client.cookies
            me = (await client.get("/api/session")).json()["person"]
            assert (me["name"], me["role"], me["has_password"]) == ("Grace", "viewer", False)
            refused = await client.put("/api/account/password", json={"old": "x", "new": "x"})
            assert (refused.status_code, refused.json()["reason"]["code"]) == (409, "no_password_here")
        async with browser(app) as replayed:
            replayed.cookies.update({PROVIDER_COOKIE: cookies[PROVIDER_COOKIE]})
            assert await come_back(replayed, query) == "/#/sign-in/return"
            assert (await replayed.get("/api/missions")).status_code == 401

        await access.audit.flushed()
        written = (tmp_path / "audit.jsonl").read_text()
        *_, entered, last = (json.loads(line) for line in written.splitlines() if "/return" in line)
        assert (entered["who"], entered["provided"]["subject"], entered["role"]["role"]) == ("Grace", "4711", "viewer")
        assert (last["status"], last["outcome"], last["reason"]) == (403, "refused", "provider_refused: return")
        assert "code=" not in written

        async with browser(app, "http://10.0.0.1") as plain:
            assert (await plain.get("/api/provider/begin")).json()["reason"]["code"] == "not_encrypted"
        app.state.services = replace(services, access=access)
        async with browser(app) as client:
            assert (await client.get("/api/session")).json()["provider"] is None
            assert (await client.get("/api/provider/begin")).json()["reason"]["code"] == "no_provider"
    await access.close()
