"""What is written to the database, one kind a class. Writing is idempotent, so an entry may be written again after a
commit whose answer was lost: that is what makes the spool's draining exactly-once."""

from __future__ import annotations

import base64
import json
import math
import zlib
from collections.abc import Sequence
from dataclasses import asdict, dataclass, fields
from datetime import datetime, timedelta
from typing import Any, Literal

import numpy as np
from pydantic import TypeAdapter
from sqlalchemy import Table, select
from sqlalchemy.dialects import postgresql, sqlite
from sqlalchemy.ext.asyncio import AsyncConnection

from backend.events import Event, Recorded
from backend.mission.ports import FactRefused, TrackPoint
from backend.store.digest import EPOCH, MissionDigest, fold, to_us
from backend.store.tables import events, missions, sweeps, track
from hardware.readings import GeoPoint, Sweep

EVENT: TypeAdapter[Event] = TypeAdapter(Event)


class JournalConflict(FactRefused):
    """Another writer has used this mission's sequence numbers for other facts."""


@dataclass(frozen=True, slots=True)
class EventRow:
    seq: int
    at_us: int
    kind: str
    body: str


def to_row(seq: int, at_utc: datetime, event: Event) -> EventRow:
    return EventRow(seq, to_us(at_utc), event.kind, event.model_dump_json())


def to_record(mission_id: str, row: EventRow) -> Recorded:
    """Raises ValueError when the body is no event (a required number that was not finite, for one)."""
    at_utc = EPOCH + timedelta(microseconds=row.at_us)
    return Recorded(seq=row.seq, mission_id=mission_id, at_utc=at_utc, event=EVENT.validate_json(row.body))


@dataclass(frozen=True, slots=True)
class EventsEntry:
    """Consecutive events of one mission."""

    mission_id: str
    rows: tuple[EventRow, ...]

    def encode(self) -> bytes:
        return _encode("events", {"mission_id": self.mission_id, "rows": [asdict(row) for row in self.rows]})

    async def write(self, connection: AsyncConnection) -> None:
        first, last = self.rows[0].seq, self.rows[-1].seq
        known = {
            row.seq: row
            for row in await connection.execute(
                select(events.c.seq, events.c.at_us, events.c.kind, events.c.body).where(
                    events.c.mission_id == self.mission_id, events.c.seq.between(first, last)
                )
            )
        }
        for row in self.rows:
            if row.seq in known and tuple(known[row.seq]) != (row.seq, row.at_us, row.kind, row.body):
                raise JournalConflict(f"mission {self.mission_id}: event {row.seq} is already another one")
        new = [row for row in self.rows if row.seq not in known]
        if not new:
            return
        before = await read_digest(connection, self.mission_id)
        if new[0].seq != (before.last_seq if before else 0) + 1:
            raise JournalConflict(f"mission {self.mission_id}: event {new[0].seq} does not follow the last one")
        after = asdict(fold(before, [to_record(self.mission_id, row) for row in new]))
        after["name"] = after["name"].replace("\x00", "")
        if before is None:
            await connection.execute(missions.insert().values(after))
        else:
            await connection.execute(missions.update().where(missions.c.mission_id == self.mission_id).values(after))
        await connection.execute(events.insert(), [{"mission_id": self.mission_id, **asdict(row)} for row in new])


async def read_digest(connection: AsyncConnection, mission_id: str) -> MissionDigest | None:
    found = (await connection.execute(select(missions).where(missions.c.mission_id == mission_id))).one_or_none()
    return None if found is None else MissionDigest(**found._mapping)


