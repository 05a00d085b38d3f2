"""Another search area in flight: planned, taken over, and hung around with the autopilot's own nets. One change after
the other, so that the nets that hang in the end are those of the area that is searched."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable
from dataclasses import dataclass, field

from backend.commands import Author, ChangeArea, CommandRequest
from backend.craft.inputs import NetsNotTaken, NetsUp
from backend.craft.safety import staying_vetoes
from backend.events import Event
from backend.mission.effects import Effect
from backend.mission.inputs import ToCraft
from backend.mission.nets import NetsKeeper
from backend.mission.runner import MissionRunner
from backend.search.effects import SearchElsewhere
from backend.search.other_area import task_or_reason

log = logging.getLogger("crossfix.mission")

AGAIN_S = 2.0
"""Wall time: how often it is asked whether nets that do not hang yet can be hung."""

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

    async def run(self, active: Running) -> None:
        """Hangs what was left undone, by a link that failed or a server that went away meanwhile. Until cancelled."""
        while True:
            await asyncio.sleep(AGAIN_S)
            async with self._one:
                runner = active()
                if runner is not None:
                    try:
                        await self._hang_nets(runner)
                    except Exception:
                        log.exception("the nets of the search area could not be looked after; tried again")

    async def _hang_nets(self, runner: MissionRunner) -> None:
        """Of every craft that waits for them."""

        async def record(event: Event) -> None:
            runner.outbox.record([event])
            await runner.outbox.flushed()

        for craft_id, craft in list(runner.crafts.items()):
            async with self.nets.one(craft_id):
                if not runner.waits_for_nets(craft_id):
                    continue
                trouble = next(iter(staying_vetoes(craft.limits, craft.watch.situation())), None)
                if trouble is None:
                    trouble = await self.nets.change(runner.mission_id, craft.equipment, runner.task, record)
                runner.give(ToCraft(craft_id, NetsUp() if trouble is None else NetsNotTaken(trouble)))
