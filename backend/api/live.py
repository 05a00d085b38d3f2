"""The live websocket /api/live?mission=ID&after=SEQ&lite=0|1. It only tells; whatever a browser sends is ignored.

Close codes: 4400 the address makes no sense, 4404 no such mission, 1013 too many viewers or the journal does not
answer (try again), 4408 the viewer took nothing for too long (come back with after = its last number), 4500 what is
stored of the mission is damaged.
"""

from __future__ import annotations

import asyncio
import re
from contextlib import suppress

from fastapi import APIRouter, WebSocket, WebSocketDisconnect

from backend.api.services import Services
from backend.live.hub import Hub, Viewer
from backend.live.viewer import ViewerStalled, serve
from backend.ports import JournalDamaged, JournalUnavailable
from backend.version import VERSION
from backend.wire.messages import Hello

router = APIRouter()

MISSION_ID = re.compile(r"[A-Za-z0-9_-]{1,64}")


class Refused(Exception):
    """Closes the websocket; a browser sees code and reason, which it would not of a refused handshake."""

    def __init__(self, code: int, reason: str) -> None:
        super().__init__(reason)
        self.code, self.reason = code, reason


@router.websocket("/api/live")
async def live(websocket: WebSocket) -> None:
    """Close codes: 1013 the journal is away, 4408 too slow (come back with after=SEQ), 4500 damaged; else those of
    Refused."""
    services: Services = websocket.app.state.services
    await websocket.accept()
    with suppress(WebSocketDisconnect):
        try:
            await _live(websocket, services)
        except Refused as refused:
            await websocket.close(refused.code, refused.reason)
        except JournalUnavailable as error:
            await websocket.close(1013, str(error)[:120])
        except JournalDamaged as error:
            await websocket.close(4500, str(error)[:120])
        except ViewerStalled:
            await websocket.close(4408, "nothing was taken for too long: come back with after=SEQ")


async def _live(websocket: WebSocket, services: Services) -> None:
    hub = services.hub
    if hub.viewers() >= services.settings.live_clients_max:
        raise Refused(1013, "too many viewers: close another page")
    mission_id, after, lite = _parameters(websocket)
    last_seq = await _last_seq(services, mission_id)
    viewer = Viewer(mission_id, lite, cursor=after if after <= last_seq else 0)
    hub.join(viewer, last_seq)
    try:
        hello = Hello(
            server_version=VERSION,
            mission_id=mission_id,
            last_seq=last_seq,
            time_factor=services.settings.time_factor,
        )
        await websocket.send_text(hello.model_dump_json())
        await _serve_until_gone(websocket, hub, viewer)
    finally:
        hub.leave(viewer)


async def _serve_until_gone(websocket: WebSocket, hub: Hub, viewer: Viewer) -> None:
    async def send(content: str | bytes) -> None:
        if isinstance(content, bytes):
            await websocket.send_bytes(content)
        else:
            await websocket.send_text(content)

    async def until_gone() -> None:
        while (await websocket.receive())["type"] != "websocket.disconnect":
            pass

    serving = asyncio.create_task(serve(hub, viewer, send))
    watching = asyncio.create_task(until_gone())
    try:
        await asyncio.wait({serving, watching}, return_when=asyncio.FIRST_COMPLETED)
    finally:
        watching.cancel()
        serving.cancel()
        results = await asyncio.gather(serving, watching, return_exceptions=True)
    fault = results[0]
    if isinstance(fault, Exception):
        raise fault


def _parameters(websocket: WebSocket) -> tuple[str | None, int, bool]:
    query = websocket.query_params
    mission_id, after, lite = query.get("mission"), query.get("after", "0"), query.get("lite", "0")
    if mission_id is not None and not MISSION_ID.fullmatch(mission_id):
        raise Refused(4400, "mission is no mission id")
    if not re.fullmatch(r"[0-9]{1,15}", after):
        raise Refused(4400, "after must be a whole number, 0 or more")
    if lite not in {"0", "1"}:
        raise Refused(4400, "lite must be 0 or 1")
    return mission_id, int(after), lite == "1"


async def _last_seq(services: Services, mission_id: str | None) -> int:
    if mission_id is None:
        return 0
    digest = await services.journal.mission(mission_id)
    if digest is None:
        raise Refused(4404, "no such mission")
    return digest.last_seq
