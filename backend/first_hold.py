"""The first second of a server: the vehicle that the server before left in flight is held, before anything else loads.

Reads no more of the journal than whether a craft was in flight and who flew it. Where that cannot be told so quickly
(a database that does not answer, rows of before), the mission's own recovery does it, some
seconds later; it follows in any case and records what happened.
"""

from __future__ import annotations

import asyncio
import fcntl
import json
import logging
import sqlite3
from collections.abc import Awaitable, Callable, Sequence
from contextlib import closing, suppress
from dataclasses import dataclass, fields
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

from backend.settings import Settings
from backend.store.spool_layout import waiting
from hardware.authority import NOBODY, Authority
from hardware.autopilot.opening import open_connection
from hardware.clock import ScaledClock

if TYPE_CHECKING:  # loaded while the vehicle is listened for
    from hardware.autopilot.vehicle import MavsdkVehicle

log = logging.getLogger("crossfix")

ANSWERS_S = 5.0
FORMS = (2, 3, 4, 5)
"""Of the rows that are read here; see backend.store.upgrade."""


@dataclass(frozen=True, slots=True)
class FirstHold:
    """The vehicle that was found, connected on url; authority: who flew it as the journal says. clock: its.

    holding: the hold that is under way, None where somebody else has the vehicle.
    """

    url: str
    vehicle: MavsdkVehicle
    authority: Authority
    clock: ScaledClock
    holding: asyncio.Task[None] | None


@dataclass(frozen=True, slots=True)
class LeftInFlight:
    """Who flew the craft, and at_s: when the mission's last fact was recorded (UTC epoch seconds)."""

    mission_id: str
    authority: Authority
    at_s: float


async def hold_what_flies(settings: Settings) -> FirstHold | None:
    """None when nothing was left in flight, or it cannot be told or reached so quickly. Never raises.

    A vehicle that a pilot or its failsafe has is connected to, and nothing is sent.
    """
    try:
        return await _hold_what_flies(settings)
    except Exception:
        log.exception("the first look at what flies failed")
        return None


async def _hold_what_flies(settings: Settings) -> FirstHold | None:
    left = await left_in_flight(settings)
    if left is None:
        return None
    url = settings.vehicle_url or await _simulated(settings)
    if url is None:
        return None
    opening = asyncio.create_task(asyncio.to_thread(open_connection, url))
    await asyncio.to_thread(import_module, "hardware.autopilot.vehicle")
    try:
        opened = await opening
    except OSError as error:
        log.warning("no link to the vehicle that was left in flight: %s", error)
        return None
    from hardware.autopilot.vehicle import MavsdkVehicle
    from hardware.ports import HardwareError

    clock = ScaledClock(factor=settings.time_factor)
    if left.at_s > clock.now():  # a sped-up clock must not run behind what it has recorded
        clock = ScaledClock(left.at_s, settings.time_factor)
    vehicle = MavsdkVehicle(url, clock, opened=opened)
    try:
        await vehicle.connect(ANSWERS_S)
    except HardwareError as error:
        log.warning("%s", error)
        return None
    vehicle.restore(left.authority)
    ours = vehicle.telemetry().authority.taken_by is None
    return FirstHold(url, vehicle, left.authority, clock, asyncio.create_task(_hold(vehicle)) if ours else None)


async def _simulated(settings: Settings) -> str | None:
    from backend.simulation.hangar import Hangar  # a real vehicle has no hangar here

    return await Hangar(settings).address_left()


async def _hold(vehicle: MavsdkVehicle) -> None:
    """The mission's recovery orders it again, and tells what came of it."""
    from hardware.ports import HardwareError

    try:
        await vehicle.hold()
    except HardwareError as error:
        log.warning("the first hold: %s", error)


async def left_in_flight(settings: Settings) -> LeftInFlight | None:
    """From the database itself and the spool, without what is needed to write to them."""
    url = settings.async_database_url
    sqlite = url.removeprefix(SQLITE)
    if _locked(settings.spool_path):
        return None
    try:
        stored = await (_in_postgresql(url) if sqlite == url else _in_sqlite(sqlite))
        return _after(stored, waiting(settings.spool_path))
    except (sqlite3.Error, OSError, ValueError, TypeError, KeyError) as error:
        log.info("what flies is not known from the first look: %s", error)
        return None


