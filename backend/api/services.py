"""The parts behind the API, as the endpoints see them."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from backend.api.stock import Stock, stocks
from backend.auth.access import Access
from backend.live.hub import Hub
from backend.maps.overlay_folder import OverlayFolder
from backend.ports import Kept
from backend.settings import Settings
from backend.store.iq_folder import IqFolder
from backend.store.journal import SqlJournal
from backend.store.told_folder import ToldFolder
from backend.wire.health import BearingsUdpHealth, StockKind
from backend.workers import Workers
from hardware.direction_finding.antenna import AntennaPattern
from hardware.payload.session import PayloadHub
from hardware.ports import DirectionFinder

if TYPE_CHECKING:
    from backend.auth.provider import Provider
    from backend.mission.room import MissionRoom


DESK_S, DESK_BYTES = 120.0, 2 * 2**30
"""What the work on one mission may take."""


@dataclass(frozen=True, slots=True)
class Services:
    """Everything the endpoints use; made once by the application's start.

    now: UTC epoch seconds of the mission's clock. wall: of the machine's, which may be set, or go on while the machine
    sleeps: the mission's does neither. planning: what-if questions are answered one at a time, so that they never take
    the planner's threads from the flight. payload: None where no companion computer may connect. bearings: how what
    comes by UDP is, None where no port is open.
    beside: short work on missions runs in one thread at a time, since each more takes the interpreter from the flight.
    workers: read what comes from outside. desk: works on whole missions, so that no file from outside keeps it waiting.
    stocks: what comes from outside, and how much of it may be kept. iq: of recordings that came as SigMF.
    told: what checked missions say of their errors, reckoned once by whoever asks first (reckoning).
    access: who may enter. provider: whom the settings trust to say who somebody is.
    """

    missions: MissionRoom
    journal: SqlJournal
    hub: Hub
    settings: Settings
    now: Callable[[], float]
    access: Access = field(kw_only=True)
    finder: DirectionFinder = field(kw_only=True)
    pattern: AntennaPattern = field(kw_only=True)
    payload: PayloadHub | None = None
    bearings: Callable[[], BearingsUdpHealth] | None = field(default=None, kw_only=True)
    provider: Provider | None = field(default=None, kw_only=True)
    workers: Workers = field(default_factory=Workers)
    desk: Workers = field(default_factory=lambda: Workers(time_s=DESK_S, memory_bytes=DESK_BYTES))
    planning: asyncio.Semaphore = field(default_factory=lambda: asyncio.Semaphore(1))
    beside: asyncio.Semaphore = field(default_factory=lambda: asyncio.Semaphore(1))
    wall: Callable[[], float] = time.time
    began_monotonic_s: float = field(default_factory=time.monotonic)
    stocks: dict[StockKind, Stock] = field(init=False)
    iq: IqFolder = field(init=False)
    told: ToldFolder = field(init=False)
    reckoning: asyncio.Lock = field(init=False, default_factory=asyncio.Lock)

    def __post_init__(self) -> None:
        overlays = OverlayFolder(self.settings.data_dir / "overlays")

        async def kept_overlays() -> Kept:
            return await asyncio.to_thread(overlays.kept)

        made = stocks(self.settings, kept_overlays, self.journal.imported_sweeps)
        object.__setattr__(self, "stocks", made)
        object.__setattr__(self, "iq", IqFolder.of_settings(self.settings))
        object.__setattr__(self, "told", ToldFolder.of_settings(self.settings))

    async def close(self) -> None:
        """Ends what runs beside requests; the journal is the caller's."""
        for stock in self.stocks.values():
            await stock.close()
        await self.workers.close()
        await self.desk.close()
