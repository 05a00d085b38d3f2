"""A mission out of a bundle of another installation: read with distrust, written whole.

`read_bundle` runs in a worker process (backend.workers) and opens nothing on the disk: names inside the zip are
compared with those that Crossfix writes and used for nothing else.
"""

from __future__ import annotations

import io
import json
import math
import zipfile
import zlib
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass
from datetime import UTC, datetime
from typing import Any, Literal, cast

import numpy as np
from pydantic import TypeAdapter
from sqlalchemy import exc
from sqlalchemy.ext.asyncio import AsyncEngine

from backend.events import Event, MissionBroughtIn, MissionRestored, Recorded
from backend.mission.state import fold as fold_mission
from backend.ports import TrackPoint
from backend.reasons.request import BundleFactWrong, BundleFileWrong, BundleUnreadable
from backend.store.brought_facts import LARGEST, is_id, number_of, of_emitters_looked_for, on_earth, unfit
from backend.store.digest import MissionDigest, fold, to_columns
from backend.store.entries import EventRow, SweepEntry, TrackEntry, decode, to_records, to_row
from backend.store.exported import ExportedLater, NotExported, export_of_today
from backend.store.patience import patience
from backend.store.reading import unavailable
from backend.store.tables import events, missions
from planner.reason import ReasonedError

SCHEMA, SCHEMA_VERSION = "crossfix bundle", 2
JOURNAL, MANIFEST, SWEEPS, TRACKS = "mission.json", "bundle.json", "sweeps.jsonl", "tracks.jsonl"
WAYS = "ways.geojson"
BESIDE = frozenset({"README.txt", "mission.geojson", "mission.kml", "bearings.csv", "mission.mcap", "tak.zip"})
"""Made from the journal; not read."""
READ = frozenset({JOURNAL, MANIFEST, SWEEPS, TRACKS, WAYS})

MOST_FILES = 32
MOST_BYTES = 96 * 2**20
"""Of what is read, unpacked: a mission of hours with some hundred sweeps takes a tenth of it."""
MOST_EVENTS, MOST_SWEEPS, MOST_POINTS = 100_000, 2_000, 500_000
MOST_SAMPLES_BYTES = 16 * 2**20
"""Of one sweep, unpacked."""
ROW_BYTES = 3 * 8
POINTS_A_LINE = 5_000
EARLIEST, LATEST = datetime(1970, 1, 1, tzinfo=UTC), datetime(2200, 1, 1, tzinfo=UTC)
"""Between them a clock may be, one that was never set among them; beyond some years no export can be written."""
MOST_COUNTED, HIGHEST_HZ = 2**31 - 1, 1e12
MOST_TOLD, LONGEST_MODE, LONGEST_TAG = 1e6, 40, 200
"""Metres, degrees, percent or decibels that a point of a path or a sweep may tell, and characters of its words; NaN of
a point: it does not."""
WRITE_S = 10.0
AT_ONCE = 64
"""Rows of one statement: to pack their texts holds the event loop."""

SWEEP = TypeAdapter(SweepEntry)
TRACK = TypeAdapter(TrackEntry)

Whole = Literal["not_zip", "too_large", "later", "under_way"]
InFile = Literal["foreign", "damaged", "not_exported"]


class BundleRefused(ReasonedError):
    """It is no bundle that can be brought in."""

    def __init__(self, reason: BundleUnreadable | BundleFileWrong | BundleFactWrong) -> None:
        super().__init__(reason)


def _refused(fault: Whole) -> BundleRefused:
    return BundleRefused(BundleUnreadable(fault))


def _wrong(fault: InFile, name: str) -> BundleRefused:
    return BundleRefused(BundleFileWrong(fault, name[:80]))


@dataclass(frozen=True, slots=True)
class Brought:
    """rows: from number 1 on, in today's form. digest: after them. software: that wrote the bundle. ways: the file of
    its ways, which nobody has looked at yet; None: it has none."""

    mission_id: str
    rows: tuple[EventRow, ...]
    digest: MissionDigest
    sweeps: tuple[SweepEntry, ...]
    tracks: tuple[TrackEntry, ...]
    software: str
    ways: bytes | None = None


def raw_files(
    mission_id: str,
    sweeps: Sequence[SweepEntry],
    tracks: Mapping[str, Sequence[TrackPoint]],
    ways: bytes | None = None,
) -> dict[str, bytes]:
    """The files of a bundle that Crossfix reads, exact to the last bit. ways: as they lie beside the database."""
    pieces = [
        TrackEntry(mission_id, craft_id, tuple(points[at : at + POINTS_A_LINE]))
        for craft_id, points in tracks.items()
        for at in range(0, len(points), POINTS_A_LINE)
    ]
    return {
        SWEEPS: b"".join(entry.encode() + b"\n" for entry in sweeps),
        TRACKS: b"".join(piece.encode() + b"\n" for piece in pieces),
    } | ({} if ways is None else {WAYS: ways})


