"""The database: missions, their events, raw sweeps and the thinned tracks. The same on SQLite and PostgreSQL.

Times are UTC microseconds since the epoch, exact on both. An event's body is the JSON text that the wire sends, kept
as text so that it is read back byte for byte (a long one compressed: see packed); its form says in which words it was
written (see upgrade).
"""

from __future__ import annotations

from sqlalchemy import (
    JSON,
    BigInteger,
    Boolean,
    Column,
    Double,
    ForeignKey,
    Index,
    Integer,
    LargeBinary,
    MetaData,
    PrimaryKeyConstraint,
    String,
    Table,
    Text,
    text,
)

from backend.store.packed import PackedText

metadata = MetaData()

missions = Table(
    "missions",
    metadata,
    Column("mission_id", String(64), primary_key=True),
    Column("name", Text, nullable=False),
    Column("spec_name", Text),
    Column("phase", String(20), nullable=False),
    Column("outcome", String(20)),
    Column("crafts", JSON, nullable=False),
    Column("flying", Boolean, nullable=False),
    Column("drafted_at_us", BigInteger, nullable=False),
    Column("started_at_us", BigInteger),
    Column("ended_at_us", BigInteger),
    Column("mission_time_s", Double),
    Column("emitters", Integer, nullable=False),
    Column("bearings", Integer, nullable=False),
    Column("counted", JSON),
    Column("rejected_sweeps", Integer, nullable=False),
    Column("last_seq", Integer, nullable=False),
    Column("tags", Text, nullable=False),
    Column("notes", Text, nullable=False),
    Column("deleted_at_us", BigInteger),
    Column("sought", Text, nullable=False),
    Column("vehicles", Text, nullable=False),
    Column("west", Double),
    Column("south", Double),
    Column("east", Double),
    Column("north", Double),
    Column("truths", Integer, nullable=False),
    Column("sketch", JSON, nullable=False),
    Index("missions_in_order", "drafted_at_us", "mission_id"),
)

events = Table(
    "events",
    metadata,
    Column("mission_id", String(64), ForeignKey("missions.mission_id"), nullable=False),
    Column("seq", Integer, nullable=False),
    Column("at_us", BigInteger, nullable=False),
    Column("kind", String(40), nullable=False),
    Column("form", Integer, nullable=False),
    Column("body", PackedText, nullable=False),
    PrimaryKeyConstraint("mission_id", "seq"),
    Index("events_by_kind", "mission_id", "kind"),
)

_NO_CRAFT = text("craft_id IS NULL")

sweeps = Table(
    "sweeps",
    metadata,
    Column("mission_id", String(64), ForeignKey("missions.mission_id"), nullable=False),
    Column("sweep_id", String(64), nullable=False),
    Column("craft_id", String(40)),
    Column("emitter_id", String(40), nullable=False),
    Column("place_number", Integer, nullable=False),
    Column("attempt", Integer, nullable=False),
    Column("frequency_hz", Double, nullable=False),
    Column("lat_deg", Double, nullable=False),
    Column("lon_deg", Double, nullable=False),
    Column("altitude_amsl_m", Double),
    Column("drift_m", Double),
    Column("clipped_samples", Integer, nullable=False),
    Column("noise_floor_db", Double),
    Column("tag", Text),
    Column("samples", LargeBinary, nullable=False),
    PrimaryKeyConstraint("mission_id", "sweep_id"),
    Index("sweeps_imported", "mission_id", sqlite_where=_NO_CRAFT, postgresql_where=_NO_CRAFT),
)
"""samples: (3, n) float64 little-endian in C order, zlib: at_s, heading_deg, power_db. craft_id: who took it, null when
no craft did (a recording)."""

tracks = Table(
    "tracks",
    metadata,
    Column("mission_id", String(64), ForeignKey("missions.mission_id"), nullable=False),
    Column("craft_id", String(40), nullable=False),
    Column("at_us", BigInteger, nullable=False),
    Column("lat_deg", Double, nullable=False),
    Column("lon_deg", Double, nullable=False),
    Column("altitude_amsl_m", Double),
    Column("altitude_relative_m", Double),
    Column("heading_deg", Double),
    Column("battery_percent", Double),
    Column("mode", Text),
    PrimaryKeyConstraint("mission_id", "craft_id", "at_us"),
)

paths = Table(
    "paths",
    metadata,
    Column("mission_id", String(64), ForeignKey("missions.mission_id"), nullable=False),
    Column("craft_id", String(40), nullable=False),
    Column("at_us", BigInteger, nullable=False),
    Column("points", LargeBinary, nullable=False),
    PrimaryKeyConstraint("mission_id", "craft_id", "at_us"),
)
"""What was in `tracks` of missions that are over: pieces of an hour at most. at_us: of the first point. points: see
store.paths."""

people = Table(
    "people",
    metadata,
    Column("person_id", String(40), primary_key=True),
    Column("name", String(40), nullable=False),
    Column("name_key", String(80), nullable=False, unique=True),
    Column("role", String(10), nullable=False),
    Column("admin", Boolean, nullable=False),
    Column("active", Boolean, nullable=False),
    Column("password_hash", Text, nullable=False),
    Column("made_at_us", BigInteger, nullable=False),
    Column("issuer", String(255)),
    Column("subject", String(255)),
    Index("people_provided", "issuer", "subject", unique=True),
)
"""name_key: the name in the form in which two are compared. password_hash: argon2id with its salt and parameters, ""
where there is none. issuer, subject: of the sign-in provider (OpenID Connect Core 5.7: only both name somebody)."""

sessions = Table(
    "sessions",
    metadata,
    Column("session_id", String(40), primary_key=True),
    Column("secret_hash", String(64), nullable=False, unique=True),
    Column("person_id", String(40), ForeignKey("people.person_id"), nullable=False),
    Column("made_at_us", BigInteger, nullable=False),
    Column("seen_at_us", BigInteger, nullable=False),
    Column("address", String(64), nullable=False),
    Column("device", String(200), nullable=False),
)
"""secret_hash: SHA-256 of what the cookie holds, here and below; the secret itself is stored nowhere."""

invitations = Table(
    "invitations",
    metadata,
    Column("invitation_id", String(40), primary_key=True),
    Column("secret_hash", String(64), nullable=False, unique=True),
    Column("role", String(10), nullable=False),
    Column("admin", Boolean, nullable=False),
    Column("made_by", String(40), nullable=False),
    Column("made_at_us", BigInteger, nullable=False),
    Column("expires_at_us", BigInteger, nullable=False),
    Column("used_by", String(40)),
)

machine_tokens = Table(
    "machine_tokens",
    metadata,
    Column("token_id", String(40), primary_key=True),
    Column("secret_hash", String(64), nullable=False, unique=True),
    Column("name", String(40), nullable=False),
    Column("scope", String(10), nullable=False),
    Column("made_by", String(40), nullable=False),
    Column("made_at_us", BigInteger, nullable=False),
    Column("expires_at_us", BigInteger),
)
