"""A server inside this process: bound, opened, told when it answers. Shared by `serve` and `demo`."""

from __future__ import annotations

import asyncio
import signal
import socket
from collections.abc import AsyncGenerator, Callable, Generator, Sequence
from contextlib import asynccontextmanager, contextmanager, nullcontext
from dataclasses import dataclass
from types import FrameType

import uvicorn

from backend.api.services import Services
from backend.first_hold import FirstHold
from backend.main import create_app, server_config
from backend.mission.flights import LeftFlying
from backend.settings import Settings
from backend.simulation.emitters import SimulatedEmitter
from backend.simulation.receiver import EmittersAroundHome
from backend.wiring import open_simulation


class CannotServe(RuntimeError):
    """The server cannot start; the message says why and what to try."""


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


WAITING_TO_ENTER = 2048
"""Connections that the system keeps until they are let in: the event loop takes those of a crowd a few at a time."""


class _Server(uvicorn.Server):
    """Says when it answers. Leaves signals to `stop_on_signals`: uvicorn would raise them again once it has stopped,
    and end the process before the vehicle and the journal are closed."""

    def __init__(self, config: uvicorn.Config) -> None:
        super().__init__(config)
        self.ready = asyncio.Event()

    @contextmanager
    def capture_signals(self) -> Generator[None]:
        yield

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        await super().startup(sockets)
        for bound in sockets or ():
            bound.listen(WAITING_TO_ENTER)
        self.ready.set()


@asynccontextmanager
async def running_server(
    settings: Settings,
    leave_flying: bool = False,
    emitters: Sequence[SimulatedEmitter] | None = None,
    first: FirstHold | None = None,
) -> AsyncGenerator[RunningServer]:
    """Answers inside the block, is down after it. Raises CannotServe, DatabaseUnusable, HardwareError.

    emitters: what transmits in the simulated world, None: what the settings name. first: the vehicle that was found in
    flight and held already.
    """
    bound = _bind(settings.host, settings.port)
    try:
        async with open_simulation(settings, leave_flying, emitters, first) as (services, receiver):
            app = create_app(settings, lambda _: nullcontext(services))
            server = _Server(server_config(settings, app))
            gone = asyncio.create_task(server.serve(sockets=[bound]))
            ready = asyncio.create_task(server.ready.wait())
            await asyncio.wait({gone, ready}, return_when=asyncio.FIRST_COMPLETED)
            ready.cancel()
            if gone.done():
                raise CannotServe("the server stopped while it started")
            host = f"[{settings.host}]" if ":" in settings.host else settings.host
            shown = "127.0.0.1" if host in ("0.0.0.0", "[::]") else host
            running = RunningServer(f"http://{shown}:{bound.getsockname()[1]}", services, receiver, server, gone)
            try:
                yield running
            finally:
                running.stop()
                await asyncio.gather(gone, return_exceptions=True)
    finally:
        bound.close()


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


def _bind(host: str, port: int) -> socket.socket:
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    bound = socket.socket(family, socket.SOCK_STREAM)
    bound.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        bound.bind((host, port))
    except OSError as error:
        bound.close()
        raise CannotServe(
            f"cannot listen on {host} port {port}: {error.strerror}; choose another with "
            f"{'--host' if isinstance(error, socket.gaierror) else '--port'}"
        ) from error
    bound.set_inheritable(False)
    return bound
