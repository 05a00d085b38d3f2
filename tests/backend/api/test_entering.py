"""Cookies, origins, proxies and sessions, from outside the application."""

from __future__ import annotations

import asyncio
import json
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any
from uuid import uuid4

import httpx
import pytest
import uvicorn
import websockets
from argon2 import PasswordHasher
from fastapi import FastAPI

from backend.api import gate
from backend.api.application import make_application
from backend.api.gate import PLAIN_COOKIE, SECURE_COOKIE, SIGNED_OUT
from backend.api.services import Services
from backend.auth.access import Access, Visit
from backend.auth.audit import AuditLog
from backend.auth.invitations import Invitations
from backend.auth.passwords import Passwords
from backend.events import CommandAccepted
from backend.live.protocol import LiveProtocol
from backend.settings import Settings

PASSWORD = "correct horse battery"
ADA = {"name": "Ada", "password": PASSWORD}


@pytest.fixture
async def access(tmp_path: Path) -> AsyncIterator[Access]:
    hasher = PasswordHasher(time_cost=1, memory_cost=8, parallelism=1)
    audit = AuditLog(tmp_path / "audit.jsonl", lambda: 1_700_000_000.0)
    access = Access(None, audit, people_expected=True, passwords=Passwords(hasher))
    yield access
    await access.close()


@asynccontextmanager
async def nothing(_: FastAPI) -> AsyncIterator[None]:
    yield


@pytest.fixture
def shared(services: Services, access: Access, settings: Settings) -> FastAPI:
    app = make_application(settings, nothing)
    app.state.services = replace(services, access=access)
    return app


def visiting(
    app: FastAPI, base: str = "http://127.0.0.1", address: str = "127.0.0.1", **more: Any
) -> httpx.AsyncClient:
    transport = httpx.ASGITransport(app, raise_app_exceptions=False, client=(address, 1))
    return httpx.AsyncClient(transport=transport, base_url=base, headers={"origin": base}, **more)


async def first_admin(client: httpx.AsyncClient, access: Access) -> httpx.Response:
    code = access.begin_first_admin() or ""
    return await client.post("/api/first-admin", json={"code": code, **ADA})


def reason(reply: httpx.Response) -> str:
    return reply.json()["reason"]["code"]


async def test_over_https_the_cookie_is_one_that_no_other_host_can_set(shared: FastAPI, access: Access) -> None:
    async with visiting(shared, "https://10.0.0.1", "10.0.0.7") as client:
        made = await first_admin(client, access)
        assert made.status_code == 201
        cookie = made.headers["set-cookie"]
        assert cookie.startswith(f"{SECURE_COOKIE}=")
        for part in ("HttpOnly", "Secure", "SameSite=strict", "Path=/"):
            assert part in cookie
        assert "Domain" not in cookie
        assert (await client.get("/api/missions")).status_code == 200
        secret = made.cookies[SECURE_COOKIE]
    async with visiting(shared, "https://10.0.0.1", "10.0.0.7", cookies={PLAIN_COOKIE: secret}) as client:
        assert (await client.get("/api/missions")).status_code == 401, "a cookie that an http page could have set"


async def test_over_http_on_this_machine_the_cookie_promises_nothing_it_cannot_keep(
    shared: FastAPI, access: Access
) -> None:
    async with visiting(shared) as client:
        cookie = (await first_admin(client, access)).headers["set-cookie"]
        assert cookie.startswith(f"{PLAIN_COOKIE}=")
        assert "Secure" not in cookie
        assert "HttpOnly" in cookie


@pytest.mark.parametrize("forwarded", [{}, {"x-forwarded-for": "127.0.0.1"}])
async def test_from_another_machine_no_password_is_taken_over_http(
    shared: FastAPI, access: Access, forwarded: dict[str, str]
) -> None:
    address = "127.0.0.1" if forwarded else "10.0.0.7"
    async with visiting(shared, address=address) as client:
        client.headers.update(forwarded)
        assert (await client.get("/api/session")).json()["encrypted"] is False
        refused = await first_admin(client, access)
        assert (refused.status_code, reason(refused)) == (403, "not_encrypted")
        assert access.mode == "waiting"
        await access.make_first_admin(access.begin_first_admin() or "", "Ada", PASSWORD, Visit("a", ""))
        assert reason(await client.post("/api/session", json=ADA)) == "not_encrypted"


