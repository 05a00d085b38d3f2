"""What a mission is at one moment: a fold of its events, and nothing else.

`evolve` is the only place that derives state from a fact; the machine itself changes state by recording facts, so a
journal read back after a crash gives the state that was running.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace

from backend.events import (
    AbortOrdered,
    AlertAcknowledged,
    AlertCleared,
    AlertRaised,
    AntennaChecked,
    AreaChanged,
    AutomaticChanged,
    BearingExcluded,
    BearingMeasured,
    BeliefUpdated,
    CheckFact,
    CommandAccepted,
    CommandRefused,
    ControlReleased,
    ControlTaken,
    Event,
    FlightStarted,
    HoldOrdered,
    LinkLost,
    LinkRestored,
    MissionDrafted,
    MissionEdited,
    MissionEnded,
    MissionStarted,
    Phase,
    PhaseChanged,
    PlanChosen,
    PlanVetoed,
    Recorded,
    ReturnOrdered,
    ServerRestarted,
    SweepRejected,
    SweepStarted,
    TookOff,
)
from backend.spec import MissionSpec, Place

GROUND: frozenset[Phase] = frozenset({"draft", "ready"})
AUTOMATIC: frozenset[Phase] = frozenset({"taking_off", "planning", "waiting", "flying", "measuring"})
HOMEWARD: frozenset[Phase] = frozenset({"returning", "landing"})
TERMINAL: frozenset[Phase] = frozenset({"done", "aborted", "failed"})


@dataclass(frozen=True, slots=True)
class Answer:
    accepted: bool
    reason: str
    remedy: str


@dataclass(frozen=True, slots=True)
class MissionState:
    """`chosen`: the place being proposed, flown to or measured at, None when the next is still to be planned.

    avoid: places vetoed or without a usable sweep since the last bearing, or since the search area changed.
    belief_current: no bearing came or went since `belief` was computed, and the area is the same. localized_at_s: when
    the belief was first good enough. homebound: an abort or a return was ordered last, and no hold since. open_alerts:
    ids raised and not cleared. answered: the first answer to every command id.
    """

    phase: Phase = "draft"
    phase_reason: str = ""
    spec: MissionSpec | None = None
    home: Place | None = None
    home_amsl_m: float = 0.0
    started_at_s: float | None = None
    localized_at_s: float | None = None
    automatic: bool = True
    took_off: bool = False
    place_number: int = 0
    chosen: PlanChosen | None = None
    accepted: bool = False
    attempt: int = 0
    avoid: tuple[Place, ...] = ()
    measured: tuple[BearingMeasured, ...] = ()
    excluded: frozenset[str] = frozenset()
    belief: BeliefUpdated | None = None
    belief_current: bool = False
    return_reason: str = ""
    homebound: bool = False
    pilot_has_control: bool = False
    links_down: frozenset[str] = frozenset()
    open_alerts: tuple[str, ...] = ()
    alerts_raised: int = 0
    outcome: str | None = None
    antenna: CheckFact | None = None
    answered: Mapping[str, Answer] = field(default_factory=dict)

    @property
    def bearings(self) -> tuple[BearingMeasured, ...]:
        """The bearings that count, in the order they were taken."""
        return tuple(b for b in self.measured if b.bearing_id not in self.excluded)

    @property
    def bearing_ids(self) -> tuple[str, ...]:
        return tuple(b.bearing_id for b in self.bearings)

    @property
    def localized(self) -> bool:
        return self.belief_current and self.belief is not None and self.belief.localized

    @property
    def flying_itself(self) -> bool:
        """Automatic control moves the vehicle, or is about to."""
        return self.phase in AUTOMATIC or self.phase in HOMEWARD

    @property
    def mission(self) -> MissionSpec:
        if self.spec is None:
            raise ValueError("this mission has no specification: its journal does not begin with mission_drafted")
        return self.spec


def evolve(state: MissionState, event: Event, at_s: float) -> MissionState:
    """The state after one fact. `at_s`: UTC epoch seconds of the fact."""
    match event:
        case AreaChanged(search=search):
            spec = state.mission.searching(search)
            return replace(
                state, spec=spec, chosen=None, accepted=False, avoid=(), belief_current=False, localized_at_s=None
            )
        case MissionDrafted(spec=spec) | MissionEdited(spec=spec):
            return replace(state, spec=spec, automatic=spec.flight.automatic, belief_current=False, antenna=None)
        case MissionStarted():
            # bearings from before the start (imported) are folded anew in the frame of the home
            current = state.belief_current and not state.measured
            return replace(
                state, home=event.home, home_amsl_m=event.home_amsl_m, started_at_s=at_s, belief_current=current
            )
        case PhaseChanged(after=after, reason=reason):
            back = reason if after == "returning" else state.return_reason
            return replace(state, phase=after, phase_reason=reason, return_reason=back)
        case TookOff():
            return replace(state, took_off=True)
        case PlanChosen():
            return replace(
                state, chosen=event, place_number=event.place_number, accepted=event.source == "operator", attempt=0
            )
        case PlanVetoed(place=place):
            return replace(state, chosen=None, accepted=False, avoid=(*state.avoid, place))
        case FlightStarted():
            return replace(state, accepted=True)
        case SweepStarted(attempt=attempt):
            return replace(state, attempt=attempt)
        case SweepRejected(attempt=attempt):
            if attempt <= state.mission.sensor.maximum_retakes or state.chosen is None:
                return state
            return replace(state, chosen=None, accepted=False, avoid=(*state.avoid, state.chosen.place))
        case BearingMeasured():
            return replace(
                state,
                measured=(*state.measured, event),
                place_number=max(state.place_number, event.place_number),
                chosen=None,
                accepted=False,
                avoid=(),
                belief_current=False,
            )
        case BearingExcluded(bearing_id=bearing_id):
            obsolete = state.phase == "waiting"
            return replace(
                state,
                excluded=state.excluded | {bearing_id},
                belief_current=False,
                chosen=None if obsolete else state.chosen,
            )
        case BeliefUpdated():
            since = (state.localized_at_s or at_s) if event.localized else None
            return replace(state, belief=event, belief_current=True, localized_at_s=since)
        case ServerRestarted():
            return replace(state, belief_current=False, links_down=frozenset())
        case MissionEnded(outcome=outcome):
            return replace(state, outcome=outcome)
        case _:
            return _evolve_surroundings(state, event)


def _evolve_surroundings(state: MissionState, event: Event) -> MissionState:
    """Facts about control, links, alerts and commands."""
    match event:
        case AutomaticChanged(automatic=automatic):
            return replace(state, automatic=automatic)
        case AbortOrdered() | ReturnOrdered() | HoldOrdered():
            return replace(state, homebound=not isinstance(event, HoldOrdered))
        case ControlTaken():
            return replace(state, pilot_has_control=True)
        case ControlReleased():
            return replace(state, pilot_has_control=False)
        case LinkLost(link=link):
            return replace(state, links_down=state.links_down | {link})
        case LinkRestored(link=link):
            return replace(state, links_down=state.links_down - {link})
        case AlertRaised(alert_id=alert_id):
            return replace(state, open_alerts=(*state.open_alerts, alert_id), alerts_raised=state.alerts_raised + 1)
        case AlertCleared(alert_id=alert_id):
            return replace(state, open_alerts=tuple(a for a in state.open_alerts if a != alert_id))
        case CommandAccepted(command_id=command_id):
            return replace(state, answered={**state.answered, command_id: Answer(True, "", "")})
        case CommandRefused(command_id=command_id, reason=reason, remedy=remedy):
            return replace(state, answered={**state.answered, command_id: Answer(False, reason, remedy)})
        case AntennaChecked(check=check):
            return replace(state, antenna=check)
        case AlertAcknowledged() | _:
            return state


def fold(recorded: Iterable[Recorded]) -> MissionState:
    """The state after a whole journal, in sequence order."""
    state = MissionState()
    for fact in recorded:
        state = evolve(state, fact.event, fact.at_utc.timestamp())
    return state