def read_bundle(content: bytes) -> Brought:
    """Raises BundleRefused."""
    files = _unpacked(content)
    software = _software(files.get(MANIFEST))
    recorded, paths = _journal(files[JOURNAL])
    mission_id = recorded[0].mission_id
    sweeps = tuple(_sweep(line, mission_id) for line in _lines(files, SWEEPS, MOST_SWEEPS))
    tracks = tuple(_track(line, mission_id) for line in _lines(files, TRACKS, MOST_POINTS))
    if TRACKS not in files:
        tracks = _thin_tracks(paths, mission_id)
    if sum(len(track.points) for track in tracks) > MOST_POINTS:
        raise _refused("too_large")
    try:
        fold_mission(recorded)
        digest = fold(None, recorded)
        rows = tuple(to_row(record.seq, record.at_utc, record.event) for record in recorded)
    except (ValueError, LookupError, TypeError, OverflowError, ArithmeticError, AssertionError) as error:
        raise _wrong("not_exported", JOURNAL) from error
    if digest.unfinished:
        raise _refused("under_way")
    return Brought(mission_id, rows, digest, sweeps, tracks, software, files.get(WAYS))


def _unpacked(content: bytes) -> dict[str, bytes]:
    """The files that are read."""
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            entries = archive.infolist()
            names = [entry.filename for entry in entries]
            for name in names:
                if name not in READ | BESIDE:
                    raise _wrong("foreign", _spoken(name))
            if len(names) != len(set(names)) or len(names) > MOST_FILES:
                raise _wrong("damaged", _spoken(names[-1]))
            wanted = [entry for entry in entries if entry.filename in READ]
            if sum(entry.file_size for entry in wanted) > MOST_BYTES:
                raise _refused("too_large")
            if JOURNAL not in names:
                raise _wrong("not_exported", JOURNAL)
            return {entry.filename: _read(archive, entry) for entry in wanted}
    except zipfile.BadZipFile as error:
        raise _refused("not_zip") from error


def _read(archive: zipfile.ZipFile, entry: zipfile.ZipInfo) -> bytes:
    """No more than its head says, which was counted."""
    try:
        with archive.open(entry) as stream:
            return stream.read(MOST_BYTES + 1)
    except (zipfile.BadZipFile, zlib.error, EOFError, RuntimeError, NotImplementedError, OSError, ValueError) as error:
        raise _wrong("damaged", entry.filename) from error


def _spoken(name: str) -> str:
    return "".join(c if c.isprintable() else "?" for c in name)


def _software(manifest: bytes | None) -> str:
    """A bundle without a manifest is of a Crossfix before there was one."""
    if manifest is None:
        return ""
    parsed = _parsed(manifest, MANIFEST)
    told = cast("dict[str, Any]", parsed) if isinstance(parsed, dict) else {}
    if told.get("schema") != SCHEMA or not isinstance(told.get("version"), int):
        raise _wrong("not_exported", MANIFEST)
    if told["version"] > SCHEMA_VERSION:
        raise _refused("later")
    software = told.get("software", "")
    return _spoken(software)[:80] if isinstance(software, str) else ""


def _parsed(text: bytes, name: str) -> Any:
    try:
        return json.loads(text, parse_float=number_of, parse_int=number_of)
    except (ValueError, RecursionError) as error:
        raise _wrong("damaged", name) from error


def _journal(text: bytes) -> tuple[list[Recorded], Mapping[str, Any]]:
    exported = _parsed(text, JOURNAL)
    try:
        today = export_of_today(exported)
    except ExportedLater as error:
        raise _refused("later") from error
    except (NotExported, RecursionError) as error:
        raise _wrong("not_exported", JOURNAL) from error
    recorded: list[Recorded] = today["events"]
    mission_id = today["mission_id"]
    if len(recorded) > MOST_EVENTS:
        raise _refused("too_large")
    in_order = all(r.seq == seq and r.mission_id == mission_id for seq, r in enumerate(recorded, start=1))
    sound = in_order and all(_in_time(r.at_utc) for r in recorded) and of_emitters_looked_for(recorded)
    if not sound or not is_id(mission_id):
        raise _wrong("not_exported", JOURNAL)
    wrong = unfit(recorded)
    if wrong is not None:
        raise BundleRefused(wrong)
    return recorded, today["tracks"]


def _in_time(at_utc: datetime) -> bool:
    return at_utc.tzinfo is not None and EARLIEST <= at_utc < LATEST


def _lines(files: Mapping[str, bytes], name: str, most: int) -> Iterable[tuple[bytes, str]]:
    lines = [line for line in files.get(name, b"").split(b"\n") if line]
    if len(lines) > most:
        raise _refused("too_large")
    return ((line, name) for line in lines)


