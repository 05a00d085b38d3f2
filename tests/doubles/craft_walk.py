"""A craft machine driven by inputs, beside a search that is folded from the same facts."""

from __future__ import annotations

from typing import TypeVar

from facts import (
    CHECK,
    HOME,
    OURS,
    PILOT,
    SPEC,
    START,
    WAITING_SPEC,
    belief,
    plan,
)

from backend import commands
from backend.commands import ForCraft
from backend.craft import effects, inputs
from backend.craft.effects import CraftEffect
from backend.craft.machine import transition
from backend.craft.state import CraftState, evolve
from backend.events import FIRST_CRAFT, AlertRaised, Event, MissionDrafted, Phase, PreflightChecked
from backend.reasons import Reason
from backend.search.effects import Record, Refuse
from backend.search.inputs import SearchOver
from backend.search.machine import transition as transition_search
from backend.search.state import SearchState
from backend.search.state import evolve as evolve_search
from backend.spec import MissionSpec

OneFact = TypeVar("OneFact", bound=Event)

MOVES = (effects.TakeOff, effects.FlyTo, effects.Measure, effects.ReturnHome, effects.Land)
"""What sends the vehicle somewhere."""
VEHICLE = (*MOVES, effects.HoldVehicle)
"""What sends anything to the vehicle."""

PHASES: tuple[Phase, ...] = (
    "ground", "taking_off", "planning", "waiting", "flying", "measuring", "hold", "manual", "returning", "landing",
)  # fmt: skip


def moves(asked: tuple[CraftEffect, ...]) -> list[CraftEffect]:
    return [effect for effect in asked if isinstance(effect, MOVES)]


def sent(asked: tuple[CraftEffect, ...]) -> list[CraftEffect]:
    return [effect for effect in asked if isinstance(effect, VEHICLE)]


def refusal(asked: tuple[CraftEffect, ...]) -> Reason | None:
    """Why an order was refused, None when it was carried out."""
    for effect in asked:
        if isinstance(effect, Refuse):
            return effect.reason
    return None


def ordered(command: ForCraft, **more: object) -> inputs.CraftOrdered:
    start = START if isinstance(command, commands.Start) else None
    return inputs.CraftOrdered("anna", command, **{"start": start, **more})  # type: ignore[arg-type]


class CraftWalk:
    """`recorded`: every fact, of the search and of the craft, in order."""

    def __init__(self, spec: MissionSpec = SPEC, craft_id: str = FIRST_CRAFT) -> None:
        self.at_s = 1_000.0
        self.craft = CraftState(craft_id)
        self.search = SearchState()
        self.recorded: list[Event] = []
        self.fold(MissionDrafted(spec=spec))

    def fold(self, *facts: Event) -> None:
        """Facts from elsewhere."""
        for fact in facts:
            self.craft = evolve(self.craft, fact)
            self.search = evolve_search(self.search, fact, self.at_s)
            self.recorded.append(fact)

    def give(self, given: inputs.CraftInput) -> tuple[CraftEffect, ...]:
        self.at_s += 1.0
        expected, asked = transition(self.craft, self.search, given, self.at_s)
        for effect in asked:
            match effect:
                case Record(event=event):
                    self.fold(event)
                case effects.LeaveSearch(because=because, outcome=outcome):
                    _, over = transition_search(self.search, SearchOver(because, outcome), self.at_s)
                    self.fold(*(found.event for found in over if isinstance(found, Record)))
                case _:
                    pass
        assert self.craft == expected, "the new state is the fold of the recorded facts"
        return asked

    def order(self, command: ForCraft, **more: object) -> tuple[CraftEffect, ...]:
        return self.give(ordered(command, **more))

    def believe(self, localized: bool = False) -> tuple[CraftEffect, ...]:
        """The beliefs about all emitters are ready."""
        for emitter in self.search.emitters.values():
            self.fold(belief(len(emitter.bearing_ids), localized, emitter.emitter_id))
        return self.give(inputs.SearchChanged())

    def learn(self, *facts: Event) -> tuple[CraftEffect, ...]:
        """The search learns of this from elsewhere."""
        self.fold(*facts)
        return self.give(inputs.SearchChanged())

    def to(self, phase: Phase) -> CraftWalk:
        """Along the usual way to `phase`. Ours to command as soon as it is off the ground."""
        if phase == "ground":
            return self
        self.fold(PreflightChecked(passed=True, checks=[CHECK]))
        self._play(commands.Start(), inputs.AuthorityHeard(OURS))
        usual: dict[Phase, tuple[object, ...]] = {
            "planning": (inputs.InTheAir(HOME, 40.0),),
            "waiting": (inputs.Planned(plan(1)),),
            "flying": (commands.Accept(),),
            "measuring": (inputs.Arrived(HOME, 0.5, 20.0),),
        }
        for step, played in usual.items():
            if self.craft.phase == phase:
                return self
            if step == "waiting":
                self.believe()
            if self.craft.phase != step:
                self._play(*played)
        after: dict[Phase, tuple[object, ...]] = {
            "hold": (commands.Hold(),),
            "manual": (inputs.AuthorityHeard(PILOT),),
            "returning": (commands.Return(),),
            "landing": (commands.Return(), inputs.HomeReached()),
        }
        self._play(*after.get(phase, ()))
        if self.craft.phase != phase:
            raise AssertionError(f"the usual way ended in {self.craft.phase}, not {phase}")
        return self

    def _play(self, *steps: object) -> None:
        for step in steps:
            if isinstance(step, commands.CraftCommand):
                self.order(step)  # type: ignore[arg-type]
            else:
                self.give(step)  # type: ignore[arg-type]

    def of_kind(self, kind: type[OneFact]) -> list[OneFact]:
        return [fact for fact in self.recorded if isinstance(fact, kind)]

    @property
    def kinds(self) -> list[str]:
        return [fact.kind for fact in self.recorded]

    @property
    def topics(self) -> list[str]:
        """Of the craft's open alerts."""
        return [alert.topic for alert in self.craft.open_alerts]

    @property
    def last_alert(self) -> AlertRaised:
        return self.of_kind(AlertRaised)[-1]


def craft_in(phase: Phase) -> CraftWalk:
    return CraftWalk(WAITING_SPEC if phase == "waiting" else SPEC).to(phase)
