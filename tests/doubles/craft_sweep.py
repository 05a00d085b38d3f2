"""The craft machine swept: one state of each kind that can be reached, and what each does with every input.

A million steps, made once a process. A rule that speaks of one kind of input asks for the steps of that kind.
"""

from __future__ import annotations

import gc
from collections import defaultdict, deque
from collections.abc import Iterator
from functools import cache
from itertools import chain
from typing import NamedTuple

from craft_inputs import every_craft_input
from craft_walk import CraftWalk, refusal
from facts import SPEC, WAITING_SPEC

from backend import commands
from backend.craft import effects, inputs
from backend.craft.effects import CraftEffect
from backend.craft.machine import transition
from backend.craft.state import HOMEWARD, CraftState
from backend.craft.who_flies import kept_of
from backend.search.effects import Record
from backend.search.inputs import SearchOver
from backend.search.machine import transition as transition_search
from backend.search.state import SearchState
from backend.search.state import evolve as evolve_search


class Step(NamedTuple):
    """`given` to a craft beside a search: what becomes of the craft, and what it asks for."""

    craft: CraftState
    search: SearchState
    given: inputs.CraftInput
    after: CraftState
    asked: tuple[CraftEffect, ...]

    @property
    def command(self) -> commands.ForCraft | None:
        return self.given.command if isinstance(self.given, inputs.CraftOrdered) else None

    @property
    def carried_out(self) -> bool:
        return self.command is not None and refusal(self.asked) is None

    @property
    def about(self) -> str:
        return f"{self.given} in {self.craft.phase}, {self.craft.authority.who}, {self.search.stage}"


def stepped(craft: CraftState, search: SearchState, given: inputs.CraftInput) -> Step:
    """At the time of all steps of the sweep."""
    after, asked = transition(craft, search, given, 2_000.0)
    return Step(craft, search, given, after, asked)


def _search_after(step: Step) -> SearchState:
    """The search folded on, and over when the machine says so."""
    search = step.search
    for effect in step.asked:
        if isinstance(effect, Record):
            search = evolve_search(search, effect.event, 2_000.0)
        elif isinstance(effect, effects.LeaveSearch):
            search, _ = transition_search(search, SearchOver(effect.because, effect.outcome), 2_000.0)
    return search


def _key_of(craft: CraftState, search: SearchState) -> tuple[object, ...]:
    """What of a state matters for what may be sent."""
    ladder = craft.ladder
    return (
        craft.phase,
        kept_of(craft.authority),
        search.stage,
        search.localized,
        search.beliefs_current,
        craft.engaged,
        craft.searching,
        craft.took_off,
        craft.automatic,
        craft.counting_down,
        craft.countdown_stopped,
        craft.chosen is None,
        craft.reached,
        craft.taken_from in HOMEWARD,
        "vehicle" in craft.links_down,
        ladder and (ladder.way, ladder.stage),
    )


@cache
def _swept() -> tuple[tuple[tuple[CraftState, SearchState], ...], dict[type[inputs.CraftInput], list[Step]]]:
    """As `reachable` and `steps` have them; the steps by the type of their input."""
    found: dict[tuple[object, ...], tuple[CraftState, SearchState]] = {}
    ahead: deque[tuple[CraftState, SearchState]] = deque()
    taken: defaultdict[type[inputs.CraftInput], list[Step]] = defaultdict(list)

    def reach(craft: CraftState, search: SearchState) -> None:
        key = _key_of(craft, search)
        if key not in found:
            found[key] = (craft, search)
            ahead.append((craft, search))

    for spec in (SPEC, WAITING_SPEC):
        walk = CraftWalk(spec)
        reach(walk.craft, walk.search)
    gc.disable()  # all of it is kept, and the collector would walk through it over and over
    while ahead:
        craft, search = ahead.popleft()
        for given in every_craft_input(craft, search):
            step = stepped(craft, search, given)
            taken[type(given)].append(step)
            known_search = _search_after(step)
            if step.after is not craft or known_search is not search:
                reach(step.after, known_search)
        for localized in (False, True):
            known = CraftWalk()
            known.craft, known.search = craft, search
            known.believe(localized)
            reach(known.craft, known.search)
    gc.freeze()
    gc.enable()
    return tuple(found.values()), dict(taken)


def reachable() -> tuple[tuple[CraftState, SearchState], ...]:
    """One state of each kind that is reached from the ground by inputs and by what the search learns meanwhile."""
    return _swept()[0]


def steps(*kinds: type[inputs.CraftInput]) -> Iterator[Step]:
    """What each of these states does with every input of these kinds, of all kinds if none is named. Raises KeyError
    for a kind that the sweep does not give."""
    taken = _swept()[1]
    return chain.from_iterable(taken[kind] for kind in kinds or taken)
