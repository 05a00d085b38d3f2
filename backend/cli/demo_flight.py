"""One mission flown as a browser would fly it: drafted and started by REST, watched on the websocket to its end."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Mapping
from typing import Any
from uuid import uuid4

import httpx
import websockets
from pydantic import TypeAdapter

from backend.cli.demo_grade import MissionLog
from backend.cli.edge import remark
from backend.cli.progress import progress_line
from backend.cli.running import RunningServer
from backend.commands import CommandReply
from backend.craft.reconnecting_vehicle import ReconnectingVehicle
from backend.events import PhaseChanged, PreflightChecked, Recorded
from backend.mission.state import MissionState, evolve
from backend.settings import Settings
from backend.wire.health import Health
from backend.wire.messages import TelemetryMessage
from backend.wire.problem import Problem
from planner.reason import sentence_of, text_of

LONGEST_MISSION_S = 3_600.0
START_WALL_S = 120.0
"""The longest that an answer may take: a start sends the fence over the link and reads it back, corner by corner."""
PATIENCE_WALL_S = 60.0
MOST_HOLDS = 5


class DemoFailed(RuntimeError):
    """The mission was not flown to an end; the message says why."""


async def fly(
    running: RunningServer, settings: Settings, mend: bool = False, changes: Mapping[str, Any] | None = None
) -> MissionLog:
    """Draft and start the suggested mission by REST, then watch the websocket to its end. Raises DemoFailed.

    changes: parts of the specification; an object is merged into the part it changes.
    """
    async with httpx.AsyncClient(base_url=running.url, timeout=START_WALL_S) as client:
        await _vehicles_there(client)
        if mend:
            await _mend_failsafes(running)
        spec = _answer(await client.get("/api/defaults"))["spec"] | {"name": f"Demo, seed {settings.seed}"}
        spec["planner"] = spec["planner"] | {"seed": settings.seed}
        for part, wanted in (changes or {}).items():
            spec[part] = spec[part] | wanted if isinstance(wanted, dict) else wanted
        mission_id = _answer(await client.post("/api/missions", json=spec))["mission_id"]
        await _preflight_passed(client, mission_id)
        log = MissionLog(mission_id)
        reply = await _command(client, mission_id, "start")
        if reply.reason is not None:
            raise DemoFailed(f"the start was refused: {sentence_of(reply.reason)}")
        address = running.url.replace("http", "ws", 1) + f"/api/live?mission={mission_id}&after=0"
        # not before the start: a socket that nobody reads is cut off after 40 s, and a slow link takes as long
        async with websockets.connect(address, max_size=None) as socket:
            try:
                async with asyncio.timeout(LONGEST_MISSION_S / settings.time_factor):
                    await _watch(socket, log, client)
            except TimeoutError:
                last = log.all(PhaseChanged)[-1]
                raise DemoFailed(
                    f"the mission did not end within {LONGEST_MISSION_S / 60:.0f} minutes; it is in {last.after}: "
                    f"{text_of(last.reason)}"
                ) from None
    return log


async def _mend_failsafes(running: RunningServer) -> None:
    for craft in running.services.missions.equipment.crafts.values():
        if isinstance(craft.vehicle, ReconnectingVehicle):
            for reason in await craft.vehicle.mend_failsafes():
                remark(text_of(reason))


async def _vehicles_there(client: httpx.AsyncClient) -> None:
    """They are connected and know where they are. Raises DemoFailed."""
    wrong = "the server does not say"
    try:
        async with asyncio.timeout(PATIENCE_WALL_S):
            while True:
                health = Health.model_validate(_answer(await client.get("/api/health")))
                missing = [vehicle.reason for vehicle in health.vehicles if vehicle.reason is not None]
                if missing:
                    wrong = sentence_of(missing[0])
                else:
                    heard = [
                        _answer(await client.get("/api/vehicle", params={"craft": vehicle.craft_id}))
                        for vehicle in health.vehicles
                    ]
                    if all(TelemetryMessage.model_validate(one).lat is not None for one in heard):
                        return
                    wrong = "it has no GPS fix"
                await asyncio.sleep(0.1)
    except TimeoutError:
        raise DemoFailed(f"no vehicle is ready: {wrong}") from None


async def _preflight_passed(client: httpx.AsyncClient, mission_id: str) -> None:
    """A vehicle that was just switched on needs some seconds. Raises DemoFailed with what stays wrong."""
    wrong = "nothing was checked"
    try:
        async with asyncio.timeout(PATIENCE_WALL_S):
            while True:
                answer = _answer(await client.post(f"/api/missions/{mission_id}/preflight"))
                checked = PreflightChecked.model_validate(answer)
                failed = [check for check in checked.checks if not check.ok and check.blocking]
                if not failed:
                    return
                wrong = f"{failed[0].name.replace('_', ' ')}: {sentence_of(failed[0].reason)}"
                await asyncio.sleep(0.5)
    except TimeoutError:
        raise DemoFailed(f"preflight does not pass: {wrong}") from None


async def _watch(socket: websockets.ClientConnection, log: MissionLog, client: httpx.AsyncClient) -> None:
    """Until the mission has ended and its craft are down. A hold is resumed, as an operator would once all is well."""
    read = TypeAdapter(Recorded)
    state = MissionState()
    resuming: asyncio.Task[None] | None = None
    async for message in socket:
        if resuming is not None and resuming.done():
            resuming.result()
        if isinstance(message, bytes):
            continue
        content = json.loads(message)
        if content["type"] != "event":
            continue
        record = read.validate_python(content["recorded"])
        log.recorded.append(record)
        state = evolve(state, record.event, record.at_utc.timestamp())
        if (line := progress_line(record.event)) is not None:
            remark(line)
        if state.search.outcome is not None and not state.engaged:
            return
        if isinstance(record.event, PhaseChanged):
            why = text_of(record.event.reason)
            if record.event.after == "manual":
                raise DemoFailed(f"a pilot took control: {why}")
            if record.event.after == "hold":
                log.holds.append(why)
                resuming = asyncio.create_task(_resume(client, log))
    raise DemoFailed("the websocket closed before the mission ended")


async def _resume(client: httpx.AsyncClient, log: MissionLog) -> None:
    """Raises DemoFailed when the mission keeps stopping, or cannot be resumed."""
    why = log.holds[-1]
    if len(log.holds) > MOST_HOLDS:
        raise DemoFailed(f"the mission stopped {len(log.holds)} times, at last because of: {why}")
    try:
        async with asyncio.timeout(PATIENCE_WALL_S):
            while True:
                await asyncio.sleep(1.0)
                if (await _command(client, log.mission_id, "resume")).accepted:
                    return
    except TimeoutError:
        raise DemoFailed(f"the mission stopped and cannot be resumed: {why}") from None


async def _command(client: httpx.AsyncClient, mission_id: str, kind: str) -> CommandReply:
    command = {"command_id": str(uuid4()), "command": {"kind": kind}}
    return CommandReply.model_validate(_answer(await client.post(f"/api/missions/{mission_id}/commands", json=command)))


def _answer(response: httpx.Response) -> dict[str, Any]:
    """Raises DemoFailed with the server's own words."""
    if response.is_success:
        return response.json()
    try:
        problem = Problem.model_validate_json(response.content)
    except ValueError:
        raise DemoFailed(f"the server answered {response.status_code}") from None
    raise DemoFailed(sentence_of(problem.reason))
