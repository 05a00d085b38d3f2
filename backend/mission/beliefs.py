"""Folds bearings into beliefs beside everything else: one emitter at a time each, the newest request wins."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable

from backend.events import BeliefUpdated
from backend.search.inputs import BeliefFailed, BeliefReady
from backend.search.state import SearchState
from backend.search.task import SearchTask
from planner.belief.grid import GridBelief

log = logging.getLogger("crossfix.mission")


class Beliefs:
    """give: takes a finished belief, or that there is none."""

    def __init__(self, task: SearchTask, give: Callable[[BeliefReady | BeliefFailed], object]) -> None:
        self._task = task
        self._give = give
        self._running: dict[str, asyncio.Task[None]] = {}
        self._newest: dict[str, GridBelief] = {}

    def adopt(self, task: SearchTask) -> None:
        """What was believed in the old area is no belief of the new one."""
        self._task = task
        self._newest.clear()

    def update(self, search: SearchState, emitter_id: str) -> None:
        """Begins to fold an emitter's bearings; an older request about it is dropped. Returns at once."""
        running = self._running.pop(emitter_id, None)
        if running is not None:
            running.cancel()
        self._running[emitter_id] = asyncio.create_task(self._fold(search, emitter_id))

    async def _fold(self, search: SearchState, emitter_id: str) -> None:
        try:
            fact, belief = await asyncio.to_thread(self._folded, search, emitter_id)
        except Exception:
            log.exception("the belief about %s cannot be computed", emitter_id)
            self._give(BeliefFailed(search.behind(emitter_id), emitter_id))
            return
        self._newest[emitter_id] = belief
        self._give(BeliefReady(search.behind(emitter_id), fact))

    def _folded(self, search: SearchState, emitter_id: str) -> tuple[BeliefUpdated, GridBelief]:
        return self._task.together.about(search, emitter_id).belief_fact(search.emitters[emitter_id].bearings)

    def newest(self, emitter_id: str) -> tuple[GridBelief, list[tuple[float, float]]] | None:
        """The last belief computed, and its corners (lon, lat): SW, SE, NE, NW."""
        belief = self._newest.get(emitter_id)
        if belief is None:
            return None
        return belief, self._task.emitters[emitter_id].corners_lon_lat(belief)

    async def close(self) -> None:
        """What is being folded is given to nobody any more."""
        tasks = list(self._running.values())
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)
