"""The agent's buffer on disk: samples wait here until the server has acknowledged them. SQLite, one file."""

from __future__ import annotations

import sqlite3
import threading
from collections.abc import Sequence
from dataclasses import astuple
from pathlib import Path
from uuid import uuid4

from pydantic import TypeAdapter

from hardware.readings import Channel, PowerSample
from hardware.reasons.payload import SpoolNotWritten, SpoolUnusable
from planner.reason import ReasonedError

_CHANNELS: TypeAdapter[tuple[Channel, ...]] = TypeAdapter(tuple[Channel, ...])
DEFAULT_CAPACITY = 2_000_000
"""Samples; at 20 a second more than a day, on disk about 150 MB."""


class SpoolError(ReasonedError):
    """The spool cannot be opened or written."""

    def __init__(self, reason: SpoolUnusable | SpoolNotWritten) -> None:
        super().__init__(reason)
        self._spool_reason = reason

    @property
    def reason(self) -> SpoolUnusable | SpoolNotWritten:
        """Whether the file is unusable from the start, or one write failed."""
        return self._spool_reason


class Spool:
    """Append, read in order, forget what was acknowledged. Sequence numbers start at 1 and are never reused.

    A commit reaches the disk before `append` returns (synchronous=FULL), so a pulled plug loses nothing appended.
    When `capacity` is exceeded the oldest samples go, and `lost` counts them. Safe to call from several threads.
    """

    def __init__(self, path: Path | str, capacity: int = DEFAULT_CAPACITY) -> None:
        self._capacity = capacity
        self._lock = threading.Lock()
        path = Path(path)
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            self._db = sqlite3.connect(path, check_same_thread=False, isolation_level=None)
            self._db.executescript(
                "PRAGMA journal_mode=WAL; PRAGMA synchronous=FULL;"
                "CREATE TABLE IF NOT EXISTS sample (seq INTEGER PRIMARY KEY AUTOINCREMENT, at_s REAL NOT NULL,"
                " frequency_hz REAL NOT NULL, power_db REAL NOT NULL, noise_db REAL, clipped INTEGER NOT NULL,"
                " detected INTEGER NOT NULL DEFAULT 1);"
                "CREATE TABLE IF NOT EXISTS note (key TEXT PRIMARY KEY, value TEXT NOT NULL);"
            )
            columns = [row[1] for row in self._db.execute("PRAGMA table_info(sample)")]
            if "detected" not in columns:  # a spool from before missed pulses were sent
                self._db.execute("ALTER TABLE sample ADD COLUMN detected INTEGER NOT NULL DEFAULT 1")
            self._db.execute("INSERT OR IGNORE INTO note VALUES ('stream', ?)", (uuid4().hex,))
        except (sqlite3.Error, OSError) as error:
            raise SpoolError(SpoolUnusable(str(path), str(error))) from error

    @property
    def stream(self) -> str:
        """Names this spool for ever: sequence numbers belong to it."""
        return self._note("stream") or ""

    @property
    def lost(self) -> int:
        """Samples dropped because the spool was full, since it was made."""
        return int(self._note("lost") or 0)

    @property
    def channels(self) -> tuple[Channel, ...] | None:
        """What the server last asked to listen to; survives a reboot."""
        stored = self._note("channels")
        return None if stored is None else _CHANNELS.validate_json(stored)

    @channels.setter
    def channels(self, channels: Sequence[Channel]) -> None:
        self._set("channels", _CHANNELS.dump_json(tuple(channels)).decode())

    def append(self, samples: Sequence[PowerSample]) -> None:
        """Durable when it returns. Raises SpoolError (disk full)."""
        rows = [astuple(sample) for sample in samples]
        with self._lock:
            try:
                self._db.execute("BEGIN IMMEDIATE")
                self._db.executemany(
                    "INSERT INTO sample (at_s, frequency_hz, power_db, noise_db, clipped, detected)"
                    " VALUES (?, ?, ?, ?, ?, ?)",
                    rows,
                )
                surplus = self._count() - self._capacity
                if surplus > 0:
                    self._db.execute(
                        "DELETE FROM sample WHERE seq IN (SELECT seq FROM sample ORDER BY seq LIMIT ?)", (surplus,)
                    )
                    self._db.execute(
                        "INSERT INTO note VALUES ('lost', ?1) ON CONFLICT DO UPDATE SET value = value + ?1", (surplus,)
                    )
                self._db.execute("COMMIT")
            except sqlite3.Error as error:
                if self._db.in_transaction:
                    self._db.execute("ROLLBACK")
                raise SpoolError(SpoolNotWritten(str(error))) from error

    def after(self, seq: int, limit: int) -> list[tuple[int, PowerSample]]:
        """Up to `limit` samples with larger numbers than `seq`, in order."""
        with self._lock:
            rows = self._db.execute(
                "SELECT seq, at_s, frequency_hz, power_db, noise_db, clipped, detected FROM sample WHERE seq > ?"
                " ORDER BY seq LIMIT ?",
                (seq, limit),
            ).fetchall()
        return [(row[0], PowerSample(row[1], row[2], row[3], row[4], bool(row[5]), bool(row[6]))) for row in rows]

    def forget(self, seq: int) -> None:
        """Everything up to `seq` has been received."""
        with self._lock:
            self._db.execute("DELETE FROM sample WHERE seq <= ?", (seq,))

    def first_seq(self) -> int:
        """Of the oldest sample held; the next number to be given when none is held."""
        with self._lock:
            (first,) = self._db.execute("SELECT min(seq) FROM sample").fetchone()
            if first is not None:
                return int(first)
            row = self._db.execute("SELECT seq FROM sqlite_sequence WHERE name = 'sample'").fetchone()
        return 1 if row is None else int(row[0]) + 1

    def waiting(self) -> int:
        """How many samples have not been acknowledged."""
        with self._lock:
            return self._count()

    def close(self) -> None:
        """What was appended stays in the file; every later call fails."""
        with self._lock:
            self._db.close()

    def _count(self) -> int:
        first, last = self._db.execute("SELECT min(seq), max(seq) FROM sample").fetchone()
        return 0 if first is None else int(last - first + 1)

    def _note(self, key: str) -> str | None:
        with self._lock:
            row = self._db.execute("SELECT value FROM note WHERE key = ?", (key,)).fetchone()
        return None if row is None else str(row[0])

    def _set(self, key: str, value: str) -> None:
        with self._lock:
            self._db.execute("INSERT INTO note VALUES (?1, ?2) ON CONFLICT DO UPDATE SET value = ?2", (key, value))
