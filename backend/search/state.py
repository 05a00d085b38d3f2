"""What a search knows at one moment: a fold of the mission's facts, and nothing else. It needs no craft."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Literal

from backend.events import (
    AlertCleared,
    AlertRaised,
    AntennaChecked,
    AreaChanged,
    BearingExcluded,
    BearingIncluded,
    BearingMeasured,
    BearingSource,
    BeliefUpdated,
    CheckFact,
    Event,
    GroundFact,
    HeardOnTheWay,
    MissionDeleted,
    MissionDrafted,
    MissionEdited,
    MissionEnded,
    MissionRestored,
    MissionStarted,
    Outcome,
    PlanChosen,
    PreflightChecked,
    PrioritiesChanged,
    ServerRestarted,
    SetBackFact,
    SourceMuteChanged,
    SweepRejected,
    Topic,
    TruthNoted,
)
from backend.reasons import Reason
from backend.search.emitter import EmitterState
from backend.search.importance import Patience, rank_of, standing_back, waited
from backend.spec import MissionSpec, Place

Stage = Literal["draft", "ready", "open", "ended"]
"""A draft may be edited; ready: its preflight passed; open: it is searched; ended stays ended."""


@dataclass(frozen=True, slots=True)
class OpenAlert:
    """An alert that was raised and not cleared."""

    alert_id: str
    topic: Topic
    reason: Reason


@dataclass(frozen=True, slots=True)
class SearchState:
    """emitters: by id, in the specification's order. home: origin of the local frame, None until a craft started.
    ground: the terrain below, None while it is taken to be flat.

    muted: sources whose bearings count for no emitter. patience: by emitter id.

    place_number: the highest so far, of all craft. started_at_s, ended_at_s: UTC epoch seconds. deleted: out of the
    list, to be restored for some days.
    """

    spec: MissionSpec | None = None
    passed: bool = False
    antenna: CheckFact | None = None
    home: Place | None = None
    home_amsl_m: float = 0.0
    ground: GroundFact | None = None
    started_at_s: float | None = None
    emitters: Mapping[str, EmitterState] = field(default_factory=dict[str, EmitterState])
    muted: frozenset[BearingSource] = frozenset()
    patience: Mapping[str, Patience] = field(default_factory=dict[str, Patience])
    place_number: int = 0
    open_alerts: tuple[OpenAlert, ...] = ()
    alerts_raised: int = 0
    outcome: Outcome | None = None
    outcome_reason: Reason | None = None
    deleted: bool = False

    @property
    def stage(self) -> Stage:
        """ "ready": the last checklist passed; "open": a craft has started."""
        if self.outcome is not None:
            return "ended"
        if self.started_at_s is not None:
            return "open"
        return "ready" if self.passed else "draft"

    @property
    def mission(self) -> MissionSpec:
        """Raises ValueError for a journal without a draft."""
        if self.spec is None:
            raise ValueError("this mission has no specification: its journal does not begin with mission_drafted")
        return self.spec

    @property
    def localized(self) -> bool:
        """Every emitter that is looked for."""
        return bool(self.emitters) and all(emitter.localized for emitter in self.emitters.values())

    @property
    def follows(self) -> bool:
        """Whether emitters that move are looked for on after they were localized."""
        return self.mission.localization.follow and any(e.movement.kind != "still" for e in self.mission.emitters)

    @property
    def done(self) -> bool:
        """Nothing is left to be measured."""
        return self.localized and not self.follows

    @property
    def found(self) -> bool:
        """What the search ends with: localized now; of one that follows, localized at one time or other."""
        emitters = self.emitters.values()
        if not emitters:
            return False
        claimed = self.follows and all(emitter.claim is not None for emitter in emitters)
        return claimed or all(emitter.found for emitter in emitters)

    @property
    def sought(self) -> tuple[EmitterState, ...]:
        """Whom the next place is for, the most important first: the wanted, else those that are followed, else all."""
        if self.wanted or not self.follows:
            sought = self.wanted or tuple(self.emitters.values())
        else:
            moving = [e.emitter_id for e in self.mission.emitters if e.movement.kind != "still"]
            sought = tuple(self.emitters[name] for name in moving)
        return tuple(sorted(sought, key=lambda emitter: self.rank(emitter.emitter_id)))

    def rank(self, emitter_id: str) -> int:
        """In the order of importance, the lower the sooner; equal ones are alike."""
        return rank_of(self.spec, emitter_id, self.patience)

    @property
    def set_back(self) -> list[SetBackFact]:
        """Those that are still looked for and would come first, but for the others' patience."""
        return standing_back(self.mission, [one.emitter_id for one in self.sought], self.patience)

    @property
    def beliefs_current(self) -> bool:
        """True also of a search without emitters."""
        return all(emitter.belief_current for emitter in self.emitters.values())

    @property
    def localized_at_s(self) -> float | None:
        """When the last of them was, None while one is not."""
        times = [emitter.localized_at_s for emitter in self.emitters.values()]
        return None if not times or None in times else max(time for time in times if time is not None)

    @property
    def wanted(self) -> tuple[EmitterState, ...]:
        """The emitters that are not localized."""
        return tuple(emitter for emitter in self.emitters.values() if not emitter.localized)

    @property
    def not_yet(self) -> tuple[Reason, ...]:
        """Of every emitter still looked for."""
        return tuple(reason for emitter in self.wanted for reason in emitter.not_yet)

    @property
    def measured(self) -> tuple[BearingMeasured, ...]:
        """The bearings of all emitters."""
        return tuple(bearing for emitter in self.emitters.values() for bearing in emitter.measured)

    def behind(self, emitter_id: str) -> tuple[str, ...]:
        """The ids of all that the belief about an emitter stands on; its own first."""
        own, sharing = self.emitters[emitter_id], self.mission.sharing
        others = [self.emitters[name] for name in sharing if name != emitter_id] if emitter_id in sharing else []
        return (*own.bearing_ids, *(one for other in others if other.bearings for one in other.bearing_ids))

    def silent(self, sweep_id: str) -> tuple[EmitterState, SweepRejected] | None:
        """A turn that heard nothing of an emitter, also one that was excluded; None for an unknown id."""
        for emitter in self.emitters.values():
            for one in emitter.silences:
                if one.sweep_id == sweep_id:
                    return emitter, one
        return None

    def way(self, leg_id: str) -> tuple[EmitterState, HeardOnTheWay] | None:
        """A leg that was listened on, also one that was excluded; None for an unknown id."""
        for emitter in self.emitters.values():
            for leg in emitter.ways:
                if leg.leg_id == leg_id:
                    return emitter, leg
        return None

    def told(self, told_id: str) -> tuple[EmitterState, BearingMeasured | SweepRejected | HeardOnTheWay] | None:
        """What an operator may leave out: a bearing, a turn that heard nothing, or a leg."""
        return self.bearing(told_id) or self.silent(told_id) or self.way(told_id)

    def bearing(self, bearing_id: str) -> tuple[EmitterState, BearingMeasured] | None:
        """Also one that was excluded; None for an unknown id."""
        for emitter in self.emitters.values():
            for bearing in emitter.measured:
                if bearing.bearing_id == bearing_id:
                    return emitter, bearing
        return None


