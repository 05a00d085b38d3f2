"""Stand-ins for what a craft holds: an obedient vehicle, a receiver that hums, a finder that knows the way."""

from __future__ import annotations

import asyncio
import math
from collections.abc import AsyncIterator, Mapping, Sequence
from dataclasses import replace

import numpy as np

from backend.spec import EmitterSpec, FlightSpec, MissionSpec, PlannerSpec, Polygon
from hardware.authority import Authority, CommandSent, ModeHeard, ModeKind, OperatorTookControl
from hardware.autopilot.control import Control
from hardware.direction_finding.antenna import AntennaPattern
from hardware.fence import MissionNets, Nets, NetsPlan, ParameterValue
from hardware.frame import LocalFrame
from hardware.ports import Clock, NotInControl, ReceiverError, VehicleError, VehicleUnreachable
from hardware.readings import (
    Announcement,
    BearingReading,
    Channel,
    HeadingSample,
    Place,
    PowerSample,
    PreflightCheck,
    ReturnAltitude,
    Sweep,
    Telemetry,
)
from hardware.reasons.nets import FenceReadBackDifferent
from hardware.reasons.preflight import LinkChecked
from hardware.reasons.receiver import ReceiverUnplugged
from hardware.reasons.sweep import NoDirection
from hardware.reasons.vehicle import ManoeuvreName, ModeNotCommanded, NoAutopilotAnswers, VehicleSilent
from hardware.reasons.vehicle_news import OperatorInControl, TakenOver
from hardware.yaw_swings import Swinging

HOME = Place(50.0, 7.0)
FRAME = LocalFrame(HOME)
PATTERN = AntennaPattern("test", np.array([0.0, 90.0, 180.0, 270.0]), np.array([0.0, -6.0, -12.0, -6.0]))
NOTHING = np.full(180, np.nan)
MODES: dict[str, tuple[int, ModeKind]] = {
    "HOLD": (1, "waiting"),
    "POSCTL": (2, "other"),
    "RETURN": (3, "return"),
    "LAND": (4, "land"),
}
COMMANDED: dict[ManoeuvreName, frozenset[int]] = {
    "take_off": frozenset({1}),
    "flight": frozenset({1}),
    "turn": frozenset({1}),
    "hold": frozenset({1}),
    "return": frozenset({3, 4}),
    "landing": frozenset({4}),
}
"""The modes that follow from a command."""
SECOND_HZ = 869.5e6


def spec(emitters: Sequence[EmitterSpec] = (EmitterSpec(),), **flight: object) -> MissionSpec:
    """A field of 200 x 100 m north of home, planned at once."""
    ring = [FRAME.to_geo(x, y) for x, y in ((-100, 0), (100, 0), (100, 100), (-100, 100), (-100, 0))]
    return MissionSpec(
        name="test",
        area=Polygon(coordinates=[[(p.lon, p.lat) for p in ring]]),
        emitters=list(emitters),
        planner=PlannerSpec(method="base_policy", standoff_m=0.0),
        flight=FlightSpec(**flight),  # type: ignore[arg-type]
    )


TWO_EMITTERS = (EmitterSpec(), EmitterSpec(emitter_id="emitter-2", frequency_hz=SECOND_HZ))


