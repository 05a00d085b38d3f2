"""Another search area in flight: its task, and what to expect of it. Heavy: call it in a thread."""

from __future__ import annotations

from dataclasses import dataclass

from backend.events import BeliefUpdated, PlanChosen
from backend.reasons import Reason
from backend.reasons.search import Localized
from backend.search.errors import MissionInputError
from backend.search.planning import lay_out_ways, next_place
from backend.search.state import SearchState
from backend.search.task import SearchTask, search_task
from backend.spec import Place, SearchArea
from backend.terrain import Terrain
from planner.types import PlannerError


@dataclass(frozen=True, slots=True)
class Outlook:
    """What the bearings so far would say of an emitter there, and the next place. plan None: `no_plan` says why."""

    belief: BeliefUpdated
    plan: PlanChosen | None
    no_plan: Reason | None


def task_in(state: SearchState, area: SearchArea, terrain: Terrain | None = None) -> SearchTask:
    """The flown search's task in another area, from the same home over the same ground.

    Raises MissionInputError when it makes no sense there, ValueError when the search has not started.
    """
    if state.home is None:
        raise ValueError("a mission that has not started has no home to search from")
    task = search_task(state.mission.searching(area), state.home, state.home_amsl_m, terrain)
    lay_out_ways(task.first)
    return task


def task_or_reason(state: SearchState, area: SearchArea, terrain: Terrain | None = None) -> SearchTask | Reason:
    """The reason instead of MissionInputError: it is refused like an order."""
    try:
        return task_in(state, area, terrain)
    except MissionInputError as error:
        return error.reason


def outlook(state: SearchState, task: SearchTask, platform: Place, threads: int) -> Outlook:
    """Of the most important emitter that is not localized, else the first."""
    emitter = state.sought[0] if state.wanted else next(iter(state.emitters.values()))
    localization = task.together.about(state, emitter.emitter_id)
    belief, grid = localization.belief_fact(emitter.bearings)
    if belief.localized:
        return Outlook(belief, None, Localized())
    here = task.frame.to_enu(platform)
    try:
        plan = next_place(localization, grid, emitter.bearings, here, state.place_number + 1, (), threads)
    except PlannerError as error:
        return Outlook(belief, None, error.reason)
    return Outlook(belief, plan, None)
