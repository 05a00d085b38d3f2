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
    StartTimer,
    TakeOff,
)
from backend.craft.ladder import Ladder
from backend.craft.state import CraftState, evolve
from backend.events import (
    AlertCleared,
    AlertRaised,
    BearingMeasured,
    Event,
    FlightStarted,
    OrderDone,
    OrderNotDone,
    OrderTried,
    Outcome,
    Phase,
    PhaseChanged,
    PlacePassed,
    SafetyVetoed,
    SweepStarted,
    Topic,
)
from backend.reasons import Instead, NotDone, NotLocalized, OrderedAgainLater, PlacesUsedUp, Reason
from backend.reasons.flight import OrderName, PlaceUnsure, Proceeds, Way
from backend.reasons.safety import BATTERY
from backend.reasons.search import Localized
from backend.reasons.turning import TurnsHere
from backend.search.effects import Record
from backend.search.never_stop import turn_or_pass, ways_to, why_turn_before_belief
from backend.search.state import SearchState
from backend.search.state import evolve as evolve_search
from hardware.reasons.vehicle_news import AutopilotSaidMore, AutopilotWords, ClockRateOdd

OF_THE_FLIGHT: tuple[Topic, ...] = (
    "vehicle", "receiver", "console", "payload", "gps", "pilot", "battery", "place", "failure", "safety", "ground",
    "order", "autopilot", "clock", "nets", "antenna",
)  # fmt: skip
"""Topics that are over once the vehicle is down."""
UNSURE_PLACE_M = 5.0
"""A vehicle that hovers stays within this; what it reports beyond is an alert."""
MOST_SAID = 5
"""Alerts of the autopilot's own words at a time."""


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

    @property
    def on_ground(self) -> bool:
        """It was found there in hold, and nobody has resumed since."""
        return any(raised.topic == "ground" for raised in self.craft.open_alerts)

    def do(self, effect: CraftEffect) -> None:
        """Ask for it, after what was asked for before; the state does not change."""
        self.effects.append(effect)

    def record(self, event: Event) -> None:
        """State changes by facts only."""
        self.craft = evolve(self.craft, event)
        self.search = evolve_search(self.search, event, self.at_s)
        self.effects.append(Record(event))

    def go(self, after: Phase, reason: Reason) -> None:
        """Nothing is recorded when the craft is in that phase already."""
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
    elif search.done:
        go_home(step, Localized())
    elif craft.chosen is not None and craft.reached:
        leave_or_turn(step)
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
    elif search.place_number >= spec.localization.maximum_bearings and not (search.follows and search.found):
        go_home(step, NotLocalized(PlacesUsedUp(search.place_number), search.not_yet))
    else:
        step.go("planning", reason)
        step.do(PlanNext(search.place_number + 1, craft.shunned))


def arrived(step: CraftStep) -> None:
    """At a place: it turns there; of a mission that never stops, only where it has to, which may show in the belief."""
    emitters = tuple(step.search.emitters.values())
    if not step.search.mission.sensor.never_stop or len(emitters) != 1:
        measure(step, Proceeds("flight"))
        return
    craft = step.craft
    why = why_turn_before_belief(emitters[0], craft.craft_id, craft.place_number)
    if why is not None:
        measure(step, why)
    else:
        go_on(step, Proceeds("flight"))


def leave_or_turn(step: CraftStep) -> None:
    """With all that the way told in the belief."""
    craft = step.craft
    (emitter,) = step.search.emitters.values()
    why = turn_or_pass(emitter.belief, ways_to(emitter, craft.craft_id, craft.place_number))
    if isinstance(why, TurnsHere):
        measure(step, why)
        return
    step.record(PlacePassed(craft_id=craft.craft_id, place_number=craft.place_number, reason=why))
    go_on(step, why)


def take_off(step: CraftStep, reason: Reason) -> None:
    """To the mission's flight altitude, metres above home."""
    step.go("taking_off", reason)
    step.do(TakeOff(step.search.mission.flight.altitude_relative_m))


def take_off_again(step: CraftStep, reason: Reason) -> None:
    """From the ground, of a search that was begun before: no checklist has asked what it would fly to."""
    craft, altitude_m = step.craft, step.search.mission.flight.altitude_relative_m
    step.go("taking_off", reason)
    chosen = None if craft.chosen is None else craft.chosen.place
    step.do(TakeOff(altitude_m, again=True, chosen=chosen, avoid=craft.shunned))