class FlatVehicle:
    """Flies straight at 50 times its speed; every command is noted with its time. `stuck`: commands never
    finish. flown: places and altitudes (m AMSL) it went to."""

    def __init__(self, clock: Clock) -> None:
        self.clock = clock
        self.commands: list[tuple[str, float]] = []
        self.flown: list[tuple[Place, float]] = []
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
            autopilot="px4",
        )
        self.nets = Nets((), (ParameterValue("CEILING", 0.0),))
        self.nets_set: list[Nets] = []
        self.nets_refused: FenceReadBackDifferent | None = None
        self.control = Control(lambda before, after: None)
        self.heard = True
        self.silence_unnoticed = False
        self.charge_reported = True
        self.returns_at = ReturnAltitude("RTL_RETURN_ALT", 30.0)
        self.stuck = False
        self.reachable = True
        self.headings_heard: list[HeadingSample] = []
        self.turned_by: list[float] = []
        self.flown_facing: list[float | None] = []
        self.announced: asyncio.Queue[Announcement] = asyncio.Queue()

    async def connect(self, timeout_s: float = 30.0) -> None:
        if not self.reachable:
            raise VehicleUnreachable(NoAutopilotAnswers("udpin://nowhere", timeout_s))

    async def close(self) -> None:
        pass

    def telemetry(self) -> Telemetry:
        now = self.clock.now()
        if self.heard:
            battery_at_s = now if self.charge_reported else self.state.battery_at_s
            self.state = replace(
                self.state, at_s=now, position_at_s=now, heading_at_s=now, battery_at_s=battery_at_s, mode_at_s=now
            )
        connected = self.heard or self.silence_unnoticed
        return replace(self.state, connected=connected, authority=self.control.authority)

    def shows(self, mode: str, after_silence: bool = False) -> None:
        """The autopilot reports this mode."""
        self.state = replace(self.state, mode=mode)
        armed, in_air = bool(self.state.armed), bool(self.state.in_air)
        number, kind = MODES[mode]
        self.control.see(ModeHeard(number, kind, mode, armed, in_air, after_silence, self.clock.now()))

    def headings(self, since_s: float) -> list[HeadingSample]:
        return [h for h in self.headings_heard if h.at_s >= since_s]

    async def changes(self) -> AsyncIterator[Announcement]:
        while True:
            yield await self.announced.get()

    async def preflight(self) -> list[PreflightCheck]:
        silent = VehicleSilent("take_off", 9.0)
        return [PreflightCheck("vehicle_link", self.heard, LinkChecked("px4") if self.heard else silent)]

    async def return_altitude(self) -> ReturnAltitude:
        return self.returns_at

    def _order(self, name: str, manoeuvre: ManoeuvreName) -> None:
        authority = self.control.authority
        if authority.taken_by is not None:
            who = "nobody" if authority.who == "ours" else authority.who
            raise NotInControl(ModeNotCommanded(manoeuvre, authority.mode or "", who))
        if not self.heard:
            raise VehicleUnreachable(VehicleSilent(manoeuvre, 9.0))
        self.commands.append((name, self.clock.now()))
        self.control.see(CommandSent(COMMANDED[manoeuvre]))

    async def _takes(self, seconds: float) -> None:
        await self.clock.sleep(math.inf if self.stuck else seconds)

    async def plan_nets(self, wanted: MissionNets, own: Nets | None = None) -> NetsPlan:
        before = self.nets if own is None else own
        return NetsPlan(before, Nets(wanted.zones, (ParameterValue("CEILING", wanted.net_ceiling_m),)))

    async def set_nets(self, nets: Nets) -> None:
        if self.nets_refused is not None:
            raise VehicleError(self.nets_refused)
        self.nets = nets
        self.nets_set.append(nets)

    async def put_nets_back(self, before: Nets, ours: Sequence[Nets]) -> bool | None:
        if self.state.armed:
            return None
        whole = self.nets in (before, *ours)
        if whole:
            await self.set_nets(before)
        return whole

    async def take_off(self, altitude_relative_m: float) -> None:
        self._order("take_off", "take_off")
        await self._takes(2.0)
        self.state = replace(
            self.state,
            armed=True,
            in_air=True,
            altitude_relative_m=altitude_relative_m,
            altitude_amsl_m=100.0 + altitude_relative_m,
        )
        self.shows("HOLD")

    async def goto(
        self,
        place: Place,
        altitude_amsl_m: float,
        speed_m_s: float,
        heading_deg: float | None = None,
        swinging: Swinging | None = None,
    ) -> None:
        self._order("goto", "flight")
        await self._takes(2.0)
        self.flown_facing.append(heading_deg)
        facing = self.state.heading_deg if heading_deg is None else heading_deg
        self.flown.append((place, altitude_amsl_m))
        above_home = altitude_amsl_m - (self.state.home_amsl_m or 0.0)
        self.state = replace(
            self.state,
            position=place,
            altitude_amsl_m=altitude_amsl_m,
            altitude_relative_m=above_home,
            heading_deg=facing,
        )

    async def turn(self, rate_deg_s: float, by_deg: float = 360.0) -> None:
        self._order("turn", "turn")
        self.turned_by.append(by_deg)
        seconds, steps = abs(by_deg) / rate_deg_s, max(round(abs(by_deg) / 4.5), 2)
        start = self.state.heading_deg or 0.0
        for step in range(steps + 1):
            heading = (start + by_deg * step / steps) % 360.0
            self.headings_heard.append(HeadingSample(self.clock.now(), heading, self.state.position))
            self.state = replace(self.state, heading_deg=heading)
            await self._takes(seconds / steps)

    async def hold(self) -> None:
        self._order("hold", "hold")
        self._stops()

    async def return_home(self) -> None:
        self._order("return_home", "return")
        await self._takes(1.0)
        self.state = replace(self.state, position=HOME)

    async def land(self) -> None:
        self._order("land", "landing")

    def _stops(self) -> None:
        if self.state.in_air:
            self.shows("HOLD")

    def touch_down(self) -> None:
        self.state = replace(self.state, armed=False, in_air=False, altitude_relative_m=0.0)
        self.shows("HOLD")

    def pilot_takes_over(self) -> None:
        self.shows("POSCTL")
        self.announced.put_nowait(Announcement(self.clock.now(), TakenOver("pilot", "POSCTL")))

    def pilot_gives_back(self) -> None:
        """Some seconds later."""
        self.state = replace(self.state, mode="HOLD")
        number, kind = MODES["HOLD"]
        self.control.see(ModeHeard(number, kind, "HOLD", True, True, False, self.clock.now() + 2.0))

    def take_control(self) -> None:
        before = self.control.authority
        self.control.see(OperatorTookControl())
        if self.control.authority != before:
            self.announced.put_nowait(Announcement(self.clock.now(), OperatorInControl()))

    def restore(self, authority: Authority) -> None:
        self.control.restore(authority)
        self.shows(self.state.mode or "HOLD", after_silence=True)

    @property
    def names(self) -> list[str]:
        return [name for name, _ in self.commands]


