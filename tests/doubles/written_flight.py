"""What a flight writes, and whether all of it was stored."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager, suppress

import numpy as np
from narrowing import a

from backend.events import HoldOrdered, MissionDrafted, MissionStarted
from backend.ports import TrackPoint
from backend.spec import MissionSpec, Polygon
from backend.store.journal import SqlJournal
from hardware.readings import Place, Sweep

SPEC = MissionSpec(name="s", area=Polygon(coordinates=[[(7.2, 50.6), (7.21, 50.6), (7.21, 50.61), (7.2, 50.6)]]))
DRAFT = MissionDrafted(spec=SPEC)
HOME = Place(lat=50.6, lon=7.2)
STARTED = MissionStarted(craft_id="craft-1", by="operator", home=HOME, home_amsl_m=100.0, software="0")
SWEEP = Sweep(np.arange(3.0), np.arange(3.0), np.arange(3.0), 868e6, Place(50.6, 7.2), 140.0)


def hold(n: int) -> HoldOrdered:
    return HoldOrdered(craft_id="craft-1", by=str(n), reason=None)


@asynccontextmanager
async def watched(journal: SqlJournal) -> AsyncIterator[None]:
    task = asyncio.create_task(journal.run())
    yield
    task.cancel()
    with suppress(asyncio.CancelledError):
        await task


async def until(journal: SqlJournal, state: str) -> None:
    async with asyncio.timeout(30):
        while journal.report().state != state:  # noqa: ASYNC110 (the report is polled by its users too)
            await asyncio.sleep(0.02)


class Flight:
    """Writes what a flight writes, and knows what was acknowledged."""

    def __init__(self, journal: SqlJournal) -> None:
        self.journal = journal
        self.count = 0

    async def begin(self) -> None:
        await self.journal.append("m", [DRAFT, STARTED])

    async def go_on(self, steps: int) -> None:
        for _ in range(steps):
            n = self.count
            await self.journal.append("m", [hold(n)])
            await self.journal.save_sweep("m", f"s{n}", "craft-1", "emitter-1", 1, 1, SWEEP)
            point = TrackPoint(1.7e9 + n, 50.6, 7.2, 140.0, 40.0, 0.0, None, None)
            await self.journal.save_track("m", "craft-1", [point])
            self.count += 1

    async def check(self, stored: SqlJournal) -> None:
        read = await stored.read("m")
        assert [record.seq for record in read] == list(range(1, self.count + 3))
        assert [a(HoldOrdered, record.event).by for record in read[2:]] == [str(n) for n in range(self.count)]
        assert len((await stored.tracks("m"))["craft-1"]) == self.count
        for n in range(self.count):
            assert await stored.sweep("m", f"s{n}") is not None
