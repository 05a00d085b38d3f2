"""The vehicle's end of the proxy: MAVLink frames to and from an address in the form that `--vehicle` takes."""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from dataclasses import dataclass
from typing import cast
from urllib.parse import urlsplit

from tests.strikes.frames import Frame, Framer

Heard = Callable[[Frame], None]
Send = Callable[[bytes], None]
Address = tuple[str, int]


@dataclass(frozen=True, slots=True)
class End:
    """send: a frame to whoever is there. address: where that is, once heard; None: not by datagrams."""

    send: Send
    address: Callable[[], Address | None]


class _Datagrams(asyncio.DatagramProtocol):
    """peer: None until somebody spoke; then whoever spoke last."""

    def __init__(self, heard: Heard, peer: Address | None) -> None:
        self._heard = heard
        self._peer = peer
        self._framer = Framer()
        self._transport: asyncio.DatagramTransport | None = None
        self.closed = asyncio.Event()

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        self._transport = cast(asyncio.DatagramTransport, transport)

    def datagram_received(self, data: bytes, addr: Address) -> None:
        self._peer = addr
        for frame in self._framer.cut(data):
            self._heard(frame)

    def connection_lost(self, exc: Exception | None) -> None:
        self.closed.set()

    def error_received(self, exc: Exception) -> None:
        """Nobody listens yet: as on the air."""

    @property
    def peer(self) -> Address | None:
        return self._peer

    def send(self, raw: bytes) -> None:
        if self._transport is not None and self._peer is not None and not self._transport.is_closing():
            self._transport.sendto(raw, self._peer)


@asynccontextmanager
async def datagrams(heard: Heard, *, bind: Address | None = None, peer: Address | None = None) -> AsyncIterator[End]:
    """A UDP socket at `bind` that speaks to `peer`, or to whoever speaks to it."""
    loop = asyncio.get_running_loop()
    local = bind or ("127.0.0.1", 0)
    transport, protocol = await loop.create_datagram_endpoint(lambda: _Datagrams(heard, peer), local_addr=local)
    try:
        yield End(protocol.send, lambda: protocol.peer)
    finally:
        transport.close()
        await protocol.closed.wait()  # its port is free for the next one


@asynccontextmanager
async def vehicle_end(url: str, heard: Heard) -> AsyncIterator[End]:
    """url: udpin://, udpout:// or tcpout://HOST:PORT of the autopilot. Raises ValueError for another."""
    parts = urlsplit(url)
    if parts.hostname is None or parts.port is None or parts.scheme not in ("udpin", "udpout", "tcpout", "tcp"):
        raise ValueError(f"{url!r}: give the vehicle as udpin://, udpout:// or tcpout://HOST:PORT.")
    address = (parts.hostname, parts.port)
    if parts.scheme.startswith("udp"):
        ends = {"bind": address} if parts.scheme == "udpin" else {"peer": address}
        async with datagrams(heard, **ends) as end:
            yield end
        return
    reader, writer = await asyncio.open_connection(*address)
    reading = asyncio.create_task(_read(reader, heard))
    try:
        yield End(writer.write, lambda: None)
    finally:
        reading.cancel()
        writer.close()
        with contextlib.suppress(asyncio.CancelledError, OSError):
            await reading


async def _read(reader: asyncio.StreamReader, heard: Heard) -> None:
    framer = Framer()
    while data := await reader.read(65536):
        for frame in framer.cut(data):
            heard(frame)
