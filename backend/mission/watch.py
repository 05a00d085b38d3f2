"""Watches the world while a mission runs and turns what changed into the machine's inputs. Times are the clock's."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace

from backend.events import Phase
from backend.mission import inputs
from backend.mission.equipment import Equipment
from backend.mission.listening import Listening
from backend.mission.ports import TrackPoint
from backend.mission.safety import BATTERY_STALE_S, NOMINAL_DRAIN_PERCENT_S, Limits, Situation, battery_vetoes
from backend.mission.state import AUTOMATIC, HOMEWARD, MissionState
from hardware.autopilot.patience import Deadline
from hardware.readings import Telemetry

TICK_S = 0.2
LONGEST_TICK_S = 1.0
"""A tick that came later than this was held up by the machine: more silence than this was not observed."""

TRACK_S = 0.5
HOME_RADIUS_M = 6.0
LANDED_FOR_S = 1.0
GOING_HOME = frozenset({"RETURN", "RTL", "SMART_RTL", "AUTO_RTL", "LAND", "PRECISION LAND"})
"""Modes that an autopilot's failsafe enters by itself (as the vehicle names them)."""
WAITING = frozenset({"HOLD", "GUIDED", "BRAKE"})
"""Modes into which our orders bring a flying vehicle."""
HEARD_AGAIN_S, HEARD_AGAIN_WALL_S = 15.0, 5.0
"""So long after it was heard again, or the server came back, a vehicle may still act on the silence before: it hears us
later. A mission that just started had none."""

RECOVERED_PERCENT = 2.0
"""A low battery counts as recovered with so much to spare: a charge at the limit is told once."""

MEASURED_DRAIN_AFTER_S = 60.0
MEASURED_DRAIN_PERCENT = 2.0


@dataclass(slots=True)
class Drain:
    """Battery used a second in the air since the last take-off, the nominal rate until enough was used to tell.

    Time is the charge's own: what a lost link did not bring drained nothing.
    """

    began: tuple[float, float] | None = None
    percent_s: float = NOMINAL_DRAIN_PERCENT_S

    def update(self, telemetry: Telemetry, now_s: float) -> None:
        charge, at_s = telemetry.battery_percent, telemetry.battery_at_s or now_s
        if telemetry.in_air is False:
            self.began = None
        if not telemetry.in_air or charge is None:
            return
        if self.began is None or charge > self.began[1]:
            self.began = (at_s, charge)
        seconds, used = at_s - self.began[0], self.began[1] - charge
        if seconds >= MEASURED_DRAIN_AFTER_S and used >= MEASURED_DRAIN_PERCENT:
            self.percent_s = used / seconds


