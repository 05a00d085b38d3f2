"""Work on facts beside the event loop where they are many, so that an abort is answered meanwhile."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import ParamSpec, TypeVar

P = ParamSpec("P")
T = TypeVar("T")

MANY = 64
"""Facts: fewer take less time than handing the work to a thread and back."""


async def beside(count: int, work: Callable[P, T], *args: P.args, **named: P.kwargs) -> T:
    """The result of `work`, which takes long for a large count: of a thread then, and at once for a small one."""
    if count < MANY:
        return work(*args, **named)
    return await asyncio.to_thread(work, *args, **named)