def _after(stored: LeftInFlight | None, spooled: Sequence[bytes]) -> LeftInFlight | None:
    """What was recorded while the database was away comes after what it holds. Raises ValueError for rows of before."""
    left = stored
    for entry in map(json.loads, spooled):
        if entry["entry"] != "events":
            continue
        mission_id = entry["fields"]["mission_id"]
        for row in entry["fields"]["rows"]:
            if row.get("form") not in FORMS:
                raise ValueError("the spool holds rows of before")
            left = _after_row(left, mission_id, row)
    return left


def _after_row(left: LeftInFlight | None, mission_id: str, row: dict[str, Any]) -> LeftInFlight | None:
    kind, body, at_s = row["kind"], json.loads(row["body"]), row["at_us"] / 1e6
    ours = left is not None and left.mission_id == mission_id
    if kind == "mission_started" or (kind == "phase_changed" and body["after"] != "ground" and not ours):
        return LeftInFlight(mission_id, NOBODY, at_s)
    if left is None or not ours:
        return left
    if kind == "phase_changed" and body["after"] == "ground":
        return None
    authority = _authority(body["authority"]) if kind == "authority_changed" else left.authority
    return LeftInFlight(mission_id, authority, max(at_s, left.at_s))


def _locked(path: Path) -> bool:
    """By a server that runs and flies: this one will not start, and must not stop its vehicle."""
    with suppress(FileNotFoundError, NotADirectoryError), path.open() as lock:
        try:
            fcntl.flock(lock.fileno(), fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            return True
    return False


SQLITE, POSTGRESQL = "sqlite+aiosqlite:///", "postgresql+asyncpg:"
DATABASE_ANSWERS_S = 1.0
Rows = Callable[..., Awaitable[Sequence[Any]]]
"""(statement, at most one value for its `$1`) -> rows, to be indexed."""


async def _in_sqlite(path: str) -> LeftInFlight | None:
    """Raises sqlite3.Error, also where there is none."""
    if _locked(Path(f"{path}.server")):
        return None
    with closing(sqlite3.connect(f"file:{path}?mode=ro", uri=True, timeout=0.3)) as connection:

        async def rows(statement: str, *value: str) -> Sequence[Any]:
            return connection.execute(statement.replace("$1", "?"), value).fetchall()

        return await _in_flight(rows)


async def _in_postgresql(url: str) -> LeftInFlight | None:
    """Raises OSError when it does not answer."""
    asyncpg: Any = import_module("asyncpg")  # only where it is needed: 0.1 s; it has no types
    try:
        async with asyncio.timeout(DATABASE_ANSWERS_S):
            connection = await asyncpg.connect(url.replace(POSTGRESQL, "postgresql:", 1))
            try:
                if await connection.fetchval("SELECT to_regclass('missions')") is None:  # it would log an error
                    return None
                return await _in_flight(connection.fetch)
            finally:
                connection.terminate()
    except (asyncpg.PostgresError, asyncpg.InterfaceError) as error:
        raise OSError(str(error)) from error


async def _in_flight(rows: Rows) -> LeftInFlight | None:
    going_on = "started_at_us IS NOT NULL AND (ended_at_us IS NULL OR flying)"
    found = await rows(f"SELECT mission_id, crafts FROM missions WHERE {going_on} ORDER BY started_at_us DESC LIMIT 1")
    if not found or not json.loads(found[0][1]):
        return None
    mission_id = found[0][0]
    at_us, form = (await rows("SELECT max(at_us), min(form) FROM events WHERE mission_id = $1", mission_id))[0]
    if form not in FORMS:
        return None
    of_authority = "mission_id = $1 AND kind = 'authority_changed' ORDER BY seq DESC LIMIT 1"
    found = await rows(f"SELECT body FROM events WHERE {of_authority}", mission_id)
    authority = _authority(json.loads(found[0][0])["authority"]) if found else NOBODY
    return LeftInFlight(mission_id, authority, at_us / 1e6)


def _authority(body: dict[str, Any]) -> Authority:
    known: dict[str, Any] = {field.name: body[field.name] for field in fields(Authority) if field.name in body}
    return Authority(**{name: _frozen(value) for name, value in known.items()})


def _frozen(value: Any) -> Any:
    """JSON has lists where the fact had tuples."""
    return tuple(cast(list[Any], value)) if isinstance(value, list) else value
