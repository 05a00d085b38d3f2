"""The audit log: who did or tried what, from where, when. A file that is only appended to; a chain of digests.

It lies beside the database, so that a database that is away, or a flight that fills it, takes nothing from it. Noting
never waits: a thread writes. While the disk takes nothing entries wait, bounded, and the log counts what is lost.
"""

from __future__ import annotations

import asyncio
import fcntl
import logging
import os
from collections import deque
from collections.abc import Callable
from contextlib import suppress
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from backend.auth.audit_chain import Head, linked, read
from backend.auth.recovery import same_owner

log = logging.getLogger("crossfix.audit")

WAITING = 10_000
RETRY_S = 2.0
TAIL_BYTES = 64 * 2**10
"""Longer than any entry."""


class AuditLog:
    """path None: nothing is kept. Lives on one event loop; `close` writes what waits."""

    def __init__(self, path: Path | None, wall_s: Callable[[], float]) -> None:
        self._path = path
        self._wall_s = wall_s
        self._head: Head | None = None
        self._end = 0
        self._waiting: deque[dict[str, Any]] = deque()
        self._lost = 0
        self._writer: asyncio.Task[None] | None = None
        self._wanted = asyncio.Event()
        self._idle = asyncio.Event()
        self._idle.set()

    def note(self, **content: Any) -> None:
        """content: JSON values; time and place in the chain are added."""
        if self._path is None:
            return
        if len(self._waiting) >= WAITING:
            self._lost += 1
            return
        at = datetime.fromtimestamp(self._wall_s(), UTC).isoformat(timespec="milliseconds")
        self._waiting.append({"at": at, **content})
        self._idle.clear()
        self._wanted.set()
        if self._writer is None:
            self._writer = asyncio.create_task(self._write())

    async def flushed(self) -> None:
        """Returns when all noted so far is on the disk."""
        await self._idle.wait()

    async def close(self, patience_s: float = 5.0) -> None:
        """What a full disk will not take within `patience_s` is lost, and logged."""
        with suppress(TimeoutError):
            async with asyncio.timeout(patience_s):
                await self.flushed()
        if self._waiting:
            log.error("%s entries of the audit log could not be written", len(self._waiting))
        if self._writer is not None:
            self._writer.cancel()
            await asyncio.gather(self._writer, return_exceptions=True)

    async def _write(self) -> None:
        failing = False
        while True:
            await self._wanted.wait()
            self._wanted.clear()
            batch = list(self._waiting)
            if self._lost:
                batch.append({"at": batch[-1]["at"], "call": "audit", "outcome": "lost", "entries": self._lost})
            try:
                await asyncio.to_thread(self._append, batch)
            except OSError as error:
                if not failing:
                    log.error("the audit log cannot be written, trying again: %s", error)
                failing = True
                await asyncio.sleep(RETRY_S)
                self._wanted.set()
                continue
            failing, self._lost = False, 0
            for _ in range(min(len(batch), len(self._waiting))):
                self._waiting.popleft()
            if self._waiting:
                self._wanted.set()
            else:
                self._idle.set()

    def _append(self, batch: list[dict[str, Any]]) -> None:
        assert self._path is not None
        self._path.parent.mkdir(parents=True, exist_ok=True)
        new = not self._path.exists()
        handle = os.open(self._path, os.O_RDWR | os.O_CREAT, 0o600)
        if new:
            same_owner(self._path)
        try:
            fcntl.flock(handle, fcntl.LOCK_EX)  # `crossfix recover` writes beside a server that runs
            if os.fstat(handle).st_size > self._end:
                self._head = None
            head = self._head or self._found(handle)
            lines: list[bytes] = []
            for content in batch:
                line, head = linked(head, content)
                lines.append(line)
            text = b"".join(lines)
            try:
                written = os.pwrite(handle, text, self._end)
                if written != len(text):
                    raise OSError(f"{written} of {len(text)} bytes were written")
                os.fsync(handle)
            except OSError:
                os.ftruncate(handle, self._end)
                raise
            self._head, self._end = head, self._end + len(text)
        finally:
            os.close(handle)

    def _found(self, handle: int) -> Head:
        """Where the log of before ended. A line that a power cut tore is cut off; it was never whole."""
        size = os.fstat(handle).st_size
        tail = os.pread(handle, TAIL_BYTES, max(0, size - TAIL_BYTES))
        whole = tail.rfind(b"\n") + 1
        self._end = size - (len(tail) - whole)
        if self._end != size:
            log.warning("the audit log ended in a torn line of %s bytes, which is cut off", size - self._end)
            os.ftruncate(handle, self._end)
        entry = read(tail[:whole].splitlines()[-1]) if whole else None
        if whole and entry is None:
            raise OSError("the audit log ends in what is no entry; look at it with `crossfix audit verify`")
        return Head() if entry is None else Head(entry["number"], entry["digest"])
