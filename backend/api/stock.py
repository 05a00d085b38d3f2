"""How much is kept of what comes from outside, and how much may be: overlays and the raw sweeps of recordings."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Awaitable, Callable
from contextlib import suppress
from dataclasses import dataclass, field

from backend.api.problems import ApiProblem
from backend.ports import JournalUnavailable, Kept
from backend.reasons.storage import StockFull
from backend.settings import Settings
from backend.wire.health import StockHealth, StockKind

LOOK_AFTER_S = 60.0


@dataclass(slots=True)
class Stock:
    """One kind. count: how much is kept now, as its store knows it."""

    what: StockKind
    most: int
    most_bytes: int
    count: Callable[[], Awaitable[Kept]]
    known: Kept | None = None
    _looking: asyncio.Task[None] | None = None
    _looked_at_s: float = field(default=-LOOK_AFTER_S)

    async def must_take(self, more: int, more_bytes: int) -> None:
        """Raises ApiProblem when that would be too much, JournalUnavailable."""
        self.known = kept = await self.count()
        if kept.number + more > self.most or kept.size_bytes + more_bytes > self.most_bytes:
            raise ApiProblem(413, StockFull(self.what, self.most, self.most_bytes))

    def health(self) -> StockHealth:
        """As last counted; asks nobody, but has it counted again for the next who asks."""
        now_s = time.monotonic()
        if now_s - self._looked_at_s >= LOOK_AFTER_S and (self._looking is None or self._looking.done()):
            self._looked_at_s = now_s
            self._looking = asyncio.create_task(self._look())
        kept = self.known
        return StockHealth(
            what=self.what,
            number=None if kept is None else kept.number,
            most=self.most,
            size_bytes=None if kept is None else kept.size_bytes,
            most_bytes=self.most_bytes,
            full=kept is not None and (kept.number >= self.most or kept.size_bytes >= self.most_bytes),
        )

    async def close(self) -> None:
        """Nothing is asked of the store any more."""
        if self._looking is not None:
            self._looking.cancel()
            await asyncio.gather(self._looking, return_exceptions=True)

    async def _look(self) -> None:
        with suppress(JournalUnavailable, OSError):  # the database's own part of the page says so
            self.known = await self.count()


def stocks(
    settings: Settings, overlays: Callable[[], Awaitable[Kept]], recordings: Callable[[], Awaitable[Kept]]
) -> dict[StockKind, Stock]:
    """With the limits of the settings."""
    return {
        "overlays": Stock("overlays", settings.overlays_max, settings.overlays_max_bytes, overlays),
        "recordings": Stock("recordings", settings.recordings_max_sweeps, settings.recordings_max_bytes, recordings),
    }