@dataclass(frozen=True, slots=True)
class SweepEntry:
    """One raw sweep. samples: see tables.sweeps."""

    mission_id: str
    sweep_id: str
    place_number: int
    attempt: int
    frequency_hz: float
    lat_deg: float
    lon_deg: float
    altitude_amsl_m: float | None
    drift_m: float | None
    clipped_samples: int
    noise_floor_db: float | None
    tag: str | None
    samples: bytes

    def encode(self) -> bytes:
        return _encode("sweep", {**asdict(self), "samples": base64.b64encode(self.samples).decode()})

    async def write(self, connection: AsyncConnection) -> None:
        await _insert_new(connection, sweeps, [asdict(self)])

    def sweep(self) -> Sweep:
        at_s, heading_deg, power_db = np.frombuffer(zlib.decompress(self.samples), dtype="<f8").reshape(3, -1)
        return Sweep(
            at_s=at_s,
            heading_deg=heading_deg,
            power_db=power_db,
            frequency_hz=self.frequency_hz,
            position=GeoPoint(self.lat_deg, self.lon_deg),
            altitude_amsl_m=math.nan if self.altitude_amsl_m is None else self.altitude_amsl_m,
            drift_m=math.nan if self.drift_m is None else self.drift_m,
            clipped_samples=self.clipped_samples,
            noise_floor_db=self.noise_floor_db,
            tag=self.tag,
        )


def sweep_entry(mission_id: str, sweep_id: str, place_number: int, attempt: int, sweep: Sweep) -> SweepEntry:
    samples = np.stack([sweep.at_s, sweep.heading_deg, sweep.power_db]).astype("<f8")
    return SweepEntry(
        mission_id=mission_id,
        sweep_id=sweep_id,
        place_number=place_number,
        attempt=attempt,
        frequency_hz=sweep.frequency_hz,
        lat_deg=sweep.position.lat_deg,
        lon_deg=sweep.position.lon_deg,
        altitude_amsl_m=_finite(sweep.altitude_amsl_m),
        drift_m=_finite(sweep.drift_m),
        clipped_samples=sweep.clipped_samples,
        noise_floor_db=_finite(sweep.noise_floor_db),
        tag=sweep.tag,
        samples=zlib.compress(samples.tobytes(), 1),
    )


@dataclass(frozen=True, slots=True)
class TrackEntry:
    mission_id: str
    points: tuple[TrackPoint, ...]

    def encode(self) -> bytes:
        return _encode("track", {"mission_id": self.mission_id, "points": [asdict(point) for point in self.points]})

    async def write(self, connection: AsyncConnection) -> None:
        """Points without a finite place are left out: they say nothing about the path."""
        rows = [
            {
                "mission_id": self.mission_id,
                "at_us": round(point.at_s * 1e6),
                "lat_deg": point.lat_deg,
                "lon_deg": point.lon_deg,
                "altitude_amsl_m": _finite(point.altitude_amsl_m),
                "altitude_relative_m": _finite(point.altitude_relative_m),
                "heading_deg": _finite(point.heading_deg),
                "battery_percent": _finite(point.battery_percent),
                "mode": point.mode,
            }
            for point in self.points
            if math.isfinite(point.lat_deg) and math.isfinite(point.lon_deg) and math.isfinite(point.at_s)
        ]
        if rows:
            await _insert_new(connection, track, rows)


Entry = EventsEntry | SweepEntry | TrackEntry


def decode(payload: bytes) -> Entry:
    content = json.loads(payload)
    kind, fields_of = content["entry"], content["fields"]
    match kind:
        case "events":
            return EventsEntry(fields_of["mission_id"], tuple(EventRow(**row) for row in fields_of["rows"]))
        case "sweep":
            return SweepEntry(**{**fields_of, "samples": base64.b64decode(fields_of["samples"])})
        case "track":
            return TrackEntry(fields_of["mission_id"], tuple(TrackPoint(**point) for point in fields_of["points"]))
        case _:
            raise ValueError(f"the spool holds an entry of unknown kind {kind!r}")


def sweep_columns() -> list[str]:
    return [field.name for field in fields(SweepEntry)]


def _encode(kind: Literal["events", "sweep", "track"], content: dict[str, Any]) -> bytes:
    return json.dumps({"entry": kind, "fields": content}, separators=(",", ":")).encode()


async def _insert_new(connection: AsyncConnection, table: Table, rows: Sequence[dict[str, Any]]) -> None:
    """Rows whose key is already there are left as they are."""
    dialect = postgresql if connection.dialect.name == "postgresql" else sqlite
    await connection.execute(dialect.insert(table).on_conflict_do_nothing(), rows)


def _finite(value: float | None) -> float | None:
    return value if value is not None and math.isfinite(value) else None
