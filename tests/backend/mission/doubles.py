"""Stand-ins for the ports: an obedient vehicle, a receiver that hums, a journal and a publisher in memory."""

from __future__ import annotations

import asyncio
import math
from collections.abc import AsyncIterator, Callable, Sequence
from dataclasses import replace
from datetime import UTC, datetime

import numpy as np

from backend.events import Event, MissionEnded, MissionStarted, Recorded
from backend.mission.equipment import Equipment
from backend.mission.ports import FactRefused, Status, TrackPoint
from backend.mission.service import MissionService
from backend.spec import FlightSpec, MissionSpec, PlannerSpec, Polygon
from hardware.clock import ScaledClock
from hardware.direction_finding.antenna import AntennaPattern
from hardware.frame import LocalFrame
from hardware.ports import PilotHasControl, ReceiverError, VehicleUnreachable
from hardware.readings import (
    BearingReading,
    GeoPoint,
    HeadingSample,
    PowerSample,
    PreflightCheck,
    Sweep,
    Telemetry,
)
from planner.belief.grid import GridBelief

HOME = GeoPoint(50.0, 7.0)
FRAME = LocalFrame(HOME)
PATTERN = AntennaPattern("test", np.array([0.0, 90.0, 180.0, 270.0]), np.array([0.0, -6.0, -12.0, -6.0]))
NOTHING = np.full(180, np.nan)


def spec(**flight: object) -> MissionSpec:
    ring = [FRAME.to_geo(x, y) for x, y in ((-100, 0), (100, 0), (100, 100), (-100, 100), (-100, 0))]
    return MissionSpec(
        name="test",
        area=Polygon(coordinates=[[(p.lon_deg, p.lat_deg) for p in ring]]),
        planner=PlannerSpec(method="base_policy", standoff_m=0.0),
        flight=FlightSpec(**flight),  # type: ignore[arg-type]
    )


class FlatVehicle:
    """Flies straight at 50 times its speed; every command is noted with its time. `stuck`: commands never finish."""

    def __init__(self, clock: ScaledClock) -> None:
        self.clock = clock
        self.commands: list[tuple[str, float]] = []
        self.state = Telemetry(
            connected=True,
            at_s=clock.now(),
            position=HOME,
            altitude_amsl_m=100.0,
            altitude_relative_m=0.0,
            heading_deg=0.0,
            battery_percent=95.0,
            armed=False,
            in_air=False,
            mode="HOLD",
            home=HOME,
            home_amsl_m=100.0,
            controller="nobody",
            autopilot="px4",
        )
        self.heard = True
        self.silence_unnoticed = False
        self.charge_reported = True
        self.stuck = False
        self.reachable = True
        self.headings_heard: list[HeadingSample] = []
        self.lines: asyncio.Queue[str] = asyncio.Queue()

    async def connect(self, timeout_s: float = 30.0) -> None:
        if not self.reachable:
            raise VehicleUnreachable("nobody answers")

    async def close(self) -> None:
        pass

    def telemetry(self) -> Telemetry:
        now = self.clock.now()
        if self.heard:
            battery_at_s = now if self.charge_reported else self.state.battery_at_s
            self.state = replace(
                self.state, at_s=now, position_at_s=now, heading_at_s=now, battery_at_s=battery_at_s, mode_at_s=now
            )
        return replace(self.state, connected=self.heard or self.silence_unnoticed)

    def headings(self, since_s: float) -> list[HeadingSample]:
        return [h for h in self.headings_heard if h.at_s >= since_s]

    async def changes(self) -> AsyncIterator[str]:
        while True:
            yield await self.lines.get()

    async def preflight(self) -> list[PreflightCheck]:
        return [PreflightCheck("vehicle link", self.heard, "ok" if self.heard else "silent", "look")]

    def _order(self, name: str) -> None:
        if self.state.controller == "pilot":
            raise PilotHasControl("the pilot has control")
        if not self.heard:
            raise VehicleUnreachable("nothing heard from the vehicle")
        self.commands.append((name, self.clock.now()))
        self.state = replace(self.state, controller="crossfix")

    async def _takes(self, seconds: float) -> None:
        await self.clock.sleep(math.inf if self.stuck else seconds)

    async def take_off(self, altitude_relative_m: float) -> None:
        self._order("take_off")
        await self._takes(2.0)
        self.state = replace(
            self.state,
            armed=True,
            in_air=True,
            altitude_relative_m=altitude_relative_m,
            altitude_amsl_m=100.0 + altitude_relative_m,
        )

    async def goto(self, place: GeoPoint, altitude_amsl_m: float, speed_m_s: float) -> None:
        self._order("goto")
        await self._takes(2.0)
        self.state = replace(self.state, position=place)

    async def turn(self, rate_deg_s: float) -> None:
        self._order("turn")
        seconds, steps = 360.0 / rate_deg_s, 80
        for step in range(steps + 1):
            heading = 360.0 * step / steps % 360.0
            self.headings_heard.append(HeadingSample(self.clock.now(), heading, self.state.position))
            await self._takes(seconds / steps)

    async def hold(self) -> None:
        self._order("hold")

    async def return_home(self) -> None:
        self._order("return_home")
        await self._takes(1.0)
        self.state = replace(self.state, position=HOME)

    async def land(self) -> None:
        self._order("land")

    def touch_down(self) -> None:
        self.state = replace(self.state, armed=False, in_air=False, altitude_relative_m=0.0, held_by_pilot=False)

    def take_control(self) -> None:
        self.state = replace(self.state, controller="pilot", mode="POSCTL", held_by_pilot=True)
        self.lines.put_nowait("pilot took over: POSCTL")

    def give_back(self) -> None:
        self.state = replace(self.state, mode="HOLD", held_by_pilot=False)

    def release_pilot_latch(self) -> None:
        self.state = replace(self.state, controller="crossfix", held_by_pilot=False)

    @property
    def names(self) -> list[str]:
        return [name for name, _ in self.commands]


