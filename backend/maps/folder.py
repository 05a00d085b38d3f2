"""The map folder: PMTiles archives on this machine's disk, each with a small JSON file beside it that names it.

`ID.pmtiles` is the archive, ID the start of its SHA-256. An upload is written to a hidden part file, checked whole, and
only then renamed: a map is there completely or not at all. What this module does to files is blocking; callers on an
event loop use threads.
"""

from __future__ import annotations

import json
import os
import re
from collections.abc import AsyncIterator
from dataclasses import dataclass
from datetime import datetime
from functools import lru_cache
from pathlib import Path

import anyio.to_thread

from backend.maps.archive import HEADER_BYTES, Archive, read_header
from backend.maps.description import describe
from backend.maps.features import storable
from backend.maps.refusal import ArchiveUnusable, NotStored
from backend.maps.upload import Upload, received, replace_text, room_bytes, sync_directory
from backend.reasons.maps import MapLabelDamaged, MapUnusable, PutByHand
from backend.wire.maps import MapPackage
from backend.workers import Workers
from hardware.reasons.table import FileUnreadable


@dataclass(frozen=True)
class MapFolder:
    """`reserve_bytes`: disk that no upload may take, kept for the journal."""

    directory: Path
    reserve_bytes: int

    def room_bytes(self) -> int:
        """How large an upload may be."""
        return room_bytes(self.directory, self.reserve_bytes)

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
        async with received(body, announced_bytes, self.directory, self.reserve_bytes, _look, now) as upload:
            package = await workers.run(read_archive, upload.path, upload.content_id, name, now)
            await anyio.to_thread.run_sync(self._keep, upload, package)
            return package

    def _keep(self, upload: Upload, package: MapPackage) -> None:
        kept = {"name": package.name, "added_at_utc": package.added_at_utc.isoformat()}
        replace_text(self.directory / f"{package.map_id}.json", json.dumps(kept))
        os.replace(upload.path, self.directory / f"{package.map_id}.pmtiles")
        sync_directory(self.directory)


def read_archive(path: Path, map_id: str, name: str, added_at: datetime) -> MapPackage:
    """An archive checked and described. name: "" for the one that it states itself. Raises ArchiveUnusable."""
    archive = Archive(path)
    archive.check()
    stated = archive.metadata().get("name")
    label = name.strip() or (stated.strip() if isinstance(stated, str) else "") or f"Map {map_id[:6]}"
    return describe(archive, map_id, storable(label[:120]), added_at)


def _look(first_bytes: bytes, size: int) -> None:
    if first_bytes or size == 0:
        read_header(first_bytes[:HEADER_BYTES])


@lru_cache(maxsize=64)
def _opened(path: Path) -> Archive:
    """Archives do not change once they have a name made from their content."""
    return Archive(path)


@lru_cache(maxsize=64)
def _described(path: Path, map_id: str, name: str, added_at: datetime) -> MapPackage:
    return describe(_opened(path), map_id, name, added_at)
