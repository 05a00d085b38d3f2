"""uvicorn's HTTP connection with limits: how many in all, how many of one address, and how long a request's head takes.

Without them a thousand half-sent requests use up the process's file descriptors, and nobody gets in. Where there is no
room left, whoever keeps the server waiting makes room: a stranger who fills every place with half a request, a body
that never ends or an answer that is never taken keeps nobody out for longer than a whole request takes to arrive.

A crowd that came at once is not sent away at once: it would come back so, and whoever came after it would wait for all
of it. A live websocket is counted only until it is one: the live channel has a limit of its own.
"""

from __future__ import annotations

import asyncio
import ipaddress
import random
import resource
from collections import Counter
from collections.abc import Callable, Collection
from dataclasses import dataclass, field
from typing import Any, Protocol

import h11
from uvicorn.protocols.http.h11_impl import H11Protocol


class Visitor(Protocol):
    """A connection, as the door sees it. Told apart by identity."""

    @property
    def keeps_waiting(self) -> bool:
        """Is it the other side's turn: to send a head or a body, or to take an answer?"""
        ...

    def turn_out(self) -> None:
        """Cut it off now."""
        ...


SPREAD = 1.5
"""Patience with one connection is between its least and this many times as much."""


def spread(least_s: float) -> float:
    """Seconds of patience with one connection, so that those of a crowd end one after the other."""
    return least_s * random.uniform(1.0, SPREAD)


@dataclass(slots=True)
class Door:
    """most: open at once. each: of one address, but for this machine's and `exempt` ones. head_s: for a whole head, at
    least.

    inside: the address of each, the longest there first. of_address: how many of each address are inside.
    """

    most: int
    each: int
    head_s: float
    exempt: Collection[str] = ()
    inside: dict[Visitor, str] = field(default_factory=dict[Visitor, str])
    of_address: Counter[str] = field(default_factory=Counter[str])

    def enter(self, visitor: Visitor, address: str) -> bool:
        """False: there are too many, and all of them are being served."""
        if self.of_address[address] >= self.each and address not in self.exempt and not _ours(address):
            if not self._make_room([other for other, whose in self.inside.items() if whose == address]):
                return False
        elif len(self.inside) >= self.most and not self._make_room(list(self.inside)):
            return False
        self.inside[visitor] = address
        self.of_address[address] += 1
        return True

    def leave(self, visitor: Visitor) -> None:
        """Nothing happens when it has left before."""
        address = self.inside.pop(visitor, None)
        if address is not None:
            self.of_address[address] -= 1
            if not self.of_address[address]:
                del self.of_address[address]

    def _make_room(self, among: list[Visitor]) -> bool:
        """Of those who keep the server waiting, the one from the address with the most of them who came first."""
        waited_for = [visitor for visitor in among if visitor.keeps_waiting]
        if not waited_for:
            return False
        crowd = Counter(self.inside[visitor] for visitor in waited_for)
        chosen = max(waited_for, key=lambda visitor: crowd[self.inside[visitor]])  # the first of the largest
        self.leave(chosen)
        chosen.turn_out()
        return True


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
        self._head_timer: asyncio.TimerHandle | None = None

    @property
    def keeps_waiting(self) -> bool:
        """As the door asks it."""
        return self.conn.their_state in (h11.IDLE, h11.SEND_BODY) or self.flow.write_paused

    def turn_out(self) -> None:
        """As the door orders it."""
        self.transport.abort()

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        """Closed again at once when there are too many."""
        super().connection_made(transport)
        if self._door.enter(self, "unknown" if self.client is None else self.client[0]):
            self._await_head()
        else:
            transport.abort()

    def connection_lost(self, exc: Exception | None) -> None:
        """Makes room."""
        self._left()
        super().connection_lost(exc)

    def data_received(self, data: bytes) -> None:
        """The time for a head runs until it is whole, for each request of a connection."""
        super().data_received(data)
        if self.conn.their_state is h11.IDLE:
            self._await_head()
        else:
            self._head_is_whole()

    def handle_websocket_upgrade(self, event: h11.Request) -> None:
        """From here on it is the live channel's."""
        self._left()
        super().handle_websocket_upgrade(event)

    def _await_head(self) -> None:
        if self._head_timer is None and self in self._door.inside:
            self._head_timer = asyncio.get_running_loop().call_later(spread(self._door.head_s), self._too_slow)

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
        self._door.leave(self)


def limited(door: Door) -> Callable[..., LimitedProtocol]:
    """For uvicorn's option `http`."""

    def connection(**uvicorns: Any) -> LimitedProtocol:
        return LimitedProtocol(door, **uvicorns)

    return connection


def allow_descriptors() -> int:
    """As many open files and connections as this process may ask for, the usual 1024 are few; how many that is."""
    _, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (hard, hard))
    return hard
