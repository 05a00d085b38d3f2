"""A season's stock for the library: one flown mission, lengthened, and copied inside the database as often as wanted.

The facts of every copy are those of a recorded flight, byte for byte; only what the list is searched by differs. Copies
are made by the database itself, so that half a million bearings take minutes and not a day.
"""

from __future__ import annotations

import gzip
import json
import math
from collections.abc import Sequence
from datetime import UTC, datetime, timedelta
from typing import Any
from uuid import UUID

import numpy as np
from sqlalchemy import Insert, Table, bindparam, func, insert, select, text
from sqlalchemy.ext.asyncio import AsyncConnection, AsyncEngine

from backend.events import (
    BearingMeasured,
    BeliefUpdated,
    CraftSource,
    Event,
    PlanChosen,
    SourceErrorsFact,
    SweepRejected,
    SweepStarted,
)
from backend.ports import TrackPoint
from backend.search.planning import DEGREES_DIGITS, SECONDS_DIGITS
from backend.search.sweep_facts import DB_DIGITS
from backend.store.digest import MissionDigest, to_columns
from backend.store.entries import EventRow, to_records
from backend.store.journal import SqlJournal
from backend.store.tables import events, missions
from backend.store.upgrade import FIRST_FORM
from hardware.direction_finding.circle import SweepLikelihood
from hardware.readings import Place, Sweep
from tests.benchmarks.figures.circumstances import ROOT

RECORDED = ROOT / "tests" / "golden" / "journals" / "demo-px4-open.json.gz"
TEMPLATE = "template"
FIRST_DAY = datetime(2024, 3, 1, 8, tzinfo=UTC)
BETWEEN = timedelta(hours=4)
TRACK_HZ = 2.0
AT_ONCE = 100
"""Missions in one transaction."""
LEG_POINTS, FLOWN_POINTS = 108, 76
"""A bearing in 54 s, 16 s of it on the spot."""
M_PER_DEG = 111_200.0
SWEEP_SAMPLES = 800
"""Of a turn of 16 s with the simulated receiver's 50 powers a second."""

EDGES = ("west", "east", "south", "north")
PLACES = ("river", "ridge", "moor", "quarry", "orchard", "harbour", "marsh", "gravel pit", "beech wood", "sand dunes")
SPECIES = ("owl", "marten", "stork", "bat", "curlew", "lynx", "hamster", "kite")
SEEKERS = ("craft-1", "craft-2", "heron", "kestrel")
RESULTS = ("localized", "localized", "localized", "not_localized", "aborted")


def copy_id(number: int) -> str:
    """Of a copy: as long as the ids that missions get."""
    return str(UUID(int=number))


def recorded_flight() -> list[Event]:
    """Its facts."""
    told = json.loads(gzip.decompress(RECORDED.read_bytes()))
    rows = [EventRow(seq, at_us, kind, FIRST_FORM, body) for seq, at_us, kind, body in told["rows"]]
    return [_rounded(record.event) for record in to_records(told["mission_id"], rows)]


def lengthened(flown: Sequence[Event], bearings: int) -> list[Event]:
    """The flight with this number of bearings: from the second decision to its belief over and over, then its end."""
    decisions = [at for at, event in enumerate(flown) if event.kind == "plan_chosen"]
    beliefs = [at for at, event in enumerate(flown) if event.kind == "belief_updated"]
    until = next(at for at in beliefs if at > decisions[1]) + 1
    head, round_, tail = flown[: decisions[1]], flown[decisions[1] : until], flown[beliefs[-1] + 1 :]
    made: list[Event] = list(head)
    for number in range(2, bearings + 1):
        made += [_numbered(event, number) for event in round_]
    return [*made, *tail]


