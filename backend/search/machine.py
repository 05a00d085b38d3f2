"""The search machine: transition(state, input, at) -> effects. No await, no clock, no input or output, no craft.

Every input is answered in every stage; an ended search stays ended.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal, assert_never

from backend.commands import AcknowledgeAlert, ChangeArea, ExcludeBearing, IncludeBearing, MuteSource, SetPriorities
from backend.events import (
    AlertAcknowledged,
    AlertCleared,
    AlertRaised,
    AreaChanged,
    BearingExcluded,
    BearingIncluded,
    BearingMeasured,
    BeliefUpdated,
    Event,
    HeardOnTheWay,
    ImportSource,
    MissionDeleted,
    MissionEdited,
    MissionEnded,
    PersonSource,
    PreflightChecked,
    PrioritiesChanged,
    ReviewFact,
    SourceErrorsFact,
    SourceMuteChanged,
    Topic,
    TruthNoted,
)
from backend.reasons import NoLongerLocalized, NotLocalized, Reason, flight, refusals, search
from backend.reasons.refused import Refused
from backend.search.effects import Record, Refuse, SearchEffect, SearchElsewhere, UpdateBelief
from backend.search.inputs import (
    BearingsArrived,
    BeliefFailed,
    BeliefReady,
    Edited,
    NotStored,
    PreflightDone,
    Reviewed,
    SearchInput,
    SearchOrdered,
    SearchOver,
)
from backend.search.state import SearchState, evolve
from hardware.direction_finding.heading_offset import SIGNIFICANT, TOLERABLE_DEG


@dataclass(slots=True)
class SearchStep:
    """State so far and effects so far of one transition; lives no longer than it."""

    state: SearchState
    at_s: float
    effects: list[SearchEffect] = field(default_factory=list[SearchEffect])

    def do(self, effect: SearchEffect) -> None:
        """Ask for it, after what was asked for before; the state does not change."""
        self.effects.append(effect)

    def record(self, event: Event) -> None:
        """State changes by facts only."""
        self.state = evolve(self.state, event, self.at_s)
        self.effects.append(Record(event))


def transition(state: SearchState, given: SearchInput, at_s: float) -> tuple[SearchState, tuple[SearchEffect, ...]]:
    """The state after `given`, and what is to be done about it, in order. `at_s`: UTC epoch seconds of the input.

    The new state is the fold of the recorded facts onto the old one.
    """
    step = SearchStep(state, at_s)
    try:
        _take(step, given)
    except Refused as refused:
        step.do(Refuse(refused.reason))
    return step.state, tuple(step.effects)


def _take(step: SearchStep, given: SearchInput) -> None:
    state = step.state
    match given:
        case Edited(spec=spec, by=by):
            if state.stage in ("draft", "ready"):
                step.record(MissionEdited(spec=spec, by=by))
                update_stale_beliefs(step, only_with_bearings=True)
        case PreflightDone(checks=checks):
            if state.stage != "ended":
                passed = all(check.ok or not check.blocking for check in checks)
                step.record(PreflightChecked(passed=passed, checks=list(checks)))
        case BearingsArrived(facts=facts):
            _arrived(step, facts)
        case BeliefReady():
            _belief(step, given)
        case BeliefFailed(emitter_id=emitter_id):
            if state.stage == "open" and _awaits(state, emitter_id, given.bearing_ids):
                alert(step, "failure", "warning", search.BeliefBroke(emitter_id))
        case SearchOrdered():
            _ordered(step, given)
        case NotStored(detail=detail):
            if state.stage == "open":
                alert(step, "storage", "warning", flight.NotStored(detail))
        case SearchOver():
            if state.stage == "open":
                _over(step, given)
        case Reviewed(fact=fact):
            _reviewed(step, fact)
        case _:
            assert_never(given)


def update_stale_beliefs(step: SearchStep, only_with_bearings: bool = False) -> None:
    """Of every emitter whose bearings or area changed."""
    for emitter in step.state.emitters.values():
        if not emitter.belief_current and (emitter.measured or not only_with_bearings):
            step.do(UpdateBelief(emitter.emitter_id))


def _arrived(step: SearchStep, facts: tuple[Event, ...]) -> None:
    """A bearing of an emitter that is not looked for is no bearing of this search."""
    for fact in facts:
        if isinstance(fact, BearingMeasured) and fact.emitter_id not in step.state.emitters:
            raise Refused(refusals.NoSuchEmitter(fact.emitter_id))
    for fact in facts:
        step.record(fact)
    update_stale_beliefs(step, only_with_bearings=True)


def _reviewed(step: SearchStep, fact: ReviewFact) -> None:
    """What is in the air is in the list; its ground truth changes no belief."""
    if isinstance(fact, TruthNoted) and fact.emitter_id not in step.state.emitters:
        raise Refused(refusals.NoSuchEmitter(fact.emitter_id))
    if isinstance(fact, MissionDeleted) and step.state.stage == "open":
        raise Refused(refusals.StillUnderWay())
    step.record(fact)


def _belief(step: SearchStep, given: BeliefReady) -> None:
    if not _awaits(step.state, given.fact.emitter_id, given.bearing_ids):
        return
    step.record(given.fact)
    if step.state.beliefs_current:
        clear_alerts(step, "failure")
    doubt_headings(step, given.fact)


def _awaits(state: SearchState, emitter_id: str, bearing_ids: tuple[str, ...]) -> bool:
    """Whether a belief from these bearings is the one that is waited for."""
    emitter = state.emitters.get(emitter_id)
    return emitter is not None and not emitter.belief_current and bearing_ids == state.behind(emitter_id)


def doubt_headings(step: SearchStep, belief: BeliefUpdated) -> None:
    """Bearings that are turned together are a caution, whether that stops the claim or is taken into account."""
    askew = next((reason for reason in belief.not_yet if isinstance(reason, search.HeadingsAskew)), None)
    askew = askew or next((bearings_corrected(one) for one in belief.sources if turned(one)), None)
    if askew is None:
        clear_alerts(step, "heading")
    else:
        alert(step, "heading", "caution", askew)


def turned(source: SourceErrorsFact) -> bool:
    """By more than a compass may be off, and more than chance makes it."""
    return abs(source.bias_deg) > max(TOLERABLE_DEG, SIGNIFICANT * source.bias_std_error_deg)


def bearings_corrected(source: SourceErrorsFact) -> search.BearingsCorrected:
    """In words, what was taken off its bearings."""
    return search.BearingsCorrected(source.bias_deg, source.bias_std_error_deg)


def _ordered(step: SearchStep, given: SearchOrdered) -> None:
    match given.command:
        case ChangeArea():
            _change_area(step, given, given.command)
        case ExcludeBearing():
            _exclude(step, given, given.command)
        case IncludeBearing():
            _include(step, given, given.command)
        case MuteSource():
            _mute(step, given, given.command)
        case SetPriorities():
            _put_in_order(step, given, given.command)
        case AcknowledgeAlert(alert_id=alert_id):
            step.record(AlertAcknowledged(alert_id=alert_id, by=given.by))
        case _:
            assert_never(given.command)


def _change_area(step: SearchStep, given: SearchOrdered, command: ChangeArea) -> None:
    match step.state.stage:
        case "draft" | "ready":
            raise Refused(refusals.NotStarted())
        case "ended":
            raise Refused(refusals.MissionOver())
        case "open" if not given.held:
            raise Refused(refusals.AreaOnlyInHold())
        case "open":
            for reason in given.objections:
                raise Refused(reason)
            for name in command.search.priors:
                if name not in step.state.emitters:
                    raise Refused(refusals.NoSuchEmitter(name))
    step.record(AreaChanged(search=command.search, by=given.by))
    step.do(SearchElsewhere())
    update_stale_beliefs(step)


def _exclude(step: SearchStep, given: SearchOrdered, command: ExcludeBearing) -> None:
    found = step.state.told(command.bearing_id)
    if found is None:
        raise Refused(refusals.NoSuchBearing())
    emitter, left_out = found
    if command.bearing_id in emitter.excluded:
        raise Refused(refusals.BearingExcludedAlready())
    if step.state.stage == "ended":
        raise Refused(refusals.MissionOver())
    step.record(
        BearingExcluded(
            emitter_id=emitter.emitter_id,
            bearing_id=command.bearing_id,
            by=given.by,
            reason=command.reason,
            heard=isinstance(left_out, BearingMeasured),
            on_the_way=isinstance(left_out, HeardOnTheWay),
        )
    )
    update_stale_beliefs(step)


def _include(step: SearchStep, given: SearchOrdered, command: IncludeBearing) -> None:
    found = step.state.told(command.bearing_id)
    if found is None:
        raise Refused(refusals.NoSuchBearing())
    emitter, left_out = found
    if command.bearing_id not in emitter.excluded:
        raise Refused(refusals.BearingCountsAlready())
    if step.state.stage == "ended":
        raise Refused(refusals.MissionOver())
    step.record(
        BearingIncluded(
            emitter_id=emitter.emitter_id,
            bearing_id=command.bearing_id,
            by=given.by,
            heard=isinstance(left_out, BearingMeasured),
        )
    )
    update_stale_beliefs(step)


def _mute(step: SearchStep, given: SearchOrdered, command: MuteSource) -> None:
    person, name = command.of == "person", command.name
    source = PersonSource(name=name) if person else ImportSource(recording_id=name)
    if all(bearing.source != source for bearing in step.state.measured):
        raise Refused(refusals.NoSuchSource())
    if (source in step.state.muted) == command.muted:
        raise Refused(refusals.MutedAlready(command.muted))
    if step.state.stage == "ended":
        raise Refused(refusals.MissionOver())
    step.record(SourceMuteChanged(source=source, muted=command.muted, by=given.by, reason=command.reason))
    update_stale_beliefs(step)


def _put_in_order(step: SearchStep, given: SearchOrdered, command: SetPriorities) -> None:
    """Before the start the order is edited like the rest of the specification."""
    if step.state.stage in ("draft", "ready"):
        raise Refused(refusals.NotStarted())
    if step.state.stage == "ended":
        raise Refused(refusals.MissionOver())
    for name in command.priorities:
        if name not in step.state.emitters:
            raise Refused(refusals.NoSuchEmitter(name))
    step.record(PrioritiesChanged(priorities=command.priorities, by=given.by))


def _over(step: SearchStep, given: SearchOver) -> None:
    """Say honestly what came of it. The mission's time runs until the belief was good enough, else until now."""
    state = step.state
    outcome, reason = given.outcome, given.because
    if outcome is None:
        outcome, reason = _verdict(state, given.because)
    clear_alerts(step, "storage", "console", "failure")
    began = step.at_s if state.started_at_s is None else state.started_at_s
    until = state.localized_at_s if outcome == "localized" and state.localized_at_s is not None else step.at_s
    step.record(MissionEnded(outcome=outcome, reason=reason, mission_time_s=max(0.0, until - began)))


