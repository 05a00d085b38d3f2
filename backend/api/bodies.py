"""What may come in the body of a request: how large, how slowly, and how much JSON.

The event loop itself reads JSON and compares it with its model, and an abort waits meanwhile: a text of 8 MB with a
million wrong fields takes it a minute and a half. What is longer or richer than any honest request is refused unread.
"""

from __future__ import annotations

import asyncio
from contextlib import suppress

from starlette.datastructures import Headers
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from backend.api.problems import ApiProblem, respond
from backend.live.connections import spread
from backend.reasons import request as reasons
from backend.wire.problem import Problem, problem

ENTERING_BYTES = 16 * 2**10
"""What somebody may send who has not signed in."""
JSON_BYTES = 256 * 2**10
"""A mission with all its areas takes a tenth of it."""
LARGE_JSON_BYTES = 2**21
"""With the text of an antenna's pattern inside."""
AREA_BYTES = 8 * 2**20
"""With the text of a KML or GeoJSON file inside."""
RECORDING_BYTES = 128 * 2**20
"""A minute of IQ at the usual rates."""
EXPORT_BYTES = 20 * 2**20
"""Of a mission with 32 emitters and forty turns, unpacked: the worker that reads it takes up to eight times as much."""

ENTRANCES = ("/api/session", "/api/first-admin", "/api/recovery", "/api/invitation/")
UPLOADS = ("/api/maps", "/api/overlays", "/api/terrain")
"""Their bodies are files, under limits of their own."""
OF_MISSIONS = ("/api/recordings/read", "/api/bundles")
READ_APART = ("/api/recordings/read",)
"""Its JSON is read in a process of its own, and may be as rich as a mission is."""

MOST_FIELDS = 2_000
MOST_ITEMS = 20_000
MOST_QUOTES = 2 * (2 * MOST_FIELDS + MOST_ITEMS)
"""Twice for each name, and for each value that is a text."""
PIECE_BYTES = 2**15
"""Even: of a piece of backslashes alone none escapes what comes after it."""
LET_PASS_BYTES = 64 * 2**20
STALL_S = 20.0
"""A body may stand still for at least this long."""


def most_bytes(path: str) -> int | None:
    """Of the body of a request to this path; None: the endpoint has its own limit."""
    if path.startswith(UPLOADS) and path != "/api/maps/coverage":
        return None
    if path.startswith("/api/missions/") and path.endswith("/ways"):
        return None
    if path.startswith(ENTRANCES):
        return ENTERING_BYTES
    if path in OF_MISSIONS:
        return EXPORT_BYTES
    if path == "/api/areas":
        return AREA_BYTES
    if path.startswith("/api/missions/") and path.endswith("/recordings"):
        return RECORDING_BYTES
    return LARGE_JSON_BYTES if path.endswith("/what-if") else JSON_BYTES


def too_large(scope: Scope) -> Problem | None:
    """By what it says of itself."""
    length, most = Headers(scope=scope).get("content-length", "0"), most_bytes(scope["path"])
    if most is None or not length.isdigit() or int(length) <= most:
        return None
    return problem(413, _reason(scope, most))


def _reason(scope: Scope, most: int) -> reasons.BodyTooLarge:
    return reasons.BodyTooLarge(most, "mission" if scope["path"] in OF_MISSIONS else "other")


async def let_pass(receive: Receive) -> None:
    """Take the rest of a refused body and keep nothing of it: whoever still sends does not hear the refusal."""
    taken, more = 0, True
    with suppress(TimeoutError):
        async with asyncio.timeout(STALL_S):
            while more and taken < LET_PASS_BYTES:
                message = await receive()
                taken += len(message.get("body", b""))
                more = bool(message.get("more_body", False))


def too_rich(text: bytes) -> bool:
    """More fields or items than any request of ours has, whatever else is in it.

    In pieces, until it is known: a look at 8 MB at once would keep every other thread from running.
    """
    if len(text) <= MOST_FIELDS:
        return False
    fields = items = quotes = start = 0
    while start < len(text):
        piece = text[start : start + PIECE_BYTES]
        escaping = len(piece) - len(piece.rstrip(b"\\"))
        if escaping % 2 and escaping < len(piece):  # what it escapes is in the next piece
            piece = piece[:-1]
        start += len(piece)
        parts = piece.replace(rb"\\", b"").replace(rb"\"", b"").split(b'"')
        bare = b"".join(parts[quotes % 2 :: 2])
        fields, items, quotes = fields + bare.count(b":"), items + bare.count(b","), quotes + len(parts) - 1
        if fields > MOST_FIELDS or items > MOST_ITEMS or quotes > MOST_QUOTES:
            return True
    return False


async def _found_too_rich(text: bytes) -> bool:
    """In a thread when it is long."""
    return await asyncio.to_thread(too_rich, text) if len(text) > JSON_BYTES else too_rich(text)


class Bodies:
    """ASGI middleware, inside the gate: nothing is read for whoever may not make the call."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """The call gets a JSON body in one piece once it is known to be harmless, any other as it comes."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        arriving = _bounded(scope, receive)
        if not _is_json(scope):
            await self._app(scope, arriving, send)
            return
        try:
            body = await _whole(arriving)
        except ApiProblem as refused:
            if refused.status_code == 413:
                await let_pass(receive)
            await respond(refused.problem, {"connection": "close"})(scope, receive, send)
            return
        if body is None:
            return  # nobody waits for an answer
        if scope["path"] not in READ_APART and await _found_too_rich(body):
            found = problem(413, reasons.BodyTooRich(MOST_FIELDS, MOST_ITEMS))
            await respond(found)(scope, receive, send)
            return
        given = False

        async def at_once() -> Message:
            nonlocal given
            if given:
                return await receive()
            given = True
            return {"type": "http.request", "body": body, "more_body": False}

        await self._app(scope, at_once, send)


def _is_json(scope: Scope) -> bool:
    kind = Headers(scope=scope).get("content-type", "").partition(";")[0].strip().lower()
    return kind == "application/json" or kind.endswith("+json")


async def _whole(receive: Receive) -> bytes | None:
    """None: the caller has gone."""
    pieces: list[bytes] = []
    while True:
        message = await receive()
        if message["type"] == "http.disconnect":
            return None
        pieces.append(message.get("body", b""))
        if not message.get("more_body", False):
            return b"".join(pieces)


def _bounded(scope: Scope, receive: Receive) -> Receive:
    """Raises ApiProblem, where the body is read, for one that is too large or stands still."""
    most = most_bytes(scope["path"])
    taken, more = 0, True

    async def bounded() -> Message:
        nonlocal taken, more
        if not more:
            return await receive()  # whether the caller is still there
        try:
            async with asyncio.timeout(spread(STALL_S)):
                message = await receive()
        except TimeoutError:
            raise ApiProblem(408, reasons.BodyTooSlow(STALL_S), headers={"connection": "close"}) from None
        taken += len(message.get("body", b""))
        more = bool(message.get("more_body", False))
        if most is not None and taken > most:
            raise ApiProblem(413, _reason(scope, most))
        return message

    return bounded
