"""The live channel over real sockets."""

from __future__ import annotations

import asyncio
import base64
import json
import os
import socket

import numpy as np
import pytest
import websockets
from narrowing import known
from sqlalchemy import text

from backend.events import HoldOrdered, MissionDrafted
from backend.spec import MissionSpec, Polygon
from backend.store.engine import make_engine
from hardware.readings import Telemetry
from planner.belief.grid import GridBelief

SPEC = MissionSpec(name="s", area=Polygon(coordinates=[[(7.2, 50.6), (7.21, 50.6), (7.21, 50.61), (7.2, 50.6)]]))


async def happen(services, count: int, mission_id: str = "m") -> None:
    for _ in range(count):
        first = await services.journal.mission(mission_id) is None
        event = MissionDrafted(spec=SPEC) if first else HoldOrdered(craft_id="craft-1", by="x" * 500, reason=None)
        services.hub.events(await services.journal.append(mission_id, [event]))


async def take(websocket, kind: str) -> dict:
    while True:
        content = await asyncio.wait_for(websocket.recv(), 60)
        message = json.loads(content) if isinstance(content, str) else {"type": "belief", "frame": content}
        if message["type"] == kind:
            return message


async def test_hello_then_history_then_the_present(served, services):
    await happen(services, 3)
    async with websockets.connect(f"ws://{served}/api/live?mission=m&after=1") as websocket:
        hello = await take(websocket, "hello")
        assert (hello["mission_id"], hello["last_seq"], hello["time_factor"]) == ("m", 3, 1.0)
        assert [(await take(websocket, "event"))["recorded"]["seq"] for _ in range(2)] == [2, 3]
        await happen(services, 1)
        recorded = (await take(websocket, "event"))["recorded"]
        assert recorded["seq"] == 4
        services.hub.telemetry("craft-2", Telemetry(connected=True, at_s=1.0, mode="HOLD"), 2.0)
        heard = await take(websocket, "telemetry")
        assert (heard["craft_id"], heard["mode"]) == ("craft-2", "HOLD")
        belief = GridBelief(np.full((3, 2), 1 / 6), 0.0, 0.0, 1.0, (), (), 1, True)
        services.hub.belief("m", "emitter-1", 7, 1, belief, [(7.0, 50.0)] * 4)
        assert b'"nx":2' in (await take(websocket, "belief"))["frame"]


async def test_a_dropped_viewer_comes_back_where_it_was(served, services):
    await happen(services, 2)
    got = []
    for _ in range(3):
        async with websockets.connect(f"ws://{served}/api/live?mission=m&after={got[-1] if got else 0}") as websocket:
            await happen(services, 1)
            while not got or got[-1] < (await services.journal.mission("m")).last_seq:
                got.append((await take(websocket, "event"))["recorded"]["seq"])
    assert got == [1, 2, 3, 4, 5]


async def test_a_number_from_another_database_starts_from_the_beginning(served, services):
    await happen(services, 2)
    async with websockets.connect(f"ws://{served}/api/live?mission=m&after=99") as websocket:
        assert (await take(websocket, "hello"))["last_seq"] == 2
        assert (await take(websocket, "event"))["recorded"]["seq"] == 1


@pytest.mark.parametrize(
    ("query", "code"),
    [("mission=nobody", 4404), ("mission=../x", 4400), ("after=-1", 4400), ("after=x", 4400), ("lite=2", 4400)],
)
async def test_a_wrong_address_is_told_why(served, query, code):
    async with websockets.connect(f"ws://{served}/api/live?{query}") as websocket:
        with pytest.raises(websockets.ConnectionClosedError) as closed:
            await asyncio.wait_for(websocket.recv(), 60)
    assert known(closed.value.rcvd).code == code
    assert known(closed.value.rcvd).reason


async def test_a_damaged_mission_says_so_and_is_let_go(served, services, client):
    await happen(services, 2)
    services.journal._written.clear()
    services.hub._feeds.clear()
    engine = make_engine(services.settings.async_database_url, 60.0)
    async with engine.execution_options(write=True).begin() as connection:
        await connection.execute(text("UPDATE events SET body = :body WHERE seq = 2"), {"body": b"\x78\x9c no text"})
    await engine.dispose()
    async with websockets.connect(f"ws://{served}/api/live?mission=m") as websocket:
        async with asyncio.timeout(60):
            await websocket.wait_closed()
    assert (websocket.close_code, "damaged" in known(websocket.close_reason)) == (4500, True)
    reply = await client.get("/api/missions/m/events")
    assert (reply.status_code, reply.json()["reason"]["code"]) == (500, "mission_damaged")
    assert [one["mission_id"] for one in (await client.get("/api/missions")).json()["missions"]] == ["m"]


async def test_what_a_browser_sends_is_ignored(served, services):
    await happen(services, 1)
    async with websockets.connect(f"ws://{served}/api/live?mission=m") as websocket:
        for content in ("", "{}", '{"kind":"abort"}', b"\x00\xff", "x" * 60_000):
            await websocket.send(content)
        await happen(services, 1)
        assert [(await take(websocket, "event"))["recorded"]["seq"] for _ in range(2)] == [1, 2]


async def test_viewers_are_counted_while_they_are_there(served, services):
    for _ in range(3):
        async with websockets.connect(f"ws://{served}/api/live") as websocket:
            await take(websocket, "hello")
            assert services.hub.viewers() == 1
        await gone(services, 0)


async def gone(services, left: int) -> None:
    async with asyncio.timeout(60):
        while services.hub.viewers() > left:  # noqa: ASYNC110 (the server's side of a closed socket has no event)
            await asyncio.sleep(0.02)


def stalled_viewer(served: str) -> socket.socket:
    """Shakes hands and never reads again."""
    host, port = served.split(":")
    client = socket.socket()
    client.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 2048)
    client.connect((host, int(port)))
    key = base64.b64encode(os.urandom(16)).decode()
    request = f"GET /api/live?mission=m HTTP/1.1\r\nHost: {served}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
    client.sendall(f"{request}Sec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n\r\n".encode())
    return client


async def test_stalled_viewers_delay_nobody_and_are_cut_off(served, services):
    await happen(services, 1)
    stalled = [await asyncio.to_thread(stalled_viewer, served) for _ in range(3)]
    async with websockets.connect(f"ws://{served}/api/live?mission=m", max_queue=None) as websocket:
        async with asyncio.timeout(60):
            while services.hub.viewers() < 4:  # noqa: ASYNC110 (the server decides when one has joined)
                await asyncio.sleep(0.02)
        seqs = []
        for _ in range(40):
            await happen(services, 25)
            stored = known(await services.journal.mission("m")).last_seq
            while not seqs or seqs[-1] < stored:
                seqs.append((await take(websocket, "event"))["recorded"]["seq"])
        assert seqs == list(range(1, 1002))
        await gone(services, 1)
    for client in stalled:
        client.close()