class HummingReceiver:
    """One level all the time: the directions come from `PointingFinder`.

    `mute` and `gone` are its faults; while `unheard`, no pulse that is due is heard.
    """

    def __init__(self, clock: ScaledClock) -> None:
        self.clock = clock
        self.mute = False
        self.gone = False
        self.unheard = False

    async def open(self, frequency_hz: float) -> None:
        if self.gone:
            raise ReceiverError("the receiver is unplugged")

    async def close(self) -> None:
        pass

    async def samples(self) -> AsyncIterator[PowerSample]:
        while True:
            await self.clock.sleep(0.2)
            if self.gone:
                raise ReceiverError("the receiver was unplugged")
            if not self.mute:
                yield PowerSample(self.clock.now(), 868.3e6, -60.0, detected=not self.unheard)


class PointingFinder:
    """Knows where the emitter is. The first `rejected` sweeps are refused."""

    def __init__(self, target: tuple[float, float], rejected: int = 0) -> None:
        self.target = target
        self.rejected = rejected

    def estimate(self, sweep: Sweep, pattern: AntennaPattern) -> BearingReading:
        east, north = FRAME.to_enu(sweep.position)
        bearing = math.degrees(math.atan2(self.target[0] - east, self.target[1] - north)) % 360.0
        accepted = self.rejected <= 0
        self.rejected -= 1
        reason = "" if accepted else "too flat"
        return BearingReading(bearing, 3.0, 0.95 if accepted else 0.2, accepted, reason, (), NOTHING, NOTHING)


