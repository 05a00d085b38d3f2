"""Every endpoint, websocket and command by every role, made from the table: let in, refused, and written down."""

from __future__ import annotations

import json
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager, suppress
from dataclasses import dataclass, replace
from itertools import product
from pathlib import Path
from typing import Any, get_args
from uuid import uuid4

import httpx
import pytest
from argon2 import PasswordHasher
from fastapi import FastAPI, WebSocket, WebSocketDisconnect

from backend.api.application import make_application
from backend.api.gate import PLAIN_COOKIE, calls_of
from backend.api.services import Services
from backend.auth.access import Access, Visit
from backend.auth.audit import AuditLog
from backend.auth.audit_chain import verify
from backend.auth.buckets import Buckets
from backend.auth.passwords import Passwords
from backend.commands import Command, CraftRequest, ForControl, ForCraft, ForSearch
from backend.events import CommandAccepted, CommandRefused
from backend.permissions import BEFORE_PEOPLE, COMMANDS, ENDPOINTS, SAFETY, Need, at_least
from backend.settings import Settings

TOKEN = "a token of sixteen letters or more"
PASSWORD = "correct horse battery"
CHEAP = Passwords(PasswordHasher(time_cost=1, memory_cost=8, parallelism=1))
ORIGIN = {"origin": "http://127.0.0.1"}


@dataclass(frozen=True)
class Caller:
    """role None: a machine, or nobody at all."""

    name: str
    role: Any = None
    admin: bool = False
    scope: Any = None


NOBODY = Caller("nobody")
CALLERS = (
    NOBODY,
    Caller("viewer", "viewer"),
    Caller("operator", "operator"),
    Caller("pilot", "pilot"),
    Caller("viewing admin", "viewer", admin=True),
    Caller("flying admin", "pilot", admin=True),
    Caller("payload", scope="payload"),
    Caller("exports", scope="exports"),
    Caller("metrics", scope="metrics"),
    Caller("bearings", scope="bearings"),
)


def may(caller: Caller, need: Need) -> bool:
    """Said once more in other words than the gate's, so that a slip in either shows."""
    if need.anyone:
        return True
    if caller.scope is not None:
        return need.scope == caller.scope
    if caller.role is None or need.role is None:
        return False
    return at_least(caller.role, need.role) and (caller.admin or not need.admin)


@pytest.fixture
async def access(tmp_path: Path) -> AsyncIterator[Access]:
    audit = AuditLog(tmp_path / "audit.jsonl", lambda: 1_700_000_000.0)
    access = Access(None, audit, people_expected=True, passwords=CHEAP)
    access.limits.noted_refusals = Buckets(burst=1000, every_s=1.0)
    yield access
    await access.close()


@pytest.fixture
def shared(services: Services, access: Access, settings: Settings) -> FastAPI:
    """The application of a server that others can reach."""

    @asynccontextmanager
    async def nothing(_: FastAPI) -> AsyncIterator[None]:
        yield

    app = make_application(settings, nothing)
    app.state.services = replace(services, access=access)
    return app


async def everybody(access: Access) -> dict[str, dict[str, str]]:
    """Headers by caller; the address of each is its own, so that no limit of one meets another."""
    code = access.begin_first_admin() or ""
    await access.make_first_admin(code, "first", PASSWORD, Visit("a", ""))
    headers: dict[str, dict[str, str]] = {NOBODY.name: dict(ORIGIN)}
    for caller in CALLERS:
        if caller.scope is not None:
            secret, _ = await access.machines.make(caller.name, caller.scope, None, "first")
            headers[caller.name] = {"authorization": f"Bearer {secret}"}
        elif caller.role is not None:
            link, _ = await access.invitations.make(caller.role, caller.admin, 60.0, "first")
            secret = await access.accept_invitation(link, caller.name, PASSWORD, Visit(caller.name, ""))
            headers[caller.name] = {"cookie": f"{PLAIN_COOKIE}={secret}", **ORIGIN}
    return headers


def client_of(app: FastAPI) -> httpx.AsyncClient:
    return httpx.AsyncClient(
        transport=httpx.ASGITransport(app, raise_app_exceptions=False), base_url="http://127.0.0.1"
    )


def entries(tmp_path: Path) -> list[dict[str, Any]]:
    lines = (tmp_path / "audit.jsonl").read_bytes().splitlines(keepends=True)
    assert verify(lines).fault is None
    return [json.loads(line) for line in lines]


