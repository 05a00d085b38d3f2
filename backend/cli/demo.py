"""`crossfix demo`: one whole simulated mission over real sockets, as a browser would fly it, and how well it did."""

from __future__ import annotations

import asyncio
import json
import math
import tempfile
import webbrowser
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Any
from uuid import uuid4

import httpx
import typer
import websockets
from pydantic import TypeAdapter
from shapely import Point
from shapely.geometry import shape

from backend.cli.edge import print_json, remark, stop
from backend.cli.running import CannotServe, RunningServer, running_server, settings_of, stop_on_signals
from backend.events import (
    BearingMeasured,
    BeliefUpdated,
    Event,
    MissionEnded,
    PhaseChanged,
    PlanChosen,
    Recorded,
    SweepRejected,
)
from backend.settings import Settings
from backend.store.journal import DatabaseAway, JournalUnavailable
from backend.store.opening import DatabaseUnusable
from hardware.frame import LocalFrame
from hardware.ports import HardwareError
from hardware.readings import GeoPoint

LONGEST_MISSION_S = 3_600.0
PATIENCE_WALL_S = 60.0
MOST_HOLDS = 5
ENDED = frozenset({"done", "aborted", "failed"})
TAG: dict[str, dict[str, Any]] = {
    "emitter": {"frequency_hz": 150_000_000.0, "kind": "pulsed", "label": "wildlife tag"},
    "sensor": {"measurement_time_s": 45.0, "sigma_deg": 9.0},
}
"""What the page's preset for wildlife sets."""


class DemoFailed(RuntimeError):
    """The mission was not flown to an end; the message says why."""


def demo(
    headless: Annotated[bool, typer.Option("--headless", help="No browser: fly, print the result, stop.")] = False,
    seed: Annotated[int, typer.Option(min=0, help="Of the simulated world and of the planner.")] = 1,
    speedup: Annotated[
        float | None, typer.Option(help="Simulated seconds a second of the wall. Default: 10, with --vehicle 1.")
    ] = None,
    flavour: Annotated[str | None, typer.Option(help="Simulated autopilot: px4 or ardupilot. Default: px4.")] = None,
    vehicle: Annotated[
        str | None, typer.Option(help="Fly this autopilot instead, around its own home (udpin://0.0.0.0:14540 ...).")
    ] = None,
    world: Annotated[
        str | None,
        typer.Option(help="Simulated surroundings: open, or multipath (walls that reflect). Default: open."),
    ] = None,
    tag: Annotated[
        bool,
        typer.Option("--tag", help="Look for the simulated wildlife tag (pulses, 150 MHz), not the carrier."),
    ] = False,
    mend_failsafes: Annotated[
        bool,
        typer.Option(help="Set failsafe parameters of the autopilot that would not act, and say which."),
    ] = True,
    data_dir: Annotated[
        Path | None, typer.Option(help="Where the database goes. Default: a new temporary directory.")
    ] = None,
    port: Annotated[int | None, typer.Option(min=0, max=65535, help="Port of the page. Default: any free one.")] = None,
    json_: Annotated[bool, typer.Option("--json", help="Print one JSON object.")] = False,
) -> None:
    """Fly one whole mission: a simulated emitter, a simulated or real vehicle, the real server and its websocket.

    Example: crossfix demo --headless --seed 3 --speedup 10 --json
    """
    folder = data_dir or Path(tempfile.mkdtemp(prefix="crossfix-demo-"))
    try:
        settings = settings_of(
            host="127.0.0.1",
            port=port or 0,
            data_dir=folder,
            vehicle_url=vehicle,
            simulate=flavour,
            simulated_flies_on=False,
            time_factor=speedup if speedup is not None else (10.0 if vehicle is None else 1.0),
            seed=seed,
            world=world,
        )
    except ValueError as error:
        stop(error)
    try:
        result = asyncio.run(_demo(settings, headless, json_, mend_failsafes, TAG if tag else {}))
    except (CannotServe, DatabaseUnusable, ValueError) as error:
        stop(error)
    except (DatabaseAway, JournalUnavailable) as error:
        typer.echo(f"crossfix: the database does not answer ({error}); try again", err=True)
        raise typer.Exit(1) from None
    except (DemoFailed, HardwareError, httpx.HTTPError, websockets.WebSocketException, OSError) as error:
        typer.echo(f"crossfix: {' '.join(str(error).split())}", err=True)
        raise typer.Exit(1) from None
    except KeyboardInterrupt:
        raise typer.Exit(130) from None
    if json_:
        print_json(result)
    elif headless:
        typer.echo(_sentence(result))


