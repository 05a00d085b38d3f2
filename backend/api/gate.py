"""Nobody passes but by the table of permissions: who asks is found out, and every call is looked up, before its body is
read, and whoever gives an order again when its body has come. What is not in the table is refused.

A page that is signed in must say where it comes from with everything that changes something (and with each websocket):
besides SameSite cookies that keeps other sites from acting through it. A websocket ends with the session or the token
that opened it.
"""

from __future__ import annotations

import asyncio
import logging
import re
from collections.abc import Iterable
from dataclasses import dataclass
from http.cookies import CookieError, SimpleCookie
from urllib.parse import urlsplit

from fastapi.routing import iter_route_contexts
from starlette.applications import Starlette
from starlette.datastructures import Headers
from starlette.routing import BaseRoute, compile_path
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from backend.api.guard import SAFE_METHODS, place_of, refuse
from backend.api.problems import ApiProblem, retry_after
from backend.auth.access import Access
from backend.auth.keeping import Denied
from backend.auth.principal import Principal, local_person
from backend.auth.registry import MachineToken, Session
from backend.auth.sessions import Entry
from backend.permissions import BEFORE_PEOPLE, ENDPOINTS, Need
from backend.reasons import Reason
from backend.reasons.access import BehindProxy, CallNotListed, FirstAdminNeeded, OriginMissing, SignInNeeded
from backend.reasons.request import UnknownToken
from backend.wire.problem import problem

log = logging.getLogger("crossfix.access")

SECURE_COOKIE = "__Host-crossfix"
PLAIN_COOKIE = "crossfix-session"
"""Over http the browser would refuse the other name; this one promises nothing."""
FORWARDED = ("x-forwarded-for", "x-forwarded-proto", "x-forwarded-host", "forwarded", "via")
SIGNED_OUT = 4401
"""Close code of a websocket whose session or token has ended."""
LOOK_EVERY_S = 60.0
"""At a session that keeps a websocket open."""


@dataclass(frozen=True, slots=True)
class Call:
    """name: as in the table. path: compiled. method None: every one (a mount)."""

    name: str
    path: re.Pattern[str]
    method: str | None


def lay_routes(app: Starlette) -> None:
    """What the first request would else wait for, and every order meanwhile: FastAPI lays out the routes of all
    routers, with the models of their requests, when it first looks at them. For a thread, before anybody is let in."""
    app.state.calls = calls_of(app.routes)


def calls_of(routes: Iterable[BaseRoute]) -> list[Call]:
    """Every call that the application answers, in the order in which its router looks at them."""
    found: list[Call] = []
    for route in iter_route_contexts(list(routes)):
        path = route.path or ""
        pattern, path_format, _ = compile_path(path)
        methods = getattr(route, "methods", None)
        if type(route.original_route).__name__ == "Mount":
            found.append(Call(f"MOUNT {path}", compile_path(path + "/{rest:path}")[0], None))
        elif not methods:
            found.append(Call(f"WS {path_format}", pattern, "WS"))
        else:
            found += [Call(f"{method} {path_format}", pattern, method) for method in sorted(methods)]
    return found


@dataclass(frozen=True, slots=True)
class Visitor:
    """Who asks, and what they came in with: a session, a machine's token, or nothing."""

    principal: Principal | None
    session: Entry[Session] | None = None
    token: Entry[MachineToken] | None = None


