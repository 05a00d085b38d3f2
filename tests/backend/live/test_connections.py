"""The door of the HTTP server, over real sockets: half-sent requests keep nobody out."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager, suppress
from dataclasses import dataclass
from typing import Any

import pytest
import uvicorn

from backend.live.connections import Door, limited

HEAD = b"GET / HTTP/1.1\r\nhost: x\r\n"


async def hello(scope: dict[str, Any], receive: Any, send: Any) -> None:
    await send({"type": "http.response.start", "status": 200, "headers": [(b"content-length", b"2")]})
    await send({"type": "http.response.body", "body": b"hi"})


async def reading(scope: dict[str, Any], receive: Any, send: Any) -> None:
    """Answers once the whole body is there."""
    while (await receive()).get("more_body", False):
        pass
    await hello(scope, receive, send)


@asynccontextmanager
async def serving(door: Door, answers: Any = hello) -> AsyncIterator[int]:
    config = uvicorn.Config(answers, port=0, http=limited(door), lifespan="off", log_level="warning")  # type: ignore[arg-type]
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


async def test_half_sent_requests_are_closed_when_their_time_is_up() -> None:
    door = Door(most=5, each=100, head_s=0.5)
    async with serving(door) as port:
        half = [await asyncio.open_connection("127.0.0.1", port) for _ in range(8)]
        for number, (_, writer) in enumerate(half):
            writer.write(HEAD if number % 2 else b"")
        for reader, writer in half:
            await closed(reader, writer)
        assert await answered(port)
        assert len(door.inside) <= 1


@pytest.mark.parametrize("sent", [b"", HEAD, b"POST / HTTP/1.1\r\nhost: x\r\ncontent-length: 9\r\n\r\nhalf"])
async def test_whoever_keeps_the_server_waiting_makes_room_for_a_whole_request(sent: bytes) -> None:
    door = Door(most=5, each=100, head_s=60)
    async with serving(door, reading) as port:
        half = [await asyncio.open_connection("127.0.0.1", port) for _ in range(20)]
        for _, writer in half:
            writer.write(sent)
        for _ in range(3):
            assert await answered(port), "though nobody's time is up"
        assert len(door.inside) <= 5
        for _, writer in half:
            writer.close()


async def test_a_head_that_drips_in_is_closed_too_also_the_second_of_a_connection() -> None:
    async with serving(Door(most=5, each=5, head_s=0.3)) as port:
        reader, writer = await asyncio.open_connection("127.0.0.1", port)
        writer.write(HEAD + b"\r\n")
        assert b"hi" in await reader.readuntil(b"hi")
        writer.write(b"GET / HT")
        await closed(reader, writer)


@dataclass(eq=False)
class Guest:
    keeps_waiting: bool = False
    out: bool = False

    def turn_out(self) -> None:
        self.out = True


def enters(door: Door, address: str, waiting: bool = False) -> Guest | None:
    guest = Guest(waiting)
    return guest if door.enter(guest, address) else None


def test_one_address_takes_no_more_than_its_share_but_for_our_own_and_the_proxies() -> None:
    door = Door(most=10, each=2, head_s=1.0, exempt=("10.0.0.9",))
    first, _, third = (enters(door, "10.0.0.1") for _ in range(3))
    assert first is not None
    assert third is None
    assert enters(door, "10.0.0.2"), "others enter"
    assert all(enters(door, address) for address in ("127.0.0.1",) * 3 + ("10.0.0.9",) * 3)
    assert enters(door, "::1")
    assert enters(door, "10.0.0.3") is None, "ten in all"
    door.leave(first)
    door.leave(first)
    assert enters(door, "10.0.0.1")
    for guest in list(door.inside):
        door.leave(guest)
    assert not door.inside, "nothing is kept of who has gone"


def test_room_is_made_at_the_largest_crowd_and_never_by_whoever_is_served() -> None:
    door = Door(most=5, each=3, head_s=1.0)
    upload = enters(door, "10.0.0.1", waiting=True)
    served = enters(door, "10.0.0.2")
    crowd = [enters(door, "10.0.0.3", waiting=True) for _ in range(3)]
    assert all([upload, served, *crowd])
    assert enters(door, "10.0.0.4")
    assert [guest.out for guest in crowd if guest] == [True, False, False], "the one that came first"
    assert enters(door, "10.0.0.3"), "within their share now, and room is made among themselves"
    assert upload is not None
    assert served is not None
    assert not upload.out
    assert not served.out


def test_a_crowded_address_makes_room_for_itself_only() -> None:
    door = Door(most=100, each=2, head_s=1.0)
    other = enters(door, "10.0.0.1", waiting=True)
    slow, busy = enters(door, "10.0.0.2", waiting=True), enters(door, "10.0.0.2")
    assert enters(door, "10.0.0.2")
    assert enters(door, "10.0.0.2") is None
    assert [guest.out for guest in (other, slow, busy) if guest] == [False, True, False]
