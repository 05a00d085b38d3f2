"""What an archive says about itself: who made it, what is in it, and the checksum of each part."""

from __future__ import annotations

from datetime import datetime
from pathlib import PurePosixPath
from typing import Literal

from pydantic import BaseModel, ConfigDict, Field

FORMAT = 1
MANIFEST = "manifest.json"
DATABASE, FILES, PATTERN, SPOOL = "database/", "files/", "pattern/", "spool.jsonl"
"""Where in the archive: the rows of each table, the files of the data directory, the antenna pattern that the setting
names, and what waited for the database."""
LONGEST_NAME = 400

OF_THE_MACHINE = ("crossfix.sqlite", "journal.spool", "simulated_vehicle.json", "recovery.json", "logs/", ".restoring-")
"""Beginnings of names at the top of the data directory that belong to one running server: never in an archive, in
capitals neither (some disks take them for the same)."""


class BackupError(RuntimeError):
    """An archive cannot be made, read or put back; the message says why and what to do."""


class Member(BaseModel):
    """One part of the archive. size_bytes: uncompressed."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    name: str
    size_bytes: int = Field(ge=0)
    sha256: str = Field(pattern=r"^[0-9a-f]{64}$")
    rows: int | None = Field(default=None, ge=0)
    """Of a table; None for a file."""


class Manifest(BaseModel):
    """schema_revision: of the database's schema, as the migrations count them."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    format: int
    software: str
    made_at_utc: datetime
    database: Literal["sqlite", "postgresql"]
    schema_revision: str
    members: tuple[Member, ...]

    @property
    def size_bytes(self) -> int:
        """Of everything in it, uncompressed."""
        return sum(member.size_bytes for member in self.members)

    @property
    def rows(self) -> int:
        """Of all tables."""
        return sum(member.rows or 0 for member in self.members)


def of_the_machine(name: str) -> bool:
    """A path inside the data directory that no archive holds. Unfinished uploads are neither."""
    return name.lower().startswith(OF_THE_MACHINE) or name.endswith(".part")


def checked_name(name: str) -> str:
    """A member's name that stays inside the folder it is unpacked to. Raises BackupError."""
    parts = name.split("/")
    sane = 0 < len(name) <= LONGEST_NAME and name.isprintable() and not set(name) & {"\\", ":"}
    inside = all(part not in ("", ".", "..") for part in parts) and not PurePosixPath(name).is_absolute()
    known = name == SPOOL or name.startswith((DATABASE, FILES, PATTERN))
    ours = name.startswith(FILES) and of_the_machine(name.removeprefix(FILES))
    if not (sane and inside and known) or ours:
        raise BackupError(
            f"the archive holds a part named {name[:80]!r}, which no backup of Crossfix has: "
            "do not use this archive; it was made or changed by something else"
        )
    return name
