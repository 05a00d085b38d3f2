"""Where a craft turns next, by all that its search knows. Synchronous and pure; call in a thread."""

from __future__ import annotations

from collections.abc import Sequence

from shapely.geometry.base import BaseGeometry

from backend.events import FIRST_CRAFT, PlanChosen
from backend.search.importance import come_first
from backend.search.localization import Localization
from backend.search.planning import next_place, next_place_together
from backend.search.state import SearchState
from backend.search.task import SearchTask
from backend.spec import Place


def choose_place(
    task: SearchTask,
    search: SearchState,
    platform: tuple[float, float],
    place_number: int,
    now_s: float,
    threads: int,
    craft_id: str = FIRST_CRAFT,
    avoid: Sequence[Place] = (),
    closed: BaseGeometry | None = None,
) -> PlanChosen:
    """For all emitters that are not localized, the most important first; each turn listens to all of them.

    platform, closed: m ENU; closed: where the ground leaves no room. now_s: UTC epoch seconds. Raises PlannerError when
    no place is allowed or reachable.
    """
    sought = search.sought
    ranks = {emitter.emitter_id: search.rank(emitter.emitter_id) for emitter in sought}
    if len(sought) > 1 and task.mission.planner.method == "rollout":
        wanted = [(_about(task, search, one.emitter_id, now_s).without(closed), one.bearings) for one in sought]
        choice = next_place_together(wanted, platform, place_number, avoid, threads, craft_id, list(ranks.values()))
    else:
        emitter = next(iter(sought))
        about, bearings = _about(task, search, emitter.emitter_id, now_s).without(closed), emitter.bearings
        belief = about.planning_belief(about.planner_bearings(bearings))
        choice = next_place(about, belief, bearings, platform, place_number, avoid, threads, craft_id)
    return choice.model_copy(update={"first": come_first(ranks), "set_back": search.set_back})


def _about(task: SearchTask, search: SearchState, emitter_id: str, now_s: float) -> Localization:
    """Of an emitter as things stand now, with the turn that is made for what is still looked for."""
    sought = [emitter.emitter_id for emitter in search.sought]
    return task.together.about(search, emitter_id).turning_for(sought).asked(now_s)