def measure(step: CraftStep, reason: Reason) -> None:
    """One more attempt at the place where it is; held there while the autopilot's headings cannot be dated."""
    odd = next((raised.reason for raised in step.craft.open_alerts if raised.topic == "clock"), None)
    if odd is not None:
        hold(step, odd)
        return
    step.go("measuring", reason)
    number, attempt = step.craft.place_number, step.craft.attempt + 1
    step.record(SweepStarted(craft_id=step.craft.craft_id, place_number=number, attempt=attempt))
    step.do(Measure(number, attempt))


def go_home(step: CraftStep, reason: Reason) -> None:
    """Whatever work runs is dropped; the autopilot's own return brings the vehicle down."""
    step.do(CancelWork())
    step.go("returning", reason)
    bring_down(step, "return")


def bring_down(step: CraftStep, order: Literal["return", "land"]) -> None:
    """Not by an order of its own while the autopilot is on its way already."""
    if not step.comes_by_itself:
        insist(step, order)


def hold(step: CraftStep, reason: Reason) -> None:
    """Stop automatic flight by the mission's own decision."""
    step.do(CancelWork())
    insist(step, "hold")
    step.go("hold", reason)


def come_down(step: CraftStep, reason: Reason, outcome: Outcome | None = None) -> None:
    """The vehicle is down: what was to be watched in flight is over."""
    clear_alerts(step, *OF_THE_FLIGHT)
    step.go("ground", reason)
    cancel_timers(step)
    step.do(LeaveSearch(reason, outcome))


def cancel_timers(step: CraftStep) -> None:
    """All that a craft can have, whether they run or not."""
    step.do(CancelTimer("console_hold"))
    step.do(CancelTimer("console_return"))
    step.do(CancelTimer("landing"))
    step.do(CancelTimer("battery_return"))
    step.do(CancelTimer("order"))


def start_console_timers(step: CraftStep) -> None:
    """Until a console is back."""
    timers = step.search.mission.timers
    step.do(StartTimer("console_hold", timers.console_lost_hold_s))
    step.do(StartTimer("console_return", timers.console_lost_return_s))


# Orders are ladders: see ladder.py

COMMAND: dict[Way, HoldVehicle | ReturnHome | Land] = {"hold": HoldVehicle(), "return": ReturnHome(), "land": Land()}


def insist(step: CraftStep, order: OrderName) -> None:
    """Begin an order; it takes the place of the one before."""
    step.do(CancelTimer("order"))
    clear_alerts(step, "order")
    try_rung(step, Ladder(order))


def try_rung(step: CraftStep, ladder: Ladder) -> None:
    """Command it, and say so."""
    craft_id = step.craft.craft_id
    step.record(
        OrderTried(craft_id=craft_id, order=ladder.order, way=ladder.way, rung=ladder.rung, because=ladder.because)
    )
    step.do(COMMAND[ladder.way])


def not_done(step: CraftStep, ladder: Ladder, because: Reason) -> None:
    """Go to the next rung, after its pause; the same one when a lost link is heard again: nobody has refused it."""
    if "vehicle" in step.craft.links_down:
        _waits(step, ladder, because, ladder, None)
        alert(step, "order", "warning", OrderedAgainLater(because))
        return
    following = ladder.next(because)
    _waits(step, ladder, because, following, following.after_s)
    alert(step, "order", "warning", NotDone(ladder.order, ladder.way, because, following.way, following.after_s))


def _waits(step: CraftStep, failed: Ladder, because: Reason, following: Ladder, seconds: float | None) -> None:
    step.record(
        OrderNotDone(
            craft_id=step.craft.craft_id,
            order=failed.order,
            way=failed.way,
            reason=because,
            rung=following.rung,
            next_way=following.way,
            next_in_s=seconds,
        )
    )
    if seconds is not None:
        step.do(StartTimer("order", seconds))


def carried_out(step: CraftStep, way: Way) -> None:
    """The vehicle does what was tried last."""
    ladder = step.craft.ladder
    if ladder is None or ladder.stage != "tried" or ladder.way != way:
        return
    if ladder.fulfils:
        step.record(OrderDone(craft_id=step.craft.craft_id, order=ladder.order, way=way))
        clear_alerts(step, "order")
        _does_instead(step, ladder)
        return
    following = ladder.next(None)
    if following.because is None:
        try_rung(step, following)
    else:  # it hovers, and what was refused before is tried again after a while
        _waits(step, ladder, following.because, following, following.after_s)


