"""What every request passes first: is it for us, does it come from our own page, is it of a sane size?

A page of another site that is open in the operator's browser could otherwise reach the loopback address: by name
(DNS rebinding: the Host header tells) or by a plain cross-site request or websocket (the Origin header tells; a CORS
middleware guards neither the websocket nor requests that need no preflight).
"""

from __future__ import annotations

from collections.abc import Iterable
from urllib.parse import urlsplit

from starlette.datastructures import Headers
from starlette.types import ASGIApp, Receive, Scope, Send

from backend.api.bodies import let_pass, too_large
from backend.api.hosts import Hosts, secured
from backend.api.problems import respond
from backend.reasons import request as reasons
from backend.wire.problem import Problem, problem

SAFE_METHODS = frozenset({"GET", "HEAD", "OPTIONS"})


class Guard:
    """Pure ASGI middleware around the whole application."""

    def __init__(self, app: ASGIApp, allowed_hosts: Iterable[str]) -> None:
        self._app = app
        self._hosts = Hosts(allowed_hosts)

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
        await self._app(scope, receive, secured(send, headers.get("host", ""), scope["path"]))

    def _foreign(self, scope: Scope, headers: Headers) -> Problem | None:
        host = headers.get("host", "")
        if not self._hosts.ours(host):
            return problem(421, reasons.UnknownHost(host[:100]))
        if scope["type"] == "http" and scope["method"] in SAFE_METHODS:
            return None
        origin = headers.get("origin")
        if origin is None or urlsplit(origin).netloc.lower() == host.lower():
            return None
        return problem(403, reasons.ForeignOrigin(origin[:100]))


async def refuse(
    refusal: Problem, scope: Scope, receive: Receive, send: Send, headers: dict[str, str] | None = None
) -> None:
    """A websocket handshake is answered with the status too."""
    if scope["type"] == "websocket" and "websocket.http.response" not in scope.get("extensions", {}):
        await send({"type": "websocket.close", "code": 1008})
        return
    response = respond(refusal, headers)
    await response(scope, receive, send)
