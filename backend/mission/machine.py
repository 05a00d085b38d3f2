"""The mission machine: it hands each input to the search or to a craft, and each what the other did to it.

transition(state, input, at) -> (state, effects). Pure like the two machines that it binds.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, field

from backend.commands import (
    Abort,
    AcknowledgeAlert,
    AskControl,
    ChangeArea,
    ExcludeBearing,
    ForCraft,
    GiveControl,
    Hold,
    IncludeBearing,
    KeepControl,
    Land,
    MuteSource,
    ReleaseControl,
    Return,
    SetPriorities,
    Start,
    TakeControl,
    order_of,
)
from backend.craft import machine as craft_machine
from backend.craft.effects import CraftEffect, LeaveSearch
from backend.craft.inputs import CraftInput, CraftOrdered, SearchChanged
from backend.events import (
    AreaChanged,
    AuthorFact,
    BearingExcluded,
    BearingIncluded,
    BearingMeasured,
    BeliefUpdated,
    CommandAccepted,
    CommandRefused,
    ControlAsked,
    ControlChanged,
    ControlKept,
    CraftSource,
    Event,
    HeardOnTheWay,
    MissionStarted,
    PrioritiesChanged,
    ServerRestarted,
    SourceMuteChanged,
    SweepRejected,
)
from backend.mission import control
from backend.mission.effects import Effect, OfCraft, Reply
from backend.mission.inputs import Commanded, Context, Input, ServerCameBack, ToCraft
from backend.mission.state import MissionState, evolve, newcomer
from backend.reasons import Reason, refusals
from backend.reasons.access import CommandIdReused
from backend.search import machine as search_machine
from backend.search.effects import Record, Refuse, SearchEffect, UpdateBelief
from backend.search.inputs import SearchInput, SearchOrdered, SearchOver

Recount = BearingExcluded | BearingIncluded | SourceMuteChanged
"""What makes bearings count that did not, or the other way round."""

FOR_ALL = (Hold, Return, Land, Abort)
"""Orders that name no craft are for every one."""


@dataclass(slots=True)
class _Transition:
    state: MissionState
    at_s: float
    effects: list[Effect] = field(default_factory=list[Effect])
    facts: list[Event] = field(default_factory=list[Event])

    def record(self, event: Event) -> None:
        self.state = evolve(self.state, event, self.at_s)
        self.effects.append(Record(event))
        self.facts.append(event)

    def to_search(self, given: SearchInput) -> Reason | None:
        """Why it was refused, None when it was taken."""
        _, asked = search_machine.transition(self.state.search, given, self.at_s)
        return self._take(asked, None)

    def to_craft(self, craft_id: str, given: CraftInput) -> Reason | None:
        craft = self.state.crafts.get(craft_id) or newcomer(self.state, craft_id)
        _, asked = craft_machine.transition(craft, self.state.search, given, self.at_s)
        return self._take(asked, craft_id)

    def _take(self, asked: tuple[SearchEffect, ...] | tuple[CraftEffect, ...], craft_id: str | None) -> Reason | None:
        refused = None
        for effect in asked:
            match effect:
                case Record(event=event):
                    self.record(event)
                case Refuse(reason=reason):
                    refused = reason
                case LeaveSearch():
                    self._leave(effect)
                case _ if craft_id is not None:
                    self.effects.append(OfCraft(craft_id, effect))  # type: ignore[arg-type]
                case _:
                    self.effects.append(effect)  # type: ignore[arg-type]
        return refused

    def _leave(self, leaving: LeaveSearch) -> None:
        """The search goes on while another craft searches."""
        if not any(craft.searching for craft in self.state.crafts.values()):
            self.to_search(SearchOver(leaving.because, leaving.outcome))

    def react(self) -> None:
        """What the facts so far mean to the others: beliefs to fold, craft that waited for them."""
        facts, self.facts = self.facts, []
        if any(_outruns_beliefs(fact) for fact in facts):
            self.update_beliefs()
        if any(_changes_the_search(fact) for fact in facts):
            for craft in self.state.engaged:
                self.to_craft(craft.craft_id, SearchChanged())

    def update_beliefs(self) -> None:
        asked = {effect.emitter_id for effect in self.effects if isinstance(effect, UpdateBelief)}
        search, drafted = self.state.search, self.state.search.stage in ("draft", "ready")
        for emitter in search.emitters.values():
            stale = not emitter.belief_current and (emitter.measured or not drafted)
            if stale and emitter.emitter_id not in asked:
                self.effects.append(UpdateBelief(emitter.emitter_id))


def _outruns_beliefs(fact: Event) -> bool:
    """A turn that heard nothing counts where it says what it listened to, a leg where a stretch of it says anything."""
    silent = isinstance(fact, SweepRejected) and fact.silence is not None
    on_the_way = isinstance(fact, HeardOnTheWay) and fact.tells
    return silent or on_the_way or isinstance(fact, BearingMeasured | Recount | AreaChanged | MissionStarted)


def _changes_the_search(fact: Event) -> bool:
    """A craft's own bearing is part of what it is doing already."""
    foreign = isinstance(fact, BearingMeasured) and not isinstance(fact.source, CraftSource)
    return foreign or isinstance(fact, BeliefUpdated | Recount | PrioritiesChanged)