def _rounded(event: Event) -> Event:
    """As it would be recorded today: what is only shown has the digits that are shown, a bearing has its likelihood and
    a belief the errors of its source."""
    if isinstance(event, BearingMeasured):
        bins = {name: _bins(np.array(getattr(event, name), float)) for name in ("binned_db", "fitted_db")}
        said = SweepLikelihood.normal(event.bearing_deg, event.sigma_deg).packed()
        return event.model_copy(update={**bins, "likelihood": said, "taken_at_s": FIRST_DAY.timestamp() + 1 / 3})
    if isinstance(event, BeliefUpdated):
        errors = SourceErrorsFact(
            source=CraftSource(craft_id="craft-1"),
            bearings=event.bearings,
            bias_deg=1 / 3,
            bias_std_error_deg=4 / 3,
            sigma_scale=7 / 6,
            outlier_rate=1 / 12,
        )
        return event.model_copy(update={"sources": [errors]})
    if isinstance(event, PlanChosen):
        told = [
            c.model_copy(
                update={
                    "lat": round(c.lat, DEGREES_DIGITS),
                    "lon": round(c.lon, DEGREES_DIGITS),
                    "value_s": round(c.value_s, SECONDS_DIGITS),
                    "std_error_s": None if c.std_error_s is None else round(c.std_error_s, SECONDS_DIGITS),
                }
            )
            for c in event.candidates
        ]
        return event.model_copy(update={"candidates": told})
    return event


def _bins(values: np.ndarray) -> list[float | None]:
    return [None if np.isnan(value) else round(float(value), DB_DIGITS) for value in values]


def _numbered(event: Event, number: int) -> Event:
    if isinstance(event, BearingMeasured):
        changed = {"bearing_id": str(UUID(int=number)), "sweep_id": f"sweep-{number}", "place_number": number}
        return event.model_copy(update=changed)
    if isinstance(event, SweepStarted | SweepRejected):
        return event.model_copy(update={"sweep_id": f"sweep-{number}", "place_number": number})
    return event


async def write_template(journal: SqlJournal, bearings: int, track_s: float = 0.0, raw: bool = False) -> MissionDigest:
    """One mission by way of the journal. track_s: so long a path is kept; raw: a raw sweep of each bearing too."""
    await journal.append(TEMPLATE, lengthened(recorded_flight(), bearings))
    if track_s:
        await journal.save_track(TEMPLATE, "craft-1", _path(round(track_s * TRACK_HZ)))
    if raw:
        for number in range(1, bearings + 1):
            await journal.save_sweep(TEMPLATE, f"sweep-{number}", "craft-1", "emitter-1", number, 1, _turn(number))
    digest = await journal.mission(TEMPLATE)
    assert digest is not None
    return digest


