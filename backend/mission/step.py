"""One transition being built, and the moves that commands and facts share."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

from backend.events import (
    AlertCleared,
    AlertRaised,
    Event,
    FlightStarted,
    MissionEnded,
    Phase,
    PhaseChanged,
    SafetyVetoed,
    SweepStarted,
)
from backend.mission.effects import (
    CancelTimer,
    CancelWork,
    Effect,
    FlyTo,
    HoldVehicle,
    Measure,
    PlanNext,
    Record,
    ReturnHome,
    TakeOff,
    UpdateBelief,
)
from backend.mission.safety import Veto
from backend.mission.state import MissionState, evolve

Topic = Literal[
    "vehicle",
    "receiver",
    "console",
    "payload",
    "pilot",
    "battery",
    "place",
    "heading",
    "failure",
    "safety",
    "ground",
    "storage",
]


OF_THE_FLIGHT: tuple[Topic, ...] = (
    "vehicle", "receiver", "console", "payload", "pilot", "battery", "failure", "safety", "ground",
)  # fmt: skip
"""Topics that are over once the vehicle is down."""
LOCALIZED = "localized"


@dataclass(slots=True)
class Step:
    """State so far and effects so far of one transition; lives no longer than it."""

    state: MissionState
    at_s: float
    effects: list[Effect] = field(default_factory=list)

    def do(self, effect: Effect) -> None:
        self.effects.append(effect)

    def record(self, event: Event) -> None:
        """State changes by facts only."""
        self.state = evolve(self.state, event, self.at_s)
        self.effects.append(Record(event))

    def go(self, after: Phase, reason: str) -> None:
        before = self.state.phase
        if before != after:
            self.record(PhaseChanged(before=before, after=after, reason=reason))


def go_on(step: Step, reason: str, accepted: bool = False) -> None:
    """What automatic control does next, from whatever is known; the one way into every automatic phase."""
    state = step.state
    spec = state.mission
    if not state.took_off:
        take_off(step, reason)
    elif not state.belief_current:
        step.go("planning", reason)
        step.do(UpdateBelief())
    elif state.localized:
        go_home(step, LOCALIZED)
    elif state.chosen is not None and (accepted or state.accepted or state.automatic):
        altitude = state.home_amsl_m + spec.flight.altitude_relative_m
        step.go("flying", reason)
        step.record(FlightStarted(place_number=state.place_number, place=state.chosen.place, altitude_amsl_m=altitude))
        step.do(FlyTo(state.place_number, state.chosen.place, altitude, spec.flight.speed_m_s))
    elif state.chosen is not None:
        step.go("waiting", reason)
    elif state.place_number >= spec.localization.maximum_bearings:
        go_home(step, f"not localized after {state.place_number} places{why_not_yet(state)}")
    else:
        step.go("planning", reason)
        step.do(PlanNext(state.place_number + 1, state.avoid))


def take_off(step: Step, reason: str) -> None:
    step.go("taking_off", reason)
    step.do(TakeOff(step.state.mission.flight.altitude_relative_m))


def measure(step: Step, reason: str) -> None:
    step.go("measuring", reason)
    attempt = step.state.attempt + 1
    step.record(SweepStarted(place_number=step.state.place_number, attempt=attempt))
    step.do(Measure(step.state.place_number, attempt))


def go_home(step: Step, reason: str) -> None:
    step.do(CancelWork())
    step.go("returning", reason)
    step.do(ReturnHome())


def hold(step: Step, reason: str) -> None:
    """Stop automatic flight by the mission's own decision."""
    step.do(CancelWork())
    step.do(HoldVehicle())
    step.go("hold", reason)


def end(
    step: Step, phase: Phase, outcome: Literal["localized", "not_localized", "aborted", "failed"], reason: str
) -> None:
    """The mission is over. Its time runs until the belief was good enough, else until now."""
    state = step.state
    began = step.at_s if state.started_at_s is None else state.started_at_s
    until = state.localized_at_s if outcome == "localized" and state.localized_at_s is not None else step.at_s
    step.record(MissionEnded(outcome=outcome, reason=reason, mission_time_s=max(0.0, until - began)))
    step.go(phase, reason)
    step.do(CancelTimer("console_hold"))
    step.do(CancelTimer("console_return"))
    step.do(CancelTimer("landing"))


def finish(step: Step, reason: str) -> None:
    """The vehicle is down: what was to be watched in flight is over; say honestly what came of the search."""
    clear_alerts(step, *OF_THE_FLIGHT)
    if step.state.localized:
        end(step, "done", "localized", f"the expected error is below the threshold{_against(step.state)}")
    elif reason == LOCALIZED:
        end(step, "done", "not_localized", f"no longer localized since a bearing was excluded{why_not_yet(step.state)}")
    else:
        end(step, "done", "not_localized", reason + why_not_yet(step.state))


def _against(state: MissionState) -> str:
    """A claim that stands against a bearing says so (mission rule 6, decision 12)."""
    against = 0 if state.belief is None else len(state.belief.contradicting)
    return f"; it stands against {against} of {len(state.bearings)} bearings" if against else ""


def why_not_yet(state: MissionState) -> str:
    reasons = state.belief.not_yet if state.belief is not None else []
    return f" ({'; '.join(reasons)})" if reasons else ""


def alert(step: Step, topic: Topic, level: Literal["warning", "caution", "advisory"], text: str, remedy: str) -> None:
    """Raise an alert; one that is open on the same topic gives way to it."""
    clear_alerts(step, topic)
    step.record(AlertRaised(alert_id=f"{topic}-{step.state.alerts_raised + 1}", level=level, text=text, remedy=remedy))


def clear_alerts(step: Step, *topics: Topic | str) -> None:
    for alert_id in step.state.open_alerts:
        if alert_id.rsplit("-", 1)[0] in topics:
            step.record(AlertCleared(alert_id=alert_id))


def forget_failsafe(step: Step) -> None:
    """The autopilot is no longer on its own way home. Of a link that is lost the alert stays."""
    if "vehicle" not in step.state.links_down:
        clear_alerts(step, "vehicle")


def refuse_flight(step: Step, vetoes: tuple[Veto, ...]) -> None:
    """Safety said no: go home when the battery says so, else hold and tell the operator."""
    for veto in vetoes:
        step.record(SafetyVetoed(rule=veto.rule, detail=veto.detail, remedy=veto.remedy))
    first = vetoes[0]
    of_battery = [veto.rule.startswith("battery") for veto in vetoes]
    alert(step, "battery" if of_battery[0] else "safety", "warning", first.detail, first.remedy)
    if all(of_battery):
        go_home(step, first.detail)
    else:
        hold(step, first.detail)