def transition(state: MissionState, given: Input, at_s: float) -> tuple[MissionState, tuple[Effect, ...]]:
    """The state after `given`, and what is to be done about it, in order. `at_s`: UTC epoch seconds of the input.

    The new state is the fold of the recorded facts onto the old one.
    """
    now = _Transition(state, at_s)
    match given:
        case Commanded():
            _command(now, given)
        case ToCraft(craft_id=craft_id, given=to_craft):
            if craft_id in state.crafts:
                now.to_craft(craft_id, to_craft)
        case ServerCameBack():
            if state.engaged or state.search.stage == "open":
                now.record(ServerRestarted())
                if state.search.stage != "ended":
                    now.update_beliefs()
        case _:
            now.to_search(given)
    now.react()
    return now.state, tuple(now.effects)


def _command(now: _Transition, given: Commanded) -> None:
    """Carry out or refuse. A command id that was answered before gets the same answer and does nothing; with another
    order it is refused, and the first answer stands."""
    command_id, kind, order = given.command_id, given.command.kind, order_of(given.command)
    before = now.state.answered.get(command_id)
    if before is not None:
        same = before.command == kind and before.order in (None, order)
        now.effects.append(Reply(command_id, before.reason if same else CommandIdReused(before.command)))
        return
    refused = _carry_out(now, given)
    author = AuthorFact(person=given.author.person, role=given.author.role, address=given.author.address)
    by = given.author.name
    if refused is None:
        now.record(CommandAccepted(command_id=command_id, command=kind, by=by, order=order, author=author))
    else:
        now.record(
            CommandRefused(command_id=command_id, command=kind, by=by, reason=refused, order=order, author=author)
        )
    now.effects.append(Reply(command_id, refused))


def _carry_out(now: _Transition, given: Commanded) -> Reason | None:
    command, state = given.command, now.state
    not_in_control = control.objection(state.control, given.author, given.fence, command)
    if not_in_control is not None:
        return not_in_control
    match command:
        case TakeControl() | AskControl() | GiveControl() | KeepControl() | ReleaseControl():
            decided = control.decide(state.control, given.author, command, given.holder_gone, now.at_s)
            if not isinstance(decided, ControlChanged | ControlAsked | ControlKept):
                return decided
            now.record(decided)
            return None
        case AcknowledgeAlert(alert_id=alert_id) if alert_id not in open_alert_ids(state):
            return refusals.NoSuchAlert()
        case ChangeArea() | ExcludeBearing() | IncludeBearing() | MuteSource() | SetPriorities() | AcknowledgeAlert():
            held = all(craft.phase == "hold" and not craft.taken_over for craft in state.engaged)
            return now.to_search(SearchOrdered(given.author.name, command, given.search.objections, held))
        case _:
            return _order(now, given, command)


def _order(now: _Transition, given: Commanded, command: ForCraft) -> Reason | None:
    """Refused only when no craft that was meant takes it."""
    wanted = crafts_meant(now.state, command, given.contexts if isinstance(command, Start) else ())
    if not wanted:
        return refusals.NoSuchCraft(command.craft_id or "")
    refused: list[Reason | None] = []
    for craft_id in wanted:
        context = given.contexts.get(craft_id, Context())
        ordered = CraftOrdered(
            given.author.name,
            command,
            context.objections,
            context.start,
            context.on_ground,
            context.altitude_amsl_m,
            context.foretold,
        )
        refused.append(now.to_craft(craft_id, ordered))
    return None if None in refused else refused[0]


def crafts_meant(state: MissionState, command: ForCraft, joining: Collection[str] = ()) -> tuple[str, ...]:
    """The ids of the craft that a command is for; none when it names one that the mission has not, or none of several.
    joining: craft that may be started for it."""
    if command.craft_id is not None:
        known_or_joins = command.craft_id in state.crafts or command.craft_id in joining
        return (command.craft_id,) if known_or_joins else ()
    engaged = tuple(craft.craft_id for craft in state.engaged)
    if isinstance(command, FOR_ALL) and engaged:
        return engaged
    known = engaged or tuple(state.crafts)
    return known if len(known) == 1 else ()


def open_alert_ids(state: MissionState) -> frozenset[str]:
    """Of the search and of all craft: those raised and not cleared, acknowledged or not."""
    owners = (state.search, *state.crafts.values())
    return frozenset(raised.alert_id for owner in owners for raised in owner.open_alerts)
