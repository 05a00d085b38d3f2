"""Another search area in flight: its task, what stands against it, what to expect of it. Heavy: call it in a thread."""

from __future__ import annotations

from dataclasses import dataclass

from backend.events import BeliefUpdated, PlanChosen
from backend.mission.errors import MissionInputError
from backend.mission.localization import Localization, localization
from backend.mission.planning import lay_out_ways, next_place
from backend.mission.safety import Situation, Veto, staying_vetoes
from backend.mission.state import MissionState
from backend.spec import SearchArea
from hardware.readings import GeoPoint
from planner.types import PlannerError


@dataclass(frozen=True, slots=True)
class Outlook:
    """What the bearings so far would say there, and the next place. vetoes: what forbids the change, where the vehicle
    is now. plan None: `no_plan` says why."""

    vetoes: tuple[Veto, ...]
    belief: BeliefUpdated
    plan: PlanChosen | None
    no_plan: str


def task_elsewhere(state: MissionState, search: SearchArea) -> Localization:
    """The flown mission's task in another area, from the same home.

    Raises MissionInputError when it makes no sense there, ValueError when the mission has not started.
    """
    if state.home is None:
        raise ValueError("a mission that has not started has no home to search from")
    task = localization(state.mission.searching(search), state.home, state.home_amsl_m)
    lay_out_ways(task)
    return task


def task_or_veto(state: MissionState, search: SearchArea) -> Localization | Veto:
    try:
        return task_elsewhere(state, search)
    except MissionInputError as error:
        return Veto("area", str(error), error.remedy)


def outlook(state: MissionState, search: SearchArea, situation: Situation, threads: int) -> Outlook:
    """Raises as `task_elsewhere`."""
    task = task_elsewhere(state, search)
    belief, grid = task.belief_fact(state.bearings)
    vetoes, position = staying_vetoes(task.limits, situation), situation.telemetry.position
    if belief.localized:
        return Outlook(vetoes, belief, None, "localized")
    platform = (0.0, 0.0) if position is None else task.frame.to_enu(GeoPoint(position.lat_deg, position.lon_deg))
    try:
        plan = next_place(task, grid, state.bearings, platform, state.place_number + 1, (), threads)
    except PlannerError as error:
        return Outlook(vetoes, belief, None, str(error))
    return Outlook(vetoes, belief, plan, "")
