"""The door of the HTTP server, over real sockets: half-sent requests keep nobody out."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager, suppress
from typing import Any

import uvicorn

from backend.live.connections import Door, limited

HEAD = b"GET / HTTP/1.1\r\nhost: x\r\n"


async def hello(scope: dict[str, Any], receive: Any, send: Any) -> None:
    await send({"type": "http.response.start", "status": 200, "headers": [(b"content-length", b"2")]})
    await send({"type": "http.response.body", "body": b"hi"})


@asynccontextmanager
async def serving(door: Door) -> AsyncIterator[int]:
    config = uvicorn.Config(hello, port=0, http=limited(door), lifespan="off", log_level="warning")  # type: ignore[arg-type]
    server = uvicorn.Server(config)
    running = asyncio.create_task(server.serve())
    while not server.started:  # noqa: ASYNC110 (uvicorn has no event for it)
        await asyncio.sleep(0.01)
    yield server.servers[0].sockets[0].getsockname()[1]
    server.should_exit = True
    await running


async def answered(port: int) -> bool:
    """Is a whole request answered?"""
    with suppress(OSError):
        reader, writer = await asyncio.open_connection("127.0.0.1", port)
        writer.write(HEAD + b"\r\n")
        line = await reader.readline()
        writer.close()
        await writer.wait_closed()
        return b"200" in line
    return False


async def closed(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
    """By the server, without an answer."""
    with suppress(OSError):
        assert await reader.read() == b""
    writer.close()
    with suppress(OSError):
        await writer.wait_closed()


async def test_half_sent_requests_are_closed_and_make_room() -> None:
    door = Door(most=5, each=100, head_s=0.5)
    async with serving(door) as port:
        half = [await asyncio.open_connection("127.0.0.1", port) for _ in range(8)]
        for number, (_, writer) in enumerate(half):
            writer.write(HEAD if number % 2 else b"")
        for reader, writer in half:
            await closed(reader, writer)
        assert await answered(port)
        assert door.inside.total() <= 1


async def test_a_head_that_drips_in_is_closed_too_also_the_second_of_a_connection() -> None:
    async with serving(Door(most=5, each=5, head_s=0.3)) as port:
        reader, writer = await asyncio.open_connection("127.0.0.1", port)
        writer.write(HEAD + b"\r\n")
        assert b"hi" in await reader.readuntil(b"hi")
        writer.write(b"GET / HT")
        await closed(reader, writer)


def test_one_address_takes_no_more_than_its_share_but_for_our_own_and_the_proxies() -> None:
    door = Door(most=10, each=2, head_s=1.0, exempt=("10.0.0.9",))
    assert [door.enter("10.0.0.1") for _ in range(3)] == [True, True, False]
    assert door.enter("10.0.0.2"), "others enter"
    assert all(door.enter(address) for address in ("127.0.0.1",) * 3 + ("10.0.0.9",) * 3)
    assert [door.enter("::1"), door.enter("10.0.0.3")] == [True, False], "ten in all"
    door.leave("10.0.0.1")
    assert door.enter("10.0.0.1")
    for address in list(door.inside.elements()):
        door.leave(address)
    assert not door.inside, "nothing is kept of who has gone"