async def _demo(
    settings: Settings, headless: bool, json_: bool, mend: bool, changes: dict[str, dict[str, Any]]
) -> dict[str, Any]:
    async with running_server(settings) as running:
        if not headless:
            remark(f"the page: {running.url}")
            await asyncio.to_thread(webbrowser.open, running.url)
        log = await fly(running, settings, mend, changes)
        result = summary(log, settings, None if running.receiver is None else running.receiver.truth)
        if not headless:
            typer.echo(_sentence(result), err=json_)
            remark("the page stays open to look at; Ctrl-C stops the server")
            stop_on_signals(running)
            await running.gone
        return result


@dataclass(slots=True)
class MissionLog:
    """Every event that the websocket told, in order. holds: why the mission stopped and was resumed."""

    mission_id: str
    recorded: list[Recorded] = field(default_factory=list)
    holds: list[str] = field(default_factory=list)

    def all(self, kind: type[Any]) -> list[Any]:
        return [r.event for r in self.recorded if isinstance(r.event, kind)]


async def fly(
    running: RunningServer, settings: Settings, mend: bool = False, changes: dict[str, dict[str, Any]] | None = None
) -> MissionLog:
    """Draft and start the suggested mission by REST, then watch the websocket to its end. Raises DemoFailed.

    changes: parts of the specification, merged into it.
    """
    async with httpx.AsyncClient(base_url=running.url, timeout=60.0) as client:
        await _vehicle_there(client)
        if mend:
            for line in await running.services.missions.mend_failsafes():
                remark(line)
        defaults = _answer(await client.get("/api/defaults"))
        spec = defaults["spec"] | {"name": f"Demo, seed {settings.seed}"}
        spec["planner"] = spec["planner"] | {"seed": settings.seed}
        for part, values in (changes or {}).items():
            spec[part] = spec[part] | values
        mission_id = _answer(await client.post("/api/missions", json=spec))["mission_id"]
        await _preflight_passed(client, mission_id)
        log = MissionLog(mission_id)
        address = running.url.replace("http", "ws", 1) + f"/api/live?mission={mission_id}&after=0"
        async with websockets.connect(address, max_size=None) as socket:
            command = {"command_id": str(uuid4()), "command": {"kind": "start"}}
            reply = _answer(await client.post(f"/api/missions/{mission_id}/commands", json=command))
            if not reply["accepted"]:
                raise DemoFailed(f"the start was refused: {reply['reason']}. {reply['remedy']}")
            try:
                async with asyncio.timeout(LONGEST_MISSION_S / settings.time_factor):
                    await _watch(socket, log, client)
            except TimeoutError:
                last = log.all(PhaseChanged)[-1]
                raise DemoFailed(
                    f"the mission did not end within {LONGEST_MISSION_S / 60:.0f} minutes; it is in {last.after}: "
                    f"{last.reason}"
                ) from None
    return log


async def _vehicle_there(client: httpx.AsyncClient) -> None:
    """The vehicle is connected and knows where it is. Raises DemoFailed."""
    health: dict[str, Any] = {}
    try:
        async with asyncio.timeout(PATIENCE_WALL_S):
            while True:
                health = _answer(await client.get("/api/health"))
                vehicle = _answer(await client.get("/api/vehicle"))
                if health["vehicle"]["connected"] and vehicle["lat"] is not None:
                    return
                await asyncio.sleep(0.1)
    except TimeoutError:
        detail = health.get("vehicle", {}).get("detail") or "it has no GPS fix"
        raise DemoFailed(f"no vehicle is ready: {detail}") from None


async def _preflight_passed(client: httpx.AsyncClient, mission_id: str) -> None:
    """A vehicle that was just switched on needs some seconds. Raises DemoFailed with what stays wrong."""
    wrong = "nothing was checked"
    try:
        async with asyncio.timeout(PATIENCE_WALL_S):
            while True:
                checked = _answer(await client.post(f"/api/missions/{mission_id}/preflight"))
                failed = [c for c in checked["checks"] if not c["ok"] and c["blocking"]]
                if not failed:
                    return
                wrong = f"{failed[0]['name']}: {failed[0]['detail']}. {failed[0]['remedy']}"
                await asyncio.sleep(0.5)
    except TimeoutError:
        raise DemoFailed(f"preflight does not pass: {wrong}") from None


