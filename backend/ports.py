"""What search, craft and mission need of the rooms above them: the journal keeps facts, the publisher shows them."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal, Protocol

from backend.events import Event, Level, MissionPhase, Phase, Recorded, Topic
from backend.reasons import Reason
from backend.reasons.flight import OrderName, Way
from backend.terrain import Terrain
from hardware.readings import Place, Sweep, Telemetry
from planner.belief.grid import GridBelief
from planner.reason import ReasonedError

ReceiverState = Literal["ok", "silent", "off", "lost"]


@dataclass(frozen=True, slots=True)
class Kept:
    """How many there are of something that is stored, and what they take."""

    number: int
    size_bytes: int


@dataclass(frozen=True, slots=True)
class TrackPoint:
    """One thinned point of the flown track (2 Hz)."""

    at_s: float
    lat_deg: float
    lon_deg: float
    altitude_amsl_m: float
    altitude_relative_m: float
    heading_deg: float | None
    battery_percent: float | None
    mode: str | None


@dataclass(frozen=True, slots=True)
class SectorShown:
    """Of the circle, what a running turn goes through as decided so far: goal_deg clockwise from the antenna heading
    begin_deg. because: why that far."""

    begin_deg: float
    goal_deg: float
    because: Reason | None


class JournalUnavailable(ReasonedError, RuntimeError):
    """The database is away (reading), or the spool is full as well (writing). Nothing stored is lost."""


class JournalDamaged(ReasonedError, ValueError):
    """What is stored of one mission cannot be read. Those of the others can."""


class FactRefused(ReasonedError, ValueError):
    """The journal will never take this: the fact makes no sense, or another writer has used its place."""


@dataclass(frozen=True, slots=True)
class Listed:
    """What the list says of a mission, for which none of its facts is read. started_at_s: UTC epoch seconds, None
    before. crafts: what each that is engaged did last."""

    started_at_s: float | None
    ended: bool
    deleted: bool
    crafts: Mapping[str, Phase]


class Journal(Protocol):
    """Append-only facts. `append` returns only when they are durable; nothing is published before that."""

    async def append(self, mission_id: str, events: Sequence[Event]) -> list[Recorded]:
        """All or none. Raises JournalUnavailable (try again), FactRefused (never)."""
        ...

    async def keep_aside(self, mission_id: str, events: Sequence[Event], why: str) -> None:
        """For a person to look at: facts that were refused. They are counted and block nothing."""
        ...

    async def read(self, mission_id: str, after: int = 0, most: int | None = None) -> list[Recorded]:
        """The events after number `after`, in order, the first `most` of them; empty for an unknown mission.

        Raises JournalUnavailable."""
        ...

    async def read_kinds(self, mission_id: str, kinds: Collection[str]) -> list[Recorded]:
        """The events of these kinds only, in order. Raises JournalUnavailable."""
        ...

    async def listed(self, mission_id: str) -> Listed | None:
        """None for an unknown mission. Raises JournalUnavailable."""
        ...

    async def append_unread(self, mission_id: str, events: Sequence[Event]) -> list[Recorded]:
        """As `append`, to a mission whose facts cannot be read: what they follow is known from the list alone."""
        ...

    async def save_sweep(
        self,
        mission_id: str,
        sweep_id: str,
        craft_id: str | None,
        emitter_id: str,
        place_number: int,
        attempt: int,
        sweep: Sweep,
    ) -> None:
        """craft_id None: an import's. Raises JournalUnavailable, FactRefused (then it was kept aside)."""
        ...

    async def save_track(self, mission_id: str, craft_id: str, points: Sequence[TrackPoint]) -> None:
        """Oldest first. Raises JournalUnavailable, FactRefused (then they were kept aside)."""
        ...

    async def of_nets(self) -> list[Recorded]:
        """Facts about the vehicles' own nets, oldest mission first, in order: what a restart must put back."""
        ...

    async def unfinished(self) -> list[str]:
        """Missions that were started and have not ended, or whose craft still flies: what a restart must bring back."""
        ...


class Grounds(Protocol):
    """The terrain that people brought, and what missions were flown over."""

    async def around(self, home: Place) -> Terrain | None:
        """The ground within reach of a home; None where nobody knows any of it."""
        ...

    async def keep(self, terrain: Terrain) -> None:
        """Under its digest, for a restart and the review. Raises OSError."""
        ...

    async def kept(self, digest: str) -> Terrain | None:
        """None when it is lost."""
        ...


class NoGrounds:
    """Nobody brought terrain."""

    async def around(self, home: Place) -> Terrain | None:
        """None."""
        return None

    async def keep(self, terrain: Terrain) -> None:
        """There is nothing to keep."""

    async def kept(self, digest: str) -> Terrain | None:
        """None."""
        return None


@dataclass(frozen=True, slots=True)
class Said:
    """The natural log of how well a flight's bearings speak for a value, 0 for the best one."""

    value: float
    log_evidence: float