def evolve(state: SearchState, event: Event, at_s: float) -> SearchState:
    """The state after one fact. `at_s`: UTC epoch seconds of the fact."""
    evolved = _evolve(state, event, at_s)
    patience = waited(state.patience, event)
    return evolved if patience is state.patience else replace(evolved, patience=patience)


def _evolve(state: SearchState, event: Event, at_s: float) -> SearchState:
    match event:
        case MissionDrafted(spec=spec) | MissionEdited(spec=spec):
            return replace(_with_spec(state, spec), passed=False, antenna=None)
        case AreaChanged(search=search):
            changed = _with_spec(state, state.mission.searching(search))
            return _each(changed, lambda emitter: replace(emitter, localized_at_s=None, claim=None))
        case PrioritiesChanged(priorities=priorities):
            return replace(state, spec=state.mission.in_order(priorities))
        case PreflightChecked(passed=passed):
            return replace(state, passed=passed) if state.stage in ("draft", "ready") else state
        case AntennaChecked(check=check):
            return replace(state, antenna=check)
        case MissionStarted(home=home, home_amsl_m=home_amsl_m, ground=ground, learned=learned):
            if state.home is not None:
                return state
            # bearings from before the start (imported) are folded again in the frame of the home
            begun = _each(state, lambda e: _outrun(e) if e.measured else e)
            spec = state.spec if learned is None else state.mission.having_learned(learned)
            return replace(begun, spec=spec, home=home, home_amsl_m=home_amsl_m, ground=ground, started_at_s=at_s)
        case PlanChosen(place_number=number):
            return replace(state, place_number=max(state.place_number, number))
        case SweepRejected(silence=None):
            return state
        case BearingMeasured() | BearingExcluded() | BearingIncluded() | BeliefUpdated():
            return _evolve_emitter(state, event, at_s)
        case SweepRejected() | HeardOnTheWay():
            return _evolve_emitter(state, event, at_s)
        case SourceMuteChanged(source=source, muted=muted):
            sources = state.muted.union((source,)) if muted else state.muted.difference((source,))
            counted = _each(replace(state, muted=sources), lambda emitter: _muting(emitter, source, sources))
            for emitter in state.emitters.values():
                if _tells(emitter, source):
                    counted = _told(counted, emitter.emitter_id, _recounted)
            return counted
        case AlertRaised(alert_id=alert_id, topic=topic, reason=reason, craft_id=None):
            alerts = (*state.open_alerts, OpenAlert(alert_id, topic, reason))
            return replace(state, open_alerts=alerts, alerts_raised=state.alerts_raised + 1)
        case AlertCleared(alert_id=alert_id) if any(a.alert_id == alert_id for a in state.open_alerts):
            return replace(state, open_alerts=tuple(a for a in state.open_alerts if a.alert_id != alert_id))
        case ServerRestarted():
            return _each(state, _folded_again)
        case TruthNoted(emitter_id=name) if name in state.emitters:
            told = replace(state.emitters[name], truth=event)
            return replace(state, emitters={**state.emitters, name: told})
        case MissionDeleted() | MissionRestored():
            return replace(state, deleted=isinstance(event, MissionDeleted))
        case MissionEnded(outcome=outcome, reason=reason):
            return replace(state, outcome=outcome, outcome_reason=reason)
        case _:
            return state


