"""A bad radio link between a simulated vehicle and a server: every datagram late, some lost, both ways."""

from __future__ import annotations

import asyncio
import random
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from dataclasses import dataclass, field
from typing import cast

Address = tuple[str, int]


@dataclass
class PoorLink:
    """delay_s: one way, wall seconds. loss: share of datagrams. `passed` and `lost` count both ways."""

    delay_s: float
    loss: float
    chance: random.Random = field(default_factory=lambda: random.Random(1))
    passed: int = 0
    lost: int = 0

    def carry(self, data: bytes, transport: asyncio.DatagramTransport | None, to: Address | None) -> None:
        if transport is None or to is None or self.chance.random() < self.loss:
            self.lost += 1
            return
        self.passed += 1
        asyncio.get_running_loop().call_later(self.delay_s, self._deliver, data, transport, to)

    @staticmethod
    def _deliver(data: bytes, transport: asyncio.DatagramTransport, to: Address) -> None:
        if not transport.is_closing():
            transport.sendto(data, to)


class _Side(asyncio.DatagramProtocol):
    """One end of the link: what comes in here goes out at the other end, to whoever spoke there last."""

    def __init__(self, link: PoorLink, peer: Address | None) -> None:
        self.link = link
        self.peer = peer
        self.other: _Side | None = None
        self.transport: asyncio.DatagramTransport | None = None

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        self.transport = cast(asyncio.DatagramTransport, transport)

    def datagram_received(self, data: bytes, addr: Address) -> None:
        self.peer = addr
        if self.other is not None:
            self.link.carry(data, self.other.transport, self.other.peer)

    def error_received(self, exc: Exception) -> None:
        """Nobody listens yet: as on the air."""


@asynccontextmanager
async def poor_link(link: PoorLink, vehicle_sends_to: int, server_listens_on: int) -> AsyncIterator[PoorLink]:
    """Loopback ports of both ends."""
    loop = asyncio.get_running_loop()
    vehicle, server = _Side(link, None), _Side(link, ("127.0.0.1", server_listens_on))
    vehicle.other, server.other = server, vehicle
    one, _ = await loop.create_datagram_endpoint(lambda: vehicle, local_addr=("127.0.0.1", vehicle_sends_to))
    two, _ = await loop.create_datagram_endpoint(lambda: server, local_addr=("127.0.0.1", 0))
    try:
        yield link
    finally:
        one.close()
        two.close()
