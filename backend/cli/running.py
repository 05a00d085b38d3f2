"""A server inside this process: bound, opened, told when it answers. Shared by `serve` and `demo`."""

from __future__ import annotations

import asyncio
import signal
from collections.abc import AsyncGenerator, Callable, Sequence
from contextlib import asynccontextmanager, nullcontext
from dataclasses import dataclass
from types import FrameType

import uvicorn

from backend.api.services import Services
from backend.first_hold import FirstHold
from backend.front import OpenedFront, opened_front
from backend.main import create_app
from backend.mission.flights import LeftFlying
from backend.settings import Settings
from backend.simulation.emitters import SimulatedEmitter
from backend.simulation.receiver import EmittersAroundHome
from backend.wiring import open_simulation


@dataclass(frozen=True, slots=True)
class RunningServer:
    """url: of the page, without a trailing slash. receiver: the simulated one. gone: when the server has ended."""

    url: str
    services: Services
    receiver: EmittersAroundHome | None
    server: uvicorn.Server
    gone: asyncio.Task[None]

    def stop(self) -> None:
        """Returns at once; wait for `gone`."""
        self.server.should_exit = True


@asynccontextmanager
async def running_server(
    settings: Settings,
    leave_flying: bool = False,
    emitters: Sequence[SimulatedEmitter] | None = None,
    first: FirstHold | None = None,
    opened: OpenedFront | None = None,
) -> AsyncGenerator[RunningServer]:
    """Answers inside the block, is down after it. Raises CannotServe, DatabaseUnusable, HardwareError.

    emitters: what transmits in the simulated world, None: what the settings name. first: the vehicle that was found in
    flight and held already. opened: what answers already.
    """
    async with (
        opened_front(settings) if opened is None else nullcontext(opened) as server,
        open_simulation(settings, leave_flying, emitters, first) as (services, receiver),
    ):
        app = create_app(settings, lambda _: nullcontext(services))
        async with app.router.lifespan_context(app):
            server.front.lead_to(app)
            try:
                yield RunningServer(server.url, services, receiver, server.server, server.gone)
            finally:
                await server.end()


STOPPING = (signal.SIGINT, signal.SIGTERM)
HOLD_PATIENCE_S = 5.0
"""How long a vehicle may take to confirm its hold before the server ends without the confirmation."""


def stop_on_signals(running: RunningServer, say: Callable[[str], None]) -> None:
    """Ctrl-C and SIGTERM hold what flies by itself, say what became of it, and end the server; a second one of either
    ends it at once."""
    loop = asyncio.get_running_loop()
    leaving: list[asyncio.Task[None]] = []

    def stop() -> None:
        if leaving:
            return
        for number in STOPPING:
            signal.signal(number, signal.SIG_DFL)
        leaving.append(asyncio.create_task(_leave(running, say)))

    def heard(number: int, _frame: FrameType | None) -> None:
        if loop.is_closed():
            signal.signal(number, signal.SIG_DFL)
            signal.raise_signal(number)
        else:
            loop.call_soon_threadsafe(stop)

    for number in STOPPING:  # not loop.add_signal_handler: a signal is lost to it while the loop's wakeup pipe is full
        signal.signal(number, heard)


async def _leave(running: RunningServer, say: Callable[[str], None]) -> None:
    try:
        for left in await running.services.missions.flights.leave(HOLD_PATIENCE_S):
            say(f"{left.craft_id}: {_left_words(left)}")
    finally:
        running.stop()


def _left_words(left: LeftFlying) -> str:
    if not left.confirmed:
        return (
            "what it was ordered is NOT confirmed. The link is closed: its autopilot's own failsafe acts. "
            "Look at the vehicle; the pilot can take over."
        )
    if left.who == "failsafe":
        return "its autopilot brings it home by itself."
    if left.who == "nobody":
        return "this server steers it no longer. Look at the vehicle."
    match left.phase:
        case "hold":
            return "held in the air. Without this server its autopilot's failsafe acts; the next one finds it in hold."
        case "returning" | "landing":
            return "on its way home; its autopilot goes on by itself."
        case "manual":
            return "the pilot flies."
        case _:
            return f"left in {left.phase}."
