"""A console without a browser: REST for commands, the websocket for what happens; and the simulated pilot."""

from __future__ import annotations

import asyncio
import json
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any
from uuid import uuid4

import httpx
import websockets

from hardware.sim.autopilot.launch import SimulatedAutopilot, find_simulated

Event = dict[str, Any]


class Console:
    """What one websocket told, in order, by type; `events` are the recorded ones with their numbers."""

    def __init__(self, url: str, client: httpx.AsyncClient) -> None:
        self.url = url
        self.client = client
        self.mission_id = ""
        self.events: list[Event] = []
        self.messages: dict[str, list[Event]] = {}
        self.frames: list[bytes] = []
        self._news = asyncio.Event()
        self._watching: asyncio.Task[None] | None = None

    async def draft(self, **changes: Any) -> str:
        """The suggested mission; `changes`: parts of the specification; an object is merged into its part."""
        spec = (await self.client.get("/api/defaults")).json()["spec"]
        for part, values in changes.items():
            spec[part] = spec[part] | values if isinstance(values, dict) else values
        answer = await self.client.post("/api/missions", json=spec)
        assert answer.status_code == 201, answer.text
        self.mission_id = answer.json()["mission_id"]
        return self.mission_id

    async def ready(self, wall_s: float = 30.0) -> None:
        """Preflight passes (a vehicle that was just switched on needs some seconds)."""
        checked: Event = {}
        async with asyncio.timeout(wall_s):
            while not checked.get("passed"):
                checked = (await self.client.post(f"/api/missions/{self.mission_id}/preflight")).json()
                await asyncio.sleep(0.2)

    async def order(self, kind: str, **content: Any) -> Event:
        body = {"command_id": str(uuid4()), "command": {"kind": kind, **content}}
        answer = await self.client.post(f"/api/missions/{self.mission_id}/commands", json=body)
        assert answer.status_code == 200, answer.text
        return answer.json()

    async def start(self, wall_s: float = 30.0) -> list[Event]:
        """Order it until it is accepted, as a person would; the reasons why it was refused before."""
        refused: list[Event] = []
        try:
            async with asyncio.timeout(wall_s):
                while not (answer := await self.order("start"))["accepted"]:
                    refused.append(answer["reason"])
                    await asyncio.sleep(0.3)
        except TimeoutError:
            raise AssertionError(f"the start was refused: {refused}") from None
        return refused

    async def watch(self) -> None:
        """Open the websocket and keep what it says."""
        address = f"{self.url.replace('http', 'ws', 1)}/api/live?mission={self.mission_id}&after=0"
        socket = await websockets.connect(address, max_size=None)
        self._watching = asyncio.create_task(self._read(socket))

    async def _read(self, socket: websockets.ClientConnection) -> None:
        async with socket:
            async for message in socket:
                if isinstance(message, bytes):
                    self.frames.append(message)
                else:
                    told = json.loads(message)
                    self.messages.setdefault(told["type"], []).append(told)
                    if told["type"] == "event":
                        self.events.append(told["recorded"])
                self._news.set()

    @property
    def cut_off(self) -> bool:
        """The websocket has ended."""
        return self._watching is not None and self._watching.done()

    async def until(self, happened: Callable[[], bool], wall_s: float = 60.0) -> None:
        try:
            async with asyncio.timeout(wall_s):
                while not happened():
                    self._news.clear()
                    await self._news.wait()
        except TimeoutError:
            raise AssertionError(f"it did not happen in time; so far:\n{self.story()}") from None

    async def until_phase(self, phase: str, wall_s: float = 60.0) -> None:
        """It is in this phase, or was since this call: a busy machine tells several at once."""
        known = len(self.phases)
        await self.until(lambda: self.phases[-1:] == [phase] or phase in self.phases[known:], wall_s)

    async def until_event(self, kind: str, count: int = 1, wall_s: float = 60.0) -> Event:
        await self.until(lambda: len(self.of(kind)) >= count, wall_s)
        return self.of(kind)[count - 1]["event"]

    def of(self, kind: str) -> list[Event]:
        return [e for e in self.events if e["event"]["kind"] == kind]

    @property
    def phases(self) -> list[str]:
        """Of the craft."""
        return [e["event"]["after"] for e in self.of("phase_changed")]

    def story(self) -> str:
        """What happened so far, a line an event: for a test that failed."""
        return "\n".join(f"{e['at_utc']} {e['event']}"[:300] for e in self.events)

    async def close(self) -> None:
        if self._watching is not None:
            self._watching.cancel()
            await asyncio.gather(self._watching, return_exceptions=True)


@asynccontextmanager
async def console(url: str) -> AsyncIterator[Console]:
    # the server closes what was idle for 5 s: an order sent just then is lost with its connection
    async with httpx.AsyncClient(base_url=url, timeout=60.0, limits=httpx.Limits(keepalive_expiry=2.0)) as client:
        made = Console(url, client)
        try:
            yield made
        finally:
            await made.close()


async def simulated_vehicle(data_dir: Path) -> SimulatedAutopilot:
    """The one that the server on this data directory flies, to order its pilot and its faults."""
    kept = json.loads((data_dir / "simulated_vehicle.json").read_text())
    async with asyncio.timeout(20):  # on a busy machine it does not answer each question in half a second
        while (found := await find_simulated(kept["connect_port"], kept["control_port"])) is None:  # noqa: ASYNC110 (another process)
            await asyncio.sleep(0.1)
    return found
