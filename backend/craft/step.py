"""One transition of a craft being built, and the moves that orders and facts share."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

from backend.craft.effects import (
    CancelTimer,
    CancelWork,
    CraftEffect,
    FlyTo,
    HoldVehicle,
    Land,
    LeaveSearch,
    Measure,
    PlanNext,
    ReturnHome,
    TakeOff,
)
from backend.craft.state import CraftState, evolve
from backend.events import (
    AlertCleared,
    AlertRaised,
    Event,
    FlightStarted,
    Outcome,
    Phase,
    PhaseChanged,
    SafetyVetoed,
    SweepStarted,
    Topic,
)
from backend.reasons import NotLocalized, PlacesUsedUp, Reason
from backend.reasons.safety import BATTERY
from backend.reasons.search import Localized
from backend.search.effects import Record
from backend.search.state import SearchState
from backend.search.state import evolve as evolve_search

OF_THE_FLIGHT: tuple[Topic, ...] = (
    "vehicle", "receiver", "console", "payload", "pilot", "battery", "place", "failure", "safety", "ground",
)  # fmt: skip
"""Topics that are over once the vehicle is down."""


@dataclass(slots=True)
class CraftStep:
    """State so far and effects so far of one transition; lives no longer than it. search: what is known, to read."""

    craft: CraftState
    search: SearchState
    at_s: float
    effects: list[CraftEffect] = field(default_factory=list[CraftEffect])

    @property
    def comes_by_itself(self) -> bool:
        """The autopilot's failsafe brings the vehicle home or down."""
        return self.craft.authority.who == "failsafe"

    def do(self, effect: CraftEffect) -> None:
        self.effects.append(effect)

    def record(self, event: Event) -> None:
        """State changes by facts only."""
        self.craft = evolve(self.craft, event)
        self.search = evolve_search(self.search, event, self.at_s)
        self.effects.append(Record(event))

    def go(self, after: Phase, reason: Reason) -> None:
        before = self.craft.phase
        if before != after:
            self.record(PhaseChanged(craft_id=self.craft.craft_id, before=before, after=after, reason=reason))


def go_on(step: CraftStep, reason: Reason, accepted: bool = False) -> None:
    """What automatic control does next, from whatever is known; the one way into every automatic phase."""
    craft, search = step.craft, step.search
    spec = search.mission
    if not craft.took_off:
        take_off(step, reason)
    elif not search.beliefs_current:
        step.go("planning", reason)
    elif search.localized:
        go_home(step, Localized())
    elif craft.chosen is not None and (accepted or craft.accepted or craft.automatic):
        place, number = craft.chosen.place, craft.place_number
        altitude = craft.chosen.altitude_amsl_m
        if altitude is None:
            altitude = search.home_amsl_m + spec.flight.altitude_relative_m
        step.go("flying", reason)
        step.record(FlightStarted(craft_id=craft.craft_id, place_number=number, place=place, altitude_amsl_m=altitude))
        step.do(FlyTo(number, place))
    elif craft.chosen is not None:
        step.go("waiting", reason)
    elif search.place_number >= spec.localization.maximum_bearings:
        go_home(step, NotLocalized(PlacesUsedUp(search.place_number), search.not_yet))
    else:
        step.go("planning", reason)
        step.do(PlanNext(search.place_number + 1, craft.avoid))


def take_off(step: CraftStep, reason: Reason) -> None:
    step.go("taking_off", reason)
    step.do(TakeOff(step.search.mission.flight.altitude_relative_m))


def measure(step: CraftStep, reason: Reason) -> None:
    step.go("measuring", reason)
    number, attempt = step.craft.place_number, step.craft.attempt + 1
    step.record(SweepStarted(craft_id=step.craft.craft_id, place_number=number, attempt=attempt))
    step.do(Measure(number, attempt))


def go_home(step: CraftStep, reason: Reason) -> None:
    step.do(CancelWork())
    step.go("returning", reason)
    bring_down(step, ReturnHome())


def bring_down(step: CraftStep, way: ReturnHome | Land) -> None:
    """Not by an order of its own while the autopilot is on its way already."""
    if not step.comes_by_itself:
        step.do(way)


def hold(step: CraftStep, reason: Reason) -> None:
    """Stop automatic flight by the mission's own decision."""
    step.do(CancelWork())
    step.do(HoldVehicle())
    step.go("hold", reason)


def come_down(step: CraftStep, reason: Reason, outcome: Outcome | None = None) -> None:
    """The vehicle is down: what was to be watched in flight is over."""
    clear_alerts(step, *OF_THE_FLIGHT)
    step.go("ground", reason)
    cancel_timers(step)
    step.do(LeaveSearch(reason, outcome))


def cancel_timers(step: CraftStep) -> None:
    step.do(CancelTimer("console_hold"))
    step.do(CancelTimer("console_return"))
    step.do(CancelTimer("landing"))


def alert(step: CraftStep, topic: Topic, level: Literal["warning", "caution", "advisory"], reason: Reason) -> None:
    """Raise an alert; one that is open on the same topic gives way to it."""
    clear_alerts(step, topic)
    craft_id = step.craft.craft_id
    alert_id = f"{craft_id}-{topic}-{step.craft.alerts_raised + 1}"
    step.record(AlertRaised(alert_id=alert_id, topic=topic, level=level, reason=reason, craft_id=craft_id))


def clear_alerts(step: CraftStep, *topics: Topic) -> None:
    for raised in step.craft.open_alerts:
        if raised.topic in topics:
            step.record(AlertCleared(alert_id=raised.alert_id))


def clear_failsafe(step: CraftStep) -> None:
    """The autopilot is no longer on its own way home. Of a link that is lost the alert stays."""
    if "vehicle" not in step.craft.links_down:
        clear_alerts(step, "vehicle")


def record_vetoes(step: CraftStep, vetoes: tuple[Reason, ...]) -> None:
    for reason in vetoes:
        step.record(SafetyVetoed(craft_id=step.craft.craft_id, reason=reason))


def refuse_flight(step: CraftStep, vetoes: tuple[Reason, ...]) -> None:
    """Safety said no: go home when the battery says so, else hold and say why."""
    record_vetoes(step, vetoes)
    of_battery = [isinstance(reason, BATTERY) for reason in vetoes]
    alert(step, "battery" if of_battery[0] else "safety", "warning", vetoes[0])
    if all(of_battery):
        go_home(step, vetoes[0])
    else:
        hold(step, vetoes[0])
