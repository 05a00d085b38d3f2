"""An event loop whose time passes only while everybody waits: deterministic, and as quick as the work in it.

What a real loop hands to a thread is done on the spot, in no time at all.
"""

from __future__ import annotations

import asyncio
import selectors
import time
from collections.abc import Callable, Coroutine
from typing import Any, TypeVar

import pytest

T = TypeVar("T")


class _Skipping(selectors.SelectSelector):
    """Waits for nothing: the time until the next timer has passed at once."""

    def __init__(self) -> None:
        super().__init__()
        self.now_s = 1_000.0

    def select(self, timeout: float | None = None) -> list[tuple[selectors.SelectorKey, int]]:
        found = super().select(0.0)
        if not found:
            assert timeout is not None, "everybody waits, and nothing will ever happen"
            self.now_s += max(timeout, 0.0)
        return found


class SteppedLoop(asyncio.SelectorEventLoop):
    def __init__(self) -> None:
        self._skipping = _Skipping()
        super().__init__(self._skipping)

    def time(self) -> float:
        return self._skipping.now_s

    def run_in_executor(self, executor: object, func: Callable[..., Any], *args: Any) -> asyncio.Future[Any]:
        done: asyncio.Future[Any] = self.create_future()
        try:
            done.set_result(func(*args))
        except Exception as error:  # noqa: BLE001 (whoever awaits it gets it)
            done.set_exception(error)
        return done


def run_stepped(story: Coroutine[Any, Any, T]) -> T:
    """Run it to its end. The loop's time is also the monotonic clock of everything that runs meanwhile."""
    with pytest.MonkeyPatch.context() as patch, asyncio.Runner(loop_factory=SteppedLoop) as runner:
        patch.setattr(time, "monotonic", runner.get_loop().time)
        return runner.run(story)
