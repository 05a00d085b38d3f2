"""The loop that serves one viewer: stored events first, then whatever is new, at the viewer's own pace.

The belief of an event goes out before the event: who hears of it has the picture already, or knows to ask for it.

A lite viewer (a thin link) gets telemetry and the running sweep once a second only; events it gets as all others do.
"""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Awaitable, Callable, Sequence
from contextlib import suppress

from backend.live.hub import BeliefFrame, Hub, Slot, SlotKind, SlotName, Viewer, stored_event_text

Send = Callable[[str | bytes], Awaitable[None]]

EVENTS_AT_ONCE = 50
"""After this many events a look at the slots, so that telemetry lives while a long journal is caught up with."""

LITE_PERIOD_S: dict[SlotKind, float] = {"telemetry": 1.0, "sweep_progress": 1.0}
"""Least time between two values of a slot for a lite viewer, in seconds of wall time."""

SEND_S = 20.0


class ViewerStalled(Exception):
    """The viewer has taken nothing for `SEND_S`: it is let go, and may come back with its last number."""


async def serve(hub: Hub, viewer: Viewer, send: Send) -> None:
    """Runs until cancelled or until `send` raises. The viewer has joined the hub before."""
    waiting: deque[str] = deque()
    while True:
        if not waiting:
            viewer.wake.clear()
            waiting.extend(await _next_events(hub, viewer))
        patience_s = None
        for name, slot in hub.slots(viewer).items():
            missed = max(0, slot.version - viewer.seen.get(name, 0) - 1)
            if slot.version <= viewer.seen.get(name, 0) and name not in viewer.withheld:
                continue
            viewer.seen[name] = slot.version
            viewer.withheld.discard(name)
            early_s = _too_early_s(viewer, name, slot)
            if early_s > 0:
                viewer.withheld.add(name)
                patience_s = min(early_s, patience_s or early_s)
            elif slot.value is not None:
                viewer.sent_at[name] = asyncio.get_running_loop().time()
                await _send(viewer, send, _content(viewer, name, slot.value, missed))
        for _ in range(min(EVENTS_AT_ONCE, len(waiting))):
            await _send(viewer, send, waiting.popleft())
            viewer.cursor += 1
        if not waiting:
            await _woken(viewer, patience_s)


def _too_early_s(viewer: Viewer, name: SlotName, slot: Slot) -> float:
    """How long a lite viewer's next value must still wait."""
    if not viewer.lite or name[0] not in LITE_PERIOD_S or name not in viewer.sent_at or slot.value is None:
        return 0.0
    return viewer.sent_at[name] + LITE_PERIOD_S[name[0]] - asyncio.get_running_loop().time()


async def _woken(viewer: Viewer, patience_s: float | None) -> None:
    """Returns when something is new, or when a value that had to wait is due."""
    with suppress(TimeoutError):
        async with asyncio.timeout(patience_s):
            await viewer.wake.wait()


async def _next_events(hub: Hub, viewer: Viewer) -> Sequence[str]:
    """The events right after the cursor, from the ring or, when it does not reach back so far, the journal."""
    if viewer.mission_id is None:
        return []
    texts = hub.feed(viewer.mission_id).after(viewer.cursor)
    if texts is not None:
        return texts
    return [stored_event_text(told) for told in await hub.read(viewer.mission_id, viewer.cursor)]


def _content(viewer: Viewer, name: SlotName, value: str | BeliefFrame, missed: int) -> str | bytes:
    if isinstance(value, BeliefFrame):
        return value.encoded(viewer.lite)
    if name[0] == "telemetry":
        viewer.dropped += missed
        # `dropped` is the message's last field, the only one that differs between viewers
        return f"{value.removesuffix('0}')}{viewer.dropped}}}"
    return value


async def _send(viewer: Viewer, send: Send, content: str | bytes) -> None:
    viewer.sending_since = asyncio.get_running_loop().time()
    try:
        async with asyncio.timeout(SEND_S):
            await send(content)
    except TimeoutError as error:
        raise ViewerStalled from error
    finally:
        viewer.sending_since = None