async def test_a_settings_word_for_it_lets_passwords_cross_a_network_that_encrypts(
    services: Services, access: Access, settings: Settings
) -> None:
    app = make_application(settings, nothing)
    app.state.services = replace(services, access=access, settings=settings.model_copy(update={"plain_http": True}))
    async with visiting(app, address="10.0.0.7") as client:
        assert (await first_admin(client, access)).status_code == 201


async def test_a_session_set_by_somebody_else_before_is_replaced_and_the_own_old_one_ends(
    shared: FastAPI, access: Access
) -> None:
    async with visiting(shared) as client:
        await first_admin(client, access)
        old = client.cookies[PLAIN_COOKIE]
        client.cookies.set(PLAIN_COOKIE, old, domain="127.0.0.1")
        again = await client.post("/api/session", json=ADA)
        new = again.cookies[PLAIN_COOKIE]
    assert new != old
    async with visiting(shared, cookies={PLAIN_COOKIE: old}) as client:
        assert (await client.get("/api/missions")).status_code == 401
    async with visiting(shared, cookies={PLAIN_COOKIE: "fixed by eve"}) as client:
        entered = await client.post("/api/session", json=ADA)
        assert entered.cookies[PLAIN_COOKIE] != "fixed by eve"


@pytest.mark.parametrize(
    "origin", [None, "null", "http://evil.example", "http://127.0.0.1:8000", "https://127.0.0.1.evil"]
)
async def test_a_signed_in_page_of_another_origin_changes_nothing(
    shared: FastAPI, access: Access, origin: str | None
) -> None:
    async with visiting(shared) as client:
        await first_admin(client, access)
        if origin is None:
            del client.headers["origin"]
        else:
            client.headers["origin"] = origin
        for method, path in (("DELETE", "/api/account/sessions"), ("POST", "/api/invitations")):
            reply = await client.request(method, path, json={"role": "pilot", "admin": True})
            assert reply.status_code == 403, path
        assert reason(reply) in {"origin_missing", "foreign_origin"}
        assert (await client.get("/api/missions")).status_code == 200
    assert access.invitations.waiting == []


async def test_an_http_page_does_not_speak_for_an_https_one(shared: FastAPI, access: Access) -> None:
    async with visiting(shared, "https://10.0.0.1", "10.0.0.7") as client:
        await first_admin(client, access)
        reply = await client.post("/api/invitations", json={"role": "pilot"}, headers={"origin": "http://10.0.0.1"})
        assert reason(reply) == "origin_missing"


@pytest.mark.parametrize("header", ["x-forwarded-for", "x-forwarded-proto", "forwarded", "via"])
async def test_a_proxy_before_a_server_without_accounts_gets_nothing(client: httpx.AsyncClient, header: str) -> None:
    """It listens on loopback, but whoever reaches the proxy is not whoever sits before the machine."""
    refused = await client.get("/api/missions", headers={header: "10.0.0.7"})
    assert (refused.status_code, reason(refused)) == (403, "behind_proxy")
    order = {"command_id": str(uuid4()), "command": {"kind": "hold"}}
    assert (await client.post("/api/missions/x/commands", json=order, headers={header: "1"})).status_code == 403


async def test_secrets_stand_in_no_audit_log(shared: FastAPI, access: Access, tmp_path: Path) -> None:
    async with visiting(shared) as client:
        made = await first_admin(client, access)
        link = (await client.post("/api/invitations", json={"role": "viewer"})).json()["link"]
        token = (await client.post("/api/tokens", json={"name": "box", "scope": "exports"})).json()["secret"]
        await client.post("/api/session", json={"name": "Ada", "password": "not the password"})
    await access.audit.flushed()
    written = (tmp_path / "audit.jsonl").read_text()
    for secret in (PASSWORD, "not the password", made.cookies[PLAIN_COOKIE], link.rsplit("/", 1)[1], token):
        assert secret not in written
    entries = [json.loads(line) for line in written.splitlines()]
    assert [(e["call"], e["status"], e["who"]) for e in entries] == [
        ("POST /api/first-admin", 201, "Ada"),
        ("POST /api/invitations", 201, "Ada"),
        ("POST /api/tokens", 201, "Ada"),
        ("POST /api/session", 403, "Ada"),
    ]
    assert entries[-1]["account"] == "Ada"


