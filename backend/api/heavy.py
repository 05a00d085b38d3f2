"""Work on a whole mission that takes long: a short one in a thread, a long one in a process of its own, so that the
event loop answers an abort meanwhile (a thread shares the interpreter with it)."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import ParamSpec, TypeVar

from backend.api.problems import ApiProblem
from backend.api.services import Services
from backend.reasons.work import FileTooHeavy, MissionTooHeavy
from backend.workers import WorkersBusy, WorkStopped

P = ParamSpec("P")
T = TypeVar("T")

LONG_FACTS = 500
"""A mission of some hundred bearings. Below, handing it over costs more than the work."""


async def apart(services: Services, facts: int, work: Callable[P, T], *args: P.args, **kwargs: P.kwargs) -> T:
    """The result of `work`, a function of a module that asks nobody. facts: how many it works on. Raises ApiProblem."""
    if facts < LONG_FACTS:
        async with services.beside:
            return await asyncio.to_thread(work, *args, **kwargs)
    try:
        return await services.desk.run(work, *args, **kwargs)
    except WorkStopped as error:
        stopped = error.reason
        assert isinstance(stopped, FileTooHeavy)
        raise ApiProblem(503, MissionTooHeavy(stopped.limit, stopped.most_s, stopped.most_bytes)) from error
    except WorkersBusy as error:
        desk = services.desk
        raise ApiProblem(503, MissionTooHeavy("busy", desk.time_s, desk.memory_bytes)) from error
