"""A file that keeps journal entries while the database is away.

Layout: magic, generation (u64), then records of length (u32), CRC-32 of generation and payload (u32), payload. All
little-endian. A record of an older generation fails its CRC and ends the scan, so clearing is one durable write of the
header and a torn last record is never read. The file's blocks are taken in advance: a full disk does not stop it.
Synchronous; call it off the event loop.
"""

from __future__ import annotations

import fcntl
import os
import time
from pathlib import Path

from backend.reasons.storage import ForeignSpool
from backend.store.spool_layout import HEADER, MAGIC, RECORD, crc_of, records
from planner.reason import ReasonedError


class SpoolFull(RuntimeError):
    """Neither the reserve nor the disk has room for another entry."""


class SpoolForeign(ReasonedError, ValueError):
    """The file was made by something else; it is left alone."""


class SpoolTaken(RuntimeError):
    """Another process owns the file, for instance a server that is running."""


def claim(fd: int, patience_s: float) -> None:
    """Lock a file for this process alone. A server that was just killed may hold it for a moment. Raises SpoolTaken."""
    until = time.monotonic() + patience_s
    while True:
        try:
            fcntl.flock(fd, fcntl.LOCK_EX | fcntl.LOCK_NB)
            return
        except BlockingIOError:
            if time.monotonic() >= until:
                raise SpoolTaken from None
            time.sleep(0.05)


def entries_beside(path: Path) -> list[bytes]:
    """What a spool holds that another process owns, oldest first; empty where there is none. Raises SpoolForeign.

    Read while it is written to, it is what was there at one moment or a part of it that has been stored since.
    """
    try:
        fd = os.open(path, os.O_RDONLY)
    except FileNotFoundError:
        return []
    try:
        header = os.pread(fd, HEADER.size, 0)
        magic, generation = HEADER.unpack(header) if len(header) == HEADER.size else (b"", 0)
        if magic != MAGIC:
            raise SpoolForeign(ForeignSpool(str(path)))
        return list(records(fd, generation))
    finally:
        os.close(fd)


class Spool:
    """One process owns the file, for as long as it lives. Raises SpoolTaken after `patience_s`, SpoolForeign."""

    def __init__(self, path: Path, reserve_bytes: int, patience_s: float = 0.0) -> None:
        self.path = path
        path.parent.mkdir(parents=True, exist_ok=True)
        self._fd = os.open(path, os.O_RDWR | os.O_CREAT, 0o600)
        try:
            claim(self._fd, patience_s)
            self._reserve(reserve_bytes)
            magic, self._generation = HEADER.unpack(os.pread(self._fd, HEADER.size, 0))
            if magic != MAGIC:
                raise SpoolForeign(ForeignSpool(str(path)))
        except BaseException:
            os.close(self._fd)
            raise
        self._end = HEADER.size
        self._entries = self._scan()

    def _reserve(self, reserve_bytes: int) -> None:
        """Write zeros, not holes: only written blocks are sure to be there on a full disk."""
        size = os.fstat(self._fd).st_size
        if size < HEADER.size:
            os.pwrite(self._fd, HEADER.pack(MAGIC, 1), 0)
            size = HEADER.size
        chunk = bytes(2**20)
        while size < reserve_bytes:
            size += os.pwrite(self._fd, chunk[: reserve_bytes - size], size)
        os.fsync(self._fd)

    def _scan(self) -> list[bytes]:
        found = list(records(self._fd, self._generation))
        self._end = HEADER.size + sum(RECORD.size + len(payload) for payload in found)
        return found

    def entries(self) -> list[bytes]:
        """What is kept, oldest first."""
        return list(self._entries)

    def append(self, payload: bytes) -> None:
        """Durable when it returns. Raises SpoolFull; what was kept before stays intact."""
        record = RECORD.pack(len(payload), crc_of(self._generation, payload)) + payload
        try:
            written = os.pwrite(self._fd, record, self._end)
            if written < len(record):
                raise SpoolFull("the disk is full")
            os.fdatasync(self._fd)
        except OSError as error:
            raise SpoolFull(error.strerror or "it cannot be written") from error
        self._end += len(record)
        self._entries.append(payload)

    def clear(self) -> None:
        """Forget everything, durably."""
        os.pwrite(self._fd, HEADER.pack(MAGIC, self._generation + 1), 0)
        os.fdatasync(self._fd)
        self._generation += 1
        self._end = HEADER.size
        self._entries.clear()

    def keep_aside(self, payload: bytes) -> None:
        """An entry that the database will never take: one line of a file beside the spool, for a person to look at."""
        with self.path.with_suffix(".refused").open("ab") as file:
            file.write(payload + b"\n")
            file.flush()
            os.fsync(file.fileno())

    def close(self) -> None:
        """Lets go of the file: another process may take it."""
        os.close(self._fd)
