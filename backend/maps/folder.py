"""The map folder: PMTiles archives on this machine's disk, each with a small JSON file beside it that names it.

`ID.pmtiles` is the archive, ID the start of its SHA-256. An upload is written to a hidden part file, checked whole, and
only then renamed: a map is there completely or not at all. What this module does to files is blocking; callers on an
event loop use threads.
"""

from __future__ import annotations

import hashlib
import json
import os
import re
import shutil
import tempfile
from collections.abc import AsyncIterator
from dataclasses import dataclass
from datetime import datetime
from functools import lru_cache
from pathlib import Path

import anyio.to_thread

from backend.maps.archive import HEADER_BYTES, Archive, read_header
from backend.maps.description import describe
from backend.maps.features import storable
from backend.maps.refusal import ArchiveUnusable, MapRefused, NotStored
from backend.reasons.maps import (
    MapLabelDamaged,
    MapUnusable,
    NoRoomForMap,
    PutByHand,
    UploadIncomplete,
)
from backend.wire.maps import MapPackage
from backend.workers import Workers
from hardware.reasons.table import FileUnreadable

BLOCK_BYTES = 2**20
ID_DIGITS = 16
ABANDONED_S = 6 * 3600.0
"""A part file not written to for so long is the rest of an upload that died with its server."""


@dataclass(frozen=True)
class MapFolder:
    """`reserve_bytes`: disk that no upload may take, kept for the journal."""

    directory: Path
    reserve_bytes: int

    def room_bytes(self) -> int:
        """How large an upload may be."""
        self.directory.mkdir(parents=True, exist_ok=True)
        return max(0, shutil.disk_usage(self.directory).free - self.reserve_bytes)

    def packages(self) -> tuple[list[MapPackage], list[MapUnusable]]:
        """All maps by name, and the files that are none."""
        self.directory.mkdir(parents=True, exist_ok=True)
        found: list[MapPackage] = []
        unusable: list[MapUnusable] = []
        for path in sorted(self.directory.glob("*.pmtiles")):
            if not re.fullmatch(r"[0-9a-f]{16}", path.stem):
                unusable.append(MapUnusable(path.name, PutByHand()))
                continue
            try:
                found.append(self.package(path.stem))
            except ArchiveUnusable as error:
                unusable.append(MapUnusable(path.name, error.reason))
            except OSError as error:
                unusable.append(MapUnusable(path.name, FileUnreadable(path.name, error.strerror or str(error))))
        return sorted(found, key=lambda package: package.name.casefold()), unusable

    def path(self, map_id: str) -> Path:
        """Raises NotStored."""
        path = self.directory / f"{map_id}.pmtiles"
        if not path.is_file():
            raise NotStored("map", map_id)
        return path

    def archive(self, map_id: str) -> Archive:
        """Opened once and kept while the file stays the same. Raises NotStored."""
        return _opened(self.path(map_id))

    def package(self, map_id: str) -> MapPackage:
        """What is known of one map. NotStored when there is none."""
        path = self.path(map_id)
        return _described(path, map_id, *self._label(map_id))

    def _label(self, map_id: str) -> tuple[str, datetime]:
        try:
            label = json.loads((self.directory / f"{map_id}.json").read_text("utf-8"))
            return storable(str(label["name"])), datetime.fromisoformat(label["added_at_utc"])
        except (OSError, ValueError, KeyError, TypeError) as error:
            raise ArchiveUnusable(MapLabelDamaged()) from error

    def delete(self, map_id: str) -> None:
        """Raises NotStored."""
        self.path(map_id).unlink()
        (self.directory / f"{map_id}.json").unlink(missing_ok=True)

    async def store(
        self, body: AsyncIterator[bytes], name: str, announced_bytes: int | None, now: datetime, workers: Workers
    ) -> MapPackage:
        """Write an upload to disk block by block, check it, and make it a map. Nothing is left of a refused one.

        Raises MapRefused as soon as the header shows that the file is none, or when it does not fit; WorkStopped.
        """
        if announced_bytes is not None:
            self._must_fit(announced_bytes, self.room_bytes())
        await anyio.to_thread.run_sync(self._remove_abandoned, now.timestamp())
        upload = await anyio.to_thread.run_sync(_Upload, self.directory)
        try:
            held = bytearray()
            async for piece in body:
                held += piece
                if len(held) >= BLOCK_BYTES:
                    await anyio.to_thread.run_sync(self._write, upload, bytes(held))
                    held.clear()
            await anyio.to_thread.run_sync(self._write, upload, bytes(held))
            if announced_bytes is not None and upload.size != announced_bytes:
                raise MapRefused(UploadIncomplete(upload.size, announced_bytes))
            await anyio.to_thread.run_sync(upload.finish)
            package = await workers.run(read_archive, upload.path, upload.map_id, name, now)
            await anyio.to_thread.run_sync(self._keep, upload, package)
            return package
        finally:
            upload.discard()

    def _remove_abandoned(self, now_s: float) -> None:
        for part in self.directory.glob(".upload-*.part"):
            if now_s - part.stat().st_mtime > ABANDONED_S:
                part.unlink(missing_ok=True)

    def _write(self, upload: _Upload, block: bytes) -> None:
        first = upload.size == 0
        if first:
            read_header(block[:HEADER_BYTES])
        self._must_fit(len(block), self.room_bytes())
        upload.write(block)

    def _must_fit(self, size: int, room: int) -> None:
        if size > room:
            raise MapRefused(NoRoomForMap(size, room, self.reserve_bytes))

    def _keep(self, upload: _Upload, package: MapPackage) -> None:
        kept = {"name": package.name, "added_at_utc": package.added_at_utc.isoformat()}
        _replace_text(self.directory / f"{package.map_id}.json", json.dumps(kept))
        os.replace(upload.path, self.directory / f"{package.map_id}.pmtiles")
        _sync_directory(self.directory)