@dataclass(frozen=True, slots=True)
class Lesson:
    """What one flight taught of the errors of its craft's bearings. bias_deg: clockwise. spread_deg: standard
    deviations that the bias may have from flight to flight; scale: of the stated sigmas; rate: of outliers. together:
    log evidence of every combination of these values, the rates running fastest; empty in older lessons. place_known:
    somebody told where the emitter was, so that the bearings were judged by that. taken_off_deg: what the mission took
    off its bearings, clockwise; the bias is what was left."""

    mission_id: str
    bearings: int
    bias_deg: float
    bias_std_error_deg: float
    spread_deg: tuple[Said, ...]
    scale: tuple[Said, ...]
    rate: tuple[Said, ...]
    together: tuple[float, ...] = ()
    place_known: bool = False
    taken_off_deg: float = 0.0


class Lessons(Protocol):
    """What the flights of each craft with each antenna taught."""

    async def of(self, craft_id: str, antenna: str) -> list[Lesson]:
        """Oldest first; empty when nothing can be read."""
        ...

    async def keep(self, craft_id: str, antenna: str, lesson: Lesson) -> None:
        """In the place of an earlier one of the same mission. Raises OSError."""
        ...

    async def forget(self, craft_id: str, antenna: str) -> None:
        """All of them: the compass was calibrated, the antenna mounted again. Raises OSError."""
        ...


class NoLessons:
    """Nothing is learned."""

    async def of(self, craft_id: str, antenna: str) -> list[Lesson]:
        """None."""
        return []

    async def keep(self, craft_id: str, antenna: str, lesson: Lesson) -> None:
        """There is nowhere to keep it."""

    async def forget(self, craft_id: str, antenna: str) -> None:
        """There is nothing to forget."""


@dataclass(frozen=True, slots=True)
class OrderStatus:
    """The order that a craft carries out. way: what of it is tried, or done; because: why what was tried before was not
    done."""

    order: OrderName
    way: Way
    stage: Literal["tried", "waits", "done"]
    because: Reason | None


@dataclass(frozen=True, slots=True)
class CraftAlert:
    """An open alert of a craft that flies for no mission. raised_at_s: UTC epoch seconds."""

    alert_id: str
    topic: Topic
    level: Level
    reason: Reason
    raised_at_s: float


@dataclass(frozen=True, slots=True)
class CraftStatus:
    """What a craft does now, and the health of its parts. mission_id None: it flies for none; phase is not "ground"
    when it is in the air all the same. order None: nothing was ordered, or something else has come of it.
    resume_refused: why resuming would be refused now; None: it would not, or nothing waits to be resumed. alerts: of a
    craft that flies for no mission; those of one that does are its mission's facts. settling_samples: left out, since
    the receiver was changing to other channels. receiver_lost_percent: as in hardware.ports.Receiver."""

    craft_id: str
    mission_id: str | None
    phase: Phase
    receiver: ReceiverState
    receiver_power_db: float | None
    receiver_age_s: float | None
    battery_to_return_percent: float | None
    order: OrderStatus | None = None
    resume_refused: Reason | None = None
    alerts: tuple[CraftAlert, ...] = ()
    settling_samples: int = 0
    receiver_lost_percent: float = 0.0


@dataclass(frozen=True, slots=True)
class Status:
    """Once a second beside the facts: the mission that flies, if one does, and every craft there is. database:
    "unstored" while the mission's facts can be stored nowhere, and are therefore not shown."""

    mission_id: str | None
    phase: MissionPhase | None
    crafts: tuple[CraftStatus, ...]
    database: Literal["ok", "slow", "lost", "unstored"]


class Publisher(Protocol):
    """Shows facts and newest-wins values to whoever watches; never blocks, never raises for a slow client."""

    def events(self, recorded: Sequence[Recorded]) -> None:
        """Only what is durable already. None is ever dropped: a viewer that fell behind reads the journal."""
        ...

    def telemetry(self, craft_id: str, telemetry: Telemetry, now_s: float) -> None:
        """now_s: UTC epoch seconds, against which ages are reckoned."""
        ...

    def sweep_progress(
        self,
        mission_id: str,
        craft_id: str,
        emitter_id: str,
        place_number: int,
        heading_deg: list[float],
        power_db: list[float],
        turned_deg: float,
        sector: SectorShown | None = None,
    ) -> None:
        """heading_deg, power_db: all samples of the turn so far. turned_deg: of 360, or of the sector."""
        ...

    def belief(
        self,
        mission_id: str,
        emitter_id: str,
        seq: int,
        bearings: int,
        belief: GridBelief,
        corners_lon_lat: list[tuple[float, float]],
    ) -> None:
        """seq: of its BeliefUpdated, shown right before. corners_lon_lat: SW, SE, NE, NW of the grid's outer edge."""
        ...

    def status(self, status: Status) -> None:
        """The newest takes the place of the one before."""
        ...

    def watchers(self) -> int:
        """How many consoles watch now (for the console-lost timers)."""
        ...