async def knocked(app: FastAPI, path: str, headers: dict[str, str]) -> int:
    """At a websocket, gone again at once: the status of its refusal, 101 when it was let in."""
    said: list[dict[str, Any]] = []
    wanted = iter(({"type": "websocket.connect"},))

    async def receive() -> dict[str, Any]:
        return next(wanted, {"type": "websocket.disconnect", "code": 1001})

    async def send(message: Any) -> None:
        said.append(message)

    scope = {
        "type": "websocket", "path": path, "raw_path": path.encode(), "query_string": b"", "root_path": "",
        "scheme": "ws", "subprotocols": ["none"], "client": ("127.0.0.1", 1), "server": ("127.0.0.1", 80),
        "headers": [(name.encode(), value.encode()) for name, value in {"host": "127.0.0.1", **headers}.items()],
        "extensions": {"websocket.http.response": {}}, "asgi": {"version": "3.0"},
    }  # fmt: skip
    with suppress(WebSocketDisconnect, RuntimeError):
        await app(scope, receive, send)
    return next((m["status"] for m in said if m["type"] == "websocket.http.response.start"), 101)


HTTP = [name for name in ENDPOINTS if not name.startswith("WS ")]
SOCKETS = [name for name in ENDPOINTS if name.startswith("WS ")]


def test_the_table_names_every_call_of_the_application_and_none_besides(shared: FastAPI) -> None:
    assert {call.name for call in calls_of(shared.routes)} == set(ENDPOINTS)


def test_the_table_names_every_command_and_none_besides() -> None:
    union = get_args(Command)[0]
    assert {kind.model_fields["kind"].default for kind in get_args(union)} == set(COMMANDS)
    assert set(get_args(union)) == {*get_args(ForCraft), *get_args(ForSearch), *get_args(ForControl)}


async def test_a_call_that_is_not_in_the_table_cannot_be_served(shared: FastAPI) -> None:
    served: list[str] = []

    @shared.get("/api/forgotten")
    async def forgotten() -> None:
        served.append("http")

    @shared.websocket("/api/forgotten-socket")
    async def forgotten_socket(websocket: WebSocket) -> None:
        served.append("websocket")
        await websocket.accept()

    headers = await everybody(shared.state.services.access)
    async with client_of(shared) as client:
        reply = await client.get("/api/forgotten", headers=headers["flying admin"])
    assert (reply.status_code, reply.json()["reason"]["code"]) == (403, "call_not_listed")
    assert await knocked(shared, "/api/forgotten-socket", headers["flying admin"]) == 403
    assert served == []


async def test_a_route_that_is_added_behind_the_gates_back_is_not_served_either(shared: FastAPI) -> None:
    """The gate has made its list already; the application's own dependency stands behind it."""
    async with client_of(shared) as client:
        await client.get("/api/session")

        @shared.get("/api/late")
        async def late() -> str:
            return "served"

        reply = await client.get("/api/late")
    assert reply.status_code == 403


def filled(name: str) -> tuple[str, str]:
    method, path = name.split(" ", 1)
    return method, "/".join("0" * 32 if part.startswith("{") else part for part in path.split("/"))


ENDS_THE_SESSION = ("DELETE /api/session", "DELETE /api/account/sessions")
NOT_LET_IN = {"sign_in_needed", "role_too_low", "first_admin_needed", "call_not_listed", "origin_missing"}


@pytest.mark.parametrize("caller", CALLERS, ids=lambda caller: caller.name)
async def test_each_call_lets_in_whom_the_table_says_and_is_written_down(
    shared: FastAPI, tmp_path: Path, caller: Caller
) -> None:
    access: Access = shared.state.services.access
    headers = (await everybody(access))[caller.name]
    before = 0
    async with client_of(shared) as client:
        for name in (*(one for one in HTTP if one not in ENDS_THE_SESSION), *ENDS_THE_SESSION):
            need = ENDPOINTS[name]
            if name in ENDS_THE_SESSION and caller.role is not None:
                secret = await access.sign_in(caller.name, PASSWORD, Visit("again", ""))
                headers = {"cookie": f"{PLAIN_COOKIE}={secret}", **ORIGIN}
            method, path = filled(name)
            reply = await client.request(method, path, headers=headers)
            refused = reply.status_code in (401, 403) and reply.json()["reason"]["code"] in NOT_LET_IN
            assert refused != may(caller, need), (name, reply.status_code, reply.text[:200])
            assert reply.status_code != 500, (name, reply.text)
            if refused:
                assert (reply.status_code == 401) == (caller is NOBODY), name
            await access.audit.flushed()
            written = entries(tmp_path)[before:] if (tmp_path / "audit.jsonl").exists() else []
            before += len(written)
            if refused or need.audited:
                assert [entry["call"] for entry in written] == [name]
                assert (written[0]["status"], written[0]["path"]) == (reply.status_code, path)
                assert written[0]["who"] == (None if caller is NOBODY else caller.name), name
            elif reply.status_code not in (401, 403, 429):
                assert written == [], name