async def _watch(socket: websockets.ClientConnection, log: MissionLog, client: httpx.AsyncClient) -> None:
    """Until the mission has ended. A hold is resumed, as an operator would once all is well again."""
    read = TypeAdapter(Recorded)
    resuming: asyncio.Task[None] | None = None
    async for message in socket:
        if resuming is not None and resuming.done():
            resuming.result()
        if isinstance(message, bytes):
            continue
        told = json.loads(message)
        if told["type"] != "event":
            continue
        record = read.validate_python(told["recorded"])
        log.recorded.append(record)
        event: Event = record.event
        if isinstance(event, PhaseChanged):
            remark(f"{event.after}: {event.reason}")
            if event.after in ENDED:
                return
            if event.after == "manual":
                raise DemoFailed(f"a pilot took control: {event.reason}")
            if event.after == "hold":
                log.holds.append(event.reason)
                resuming = asyncio.create_task(_resume(client, log))
    raise DemoFailed("the websocket closed before the mission ended")


async def _resume(client: httpx.AsyncClient, log: MissionLog) -> None:
    """Raises DemoFailed when the mission keeps stopping, or cannot be resumed."""
    reason = log.holds[-1]
    if len(log.holds) > MOST_HOLDS:
        raise DemoFailed(f"the mission stopped {len(log.holds)} times, at last because of: {reason}")
    try:
        async with asyncio.timeout(PATIENCE_WALL_S):
            while True:
                await asyncio.sleep(1.0)
                command = {"command_id": str(uuid4()), "command": {"kind": "resume"}}
                reply = _answer(await client.post(f"/api/missions/{log.mission_id}/commands", json=command))
                if reply["accepted"]:
                    return
    except TimeoutError:
        raise DemoFailed(f"the mission stopped and cannot be resumed: {reason}") from None


def _answer(response: httpx.Response) -> dict[str, Any]:
    """Raises DemoFailed with the server's own words."""
    if response.is_success:
        return response.json()
    try:
        problem = response.json()
        raise DemoFailed(f"{problem.get('detail', response.text)} {problem.get('remedy', '')}")
    except ValueError:
        raise DemoFailed(f"the server answered {response.status_code}") from None


def summary(log: MissionLog, settings: Settings, truth: GeoPoint | None) -> dict[str, Any]:
    """How well it did: the last estimate against the truth."""
    ended: MissionEnded = log.all(MissionEnded)[-1]
    beliefs: list[BeliefUpdated] = log.all(BeliefUpdated)
    estimate = beliefs[-1].estimate if beliefs else None
    error_m = in_c95 = None
    if estimate is not None and truth is not None:
        east, north = LocalFrame(truth).to_enu(GeoPoint(estimate.lat, estimate.lon))
        error_m = (east**2 + north**2) ** 0.5
        in_c95 = bool(shape(estimate.c95.model_dump()).covers(Point(truth.lon_deg, truth.lat_deg)))
    return {
        "localized": ended.outcome == "localized",
        "error_m": error_m,
        "expected_rmse_m": None if estimate is None else estimate.expected_rmse_m,
        "in_c95": in_c95,
        "bearings": len(log.all(BearingMeasured)),
        "bearing_errors_deg": [] if truth is None else [_bearing_error(b, truth) for b in log.all(BearingMeasured)],
        "bearing_sigmas_deg": [b.sigma_deg for b in log.all(BearingMeasured)],
        "rejected_sweeps": len(log.all(SweepRejected)),
        "mission_time_s": ended.mission_time_s,
        "plan_ms": [p.plan_ms for p in log.all(PlanChosen) if p.source == "planner"],
        "database": settings.async_database_url.split(":///", 1)[-1],
        "outcome": ended.outcome,
        "reason": ended.reason,
        "holds": log.holds,
        "seed": settings.seed,
        "world": settings.world,
        "mission_id": log.mission_id,
    }


def _bearing_error(measured: BearingMeasured, truth: GeoPoint) -> float:
    """Measured minus true bearing, degrees in [-180, 180)."""
    east, north = LocalFrame(GeoPoint(measured.place.lat, measured.place.lon)).to_enu(truth)
    return (measured.bearing_deg - math.degrees(math.atan2(east, north)) + 180.0) % 360.0 - 180.0


def _sentence(result: dict[str, Any]) -> str:
    seconds = round(result["mission_time_s"])
    took = f"{seconds // 60}:{seconds % 60:02d}"
    if not result["localized"]:
        return f"Not localized after {took} and {result['bearings']} bearings: {result['reason']}."
    return (
        f"Localized after {took} with {result['bearings']} bearings: {result['error_m']:.1f} m from the emitter, "
        f"{result['expected_rmse_m']:.1f} m expected, {'inside' if result['in_c95'] else 'outside'} C95."
    )