def _evolve_emitter(
    state: SearchState,
    event: BearingMeasured | BearingExcluded | BearingIncluded | BeliefUpdated | SweepRejected | HeardOnTheWay,
    at_s: float,
) -> SearchState:
    emitter = state.emitters.get(event.emitter_id, EmitterState(event.emitter_id, muted=state.muted))
    number = state.place_number
    match event:
        case BearingMeasured():
            emitter = _outrun(replace(emitter, measured=(*emitter.measured, event)))
            number = max(number, event.place_number)
        case SweepRejected():
            emitter = _outrun(replace(emitter, silences=(*emitter.silences, event)))
        case HeardOnTheWay(tells=tells):
            emitter = replace(emitter, ways=(*emitter.ways, event))
            emitter = _outrun(emitter) if tells else emitter
        case BearingExcluded(bearing_id=bearing_id):
            emitter = _recounted(replace(emitter, excluded=emitter.excluded | {bearing_id}))
        case BearingIncluded(bearing_id=bearing_id):
            emitter = _recounted(replace(emitter, excluded=emitter.excluded - {bearing_id}))
        case BeliefUpdated(localized=localized):
            since = (emitter.localized_at_s or at_s) if localized else None
            emitter = replace(emitter, belief=event, belief_current=True, folded_again=False, localized_at_s=since)
            if localized:
                emitter = replace(emitter, claim=event)
    evolved = replace(state, emitters={**state.emitters, emitter.emitter_id: emitter}, place_number=number)
    match event:
        case BeliefUpdated():
            return evolved
        case HeardOnTheWay() if not event.tells:
            return evolved
        case BearingExcluded() | BearingIncluded():
            return _told(evolved, emitter.emitter_id, _recounted)
        case BearingMeasured() | SweepRejected() | HeardOnTheWay():
            return _told(evolved, emitter.emitter_id, _outrun)


def _told(state: SearchState, emitter_id: str, change: Callable[[EmitterState], EmitterState]) -> SearchState:
    """Changes the emitters whose beliefs stand on this one's bearings, too, since they share a source's errors."""
    sharing = () if state.spec is None else state.spec.sharing
    if emitter_id not in sharing:
        return state
    told = {name: state.emitters[name] for name in sharing if name != emitter_id and state.emitters[name].measured}
    return replace(state, emitters={**state.emitters, **{name: change(one) for name, one in told.items()}})


def _muting(emitter: EmitterState, source: BearingSource, muted: frozenset[BearingSource]) -> EmitterState:
    """An emitter that the source told nothing of keeps its belief."""
    emitter = replace(emitter, muted=muted)
    return _recounted(emitter) if _tells(emitter, source) else emitter


def _tells(emitter: EmitterState, source: BearingSource) -> bool:
    """Whether the source took a bearing of it that was not left out by itself, or heard it on the way."""
    took = any(b.source == source and b.bearing_id not in emitter.excluded for b in emitter.measured)
    return took or any(leg.source == source and leg.tells for leg in emitter.ways)


def _recounted(emitter: EmitterState) -> EmitterState:
    """What was claimed was claimed of other bearings."""
    return replace(_outrun(emitter), claim=None)


def _folded_again(emitter: EmitterState) -> EmitterState:
    return replace(emitter, belief_current=False, folded_again=emitter.belief_current or emitter.folded_again)


def _outrun(emitter: EmitterState) -> EmitterState:
    """What is believed is not of these bearings in this area."""
    return replace(emitter, belief_current=False, folded_again=False)


def _with_spec(state: SearchState, spec: MissionSpec) -> SearchState:
    """An emitter that is no longer looked for takes its bearings with it."""
    ids = [emitter.emitter_id for emitter in spec.emitters]
    unknown = {name: EmitterState(name, muted=state.muted) for name in ids}
    emitters = {name: _outrun(state.emitters.get(name, unknown[name])) for name in ids}
    return replace(state, spec=spec, emitters=emitters)


def _each(state: SearchState, change: Callable[[EmitterState], EmitterState]) -> SearchState:
    return replace(state, emitters={name: change(emitter) for name, emitter in state.emitters.items()})
