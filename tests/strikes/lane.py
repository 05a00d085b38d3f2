"""One way of a link: everything arrives late, and in its order."""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Callable


class Lane:
    """A radio keeps its order: nothing overtakes what is under way, also when the delay becomes shorter meanwhile."""

    def __init__(self) -> None:
        self._under_way: deque[tuple[float, Callable[[], None]]] = deque()

    def put(self, deliver: Callable[[], None], delay_s: float) -> None:
        """`deliver` is called in `delay_s`, at once when nothing delays it."""
        loop = asyncio.get_running_loop()
        now_s = loop.time()
        if delay_s <= 0.0 and not self._under_way:
            deliver()
            return
        last_s = self._under_way[-1][0] if self._under_way else now_s
        self._under_way.append((max(now_s + delay_s, last_s), deliver))
        if len(self._under_way) == 1:
            loop.call_at(self._under_way[0][0], self._arrive)

    def _arrive(self) -> None:
        try:
            self._under_way[0][1]()
        finally:
            self._under_way.popleft()
            if self._under_way:
                asyncio.get_running_loop().call_at(self._under_way[0][0], self._arrive)
