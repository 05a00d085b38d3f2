"""What the mission needs of the rooms above it, as protocols: the journal keeps facts, the publisher shows them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, Protocol

from backend.events import Event, Recorded
from hardware.readings import Sweep, Telemetry
from planner.belief.grid import GridBelief


@dataclass(frozen=True, slots=True)
class TrackPoint:
    """One thinned point of the flown track (2 Hz)."""

    at_s: float
    lat_deg: float
    lon_deg: float
    altitude_amsl_m: float
    altitude_relative_m: float
    heading_deg: float
    battery_percent: float | None
    mode: str | None


class JournalUnavailable(RuntimeError):
    """The database is away (reading), or the spool is full as well (writing). Nothing stored is lost."""


class FactRefused(ValueError):
    """The journal will never take this: the fact makes no sense, or another writer has used its place."""


class Journal(Protocol):
    """Append-only facts. `append` returns only when they are durable; nothing is published before that."""

    async def append(self, mission_id: str, events: Sequence[Event]) -> list[Recorded]:
        """All or none. Raises JournalUnavailable (try again), FactRefused (never)."""
        ...

    async def keep_aside(self, mission_id: str, events: Sequence[Event], why: str) -> None:
        """For a person to look at: facts that were refused. They are counted and block nothing."""
        ...

    async def read(self, mission_id: str, after: int = 0) -> list[Recorded]: ...

    async def save_sweep(self, mission_id: str, sweep_id: str, place_number: int, attempt: int, sweep: Sweep) -> None:
        """Raises JournalUnavailable, FactRefused (then it was kept aside)."""
        ...

    async def save_track(self, mission_id: str, points: Sequence[TrackPoint]) -> None: ...

    async def unfinished(self) -> list[str]:
        """Missions that were started and have no MissionEnded: what a restart must bring back to HOLD."""
        ...


@dataclass(frozen=True, slots=True)
class Status:
    """What the mission does now, in words (see wire.messages.StatusMessage)."""

    mission_id: str | None
    phase: str | None
    doing: str
    waits_for: str | None
    receiver: Literal["ok", "silent", "off", "lost"]
    receiver_power_db: float | None
    receiver_age_s: float | None
    battery_to_return_percent: float | None
    database: Literal["ok", "slow", "lost"]


class Publisher(Protocol):
    """Shows facts and newest-wins values to whoever watches; never blocks, never raises for a slow client."""

    def events(self, recorded: Sequence[Recorded]) -> None: ...

    def telemetry(self, telemetry: Telemetry, now_s: float) -> None: ...

    def sweep_progress(
        self, mission_id: str, place_number: int, heading_deg: list[float], power_db: list[float], turned_deg: float
    ) -> None: ...

    def belief(
        self, mission_id: str, bearings: int, belief: GridBelief, corners_lon_lat: list[tuple[float, float]]
    ) -> None:
        """corners_lon_lat: SW, SE, NE, NW of the grid's outer edge."""
        ...

    def status(self, status: Status) -> None: ...

    def watchers(self) -> int:
        """How many consoles watch now (for the console-lost timers)."""
        ...
