"""A radio link that delivers late: packets in the order they were sent, each some time after."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator


class Radio:
    """One direction. Times: any one clock's seconds."""

    def __init__(self) -> None:
        self._under_way: deque[tuple[float, bytes]] = deque()

    def put(self, packet: bytes, arrives_at: float) -> None:
        """No packet overtakes an earlier one."""
        last = self._under_way[-1][0] if self._under_way else arrives_at
        self._under_way.append((max(arrives_at, last), packet))

    def arrived(self, now: float) -> Iterator[bytes]:
        """What has come out by now, each once."""
        while self._under_way and self._under_way[0][0] <= now:
            yield self._under_way.popleft()[1]
