"""A database and a spool that an earlier Crossfix left behind are gone on with."""

from __future__ import annotations

import base64
import gzip
import json
import zlib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from alembic import command
from alembic.config import Config
from sqlalchemy import Connection, text

from backend.events import FIRST_CRAFT, ImportSource
from backend.mission.state import fold
from backend.store.engine import MIGRATIONS, make_engine, migrate
from backend.store.entries import EventsEntry, SweepEntry, TrackEntry, decode

JOURNALS = Path(__file__).parents[2] / "golden" / "journals"
SAMPLES = zlib.compress(np.arange(6.0).astype("<f8").tobytes())
MISSION = (
    "INSERT INTO missions (mission_id, name, phase, outcome, drafted_at_us, started_at_us, ended_at_us, mission_time_s,"
    " bearings, rejected_sweeps, last_seq)"
    " VALUES (:mission_id, 'old', :phase, NULL, 0, :started_at_us, :ended_at_us, NULL, 0, 0, :last_seq)"
)
EVENT = "INSERT INTO events (mission_id, seq, at_us, kind, body) VALUES (:mission_id, :seq, :at_us, :kind, :body)"
SWEEP = (
    "INSERT INTO sweeps (mission_id, sweep_id, place_number, attempt, frequency_hz, lat_deg, lon_deg, clipped_samples,"
    " samples) VALUES (:mission_id, :sweep_id, 1, 1, 868e6, 50.6, 7.2, 0, :samples)"
)
POINT = "INSERT INTO track (mission_id, at_us, lat_deg, lon_deg) VALUES (:mission_id, :at_us, 50.6, 7.2)"


def journal_of(name: str) -> dict[str, Any]:
    return json.loads(gzip.decompress((JOURNALS / f"{name}.json.gz").read_bytes()))


def put(connection: Connection, name: str, phase: str, ended: bool) -> str:
    """A golden journal into the tables of revision 0001."""
    stored = journal_of(name)
    mission_id, rows = stored["mission_id"], stored["rows"]
    ended_at_us = rows[-1][1] if ended else None
    mission = {"phase": phase, "started_at_us": rows[0][1], "ended_at_us": ended_at_us, "last_seq": len(rows)}
    connection.execute(text(MISSION), {"mission_id": mission_id} | mission)
    for seq, at_us, kind, body in rows:
        event = {"seq": seq, "at_us": at_us, "kind": kind, "body": body}
        connection.execute(text(EVENT), {"mission_id": mission_id} | event)
        if kind in ("bearing_measured", "sweep_rejected"):
            sweep_id = json.loads(body)["sweep_id"]
            sweep = {"mission_id": mission_id, "sweep_id": sweep_id, "samples": SAMPLES}
            connection.execute(text(SWEEP), sweep)
    connection.execute(text(POINT), [{"mission_id": mission_id, "at_us": n * 500_000} for n in range(3)])
    return mission_id


async def before(url: str) -> tuple[str, str]:
    """A database of revision 0001 with a mission that flies, and one that has ended and had recordings imported."""

    def fill(connection: Connection) -> tuple[str, str]:
        config = Config()
        config.set_main_option("script_location", str(MIGRATIONS))
        config.attributes["connection"] = connection
        command.upgrade(config, "0001")
        flying = put(connection, "takeover-ardupilot", "manual", ended=False)
        return flying, put(connection, "imported", "done", ended=True)

    engine = make_engine(url, 5.0)
    async with engine.execution_options(write=True).begin() as connection:
        found = await connection.run_sync(fill)
    await engine.dispose()
    return found


@pytest.fixture
async def missions(database_url: str) -> tuple[str, str]:
    found = await before(database_url)
    await migrate(database_url)
    return found