def _path(points: int) -> list[TrackPoint]:
    """Legs of a minute at 7 m/s with a turn between them, in the steps in which autopilots tell: 1e-7 degree, 1 mm."""
    generator = np.random.default_rng(1)
    late_s, sway, climb, yaw = generator.normal(0.0, [[0.05], [1e-7], [0.02], [0.5]], (4, points))
    course = np.repeat(generator.uniform(0.0, 360.0, -(-points // LEG_POINTS)), LEG_POINTS)[:points]
    moved = 7.0 / TRACK_HZ * (np.arange(points) % LEG_POINTS < FLOWN_POINTS) / M_PER_DEG
    lat = 50.62 + np.cumsum(moved * np.cos(np.radians(course))) + sway
    lon = 7.2 + np.cumsum(moved * np.sin(np.radians(course))) / math.cos(math.radians(50.62)) + sway
    at_s = FIRST_DAY.timestamp() + np.arange(points) / TRACK_HZ + np.abs(late_s)
    return [
        TrackPoint(
            round(at_s[n], 6),
            round(lat[n], 7),
            round(lon[n], 7),
            round(160.0 + climb[n], 3),
            round(40.0 + climb[n], 3),
            (course[n] + yaw[n]) % 360.0,
            float(98 - 70 * n // points),
            "HOLD",
        )
        for n in range(points)
    ]


def _turn(seed: int) -> Sweep:
    generator = np.random.default_rng(seed)
    at_s = FIRST_DAY.timestamp() + np.arange(SWEEP_SAMPLES) / 50.0
    heading = np.linspace(0.0, 360.0, SWEEP_SAMPLES) + generator.normal(0.0, 0.3, SWEEP_SAMPLES)
    power = -95.0 + 12.0 * np.cos(np.radians(heading)) + generator.normal(0.0, 1.5, SWEEP_SAMPLES)
    return Sweep(at_s, heading, power, 148.5e6, Place(50.62, 7.2), 140.0)


def _row(template: dict[str, Any], number: int) -> dict[str, Any]:
    """What the list shows and is searched by, of one copy."""
    shift_us = round(number * BETWEEN / timedelta(microseconds=1))
    east, north = 0.01 * (number % 100), 0.01 * (number // 100)
    species, place = SPECIES[number % len(SPECIES)], PLACES[number % len(PLACES)]
    moved = {name: template[name] + by for name, by in zip(EDGES, (east, east, north, north), strict=True)}
    first_us = round(FIRST_DAY.timestamp() * 1e6) - template["drafted_at_us"]
    times = {
        name: None if template[name] is None else template[name] + first_us + shift_us
        for name in ("drafted_at_us", "started_at_us", "ended_at_us")
    }
    return {
        **template,
        **moved,
        **times,
        "mission_id": copy_id(number),
        "name": f"{species.title()} {number} by the {place}",
        "tags": f"{species}\nnight" if number % 3 else species,
        "notes": f"Seen again near the {place} at dusk, wind from the west." if number % 4 == 0 else "",
        "sought": f"emitter-1 {species} {number % 40} {148 + 0.01 * (number % 200):g}",
        "vehicles": SEEKERS[number % len(SEEKERS)],
        "outcome": RESULTS[number % len(RESULTS)],
        "truths": int(number % 10 == 0),
        "deleted_at_us": _lately_us() if number % 50 == 49 else None,
    }


def _lately_us() -> int:
    """Yesterday: the server would bury what was deleted long ago, beside the questions that are timed."""
    return round((datetime.now(UTC) - timedelta(days=1)).timestamp() * 1e6)


async def multiply(
    engine: AsyncEngine, flown: MissionDigest, copies: range, tables: Sequence[Table] = (events,)
) -> None:
    """A copy of the template's rows of these tables for each number. Nobody else may use the database meanwhile."""
    template = to_columns(flown)
    async with engine.execution_options(write=True).connect() as connection:
        await _not_safely(connection)
        for first in range(0, len(copies), AT_ONCE):
            numbers = copies[first : first + AT_ONCE]
            async with connection.begin():
                await connection.execute(missions.insert(), [_row(template, number) for number in numbers])
                for table in tables:
                    query = _copying(table)
                    for number in numbers:
                        await connection.execute(query, {"copy": copy_id(number)})
        if engine.dialect.name == "postgresql":
            async with connection.begin():
                await connection.execute(text("ANALYZE"))


async def _not_safely(connection: AsyncConnection) -> None:
    """SQLite writes each page once, and waits for no disk. As long as this connection lasts; servers open their own."""
    if connection.dialect.name == "sqlite":
        driver = (await connection.get_raw_connection()).driver_connection
        assert driver is not None
        for pragma in ("journal_mode=OFF", "synchronous=OFF"):
            await driver.execute(f"PRAGMA {pragma}")


def _copying(table: Table) -> Insert:
    names = [column.name for column in table.c if column.name != "mission_id"]
    copied = select(bindparam("copy", type_=table.c.mission_id.type), *(table.c[name] for name in names))
    return insert(table).from_select(["mission_id", *names], copied.where(table.c.mission_id == TEMPLATE))


async def size_bytes(engine: AsyncEngine) -> int:
    """Of the whole database, its indexes included, without pages that are free to be used again."""
    if engine.dialect.name == "postgresql":
        query = "SELECT pg_database_size(current_database())"
    else:
        query = (
            "SELECT (page_count - freelist_count) * page_size"
            " FROM pragma_page_count(), pragma_freelist_count(), pragma_page_size()"
        )
    async with engine.connect() as connection:
        return int((await connection.execute(text(query))).scalar_one())


async def counted(engine: AsyncEngine) -> tuple[int, int]:
    """Missions and bearings that lie there."""
    async with engine.connect() as connection:
        of = (await connection.execute(select(func.count()).select_from(missions))).scalar_one()
        kept = select(func.count()).select_from(events).where(events.c.kind == "bearing_measured")
        return int(of), int((await connection.execute(kept)).scalar_one())