async def test_a_call_that_breaks_is_written_down_too(
    shared: FastAPI, access: Access, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    async def broken(*_: object) -> None:
        raise ZeroDivisionError

    monkeypatch.setattr(Invitations, "make", broken)
    async with visiting(shared) as client:
        await first_admin(client, access)
        assert (await client.post("/api/invitations", json={"role": "viewer"})).status_code == 500
    await access.audit.flushed()
    last = json.loads((tmp_path / "audit.jsonl").read_text().splitlines()[-1])
    assert (last["call"], last["status"], last["outcome"]) == ("POST /api/invitations", 500, "failed")


@asynccontextmanager
async def on_a_socket(app: FastAPI) -> AsyncIterator[str]:
    config = uvicorn.Config(app, port=0, ws=LiveProtocol, log_level="warning", lifespan="off")
    server = uvicorn.Server(config)
    running = asyncio.create_task(server.serve())
    while not server.started:  # noqa: ASYNC110 (uvicorn has no event for it)
        await asyncio.sleep(0.01)
    yield f"127.0.0.1:{server.servers[0].sockets[0].getsockname()[1]}"
    server.should_exit = True
    await running


async def heard_until_closed(live: websockets.ClientConnection) -> None:
    while True:
        await live.recv()


async def test_a_session_that_is_ended_elsewhere_closes_its_live_channel(shared: FastAPI, access: Access) -> None:
    secret = await access.make_first_admin(access.begin_first_admin() or "", "Ada", PASSWORD, Visit("a", ""))
    async with on_a_socket(shared) as host:
        cookie = {"cookie": f"{PLAIN_COOKIE}={secret}"}
        with pytest.raises(websockets.InvalidStatus) as foreign:
            await websockets.connect(f"ws://{host}/api/live", additional_headers=cookie)
        assert foreign.value.response.status_code == 403, "no Origin: no page of ours"
        async with websockets.connect(
            f"ws://{host}/api/live", origin=websockets.Origin(f"http://{host}"), additional_headers=cookie
        ) as live:
            assert "hello" in str(await live.recv())
            await access.sessions.end_all(access.people.by_name[0].person_id)
            with pytest.raises(websockets.ConnectionClosed) as closed:
                await heard_until_closed(live)
        assert closed.value.rcvd is not None
        assert closed.value.rcvd.code == SIGNED_OUT
        own = websockets.Origin(f"http://{host}")
        with pytest.raises(websockets.InvalidStatus) as gone:
            await websockets.connect(f"ws://{host}/api/live", origin=own, additional_headers=cookie)
        assert gone.value.response.status_code == 401


async def test_a_token_that_runs_out_closes_the_channel_that_it_opened(
    shared: FastAPI, access: Access, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(gate, "LOOK_EVERY_S", 0.05)
    await access.make_first_admin(access.begin_first_admin() or "", "Ada", PASSWORD, Visit("a", ""))
    lasting, _ = await access.machines.make("box", "payload", 3600.0, "x")
    short, _ = await access.machines.make("old box", "payload", 1.0, "x")
    async with on_a_socket(shared) as host:
        url = f"ws://{host}/api/payload"
        async with (
            websockets.connect(url, additional_headers={"authorization": f"Bearer {lasting}"}) as stays,
            websockets.connect(url, additional_headers={"authorization": f"Bearer {short}"}) as goes,
        ):
            async with asyncio.timeout(60):
                with pytest.raises(websockets.ConnectionClosed) as closed:
                    await heard_until_closed(goes)
            assert closed.value.rcvd is not None
            assert closed.value.rcvd.code == SIGNED_OUT
            with pytest.raises(TimeoutError):
                async with asyncio.timeout(0.2):
                    await heard_until_closed(stays)


async def test_a_program_is_told_of_its_token_and_not_to_sign_in(shared: FastAPI, access: Access) -> None:
    async with visiting(shared) as client:
        await first_admin(client, access)
    async with visiting(shared) as client:
        nobody = await client.get("/api/missions")
        program = await client.get("/api/missions", headers={"authorization": "Bearer one that was revoked"})
    assert (nobody.status_code, reason(nobody)) == (401, "sign_in_needed")
    assert (program.status_code, reason(program)) == (401, "unknown_token")


Deed = Callable[[Access, str], Awaitable[object]]
MEANWHILE: dict[str, Deed] = {
    "signed out": lambda access, who: access.sessions.end_all(who),
    "shut out": lambda access, who: access.change_person(who, "pilot", admin=False, active=False),
    "viewer": lambda access, who: access.change_person(who, "viewer", admin=False, active=True),
    "operator": lambda access, who: access.change_person(who, "operator", admin=False, active=True),
    "nothing": lambda access, who: asyncio.sleep(0),
}


@pytest.mark.parametrize(
    ("meanwhile", "status", "role"),
    [
        ("signed out", 401, None),
        ("shut out", 401, None),
        ("viewer", 403, None),
        ("operator", 200, "operator"),
        ("nothing", 200, "pilot"),
    ],
)
async def test_an_order_that_was_held_back_counts_as_its_giver_may_when_it_is_whole(
    shared: FastAPI, access: Access, meanwhile: str, status: int, role: str | None
) -> None:
    """Whoever is about to lose a right keeps no orders in store by half a request."""
    async with visiting(shared) as admin, visiting(shared) as client:
        await first_admin(admin, access)
        area = {"type": "Polygon", "coordinates": [[[7.2, 50.62], [7.21, 50.62], [7.21, 50.63], [7.2, 50.62]]]}
        mission = (await admin.post("/api/missions", json={"name": "m", "area": area})).json()["mission_id"]
        link, _ = await access.invitations.make("pilot", False, 60.0, access.people.by_name[0].person_id)
        client.cookies.set(PLAIN_COOKIE, await access.accept_invitation(link, "Bo", PASSWORD, Visit("b", "")))
        person = next(one.person_id for one in access.people.by_name if one.name == "Bo")
        body = json.dumps({"command_id": str(uuid4()), "command": {"kind": "take_control"}}).encode()

        async def held_back() -> AsyncIterator[bytes]:
            yield body[:5]
            await MEANWHILE[meanwhile](access, person)
            yield body[5:]

        kind = {"content-type": "application/json"}
        reply = await client.post(f"/api/missions/{mission}/commands", content=held_back(), headers=kind)
    assert reply.status_code == status
    recorded = await shared.state.services.journal.read(mission)
    authors = [r.event.author for r in recorded if isinstance(r.event, CommandAccepted)]
    assert [None if author is None else author.role for author in authors] == ([] if role is None else [role])


async def test_whoever_has_many_commands_refused_waits_but_never_with_what_is_safe(
    shared: FastAPI, access: Access
) -> None:
    async with visiting(shared) as client:
        await first_admin(client, access)
        area = {"type": "Polygon", "coordinates": [[[7.2, 50.62], [7.21, 50.62], [7.21, 50.63], [7.2, 50.62]]]}
        mission = (await client.post("/api/missions", json={"name": "m", "area": area})).json()["mission_id"]

        async def order(kind: str) -> int:
            body = {"command_id": str(uuid4()), "command": {"kind": kind}}
            return (await client.post(f"/api/missions/{mission}/commands", json=body)).status_code

        answers = [await order("accept") for _ in range(40)]
        assert answers[:30] == [200] * 30
        assert 429 in answers
        assert [await order(kind) for kind in ("hold", "abort", "return", "land")] == [200] * 4


async def test_a_resume_to_the_craft_itself_passes_by_no_lease(shared: FastAPI, access: Access) -> None:
    """Of a craft in no mission nobody holds a lease; in one its mission asks for it (tests/backend/mission)."""
    async with visiting(shared) as client:
        await first_admin(client, access)
        body = {"command_id": str(uuid4()), "command": {"kind": "resume"}}
        assert (await client.post("/api/crafts/craft-1/commands", json=body)).status_code == 200
        body["command"] = {"kind": "hold"}
        again = await client.post("/api/crafts/craft-1/commands", json=body)
        assert reason(again) == "command_id_reused"


@pytest.mark.parametrize("name", ["\u200b", "\u202eadA", "x\ufffe", "\ufdd0", "\u3164", "\u115f ", "\ufe0f", "\u2800"])
async def test_a_name_that_lists_would_not_show_as_it_is_makes_no_account(
    shared: FastAPI, access: Access, name: str
) -> None:
    code = access.begin_first_admin() or ""
    async with visiting(shared) as client:
        reply = await client.post("/api/first-admin", json={"code": code, "name": name, "password": PASSWORD})
        assert reply.status_code == 422
        assert not access.people.by_name
