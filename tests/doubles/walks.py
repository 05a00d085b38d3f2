"""A mission machine driven by inputs, with everything it recorded and asked for."""

from __future__ import annotations

from collections.abc import Iterable
from datetime import UTC, datetime
from typing import TypeVar

from craft_walk import VEHICLE
from facts import CHECK, HOME, NO_TAKE_OFF, OURS, PILOT, SPEC, START, WAITING_SPEC, belief, plan

from backend import commands
from backend.craft import inputs as craft_inputs
from backend.craft.state import CraftState
from backend.events import FIRST_CRAFT, AlertRaised, Event, MissionDrafted, Recorded
from backend.mission.effects import Effect, OfCraft, Reply
from backend.mission.inputs import Commanded, Context, Input, ToCraft
from backend.mission.machine import transition
from backend.mission.state import MissionState, evolve
from backend.reasons import Reason
from backend.search.effects import Record
from backend.search.inputs import BeliefReady, PreflightDone
from backend.search.state import SearchState
from backend.spec import FIRST_EMITTER, MissionSpec

OneFact = TypeVar("OneFact", bound=Event)

NO_CONTEXT = Context()


def of_craft(asked: tuple[Effect, ...], craft_id: str = FIRST_CRAFT) -> list[object]:
    """What is asked of a craft, but for facts."""
    return [effect.effect for effect in asked if isinstance(effect, OfCraft) and effect.craft_id == craft_id]


def sent(asked: tuple[Effect, ...], craft_id: str = FIRST_CRAFT) -> list[object]:
    return [effect for effect in of_craft(asked, craft_id) if isinstance(effect, VEHICLE)]


def answer(asked: tuple[Effect, ...]) -> Reply:
    (reply,) = [effect for effect in asked if isinstance(effect, Reply)]
    return reply


def refusal(asked: tuple[Effect, ...]) -> Reason | None:
    return answer(asked).reason


def commanded(
    command: commands.Command, command_id: str, context: Context = NO_CONTEXT, craft_id: str = FIRST_CRAFT
) -> Commanded:
    """context: of the craft, or of the search when the command is for that."""
    if isinstance(command, commands.ForSearch | commands.ForControl):
        return Commanded(command_id, commands.Author("anna"), command, search=context)
    if isinstance(command, commands.Start) and context.start is None:
        context = Context(context.objections, START)
    return Commanded(command_id, commands.Author("anna"), command, {command.craft_id or craft_id: context})


def belief_ready(search: SearchState, localized: bool = False, emitter_id: str = FIRST_EMITTER) -> BeliefReady:
    ids = search.emitters[emitter_id].bearing_ids
    return BeliefReady(ids, belief(len(ids), localized, emitter_id))