def _sweep(told: tuple[bytes, str], mission_id: str) -> SweepEntry:
    line, name = told
    try:
        sweep = SWEEP.validate_python(asdict(decode(line)))  # an instance would pass unlooked at
        found = zlib.decompressobj()
        samples = found.decompress(sweep.samples, MOST_SAMPLES_BYTES)
        told_of = (sweep.altitude_amsl_m, sweep.drift_m, sweep.noise_floor_db)
        counts = (sweep.place_number, sweep.attempt, sweep.clipped_samples)
        sound = (
            sweep.mission_id == mission_id
            and is_id(sweep.sweep_id)
            and found.eof
            and len(samples) % ROW_BYTES == 0
            and on_earth(sweep.lat_deg, sweep.lon_deg)
            and is_id(sweep.emitter_id)
            and (sweep.craft_id is None or is_id(sweep.craft_id))
            and 0 < sweep.frequency_hz <= HIGHEST_HZ
            and all(number is None or abs(number) <= MOST_TOLD for number in told_of)
            and all(0 <= count <= MOST_COUNTED for count in counts)
            and (sweep.tag is None or (len(sweep.tag) <= LONGEST_TAG and sweep.tag.isprintable()))
            and not bool((np.abs(np.frombuffer(samples, "<f8")) > LARGEST).any())
        )
    except (ValueError, LookupError, TypeError, RecursionError, zlib.error) as error:
        raise _wrong("damaged", name) from error
    if not sound:
        raise _wrong("damaged", name)
    return sweep


def _track(told: tuple[bytes, str], mission_id: str) -> TrackEntry:
    line, name = told
    try:
        track = TRACK.validate_python(decode(line))
        sound = track.mission_id == mission_id and is_id(track.craft_id) and all(map(_sound, track.points))
    except (ValueError, LookupError, TypeError, AttributeError, RecursionError) as error:
        raise _wrong("damaged", name) from error
    if not sound:
        raise _wrong("damaged", name)
    return track


def _sound(point: TrackPoint) -> bool:
    told = (point.altitude_amsl_m, point.altitude_relative_m, point.heading_deg, point.battery_percent)
    return (
        0 <= point.at_s < LATEST.timestamp()
        and on_earth(point.lat_deg, point.lon_deg)
        and not any(value is not None and abs(value) > MOST_TOLD for value in told)
        and (point.mode is None or (len(point.mode) <= LONGEST_MODE and point.mode.isprintable()))
    )


def _thin_tracks(paths: Mapping[str, Any], mission_id: str) -> tuple[TrackEntry, ...]:
    """Of an older bundle: what mission.json says of the flown paths."""
    found: list[TrackEntry] = []
    try:
        for craft_id, rows in paths.items():
            points = [
                TrackPoint(datetime.fromisoformat(at).timestamp(), lat, lon, amsl_m, math.nan, heading, None, None)
                for at, lat, lon, amsl_m, heading in rows
            ]
            entry = TRACK.validate_python(TrackEntry(mission_id, craft_id, tuple(points)))
            if not is_id(craft_id) or not all(map(_sound, points)):
                raise _wrong("not_exported", JOURNAL)
            found.append(entry)
    except (ValueError, TypeError, AttributeError, OverflowError) as error:
        raise _wrong("not_exported", JOURNAL) from error
    return tuple(found)


async def bring_in(engine: AsyncEngine, brought: Brought, at_utc: datetime, by: str) -> None:
    """One transaction. A flight that writes meanwhile waits in the spool. Raises JournalUnavailable.

    One that was deleted elsewhere is restored: nobody would see it, and retention would soon bury it.
    """
    facts: list[Event] = [MissionBroughtIn(software=brought.software, by=by)]
    if brought.digest.entry.deleted_at_us is not None:
        facts.append(MissionRestored(by=by))
    added = [to_row(seq, at_utc, fact) for seq, fact in enumerate(facts, start=len(brought.rows) + 1)]
    columns = to_columns(fold(brought.digest, to_records(brought.mission_id, added)))
    columns["name"] = columns["name"].replace("\x00", "")
    rows = (*brought.rows, *added)
    try:
        async with patience(WRITE_S), engine.execution_options(write=True).begin() as connection:
            await connection.execute(missions.insert().values(columns))
            for at in range(0, len(rows), AT_ONCE):
                await connection.execute(
                    events.insert(), [_columns(brought.mission_id, row) for row in rows[at : at + AT_ONCE]]
                )
            for entry in (*brought.sweeps, *brought.tracks):
                await connection.run_sync(entry.write)
    except (exc.DBAPIError, exc.TimeoutError, OSError) as error:
        raise unavailable(error, engine) from error


def _columns(mission_id: str, row: EventRow) -> dict[str, str | int]:
    return {
        "mission_id": mission_id, "seq": row.seq, "at_us": row.at_us,
        "kind": row.kind, "form": row.form, "body": row.body,
    }  # fmt: skip