class MemoryJournal:
    """`away`: the database answers nothing until it is False again. `refuses`: kinds of facts it will never take."""

    def __init__(self, now: ScaledClock) -> None:
        self._clock = now
        self.stored: dict[str, list[Recorded]] = {}
        self.sweeps: list[tuple[str, str]] = []
        self.track: list[TrackPoint] = []
        self.away = False
        self.refuses: set[str] = set()
        self.aside: list[Event] = []

    async def append(self, mission_id: str, events: Sequence[Event]) -> list[Recorded]:
        await asyncio.sleep(0)
        if self.away:
            raise ConnectionError("the database is away")
        if any(event.kind in self.refuses for event in events):
            raise FactRefused("a number is missing")
        stored = self.stored.setdefault(mission_id, [])
        at = datetime.fromtimestamp(self._clock.now(), UTC)
        new = [
            Recorded(seq=len(stored) + i, mission_id=mission_id, at_utc=at, event=event)
            for i, event in enumerate(events, 1)
        ]
        stored += new
        return new

    async def keep_aside(self, mission_id: str, events: Sequence[Event], why: str) -> None:
        self.aside += events

    async def read(self, mission_id: str, after: int = 0) -> list[Recorded]:
        return self.stored.get(mission_id, [])[after:]

    async def save_sweep(self, mission_id: str, sweep_id: str, place_number: int, attempt: int, sweep: Sweep) -> None:
        self.sweeps.append((mission_id, sweep_id))

    async def save_track(self, mission_id: str, points: Sequence[TrackPoint]) -> None:
        self.track += points

    async def unfinished(self) -> list[str]:
        def open_(recorded: list[Recorded]) -> bool:
            facts = [r.event for r in recorded]
            started = any(isinstance(f, MissionStarted) for f in facts)
            return started and not any(isinstance(f, MissionEnded) for f in facts)

        return [mission_id for mission_id, recorded in self.stored.items() if open_(recorded)]

    def events(self, mission_id: str) -> list[Event]:
        return [r.event for r in self.stored.get(mission_id, [])]

    def kinds(self, mission_id: str) -> list[str]:
        return [event.kind for event in self.events(mission_id)]


class MemoryPublisher:
    """`journal`: what is shown must be stored there already."""

    def __init__(self, journal: MemoryJournal) -> None:
        self._journal = journal
        self.shown: list[Recorded] = []
        self.beliefs: list[int] = []
        self.statuses: list[Status] = []
        self.progress: list[float] = []
        self.telemetries = 0
        self.consoles = 0

    def events(self, recorded: Sequence[Recorded]) -> None:
        for record in recorded:
            assert record in self._journal.stored[record.mission_id], "shown before it was durable"
            self.shown.append(record)

    def telemetry(self, telemetry: Telemetry, now_s: float) -> None:
        self.telemetries += 1

    def sweep_progress(
        self, mission_id: str, place_number: int, heading_deg: list[float], power_db: list[float], turned_deg: float
    ) -> None:
        assert len(heading_deg) == len(power_db)
        self.progress.append(turned_deg)

    def belief(
        self, mission_id: str, bearings: int, belief: GridBelief, corners_lon_lat: list[tuple[float, float]]
    ) -> None:
        self.beliefs.append(bearings)

    def status(self, status: Status) -> None:
        self.statuses.append(status)

    def watchers(self) -> int:
        return self.consoles


class Stage:
    """A service on doubles, time fifty times as fast."""

    def __init__(self, target: tuple[float, float] = (30.0, 60.0), rejected: int = 0, factor: float = 50.0) -> None:
        self.clock = ScaledClock(factor=factor)
        self.vehicle = FlatVehicle(self.clock)
        self.receiver = HummingReceiver(self.clock)
        self.finder = PointingFinder(target, rejected)
        self.journal = MemoryJournal(self.clock)
        self.publisher = MemoryPublisher(self.journal)
        self.service = self.new_service()

    def new_service(self, pattern: AntennaPattern = PATTERN) -> MissionService:
        return MissionService(
            Equipment(
                vehicle=self.vehicle,
                receiver=self.receiver,
                finder=self.finder,
                pattern=pattern,
                journal=self.journal,
                publisher=self.publisher,
                clock=self.clock,
                software="test",
                threads=1,
            )
        )

    async def until(self, mission_id: str, kind: str, count: int = 1, wall_s: float = 20.0) -> Event:
        """The n-th event of a kind, once it is stored."""
        async with asyncio.timeout(wall_s):
            while True:
                found = [e for e in self.journal.events(mission_id) if e.kind == kind]
                if len(found) >= count:
                    return found[count - 1]
                await asyncio.sleep(0.005)

    async def until_true(self, happened: Callable[[], bool], wall_s: float = 20.0) -> None:
        async with asyncio.timeout(wall_s):
            while True:
                if happened():
                    return
                await asyncio.sleep(0)

    async def until_phase(self, mission_id: str, phase: str, wall_s: float = 20.0) -> None:
        async with asyncio.timeout(wall_s):
            while True:
                changes = [e for e in self.journal.events(mission_id) if e.kind == "phase_changed"]
                if changes and changes[-1].after == phase:  # type: ignore[union-attr]
                    return
                await asyncio.sleep(0.005)
