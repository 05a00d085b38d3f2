"""A mission at one moment: its search, and the craft that fly for it, folded side by side from the same facts.

`evolve` is the only place that derives state from a fact; the machines change state by recording facts, so a journal
read back after a crash gives the state that was running.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace

from backend.craft.state import CraftState
from backend.craft.state import evolve as evolve_craft
from backend.events import (
    FIRST_CRAFT,
    CommandAccepted,
    CommandRefused,
    ControlAsked,
    ControlChanged,
    ControlKept,
    Event,
    MissionPhase,
    MissionStarted,
    Outcome,
    Phase,
    Recorded,
)
from backend.mission.control import Control
from backend.mission.control import evolve as evolve_control
from backend.reasons import Reason
from backend.search.state import SearchState
from backend.search.state import evolve as evolve_search


@dataclass(frozen=True, slots=True)
class Answer:
    """reason: why the command was refused, None when it was accepted. command: its kind. order: its digest, None where
    nobody kept it."""

    accepted: bool
    reason: Reason | None
    command: str
    order: str | None = None


@dataclass(frozen=True, slots=True)
class MissionState:
    """crafts: by id; none flies for a search on foot. answered: the first answer to every command id.
    control: who may steer the search, where there are accounts."""

    search: SearchState = field(default_factory=SearchState)
    crafts: Mapping[str, CraftState] = field(default_factory=lambda: {FIRST_CRAFT: CraftState(FIRST_CRAFT)})
    answered: Mapping[str, Answer] = field(default_factory=dict[str, Answer])
    control: Control = field(default_factory=Control)

    @property
    def craft(self) -> CraftState:
        """Of a mission with one."""
        (only,) = self.crafts.values()
        return only

    @property
    def engaged(self) -> tuple[CraftState, ...]:
        """The craft that fly for the mission, on their way home too."""
        return tuple(craft for craft in self.crafts.values() if craft.engaged)

    @property
    def phase(self) -> MissionPhase:
        """What a craft does as long as one is engaged, else the stage of the search."""
        search = self.search
        engaged: list[Phase] = [craft.phase for craft in self.engaged]
        return phase_of(search.outcome, search.started_at_s is not None, search.passed, engaged)


def phase_of(outcome: Outcome | None, started: bool, passed: bool, engaged: Iterable[Phase]) -> MissionPhase:
    """engaged: the phases of the craft that fly for the mission. passed: its last preflight was."""
    match outcome:
        case "localized" | "not_localized":
            return "done"
        case "aborted" | "failed":
            return outcome
        case None:
            for phase in engaged:
                if phase != "ground":
                    return phase
            return "searching" if started else "ready" if passed else "draft"


def evolve(state: MissionState, event: Event, at_s: float) -> MissionState:
    """The state after one fact. `at_s`: UTC epoch seconds of the fact."""
    crafts = {name: evolve_craft(craft, event) for name, craft in state.crafts.items()}
    match event:
        case MissionStarted(craft_id=craft_id) if craft_id not in crafts:
            crafts[craft_id] = evolve_craft(newcomer(state, craft_id), event)
        case CommandAccepted(command_id=command_id, command=command, order=order):
            return replace(state, answered={**state.answered, command_id: Answer(True, None, command, order)})
        case CommandRefused(command_id=command_id, reason=reason, command=command, order=order):
            return replace(state, answered={**state.answered, command_id: Answer(False, reason, command, order)})
        case ControlChanged() | ControlAsked() | ControlKept():
            return replace(state, control=evolve_control(state.control, event, at_s))
        case _:
            pass
    return replace(state, search=evolve_search(state.search, event, at_s), crafts=crafts)


def newcomer(state: MissionState, craft_id: str) -> CraftState:
    """A craft that joins later, with what the specification says."""
    spec = state.search.mission
    return CraftState(craft_id, automatic=spec.flight.automatic, maximum_retakes=spec.sensor.maximum_retakes)


def fold(recorded: Iterable[Recorded]) -> MissionState:
    """The state after a whole journal, in sequence order."""
    return fold_on(MissionState(), recorded)


def fold_on(state: MissionState, recorded: Iterable[Recorded]) -> MissionState:
    """The state after facts that follow on those it was folded from."""
    for fact in recorded:
        state = evolve(state, fact.event, fact.at_utc.timestamp())
    return state
