"""What is written to the database, one kind a class. Writing is idempotent, so an entry may be written again after a
commit whose answer was lost: that is what makes the spool's draining exactly-once."""

from __future__ import annotations

import base64
import json
import math
import zlib
from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass, fields
from datetime import datetime, timedelta
from typing import Any, Literal

import numpy as np
from pydantic import TypeAdapter
from sqlalchemy import Connection, Table, select
from sqlalchemy.dialects import postgresql, sqlite

from backend.events import FIRST_CRAFT, FORM, Event, Recorded
from backend.ports import FactRefused, TrackPoint
from backend.reasons.storage import WrittenElsewhere
from backend.spec import FIRST_EMITTER
from backend.store.digest import EPOCH, MissionDigest, fold, from_columns, to_columns, to_us
from backend.store.packed import MOST_BYTES
from backend.store.tables import events, missions, sweeps, tracks
from backend.store.upgrade import FIRST_FORM, READ_AS_IT_STANDS, Imports, craft_of_sweep, imports_of, upgraded
from hardware.readings import Place, Sweep

EVENT: TypeAdapter[Event] = TypeAdapter(Event)
ROW = (events.c.seq, events.c.at_us, events.c.kind, events.c.form, events.c.body)
"""The columns of an EventRow."""


class JournalConflict(FactRefused):
    """Another writer has used this mission's sequence numbers for other facts."""


@dataclass(frozen=True, slots=True)
class EventRow:
    """As it was stored; form: see upgrade."""

    seq: int
    at_us: int
    kind: str
    form: int
    body: str


def to_row(seq: int, at_utc: datetime, event: Event) -> EventRow:
    """In today's form. Raises ValueError for one that could not be read again."""
    body = event.model_dump_json()
    if len(body) > MOST_BYTES // 4 and len(body.encode()) > MOST_BYTES:
        raise ValueError(f"a fact of {len(body)} characters is longer than any that is read")
    return EventRow(seq, to_us(at_utc), event.kind, FORM, body)


def to_records(mission_id: str, rows: Sequence[EventRow], imports: Imports | None = None) -> list[Recorded]:
    """Events of any form. imports: of the mission, beside those that `rows` name.

    Raises ValueError when a body is no event (a required number that was not finite, for one).
    """
    known = {**(imports or {}), **imported_before(rows)}
    return [_record(mission_id, row, known) for row in rows]


def to_texts(mission_id: str, rows: Sequence[EventRow], imports: Imports | None = None) -> list[str]:
    """The JSON of what `to_records` gives. A body of today's form is passed on as it was stored, unread.

    imports: as in to_records. Raises ValueError when an older body is no event, and for none at all.
    """
    known = {**(imports or {}), **imported_before(rows)}
    head = f'"mission_id":{json.dumps(mission_id, ensure_ascii=False)},"at_utc":"'
    return [
        f'{{"seq":{row.seq},{head}{_utc_text(row.at_us)}","event":{row.body}}}'
        if row.form == FORM and row.body
        else _record(mission_id, row, known).model_dump_json()
        for row in rows
    ]


def _utc_text(at_us: int) -> str:
    return (EPOCH + timedelta(microseconds=at_us)).isoformat().replace("+00:00", "Z")


def imported_before(rows: Iterable[EventRow]) -> dict[str, str]:
    """What the rows of form 1 say about imported sweeps, for `to_records` of others of the mission."""
    imported = (row for row in rows if row.form == FIRST_FORM and row.kind == "recording_imported")
    return imports_of(json.loads(row.body) for row in imported)


def _record(mission_id: str, row: EventRow, imports: Imports) -> Recorded:
    at_utc = EPOCH + timedelta(microseconds=row.at_us)
    if row.form in READ_AS_IT_STANDS:
        event = EVENT.validate_json(row.body)
    elif row.form == FIRST_FORM:
        event = EVENT.validate_python(upgraded(json.loads(row.body), imports))
    else:
        raise ValueError(f"event {row.seq} of mission {mission_id} is of form {row.form}: a later Crossfix stored it")
    return Recorded(seq=row.seq, mission_id=mission_id, at_utc=at_utc, event=event)


@dataclass(frozen=True, slots=True)
class EventsEntry:
    """Consecutive events of one mission."""

    mission_id: str
    rows: tuple[EventRow, ...]

    def encode(self) -> bytes:
        """As the spool keeps it."""
        return _encode("events", {"mission_id": self.mission_id, "rows": [asdict(row) for row in self.rows]})

    def write(self, connection: Connection) -> None:
        """Raises JournalConflict when another writer has used one of the numbers for another fact."""
        first, last = self.rows[0].seq, self.rows[-1].seq
        known = {
            row.seq: EventRow(*row)
            for row in connection.execute(
                select(*ROW).where(events.c.mission_id == self.mission_id, events.c.seq.between(first, last))
            )
        }
        for row in self.rows:
            if row.seq in known and known[row.seq] != row:
                raise JournalConflict(WrittenElsewhere(self.mission_id, row.seq))
        new = [row for row in self.rows if row.seq not in known]
        if not new:
            return
        before = _read_digest(connection, self.mission_id)
        if new[0].seq != (before.last_seq if before else 0) + 1:
            raise JournalConflict(WrittenElsewhere(self.mission_id, new[0].seq))
        after = to_columns(fold(before, to_records(self.mission_id, new)))
        after["name"] = after["name"].replace("\x00", "")
        if before is None:
            connection.execute(missions.insert().values(after))
        else:
            connection.execute(missions.update().where(missions.c.mission_id == self.mission_id).values(after))
        connection.execute(events.insert(), [{"mission_id": self.mission_id, **asdict(row)} for row in new])


