"""A writing transaction is handed over whole, and its result comes back once.

SQLite's asynchronous driver crosses into its thread and back for every step of every statement, 25 times for one fact;
each crossing waits for its turn at the interpreter, twice, and an order to hold waited for all of them. Here a thread
does the whole transaction.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Protocol

from sqlalchemy import Connection, Engine
from sqlalchemy.ext.asyncio import AsyncEngine

from backend.store.engine import make_direct_engine

Work = Callable[[Connection], None]


class Transactions(Protocol):
    """Closed when nothing is written any more."""

    async def run(self, work: Work) -> None:
        """Committed when it returns, else nothing of it is stored. A caller who no longer waits does not know which.

        Raises what `work` and the database raise.
        """
        ...

    async def close(self) -> None:
        """Connections of its own."""
        ...


def transactions_of(engine: AsyncEngine, timeout_s: float) -> Transactions:
    """timeout_s: how long the caller waits."""
    if engine.dialect.name == "sqlite":
        return InThread(make_direct_engine(engine, timeout_s))
    return OnLoop(engine)


class InThread:
    """SQLite: one after the other, in a thread of its own."""

    def __init__(self, engine: Engine) -> None:
        self._engine = engine
        self._writer = engine.execution_options(write=True)
        self._thread = ThreadPoolExecutor(1, "crossfix-journal")

    async def run(self, work: Work) -> None:
        """As above. What was not begun when its caller gave up is never done."""
        await asyncio.get_running_loop().run_in_executor(self._thread, self._done, work)

    def _done(self, work: Work) -> None:
        with self._writer.begin() as connection:
            work(connection)

    async def close(self) -> None:
        """As above."""
        await asyncio.get_running_loop().run_in_executor(self._thread, self._engine.dispose)
        self._thread.shutdown(wait=False)


class OnLoop:
    """PostgreSQL: its driver speaks on the event loop itself."""

    def __init__(self, engine: AsyncEngine) -> None:
        self._writer = engine.execution_options(write=True)

    async def run(self, work: Work) -> None:
        """As above."""
        async with self._writer.begin() as connection:
            await connection.run_sync(work)

    async def close(self) -> None:
        """The engine is its owner's."""