def read_archive(path: Path, map_id: str, name: str, added_at: datetime) -> MapPackage:
    """An archive checked and described. name: "" for the one that it states itself. Raises ArchiveUnusable."""
    archive = Archive(path)
    archive.check()
    stated = archive.metadata().get("name")
    label = name.strip() or (stated.strip() if isinstance(stated, str) else "") or f"Map {map_id[:6]}"
    return describe(archive, map_id, storable(label[:120]), added_at)


class _Upload:
    """A part file that is being written, and the digest of what it holds."""

    def __init__(self, directory: Path) -> None:
        directory.mkdir(parents=True, exist_ok=True)
        descriptor, path = tempfile.mkstemp(prefix=".upload-", suffix=".part", dir=directory)
        self.file = os.fdopen(descriptor, "wb")
        self.path = Path(path)
        self.digest = hashlib.sha256()
        self.size = 0

    @property
    def map_id(self) -> str:
        return self.digest.hexdigest()[:ID_DIGITS]

    def write(self, block: bytes) -> None:
        self.file.write(block)
        self.digest.update(block)
        self.size += len(block)

    def finish(self) -> None:
        self.file.flush()
        os.fsync(self.file.fileno())
        self.file.close()

    def discard(self) -> None:
        self.file.close()
        self.path.unlink(missing_ok=True)


@lru_cache(maxsize=64)
def _opened(path: Path) -> Archive:
    """Archives do not change once they have a name made from their content."""
    return Archive(path)


@lru_cache(maxsize=64)
def _described(path: Path, map_id: str, name: str, added_at: datetime) -> MapPackage:
    return describe(_opened(path), map_id, name, added_at)


def _replace_text(path: Path, text: str) -> None:
    part = path.with_suffix(".json.part")
    part.write_text(text, "utf-8")
    os.replace(part, path)


def _sync_directory(directory: Path) -> None:
    descriptor = os.open(directory, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
