"""The websocket /api/payload on which companion computers deliver power samples (hardware.payload says what is said).

An agent shows its token in the header "Authorization: Bearer TOKEN"; 401 when it is none of ours, 404 when this server
takes no payload.
"""

from __future__ import annotations

from contextlib import suppress

from fastapi import APIRouter, WebSocket, WebSocketDisconnect

from backend.api.dependencies import PrincipalDep
from backend.api.problems import respond
from backend.api.services import Services
from backend.reasons.request import NoPayloadExpected, UnknownToken
from backend.wire.problem import problem

router = APIRouter()

NO_PAYLOAD = problem(404, NoPayloadExpected())
UNKNOWN_TOKEN = problem(401, UnknownToken())


@router.websocket("/api/payload")
async def payload(websocket: WebSocket, principal: PrincipalDep) -> None:
    """Denied before it is accepted when no payload is expected or the token is not ours."""
    services: Services = websocket.app.state.services
    hub = services.payload
    scheme, _, token = websocket.headers.get("authorization", "").partition(" ")
    if hub is None:
        await websocket.send_denial_response(respond(NO_PAYLOAD))
        return
    shown = scheme.lower() == "bearer" and hub.authenticate(token.strip())
    if not shown and principal.scope != "payload":
        await websocket.send_denial_response(respond(UNKNOWN_TOKEN))
        return
    await websocket.accept()
    with suppress(WebSocketDisconnect):
        await hub.serve(lambda: _text(websocket), websocket.send_text)
        await websocket.close(1008, "refused; the last message says why")


async def _text(websocket: WebSocket) -> str:
    """Binary messages are no part of the protocol: they are handed on as text that is refused there."""
    message = await websocket.receive()
    if message["type"] == "websocket.disconnect":
        raise WebSocketDisconnect(message.get("code", 1006))
    text = message.get("text")
    return (message.get("bytes") or b"").decode("utf-8", "replace") if text is None else text
