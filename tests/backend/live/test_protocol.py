"""uvicorn's websocket with peers that leave."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager, suppress

import pytest
import uvicorn
import websockets
from starlette.types import ASGIApp, Receive, Scope, Send
from websockets.frames import Close, Frame, Opcode

from backend.live.protocol import LiveProtocol

HANDSHAKE = (
    "GET / HTTP/1.1\r\nHost: {host}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
    "Sec-WebSocket-Key: x3JJHMbDL1EzLkh9GBhXDw==\r\nSec-WebSocket-Version: 13\r\n\r\n"
)
LONGEST = 100
"""Bytes of a message."""


@asynccontextmanager
async def served(app: ASGIApp, protocol: type[LiveProtocol]) -> AsyncIterator[tuple[str, int]]:
    """Where it answers."""
    config = uvicorn.Config(app, port=0, ws=protocol, log_config=None, lifespan="off", ws_max_size=LONGEST)
    server = uvicorn.Server(config)
    running = asyncio.create_task(server.serve())
    async with asyncio.timeout(60):
        while not server.started:  # noqa: ASYNC110 (uvicorn has no event for it)
            await asyncio.sleep(0.01)
        yield server.servers[0].sockets[0].getsockname()
        server.should_exit = True
        await running


def errors(caplog: pytest.LogCaptureFixture) -> list[str]:
    return [record.getMessage() for record in caplog.records if record.levelno >= logging.ERROR]


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

    async with served(app, Kept) as (host, port):
        _, writer = await asyncio.open_connection(host, port)
        writer.write(HANDSHAKE.format(host=f"{host}:{port}").encode())
        await ended.wait()
        writer.close()
    assert errors(caplog) == []


@pytest.mark.parametrize(("message", "code"), [(b"x" * (LONGEST + 1), 1009), (b"\xff", 1007)])
async def test_what_is_said_to_a_viewer_who_was_just_cut_off_is_no_error(
    caplog: pytest.LogCaptureFixture, message: bytes, code: int
) -> None:
    """The loop tells the end of a connection a moment after it was cut off for what it sent."""
    connections: list[LiveProtocol] = []
    told = asyncio.Event()

    class Kept(LiveProtocol):
        async def run_asgi(self) -> None:
            connections.append(self)
            await super().run_asgi()

    async def app(scope: Scope, receive: Receive, send: Send) -> None:
        await send({"type": "websocket.accept"})
        while not connections[0].close_sent:  # noqa: ASYNC110 (nothing else stands between the cut and its news)
            await asyncio.sleep(0)
        assert connections[0] in connections[0].connections, "its end is known already"
        try:
            with suppress(OSError):
                await send({"type": "websocket.send", "text": "hello"})
        finally:
            told.set()

    async with served(app, Kept) as (host, port):
        async with websockets.connect(f"ws://{host}:{port}/") as viewer:
            await viewer.send(message, text=True)
            await told.wait()
            await viewer.wait_closed()
        assert viewer.close_code == code
    assert errors(caplog) == []


async def test_a_broken_text_that_its_senders_goodbye_overtakes_is_no_error(caplog: pytest.LogCaptureFixture) -> None:
    async def app(scope: Scope, receive: Receive, send: Send) -> None:
        await send({"type": "websocket.accept"})
        while (await receive())["type"] != "websocket.disconnect":
            pass

    async with served(app, LiveProtocol) as (host, port):
        reader, writer = await asyncio.open_connection(host, port)
        writer.write(HANDSHAKE.format(host=f"{host}:{port}").encode())
        await reader.readuntil(b"\r\n\r\n")
        broken, goodbye = Frame(Opcode.TEXT, b"\xff"), Frame(Opcode.CLOSE, Close(1000, "").serialize())
        writer.write(b"".join(frame.serialize(mask=True) for frame in (broken, goodbye)))
        await reader.read()
        writer.close()
    assert errors(caplog) == []