class HummingReceiver:
    """One level all the time: the directions come from `PointingFinder`.

    `mute`, `gone` and `lost_percent` are its faults; while `unheard`, no pulse that is due is heard.
    """

    def __init__(self, clock: Clock) -> None:
        self.clock = clock
        self.mute = False
        self.gone = False
        self.unheard = False
        self.lost_percent = 0.0
        self.frequencies_hz: list[float] = []

    async def open(self, channels: Sequence[Channel]) -> None:
        if self.gone:
            raise ReceiverError(ReceiverUnplugged())
        self.frequencies_hz = [channel.frequency_hz for channel in channels]

    async def close(self) -> None:
        pass

    async def samples(self) -> AsyncIterator[PowerSample]:
        while True:
            await self.clock.sleep(0.2)
            if self.gone:
                raise ReceiverError(ReceiverUnplugged())
            for frequency_hz in () if self.mute else self.frequencies_hz:
                yield PowerSample(self.clock.now(), frequency_hz, -60.0, detected=not self.unheard)


class PointingFinder:
    """Knows where the emitters are. The first `rejected` sweeps are refused. others: targets by frequency. patterns:
    that it was asked with."""

    def __init__(
        self,
        target: tuple[float, float],
        rejected: int = 0,
        others: Mapping[float, tuple[float, float]] | None = None,
    ) -> None:
        self.target = target
        self.rejected = rejected
        self.others = dict(others or {})
        self.patterns: list[AntennaPattern] = []

    def estimate(self, sweep: Sweep, pattern: AntennaPattern) -> BearingReading:
        self.patterns.append(pattern)
        east, north = FRAME.to_enu(sweep.position)
        target = self.others.get(sweep.frequency_hz, self.target)
        bearing = math.degrees(math.atan2(target[0] - east, target[1] - north)) % 360.0
        accepted = self.rejected <= 0
        self.rejected -= 1
        reason = None if accepted else NoDirection()
        return BearingReading(bearing, 3.0, 0.95 if accepted else 0.2, accepted, reason, (), NOTHING, NOTHING)