class Gate:
    """ASGI middleware, inside the guard. The built page holds nothing and is served to everybody."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """A refused request reaches no endpoint, and none of its body is read."""
        if scope["type"] not in {"http", "websocket"}:
            await self._app(scope, receive, send)
            return
        name = self._call(scope)
        if name is None:  # the page, or what the router answers with 404 or 405
            await self._app(scope, receive, send)
            return
        access: Access = scope["app"].state.services.access
        need = ENDPOINTS.get(name)
        address = address_of(scope)
        visitor = Visitor(None)
        try:
            if need is None:
                log.error("%s is missing from the table of permissions", name)
                raise Denied(403, CallNotListed())
            visitor = _visitor(access, scope, address)
            _permit(access, visitor, scope, name, need)
        except Denied as error:
            _note(access, scope, name, visitor.principal, address, error.status, error.reason.code)
            found = problem(error.status, error.reason)
            await refuse(found, scope, receive, send, retry_after(error.reason))
            return
        state = scope.setdefault("state", {})
        state["need"], state["principal"], state["audit"] = name, visitor.principal, {}
        if visitor.session is not None:
            access.sessions.seen(visitor.session)
        if scope["type"] == "websocket":
            if need.audited:
                _note(access, scope, name, visitor.principal, address, 101)
            await self._watched(access, visitor, scope, receive, send)
        else:
            try:
                arriving = _permitted_still(access, scope, name, need, receive)
                await self._app(scope, arriving, _noting(access, scope, name, visitor.principal, address, need, send))
            except Exception:
                if need.audited:
                    _note(access, scope, name, visitor.principal, address, 500, detail=dict(state["audit"]))
                raise

    def _call(self, scope: Scope) -> str | None:
        app: Starlette = scope["app"]
        if not hasattr(app.state, "calls"):
            lay_routes(app)
        method = "WS" if scope["type"] == "websocket" else scope["method"]
        path = scope["path"]
        for call in app.state.calls:
            if call.method in (method, None) and call.path.match(path):
                return call.name
        return None

    async def _watched(self, access: Access, visitor: Visitor, scope: Scope, receive: Receive, send: Send) -> None:
        """The websocket until it or what opened it ends."""
        entry = visitor.session or visitor.token
        if entry is None:
            await self._app(scope, receive, send)
            return
        opened = False

        async def noticing(message: Message) -> None:
            nonlocal opened
            opened = message["type"] == "websocket.accept" or (opened and message["type"] != "websocket.close")
            await send(message)

        serving = asyncio.ensure_future(self._app(scope, receive, noticing))
        over = asyncio.create_task(_over(access, visitor, entry.ended))
        try:
            await asyncio.wait({serving, over}, return_when=asyncio.FIRST_COMPLETED)
        finally:
            over.cancel()
            if not serving.done():
                serving.cancel()
            results = await asyncio.gather(serving, over, return_exceptions=True)
        if opened and entry.ended.is_set():
            await send({"type": "websocket.close", "code": SIGNED_OUT, "reason": "signed out"})
        fault = results[0]
        if isinstance(fault, Exception):
            raise fault


async def _over(access: Access, visitor: Visitor, ended: asyncio.Event) -> None:
    """Returns when the session or token has ended. A page that watches is in use."""
    while not ended.is_set():
        try:
            async with asyncio.timeout(LOOK_EVERY_S):
                await ended.wait()
        except TimeoutError:
            if not _lasts(access, visitor):
                ended.set()
            elif visitor.session is not None:
                access.sessions.seen(visitor.session)


def _lasts(access: Access, visitor: Visitor) -> bool:
    session_lasts = visitor.session is None or access.sessions.lasts(visitor.session)
    return session_lasts and (visitor.token is None or access.machines.lasts(visitor.token))


def _permitted_still(access: Access, scope: Scope, name: str, need: Need, receive: Receive) -> Receive:
    """Raises ApiProblem, where the body is read, for whoever may not make the call any more when its end has come: they
    can be signed out, shut out or given another role while they hold it back."""
    if need.anyone or scope["method"] in SAFE_METHODS:
        return receive
    whole = False

    async def still() -> Message:
        nonlocal whole
        message = await receive()
        if whole or message["type"] != "http.request" or message.get("more_body", False):
            return message
        whole = True
        try:
            visitor = _visitor(access, scope, address_of(scope))
            _permit(access, visitor, scope, name, need)
        except Denied as error:
            raise ApiProblem(error.status, error.reason, headers=retry_after(error.reason)) from None
        scope["state"]["principal"] = visitor.principal
        return message

    return still


def address_of(scope: Scope) -> str:
    """Of the machine that asks; a trusted proxy has said which."""
    client = scope.get("client")
    return "unknown" if client is None else str(client[0])


def _visitor(access: Access, scope: Scope, address: str) -> Visitor:
    """Who asks. Raises Denied 429 where too many unknown tokens came from."""
    return Visitor(local_person(address)) if access.mode == "alone" else _named(access, scope, address)


def _permit(access: Access, visitor: Visitor, scope: Scope, name: str, need: Need) -> None:
    """Raises Denied unless they may make this call."""
    headers, principal = Headers(scope=scope), visitor.principal
    if access.mode == "waiting" and name not in BEFORE_PEOPLE:
        raise Denied(401, FirstAdminNeeded())
    if principal is None:
        if need.anyone:
            return
        raise Denied(401, SignInNeeded() if _token_of(headers) is None else UnknownToken())
    if principal.local and not need.anyone and any(header in headers for header in FORWARDED):
        raise Denied(403, BehindProxy())
    refused: Reason | None = principal.refused(need)
    if refused is not None:
        raise Denied(403, refused)
    changes = scope["type"] == "websocket" or scope["method"] not in SAFE_METHODS
    if visitor.session is not None and changes and not _from_own_page(scope, headers):
        raise Denied(403, OriginMissing())


def _named(access: Access, scope: Scope, address: str) -> Visitor:
    headers = Headers(scope=scope)
    token = _token_of(headers)
    if token is not None:
        machine = access.machines.found(token, address)
        return Visitor(None) if machine is None else Visitor(machine[0], token=machine[1])
    secret = cookie_of(scope, headers)
    found = None if secret is None else access.signed_in(secret, address)
    return Visitor(None) if found is None else Visitor(found[0], session=found[1])


def _token_of(headers: Headers) -> str | None:
    scheme, _, token = headers.get("authorization", "").partition(" ")
    return token.strip() if scheme.lower() == "bearer" else None


def encrypted(scope: Scope) -> bool:
    """As the server or a trusted proxy knows it."""
    return scope["scheme"] in {"https", "wss"}


def cookie_of(scope: Scope, headers: Headers) -> str | None:
    """The session's secret. Over https only the name counts that no other host and no http page can set."""
    try:
        cookies = SimpleCookie(headers.get("cookie", ""))
    except CookieError:
        return None
    found = cookies.get(SECURE_COOKIE if encrypted(scope) else PLAIN_COOKIE)
    return None if found is None else found.value


