"""What every request passes first: is it for us, does it come from our own page, is it of a sane size?

A page of another site that is open in the operator's browser could otherwise reach the loopback address: by name
(DNS rebinding: the Host header tells) or by a plain cross-site request or websocket (the Origin header tells; a CORS
middleware guards neither the websocket nor requests that need no preflight).
"""

from __future__ import annotations

import ipaddress
from collections.abc import Iterable
from urllib.parse import urlsplit

from starlette.datastructures import Headers, MutableHeaders
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from backend.api.bodies import let_pass, too_large
from backend.api.problems import respond
from backend.reasons import request as reasons
from backend.wire.problem import Problem, problem

SAFE_METHODS = frozenset({"GET", "HEAD", "OPTIONS"})


class Guard:
    """Pure ASGI middleware around the whole application."""

    def __init__(self, app: ASGIApp, allowed_hosts: Iterable[str]) -> None:
        self._app = app
        self._allowed = {"localhost", *(host.lower() for host in allowed_hosts)}

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """A refused request reaches no endpoint; a websocket is looked at once, when it is opened."""
        if scope["type"] not in {"http", "websocket"}:
            await self._app(scope, receive, send)
            return
        headers = Headers(scope=scope)
        large = None
        refusal = self._foreign(scope, headers) or (large := too_large(scope))
        if refusal is not None:
            if large is not None:
                await let_pass(receive)
            await refuse(refusal, scope, receive, send)
            return
        if scope["type"] == "websocket":
            await self._app(scope, receive, send)
            return
        secured = _secured(send, headers.get("host", ""), scope["path"])
        await self._app(scope, receive, secured)

    def _foreign(self, scope: Scope, headers: Headers) -> Problem | None:
        host = headers.get("host", "")
        if not self._is_ours(host):
            return problem(421, reasons.UnknownHost(host[:100]))
        if scope["type"] == "http" and scope["method"] in SAFE_METHODS:
            return None
        origin = headers.get("origin")
        if origin is None or place_of(origin) == host.lower():
            return None
        return problem(403, reasons.ForeignOrigin(origin[:100]))

    def _is_ours(self, host: str) -> bool:
        """An IP address cannot be rebound, a name can: only known names pass."""
        try:
            parts = urlsplit(f"//{host}")
            name, _ = parts.hostname, parts.port
        except ValueError:
            return False
        if not name or parts.netloc != host or "@" in host:
            return False
        try:
            ipaddress.ip_address(name)
        except ValueError:
            return name in self._allowed
        return True


def place_of(origin: str) -> str:
    """Host and port that an Origin names, in small letters; "": it names none, or is no address at all."""
    try:
        return urlsplit(origin).netloc.lower()
    except ValueError:  # a bracket without its pair
        return ""


async def refuse(
    refusal: Problem, scope: Scope, receive: Receive, send: Send, headers: dict[str, str] | None = None
) -> None:
    """A websocket handshake is answered with the status too."""
    if scope["type"] == "websocket" and "websocket.http.response" not in scope.get("extensions", {}):
        await send({"type": "websocket.close", "code": 1008})
        return
    response = respond(refusal, headers)
    await response(scope, receive, send)


def _secured(send: Send, host: str, path: str) -> Send:
    """MapLibre makes its worker from a blob and its icons from data; nothing comes from another machine."""
    policy = (
        "default-src 'self'; script-src 'self'; worker-src 'self' blob:; style-src 'self' 'unsafe-inline'; "
        f"img-src 'self' data: blob:; connect-src 'self' ws://{host} wss://{host} blob: data:; frame-src 'self'; "
        "frame-ancestors 'self'; object-src 'none'; base-uri 'none'; form-action 'self'"
    )

    async def secured(message: Message) -> None:
        if message["type"] == "http.response.start":
            headers = MutableHeaders(scope=message)
            headers.setdefault("content-security-policy", policy)
            headers["x-content-type-options"] = "nosniff"
            headers["referrer-policy"] = "no-referrer"
            headers["cross-origin-opener-policy"] = "same-origin"
            headers["cross-origin-resource-policy"] = "same-origin"
            if path.startswith("/api/"):
                headers.setdefault("cache-control", "no-store")
        await send(message)

    return secured
