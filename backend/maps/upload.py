"""A file that comes in over HTTP, block by block onto the disk: whole and checked, or nothing is left of it."""

from __future__ import annotations

import hashlib
import os
import shutil
import tempfile
from collections.abc import AsyncGenerator, AsyncIterator, Callable
from contextlib import asynccontextmanager, suppress
from datetime import datetime
from pathlib import Path

import anyio.to_thread

from backend.maps.refusal import MapRefused
from backend.reasons.maps import NoRoomForMap, UploadIncomplete

BLOCK_BYTES = 2**20
ID_DIGITS = 16
ABANDONED_S = 6 * 3600.0
"""A part file that was not written to for this long was left by an upload that died with its server."""


class Upload:
    """A part file that is being written, and the digest of what it holds."""

    def __init__(self, directory: Path) -> None:
        directory.mkdir(parents=True, exist_ok=True)
        descriptor, path = tempfile.mkstemp(prefix=".upload-", suffix=".part", dir=directory)
        self.file = os.fdopen(descriptor, "wb")
        self.path = Path(path)
        self._digest = hashlib.sha256()
        self.size = 0

    @property
    def content_id(self) -> str:
        """The same file gets the same one."""
        return self._digest.hexdigest()[:ID_DIGITS]

    def write(self, block: bytes) -> None:
        """Raises OSError."""
        self.file.write(block)
        self._digest.update(block)
        self.size += len(block)

    def finish(self) -> None:
        """All of it is on the disk."""
        self.file.flush()
        os.fsync(self.file.fileno())
        self.file.close()

    def discard(self) -> None:
        """Nothing happens to a file that was renamed."""
        self.file.close()
        self.path.unlink(missing_ok=True)


def room_bytes(directory: Path, reserve_bytes: int) -> int:
    """How large an upload may be. reserve_bytes: disk that none may take, kept for the journal."""
    directory.mkdir(parents=True, exist_ok=True)
    return max(0, shutil.disk_usage(directory).free - reserve_bytes)


@asynccontextmanager
async def received(
    body: AsyncIterator[bytes],
    announced_bytes: int | None,
    directory: Path,
    reserve_bytes: int,
    look: Callable[[bytes, int], None],
    now: datetime,
) -> AsyncGenerator[Upload]:
    """The whole body in a part file of this directory, gone afterwards unless it was renamed.

    look: raises when it sees the first bytes (and the size so far, before each block) of a file that is none of ours.
    Raises MapRefused when it does not fit, or broke off.
    """

    def must_fit(size: int) -> None:
        room = room_bytes(directory, reserve_bytes)
        if size > room:
            raise MapRefused(NoRoomForMap(size, room, reserve_bytes))

    def write(block: bytes) -> None:
        look(block if upload.size == 0 else b"", upload.size + len(block))
        must_fit(len(block))
        upload.write(block)

    if announced_bytes is not None:
        must_fit(announced_bytes)
    await anyio.to_thread.run_sync(remove_abandoned, directory, now.timestamp())
    upload = await anyio.to_thread.run_sync(Upload, directory)
    try:
        held = bytearray()
        async for piece in body:
            held += piece
            if len(held) >= BLOCK_BYTES:
                await anyio.to_thread.run_sync(write, bytes(held))
                held.clear()
        await anyio.to_thread.run_sync(write, bytes(held))
        if announced_bytes is not None and upload.size != announced_bytes:
            raise MapRefused(UploadIncomplete(upload.size, announced_bytes))
        await anyio.to_thread.run_sync(upload.finish)
        yield upload
    finally:
        upload.discard()


def remove_abandoned(directory: Path, now_s: float) -> None:
    """The rests of uploads that died with their server."""
    for part in directory.glob(".upload-*.part"):
        with suppress(FileNotFoundError):  # another upload has ended meanwhile
            if now_s - part.stat().st_mtime > ABANDONED_S:
                part.unlink()


def replace_text(path: Path, text: str) -> None:
    """All of it or nothing. Raises OSError."""
    part = path.with_suffix(f"{path.suffix}.part")
    with part.open("w", encoding="utf-8") as file:
        file.write(text)
        file.flush()
        os.fsync(file.fileno())
    os.replace(part, path)


def sync_directory(directory: Path) -> None:
    """What was renamed in it stays so when the power fails."""
    descriptor = os.open(directory, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