def _from_own_page(scope: Scope, headers: Headers) -> bool:
    """The guard has refused a foreign Origin; here it must be there, and no http page may speak for an https one."""
    origin = headers.get("origin", "")
    place = place_of(origin)
    same = place == headers.get("host", "").lower()
    return bool(place) and same and (urlsplit(origin).scheme == "https" or not encrypted(scope))


def _note(
    access: Access,
    scope: Scope,
    name: str,
    principal: Principal | None,
    address: str,
    status: int,
    reason: str | None = None,
    detail: dict[str, object] | None = None,
) -> None:
    outcome = "allowed" if status < 400 else "refused" if status < 500 else "failed"
    if outcome == "refused" and not access.limits.notes_refusal():
        return
    who = None if principal is None else principal.name
    person = None if principal is None else principal.person
    access.audit.note(
        call=name, path=scope["path"][:200], who=who, person=person, address=address, status=status, outcome=outcome,
        **({} if reason is None else {"reason": reason}), **(detail or {}),
    )  # fmt: skip


def _noting(
    access: Access, scope: Scope, name: str, principal: Principal | None, address: str, need: Need, send: Send
) -> Send:
    """Notes how an audited call was answered, and every refusal; an endpoint may add to it (request.state.audit),
    and says there with which status it refused whoever it sends back to the page."""

    async def noting(message: Message) -> None:
        if message["type"] == "http.response.start":
            detail = dict(scope["state"]["audit"])
            status: int = detail.pop("status", message["status"])
            if need.audited or status in (401, 403, 429):
                who = detail.pop("principal", principal)
                _note(access, scope, name, who, address, status, detail=detail)
        await send(message)

    return noting