async def test_each_websocket_lets_in_whom_the_table_says(shared: FastAPI) -> None:
    headers = await everybody(shared.state.services.access)
    for name in SOCKETS:
        _, path = filled(name)
        for caller in CALLERS:
            status = await knocked(shared, path, headers[caller.name])
            assert (status in (401, 403)) != may(caller, ENDPOINTS[name]), (name, caller.name, status)


async def test_before_the_first_admin_nothing_is_served_but_the_page_that_makes_them(shared: FastAPI) -> None:
    async with client_of(shared) as client:
        for name in HTTP:
            method, path = filled(name)
            reply = await client.request(method, path, headers=ORIGIN)
            assert (reply.status_code == 401) == (name not in BEFORE_PEOPLE), (name, reply.text)
        assert (await client.get("/")).status_code == 200
    for name in SOCKETS:
        assert await knocked(shared, filled(name)[1], {"authorization": f"Bearer {TOKEN}", **ORIGIN}) == 401


AREA = {
    "type": "Polygon",
    "coordinates": [[[7.2, 50.62], [7.21, 50.62], [7.21, 50.63], [7.2, 50.63], [7.2, 50.62]]],
}
SPEC = {"name": "m", "area": AREA}
COMMAND_BODIES: dict[str, dict[str, Any]] = {
    "override": {"place": {"lat": 50.0, "lon": 7.0}},
    "set_automatic": {"automatic": True},
    "exclude_bearing": {"bearing_id": "b"},
    "include_bearing": {"bearing_id": "b"},
    "set_priorities": {"priorities": {}},
    "mute_source": {"of": "person", "name": "b", "muted": True},
    "acknowledge_alert": {"alert_id": "a"},
    "change_area": {"search": {"area": AREA, "priors": {}, "fence": None, "fence_margin_m": 50, "no_fly": []}},
}


async def test_each_command_by_each_role_is_answered_or_refused_and_stands_in_journal_and_audit_log(
    shared: FastAPI, tmp_path: Path
) -> None:
    services: Services = shared.state.services
    headers = await everybody(services.access)
    services.access.limits.refused_commands = Buckets(burst=1000, every_s=1.0)
    services.access.limits.noted_refusals = Buckets(burst=1000, every_s=1.0)
    async with client_of(shared) as client:
        made = await client.post("/api/missions", json=SPEC, headers=headers["operator"])
        mission = made.json()["mission_id"]
        for kind, caller in product(sorted(COMMANDS), CALLERS):
            need = COMMANDS[kind]
            body = {"command_id": str(uuid4()), "command": {"kind": kind, **COMMAND_BODIES.get(kind, {})}}
            reply = await client.post(f"/api/missions/{mission}/commands", json=body, headers=headers[caller.name])
            allowed = caller.role is not None and at_least(caller.role, need.role)
            assert (reply.status_code == 200) == allowed, (kind, caller.name, reply.text)
            recorded = await services.journal.read(mission)
            answers = [r.event for r in recorded if isinstance(r.event, CommandAccepted | CommandRefused)]
            fact = next((answer for answer in answers if answer.command_id == body["command_id"]), None)
            assert (fact is not None) == allowed
            if fact is not None:
                assert fact.author is not None
                assert (fact.by, fact.author.role, fact.author.address) == (caller.name, caller.role, "127.0.0.1")
            code = (reply.json()["reason"] or {"code": None})["code"] if allowed else None
            if allowed and need.control:
                assert code in {"control_free", "control_held", "control_stale"}, "no fence came with it"
            elif allowed and need is SAFETY:
                assert code not in {"control_free", "control_held", "control_stale"}
            await services.access.audit.flushed()
            last = entries(tmp_path)[-1]
            assert (last["call"], last["status"]) == ("POST /api/missions/{mission_id}/commands", reply.status_code)
            if allowed:
                assert (last["command"], last["accepted"]) == (kind, reply.json()["accepted"])
            else:
                assert last["outcome"] == "refused"


def test_what_goes_to_a_craft_is_in_the_table_too() -> None:
    union = get_args(CraftRequest.model_fields["command"].annotation)
    assert {kind.model_fields["kind"].default for kind in union} <= set(COMMANDS)