def _verdict(state: SearchState, because: Reason) -> tuple[Literal["localized", "not_localized"], Reason]:
    if state.found:
        claims = [e.belief if e.localized else e.claim for e in state.emitters.values()]
        beliefs = [belief for belief in claims if belief is not None]
        against = sum(len(belief.contradicting) for belief in beliefs)
        if against == 0:
            return "localized", search.Localized()
        return "localized", search.LocalizedAgainst(against, sum(belief.bearings for belief in beliefs))
    if isinstance(because, search.Localized | search.LocalizedAgainst):
        return "not_localized", NoLongerLocalized(state.not_yet)
    if isinstance(because, NotLocalized):  # a craft that went home for it says so itself
        because = because.because
    return "not_localized", NotLocalized(because, state.not_yet)


def alert(step: SearchStep, topic: Topic, level: Literal["warning", "caution", "advisory"], reason: Reason) -> None:
    """Raise an alert; one that is open on the same topic gives way to it."""
    if any((alert.topic, alert.reason) == (topic, reason) for alert in step.state.open_alerts):
        return
    clear_alerts(step, topic)
    alert_id = f"{topic}-{step.state.alerts_raised + 1}"
    step.record(AlertRaised(alert_id=alert_id, topic=topic, level=level, reason=reason))


def clear_alerts(step: SearchStep, *topics: Topic) -> None:
    """Of the search only; those of its craft stay."""
    for alert in step.state.open_alerts:
        if alert.topic in topics:
            step.record(AlertCleared(alert_id=alert.alert_id))
