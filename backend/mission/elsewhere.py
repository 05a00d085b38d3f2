"""Another search area in flight: planned, taken over, and hung around with the autopilot's own nets. One change after
the other, so that the nets that hang in the end are those of the area that is searched."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from dataclasses import dataclass, field

from backend.commands import Author, ChangeArea, CommandRequest
from backend.craft.inputs import WorkFailed
from backend.events import Event
from backend.mission.effects import Effect
from backend.mission.inputs import ToCraft
from backend.mission.nets import NetsKeeper
from backend.mission.runner import MissionRunner
from backend.search.effects import SearchElsewhere
from backend.search.other_area import task_or_reason

Running = Callable[[], MissionRunner | None]
"""The runner of the mission; None when it does not fly, or no longer."""


@dataclass(slots=True)
class Elsewhere:
    """Of all missions, of which one flies at a time."""

    nets: NetsKeeper
    _one: asyncio.Lock = field(default_factory=asyncio.Lock)

    async def change(
        self, running: Running, request: CommandRequest, command: ChangeArea, author: Author
    ) -> tuple[MissionRunner, tuple[Effect, ...]] | None:
        """What was asked of the runner, once the nets hang. None: it flies no longer."""
        async with self._one:
            runner = running()
            if runner is None:
                return None
            state, terrain = runner.state.search, runner.task.ground.terrain
            task = await asyncio.to_thread(task_or_reason, state, command.search, terrain)
            if running() is not runner:
                return None
            asked = runner.change_area(request, author, task)
            if any(isinstance(effect, SearchElsewhere) for effect in asked):
                await self._hang_nets(runner)
            return runner, asked

    async def _hang_nets(self, runner: MissionRunner) -> None:
        """When they do not hang, the autopilot refuses what lies beyond those before, and says so."""

        async def record(event: Event) -> None:
            runner.outbox.record([event])
            await runner.outbox.flushed()

        runner.nets_changing = True
        try:
            for craft_id, craft in list(runner.crafts.items()):
                trouble = await self.nets.change(craft.equipment, runner.task, record)
                if trouble is not None:
                    runner.give(ToCraft(craft_id, WorkFailed("plan", trouble, in_air=True)))
        finally:
            runner.nets_changing = False