@dataclass(slots=True)
class Watch:
    """`give` takes the inputs; `state` is asked on every tick. Track points collect in `track` until taken.

    tolerated_mode: the autopilot's own return or landing, found after a restart or a lost link; no pilot's, until it
    changes.
    """

    equipment: Equipment
    limits: Limits
    listening: Listening
    state: Callable[[], MissionState]
    give: Callable[[inputs.Input], object]
    tolerated_mode: str | None = None
    drain: Drain = field(default_factory=Drain)
    track: list[TrackPoint] = field(default_factory=list)
    _down_since: dict[inputs.Link, float] = field(default_factory=dict)
    _console_seen: bool = False
    _battery_told: tuple[str, str] = ("", "")
    """The rule that was broken, and who flew then: a change of either is told again."""
    _heard_since_s: float = -math.inf
    _heard_again: Deadline | None = None
    _battery_unheard_since: float | None = None
    _flown: bool = False
    _on_ground_since: float | None = None
    _tracked_at: float = -math.inf
    _ticked_at: float = math.inf

    def situation(self) -> Situation:
        telemetry, now = self.equipment.vehicle.telemetry(), self.equipment.clock.now()
        return Situation(telemetry, now, self.drain.percent_s, self._heard_since_s, self.failsafe_flies)

    @property
    def failsafe_flies(self) -> bool:
        """The autopilot is on its own way home or down, begun while it heard nobody: no pilot's doing."""
        telemetry = self.equipment.vehicle.telemetry()
        return telemetry.controller == "pilot" and telemetry.mode is not None and telemetry.mode == self.tolerated_mode

    async def run(self) -> None:
        while True:
            self.tick()
            await self.equipment.clock.sleep(TICK_S)

    def tick(self) -> None:
        """One look at everything."""
        telemetry, now = self.equipment.vehicle.telemetry(), self.equipment.clock.now()
        self.listening.wait(min(max(now - self._ticked_at, 0.0), LONGEST_TICK_S))
        if math.isinf(self._ticked_at) and self.state().phase not in AUTOMATIC:
            self._heard_again = Deadline(self.equipment.clock, HEARD_AGAIN_S, HEARD_AGAIN_WALL_S)
        self._ticked_at = now
        self.drain.update(telemetry, now)
        self.notice_pilot("")
        self._links(telemetry, now)
        self._battery(telemetry, now)
        self._way_down(telemetry, now)
        self._track(telemetry, now)

    def notice_pilot(self, line: str) -> None:
        """Ask the vehicle who has control; also called the moment it says that something changed."""
        telemetry = self.equipment.vehicle.telemetry()
        mode = telemetry.mode or "unknown"
        if telemetry.controller == "pilot" and mode in GOING_HOME and mode != self.tolerated_mode:
            unheard = "vehicle" in self._down_since or not telemetry.connected
            if unheard or self.tolerated_mode is not None:
                self.tolerated_mode = mode
            elif self._just_heard and self.state().phase in AUTOMATIC | {"hold"}:
                self.tolerated_mode = mode
                self.give(inputs.FailsafeActs(mode))
        if self._failsafes_doing(telemetry, mode):
            return
        self.tolerated_mode = None
        if telemetry.controller == "pilot" and not self.state().pilot_has_control:
            self.give(inputs.PilotTookOver(mode, line or f"the vehicle is in {mode}", mode in GOING_HOME))

    @property
    def _just_heard(self) -> bool:
        return self._heard_again is not None and not self._heard_again.passed

    def _failsafes_doing(self, telemetry: Telemetry, mode: str) -> bool:
        """Not a pilot's: the autopilot's own way home, the mode it goes to once it has landed, or a return that an
        order of ours stopped, sent before we knew of it."""
        if self.tolerated_mode is None or self.state().phase in AUTOMATIC | {"manual"}:
            return False
        if mode == self.tolerated_mode or telemetry.in_air is False:
            return True
        stopped = mode in WAITING and self._just_heard and telemetry.controller == "pilot"
        if stopped:
            self.tolerated_mode = mode
            self.give(inputs.FailsafeStopped(mode))
        return stopped

    def _links(self, telemetry: Telemetry, now: float) -> None:
        heard = telemetry.heard_at_s
        silence = "nothing was ever heard" if heard is None else f"nothing heard for {now - heard:.0f} s"
        self._link("vehicle", telemetry.connected, silence, now)
        trouble = self.listening.trouble
        self._link("receiver", not trouble, trouble, now)
        if self.equipment.watch_consoles:
            watching = self.equipment.publisher.watchers() > 0
            self._console_seen |= watching
            if self._console_seen:
                self._link("console", watching, "no console is connected", now)

    def _link(self, link: inputs.Link, up: bool, detail: str, now: float) -> None:
        if not up and link not in self._down_since:
            self._down_since[link] = now
            self.give(inputs.LinkDown(link, detail))
        elif up and link in self._down_since:
            if link == "vehicle":
                self._heard_since_s = now
                self._heard_again = Deadline(self.equipment.clock, HEARD_AGAIN_S, HEARD_AGAIN_WALL_S)
            going_home = link == "vehicle" and self.failsafe_flies
            self.give(inputs.LinkUp(link, now - self._down_since.pop(link), going_home))

    def _battery(self, telemetry: Telemetry, now: float) -> None:
        if not telemetry.in_air or not telemetry.connected:
            return
        situation, state = self.situation(), self.state()
        vetoes = battery_vetoes(self.limits, situation)
        if telemetry.battery_percent is not None:
            self._battery_unheard_since = None
        elif vetoes:
            if self._battery_unheard_since is None:
                self._battery_unheard_since = now
            if now - max(self._battery_unheard_since, self._heard_since_s) < BATTERY_STALE_S:
                return
        if vetoes:
            told = (vetoes[0].rule, flown_by(state.phase))
            if told != self._battery_told:
                self._battery_told = told
                self.give(inputs.BatteryLow(vetoes[0].detail))
        elif self._battery_told != ("", "") or any(alert.startswith("battery-") for alert in state.open_alerts):
            spare = replace(self.limits, reserve_percent=self.limits.reserve_percent + RECOVERED_PERCENT)
            if not battery_vetoes(spare, situation):
                self._battery_told = ("", "")
                self.give(inputs.BatteryReported())

    def _way_down(self, telemetry: Telemetry, now: float) -> None:
        state = self.state()
        if state.phase == "returning" and self._above_home(telemetry):
            self.give(inputs.HomeReached())
        self._flown |= telemetry.in_air is True
        flown = state.took_off or self._flown or (state.phase in HOMEWARD and telemetry.armed is False)
        if not flown or telemetry.in_air is not False or not telemetry.connected:
            self._on_ground_since = None
            return
        if self._on_ground_since is None:
            self._on_ground_since = now
        elif now - self._on_ground_since >= LANDED_FOR_S:
            self.give(inputs.Landed())

    def _above_home(self, telemetry: Telemetry) -> bool:
        position = telemetry.position
        return position is not None and math.hypot(*self.limits.frame.to_enu(position)) < HOME_RADIUS_M

    def _track(self, telemetry: Telemetry, now: float) -> None:
        position = telemetry.position
        values = (telemetry.altitude_amsl_m, telemetry.altitude_relative_m, telemetry.heading_deg)
        if now - self._tracked_at < TRACK_S or position is None or None in values or not telemetry.connected:
            return
        amsl, relative, heading = (float(v) for v in values if v is not None)
        self._tracked_at = now
        self.track.append(
            TrackPoint(
                at_s=now,
                lat_deg=position.lat_deg,
                lon_deg=position.lon_deg,
                altitude_amsl_m=amsl,
                altitude_relative_m=relative,
                heading_deg=heading,
                battery_percent=telemetry.battery_percent,
                mode=telemetry.mode,
            )
        )


def flown_by(phase: Phase) -> str:
    """Who has to act on a low battery: the mission itself does when it flies, people when it is held."""
    return "mission" if phase in AUTOMATIC else "home" if phase in HOMEWARD else "people"