def _read_digest(connection: Connection, mission_id: str) -> MissionDigest | None:
    """None: no fact of it is stored."""
    rows = connection.execute(select(missions).where(missions.c.mission_id == mission_id))
    found = rows.mappings().one_or_none()
    return None if found is None else from_columns(dict(found))


@dataclass(frozen=True, slots=True)
class SweepEntry:
    """One raw sweep. samples, craft_id: see tables.sweeps."""

    mission_id: str
    sweep_id: str
    craft_id: str | None
    emitter_id: str
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
        """As the spool keeps it."""
        return _encode("sweep", {**asdict(self), "samples": base64.b64encode(self.samples).decode()})

    def write(self, connection: Connection) -> None:
        """A sweep that is stored already is left as it is."""
        _insert_new(connection, sweeps, [asdict(self)])

    def sweep(self) -> Sweep:
        """As it was measured; an altitude or a drift that was not known is NaN again."""
        at_s, heading_deg, power_db = np.frombuffer(zlib.decompress(self.samples), dtype="<f8").reshape(3, -1)
        return Sweep(
            at_s=at_s,
            heading_deg=heading_deg,
            power_db=power_db,
            frequency_hz=self.frequency_hz,
            position=Place(self.lat_deg, self.lon_deg),
            altitude_amsl_m=math.nan if self.altitude_amsl_m is None else self.altitude_amsl_m,
            drift_m=math.nan if self.drift_m is None else self.drift_m,
            clipped_samples=self.clipped_samples,
            noise_floor_db=self.noise_floor_db,
            tag=self.tag,
        )


def sweep_entry(
    mission_id: str,
    sweep_id: str,
    craft_id: str | None,
    emitter_id: str,
    place_number: int,
    attempt: int,
    sweep: Sweep,
) -> SweepEntry:
    """craft_id None: imported."""
    samples = np.stack([sweep.at_s, sweep.heading_deg, sweep.power_db]).astype("<f8")
    return SweepEntry(
        mission_id=mission_id,
        sweep_id=sweep_id,
        craft_id=craft_id,
        emitter_id=emitter_id,
        place_number=place_number,
        attempt=attempt,
        frequency_hz=sweep.frequency_hz,
        lat_deg=sweep.position.lat,
        lon_deg=sweep.position.lon,
        altitude_amsl_m=_finite(sweep.altitude_amsl_m),
        drift_m=_finite(sweep.drift_m),
        clipped_samples=sweep.clipped_samples,
        noise_floor_db=_finite(sweep.noise_floor_db),
        tag=sweep.tag,
        samples=zlib.compress(samples.tobytes(), 1),
    )


@dataclass(frozen=True, slots=True)
class TrackEntry:
    """Points of one craft, as many as were saved at once."""

    mission_id: str
    craft_id: str
    points: tuple[TrackPoint, ...]

    def encode(self) -> bytes:
        """As the spool keeps it."""
        return _encode("track", asdict(self))

    def write(self, connection: Connection) -> None:
        """Points without a finite place are left out: they say nothing about the path."""
        rows = [
            {
                "mission_id": self.mission_id,
                "craft_id": self.craft_id,
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
            _insert_new(connection, tracks, rows)


Entry = EventsEntry | SweepEntry | TrackEntry


def decode(payload: bytes) -> Entry:
    """What `encode` made, or an older server: then it named neither form, craft nor emitter."""
    content = json.loads(payload)
    kind, fields_of = content["entry"], content["fields"]
    match kind:
        case "events":
            return EventsEntry(
                fields_of["mission_id"], tuple(EventRow(**({"form": FIRST_FORM} | row)) for row in fields_of["rows"])
            )
        case "sweep":
            before = {"craft_id": craft_of_sweep(fields_of["sweep_id"]), "emitter_id": FIRST_EMITTER}
            return SweepEntry(**(before | fields_of | {"samples": base64.b64decode(fields_of["samples"])}))
        case "track":
            craft_id = fields_of.get("craft_id", FIRST_CRAFT)
            points = tuple(TrackPoint(**point) for point in fields_of["points"])
            return TrackEntry(fields_of["mission_id"], craft_id, points)
        case _:
            raise ValueError(f"the spool holds an entry of unknown kind {kind!r}")


def sweep_columns() -> list[str]:
    """All of tables.sweeps, in the order of SweepEntry."""
    return [field.name for field in fields(SweepEntry)]


def _encode(kind: Literal["events", "sweep", "track"], content: dict[str, Any]) -> bytes:
    return json.dumps({"entry": kind, "fields": content}, separators=(",", ":")).encode()


def _insert_new(connection: Connection, table: Table, rows: Sequence[dict[str, Any]]) -> None:
    """Rows whose key is already there are left as they are."""
    dialect = postgresql if connection.dialect.name == "postgresql" else sqlite
    connection.execute(dialect.insert(table).on_conflict_do_nothing(), rows)


def _finite(value: float | None) -> float | None:
    return value if value is not None and math.isfinite(value) else None
