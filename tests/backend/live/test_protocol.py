"""uvicorn's websocket with peers that leave."""

from __future__ import annotations

import asyncio
import logging
from contextlib import suppress

import pytest
import uvicorn
from starlette.types import Receive, Scope, Send

from backend.live.protocol import LiveProtocol

HANDSHAKE = (
    "GET / HTTP/1.1\r\nHost: {host}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
    "Sec-WebSocket-Key: x3JJHMbDL1EzLkh9GBhXDw==\r\nSec-WebSocket-Version: 13\r\n\r\n"
)


@pytest.mark.parametrize("then", ["says something", "says nothing"])
async def test_a_viewer_who_leaves_during_the_handshake_is_no_error(
    caplog: pytest.LogCaptureFixture, then: str
) -> None:
    connections: list[LiveProtocol] = []
    ended = asyncio.Event()

    class Kept(LiveProtocol):
        async def run_asgi(self) -> None:
            connections.append(self)
            await super().run_asgi()
            ended.set()

    async def app(scope: Scope, receive: Receive, send: Send) -> None:
        connections[0].transport.close()  # as when its end was heard, and the loop has not told it yet
        await send({"type": "websocket.accept"})
        if then == "says something":
            with suppress(OSError):  # what starlette does with a peer that is gone
                await send({"type": "websocket.send", "text": "hello"})

    server = uvicorn.Server(uvicorn.Config(app, port=0, ws=Kept, log_config=None, lifespan="off"))
    running = asyncio.create_task(server.serve())
    async with asyncio.timeout(60):
        while not server.started:  # noqa: ASYNC110 (uvicorn has no event for it)
            await asyncio.sleep(0.01)
        address = server.servers[0].sockets[0].getsockname()
        _, writer = await asyncio.open_connection(*address)
        writer.write(HANDSHAKE.format(host=f"{address[0]}:{address[1]}").encode())
        await ended.wait()
        writer.close()
        server.should_exit = True
        await running
    assert [record.getMessage() for record in caplog.records if record.levelno >= logging.ERROR] == []
