"""One way of a link: everything arrives late, and in its order."""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Callable


class Lane:
    """A radio keeps its order: nothing overtakes what is under way, also when the delay becomes shorter meanwhile.

    late_s: by how much a delivery came later than due, at most; set it to 0 to begin again. It is this process that was
    busy then, not the link.
    """

    def __init__(self) -> None:
        self.late_s = 0.0
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
        """All that is due: one each turn of a busy loop would hold up what comes behind it."""
        loop = asyncio.get_running_loop()
        try:
            while self._under_way and self._under_way[0][0] <= loop.time():
                due_s, deliver = self._under_way[0]
                self.late_s = max(self.late_s, loop.time() - due_s)
                try:
                    deliver()
                finally:
                    self._under_way.popleft()
        finally:
            if self._under_way:
                loop.call_at(self._under_way[0][0], self._arrive)
