"""uvicorn's HTTP connection with limits: how many in all, how many of one address, and how long a request's head takes.

Without them a thousand half-sent requests use up the process's file descriptors, and nobody gets in. A live websocket
is counted only until it is one: the live channel has a limit of its own.
"""

from __future__ import annotations

import asyncio
import ipaddress
from collections import Counter
from collections.abc import Callable, Collection
from dataclasses import dataclass, field
from typing import Any

import h11
from uvicorn.protocols.http.h11_impl import H11Protocol


@dataclass(slots=True)
class Door:
    """most: open at once. each: of one address, but for this machine's and `exempt` ones. head_s: for a whole head."""

    most: int
    each: int
    head_s: float
    exempt: Collection[str] = ()
    inside: Counter[str] = field(default_factory=Counter[str])

    def enter(self, address: str) -> bool:
        """False: there are too many."""
        crowd = self.inside[address] >= self.each and address not in self.exempt and not _ours(address)
        if crowd or self.inside.total() >= self.most:
            return False
        self.inside[address] += 1
        return True

    def leave(self, address: str) -> None:
        """Once for each that has entered."""
        self.inside[address] -= 1
        if self.inside[address] <= 0:
            del self.inside[address]


def _ours(address: str) -> bool:
    try:
        return ipaddress.ip_address(address).is_loopback
    except ValueError:
        return False


class LimitedProtocol(H11Protocol):
    """Of one connection."""

    def __init__(self, door: Door, **uvicorns: Any) -> None:
        super().__init__(**uvicorns)
        self._door = door
        self._address: str | None = None
        self._head_timer: asyncio.TimerHandle | None = None

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        """Closed again at once when there are too many."""
        super().connection_made(transport)
        address = "unknown" if self.client is None else self.client[0]
        if not self._door.enter(address):
            transport.abort()
            return
        self._address = address
        self._await_head()

    def connection_lost(self, exc: Exception | None) -> None:
        """Makes room."""
        self._left()
        super().connection_lost(exc)

    def data_received(self, data: bytes) -> None:
        """The time for a head runs until it is whole, for each request of a connection."""
        super().data_received(data)
        if self.conn.their_state is h11.IDLE and self._address is not None:
            self._await_head()
        else:
            self._head_is_whole()

    def handle_websocket_upgrade(self, event: h11.Request) -> None:
        """From here on it is the live channel's."""
        self._left()
        super().handle_websocket_upgrade(event)

    def _await_head(self) -> None:
        if self._head_timer is None:
            self._head_timer = asyncio.get_running_loop().call_later(self._door.head_s, self._too_slow)

    def _head_is_whole(self) -> None:
        if self._head_timer is not None:
            self._head_timer.cancel()
            self._head_timer = None

    def _too_slow(self) -> None:
        self._head_timer = None
        if not self.transport.is_closing():
            self.transport.abort()

    def _left(self) -> None:
        self._head_is_whole()
        if self._address is not None:
            self._door.leave(self._address)
            self._address = None


def limited(door: Door) -> Callable[..., LimitedProtocol]:
    """For uvicorn's option `http`."""

    def connection(**uvicorns: Any) -> LimitedProtocol:
        return LimitedProtocol(door, **uvicorns)

    return connection
