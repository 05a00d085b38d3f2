"""A search led from state to state by what its machine is given."""

from __future__ import annotations

from facts import (
    CHECK,
    HOME,
    SPEC,
    belief,
)

from backend import commands
from backend.events import (
    Event,
    MissionDrafted,
    MissionStarted,
)
from backend.reasons import Reason, flight
from backend.search.effects import Record, Refuse, SearchEffect
from backend.search.inputs import (
    BearingsArrived,
    BeliefReady,
    PreflightDone,
    SearchInput,
    SearchOrdered,
    SearchOver,
)
from backend.search.machine import transition
from backend.search.state import SearchState, Stage, evolve
from backend.spec import FIRST_EMITTER, MissionSpec

STARTED = MissionStarted(craft_id="craft-1", by="anna", home=HOME, home_amsl_m=100.0, software="test")


def facts_of(asked: tuple[SearchEffect, ...]) -> list[Event]:
    return [effect.event for effect in asked if isinstance(effect, Record)]


def refusal(asked: tuple[SearchEffect, ...]) -> Reason | None:
    for effect in asked:
        if isinstance(effect, Refuse):
            return effect.reason
    return None


def muting(person: str, muted: bool) -> commands.MuteSource:
    return commands.MuteSource(of="person", name=person, muted=muted)


class SearchWalk:
    def __init__(self, spec: MissionSpec = SPEC) -> None:
        self.at_s = 1_000.0
        self.recorded: list[Event] = []
        self.state = SearchState()
        self.fold(MissionDrafted(spec=spec))

    def fold(self, *facts: Event) -> None:
        for fact in facts:
            self.state = evolve(self.state, fact, self.at_s)
            self.recorded.append(fact)

    def give(self, given: SearchInput) -> tuple[SearchEffect, ...]:
        self.at_s += 1.0
        expected, asked = transition(self.state, given, self.at_s)
        self.fold(*facts_of(asked))
        assert self.state == expected, "the new state is the fold of the recorded facts"
        return asked

    def order(self, command: commands.ForSearch, **more: object) -> tuple[SearchEffect, ...]:
        return self.give(SearchOrdered("anna", command, **more))  # type: ignore[arg-type]

    def arrive(self, *facts: Event) -> tuple[SearchEffect, ...]:
        return self.give(BearingsArrived(facts))

    def believe(self, localized: bool = False, emitter_id: str = FIRST_EMITTER) -> tuple[SearchEffect, ...]:
        ids = self.state.emitters[emitter_id].bearing_ids
        return self.give(BeliefReady(ids, belief(len(ids), localized, emitter_id)))

    def to(self, stage: Stage) -> SearchWalk:
        if stage != "draft":
            self.give(PreflightDone((CHECK,)))
        if stage in ("open", "ended"):
            self.fold(STARTED)
        if stage == "ended":
            self.give(SearchOver(flight.Ordered("abort", "anna"), "aborted"))
        assert self.state.stage == stage
        return self