async def test_a_mission_in_flight_is_gone_on_with(missions: tuple[str, str], bench: Any) -> None:
    flying, ended = missions
    journal = await bench.open()
    assert await journal.unfinished() == [flying]
    recorded = await journal.read(flying)
    state = fold(recorded)
    assert (state.phase, state.craft.taken_over, len(state.search.measured)) == ("manual", True, 2)
    written = await journal.append(flying, [recorded[-1].event])
    assert [r.seq for r in await journal.read(flying, after=len(recorded))] == [r.seq for r in written]
    digest = await journal.mission(flying)
    assert (digest.phase, digest.crafts, digest.flying, digest.emitters) == ("manual", {FIRST_CRAFT: "manual"}, True, 1)
    over = await journal.mission(ended)
    assert (over.phase, over.crafts, over.flying) == ("done", {}, False)


async def test_imported_sweeps_are_known_in_any_part_of_a_journal(missions: tuple[str, str], bench: Any) -> None:
    _, mission_id = missions
    journal = await bench.open()
    whole = await journal.read(mission_id)
    kinds = ["sweep_rejected", "bearing_measured"]
    picked = await journal.read_kinds(mission_id, kinds)
    assert picked == [record for record in whole if record.event.kind in kinds]
    sources = [record.event.source for record in picked]
    assert {type(source).__name__ for source in sources} == {"CraftSource", "ImportSource"}
    later = picked[1].seq - 1
    assert await journal.read(mission_id, after=later) == whole[later:]
    for record in picked:
        sweep = await journal.sweep(mission_id, record.event.sweep_id)
        flown = not isinstance(record.event.source, ImportSource)
        assert (sweep.craft_id, sweep.emitter_id) == (FIRST_CRAFT if flown else None, "emitter-1")
    assert list(await journal.tracks(mission_id)) == [FIRST_CRAFT]
    assert len((await journal.tracks(mission_id))[FIRST_CRAFT]) == 3


async def test_takeovers_are_found_under_their_kind_of_today(missions: tuple[str, str], bench: Any) -> None:
    flying, _ = missions
    journal = await bench.open()
    whole = await journal.read(flying)
    picked = await journal.read_kinds(flying, ["authority_changed"])
    assert picked == [record for record in whole if record.event.kind == "authority_changed"]
    assert len(picked) == 3


def encoded(kind: str, fields: dict[str, Any]) -> bytes:
    return json.dumps({"entry": kind, "fields": fields}).encode()


def test_entries_of_an_old_spool_are_decoded() -> None:
    row = {"seq": 1, "at_us": 5, "kind": "server_restarted", "body": '{"kind":"server_restarted","detail":"d"}'}
    events = decode(encoded("events", {"mission_id": "m", "rows": [row]}))
    assert isinstance(events, EventsEntry)
    assert events.rows[0].form == 1
    assert decode(events.encode()) == events
    sweep = decode(
        encoded(
            "sweep",
            {
                "mission_id": "m", "sweep_id": "s1", "place_number": 1, "attempt": 1, "frequency_hz": 868e6,
                "lat_deg": 50.6, "lon_deg": 7.2, "altitude_amsl_m": None, "drift_m": None, "clipped_samples": 0,
                "noise_floor_db": None, "tag": None, "samples": base64.b64encode(SAMPLES).decode(),
            },
        )
    )  # fmt: skip
    assert isinstance(sweep, SweepEntry)
    assert (sweep.craft_id, sweep.emitter_id, sweep.samples) == (FIRST_CRAFT, "emitter-1", SAMPLES)
    assert decode(sweep.encode()) == sweep
    point = {
        "at_s": 1.0, "lat_deg": 50.6, "lon_deg": 7.2, "altitude_amsl_m": 140.0, "altitude_relative_m": 40.0,
        "heading_deg": 0.0, "battery_percent": None, "mode": None,
    }  # fmt: skip
    track = decode(encoded("track", {"mission_id": "m", "points": [point]}))
    assert isinstance(track, TrackEntry)
    assert track.craft_id == FIRST_CRAFT
    assert decode(track.encode()) == track