class Walk:
    def __init__(self, spec: MissionSpec = SPEC) -> None:
        self.at_s = 1_000.0
        self.state = MissionState()
        self.recorded: list[Recorded] = []
        self.asked: list[Effect] = []
        self._commands = 0
        drafted = MissionDrafted(spec=spec)
        self.state = evolve(self.state, drafted, self.at_s)
        self._keep([drafted])

    @property
    def craft(self) -> CraftState:
        return self.state.craft

    @property
    def search(self) -> SearchState:
        return self.state.search

    def give(self, given: Input) -> tuple[Effect, ...]:
        self.at_s += 1.0
        self.state, asked = transition(self.state, given, self.at_s)
        self._keep([effect.event for effect in asked if isinstance(effect, Record)])
        self.asked += asked
        return asked

    def to_craft(self, given: craft_inputs.CraftInput, craft_id: str = FIRST_CRAFT) -> tuple[Effect, ...]:
        return self.give(ToCraft(craft_id, given))

    def command(
        self, command: commands.Command, context: Context = NO_CONTEXT, craft_id: str = FIRST_CRAFT
    ) -> tuple[Effect, ...]:
        self._commands += 1
        return self.give(commanded(command, f"c{self._commands}", context, craft_id))

    def believe(self, localized: bool = False, *emitter_ids: str) -> tuple[Effect, ...]:
        """The beliefs about these emitters are ready; all of them when none is named."""
        asked: tuple[Effect, ...] = ()
        for emitter_id in emitter_ids or tuple(self.search.emitters):
            asked += self.give(belief_ready(self.search, localized, emitter_id))
        return asked

    def start(self, craft_id: str = FIRST_CRAFT) -> Walk:
        """In the air, and the next place is sought."""
        self.command(commands.Start(craft_id=craft_id))
        self.to_craft(craft_inputs.AuthorityHeard(OURS), craft_id)
        self.to_craft(craft_inputs.InTheAir(HOME, 40.0), craft_id)
        return self

    def fly(self, craft_id: str = FIRST_CRAFT) -> Walk:
        """To the place that the planner has chosen."""
        if not self.search.beliefs_current:
            self.believe()
        self.to_craft(craft_inputs.Planned(plan(self.search.place_number + 1, craft_id)), craft_id)
        return self

    def arrive(self, craft_id: str = FIRST_CRAFT) -> Walk:
        self.to_craft(craft_inputs.Arrived(HOME, 0.5, 20.0), craft_id)
        return self

    def to(self, phase: str) -> Walk:
        """Along the usual way to `phase`, of the mission or of its craft."""
        if phase == "draft":
            return self
        self.give(PreflightDone((CHECK,)))
        if phase == "ready":
            return self
        if phase in ("taking_off", "failed"):
            self.command(commands.Start())
            self.to_craft(craft_inputs.AuthorityHeard(OURS))
            if phase == "failed":
                self.to_craft(craft_inputs.WorkFailed("take_off", NO_TAKE_OFF, in_air=False))
            return self
        self.start()
        if phase == "planning":
            return self
        self.fly()
        if phase in ("waiting", "flying"):
            return self
        self.arrive()
        after: dict[str, tuple[object, ...]] = {
            "hold": (commands.Hold(),),
            "manual": (craft_inputs.AuthorityHeard(PILOT),),
            "returning": (commands.Return(),),
            "landing": (commands.Return(), craft_inputs.HomeReached()),
            "done": (commands.Return(), craft_inputs.HomeReached(), craft_inputs.Landed()),
            "aborted": (commands.Abort(),),
            "aborted and down": (commands.Abort(), craft_inputs.Landed()),
        }
        for step in after.get(phase, ()):
            if isinstance(step, commands.CraftCommand):
                self.command(step)  # type: ignore[arg-type]
            else:
                self.to_craft(step)  # type: ignore[arg-type]
        return self

    def _keep(self, events: Iterable[Event]) -> None:
        at = datetime.fromtimestamp(self.at_s, UTC)
        for event in events:
            self.recorded.append(Recorded(seq=len(self.recorded) + 1, mission_id="m", at_utc=at, event=event))

    def of_kind(self, kind: type[OneFact]) -> list[OneFact]:
        return [r.event for r in self.recorded if isinstance(r.event, kind)]

    @property
    def kinds(self) -> list[str]:
        return [r.event.kind for r in self.recorded]

    @property
    def topics(self) -> list[str]:
        """Of all open alerts."""
        return [alert.topic for owner in (self.search, *self.state.crafts.values()) for alert in owner.open_alerts]

    @property
    def last_alert(self) -> AlertRaised:
        return self.of_kind(AlertRaised)[-1]


PHASES = (
    "draft", "ready", "taking_off", "planning", "waiting", "flying", "measuring", "hold", "manual", "returning",
    "landing", "done", "aborted", "aborted and down", "failed",
)  # fmt: skip


def walk_in(phase: str) -> Walk:
    return Walk(WAITING_SPEC if phase == "waiting" else SPEC).to(phase)