def _does_instead(step: CraftStep, ladder: Ladder) -> None:
    """The vehicle took another rung than the one that was ordered: the phase says what it does."""
    if ladder.as_ordered:
        return
    phase: dict[Way, Phase] = {"hold": "hold", "return": "returning", "land": "landing"}
    after = phase[ladder.way]
    if after != step.craft.phase and ladder.because is not None:
        reason = Instead(ladder.order, ladder.way, ladder.because)
        alert(step, "order", "warning", reason)
        step.go(after, reason)


def alert(step: CraftStep, topic: Topic, level: Literal["warning", "caution", "advisory"], reason: Reason) -> None:
    """Raise an alert; one that is open on the same topic gives way to it."""
    clear_alerts(step, topic)
    _raise(step, topic, level, reason)


def _raise(step: CraftStep, topic: Topic, level: Literal["warning", "caution", "advisory"], reason: Reason) -> None:
    craft_id = step.craft.craft_id
    alert_id = f"{craft_id}-{topic}-{step.craft.alerts_raised + 1}"
    step.record(AlertRaised(alert_id=alert_id, topic=topic, level=level, reason=reason, craft_id=craft_id))


def doubt_place(step: CraftStep, bearing: BearingMeasured) -> None:
    """A caution while the newest bearing's place is not sure."""
    if bearing.drift_m > UNSURE_PLACE_M:
        alert(step, "place", "caution", PlaceUnsure(bearing.place_number, bearing.drift_m))
    else:
        clear_alerts(step, "place")


def tell_said(step: CraftStep, reason: AutopilotWords) -> None:
    """Beside the autopilot's other texts, but in place of the same one before. The oldest makes room."""
    clear_said(step, None if isinstance(reason, AutopilotSaidMore) else reason.text)
    standing = [raised for raised in step.craft.open_alerts if raised.topic == "autopilot"]
    for raised in standing[: max(0, len(standing) + 1 - MOST_SAID)]:
        step.record(AlertCleared(alert_id=raised.alert_id))
    severe = not isinstance(reason, AutopilotSaidMore) and reason.severity != "warning"
    _raise(step, "autopilot", "warning" if severe else "caution", reason)


def clear_said(step: CraftStep, text: str | None) -> None:
    """text None: the count of what was left out."""
    for raised in step.craft.open_alerts:
        if raised.topic == "autopilot" and getattr(raised.reason, "text", None) == text:
            step.record(AlertCleared(alert_id=raised.alert_id))


def clear_alerts(step: CraftStep, *topics: Topic) -> None:
    """Of this craft only."""
    for raised in step.craft.open_alerts:
        if raised.topic in topics:
            step.record(AlertCleared(alert_id=raised.alert_id))


def clear_failsafe(step: CraftStep) -> None:
    """The autopilot is no longer on its own way home. Of a link that is lost the alert stays."""
    if "vehicle" not in step.craft.links_down:
        clear_alerts(step, "vehicle")


def record_vetoes(step: CraftStep, vetoes: tuple[Reason, ...]) -> None:
    """One fact a veto; nothing is ordered."""
    for reason in vetoes:
        step.record(SafetyVetoed(craft_id=step.craft.craft_id, reason=reason))


def _topic_of(veto: Reason) -> Topic:
    if isinstance(veto, BATTERY):
        return "battery"
    return "clock" if isinstance(veto, ClockRateOdd) else "safety"


def refuse_flight(step: CraftStep, vetoes: tuple[Reason, ...], on_ground: bool = False) -> None:
    """Safety said no: go home when the battery says so, else hold and say why. What stands on the ground stays there,
    and its search open: another battery, or another place, may mend it."""
    record_vetoes(step, vetoes)
    if on_ground and step.craft.phase == "taking_off":
        alert(step, "safety", "warning", vetoes[0])
        step.go("hold", vetoes[0])
        return
    of_battery = [isinstance(reason, BATTERY) for reason in vetoes]
    alert(step, _topic_of(vetoes[0]), "warning", vetoes[0])
    if all(of_battery):
        go_home(step, vetoes[0])
    else:
        hold(step, vetoes[0])
