"""The overlay folder: KML and GeoJSON files as GeoJSON feature collections on disk, each described beside it.

`ID.geojson` is the collection, ID the start of the SHA-256 of the file that was uploaded. Blocking; use threads.
"""

from __future__ import annotations

import hashlib
import json
import os
import shutil
from collections.abc import AsyncIterator
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path

from pydantic import ValidationError

from backend.maps.features import Reading, storable
from backend.maps.geojson import read_geojson
from backend.maps.kml import read_kml, read_kmz
from backend.maps.refusal import MapRefused, NotStored
from backend.maps.simplify import simplified
from backend.maps.upload import received
from backend.ports import Kept
from backend.reasons import REASONS
from backend.reasons.maps import NoRoomForMap, NothingToDraw, NotReadableAs, OverlayFormat, OverlayUnusable
from backend.reasons.request import BodyTooLarge
from backend.reasons.storage import StockFull
from backend.wire.maps import Overlay, OverlayCollection
from backend.workers import Workers

MOST_OVERLAY_BYTES = 20 * 10**6
ID_DIGITS = 16


@dataclass(frozen=True)
class OverlayFolder:
    """reserve_bytes: disk that no upload may take, kept for the journal. most, most_bytes: of all overlays together."""

    directory: Path
    reserve_bytes: int = 0
    most: int = 200
    most_bytes: int = 500 * 10**6

    def kept(self) -> Kept:
        """What is stored now."""
        sizes = [path.stat().st_size for path in self.directory.glob("*.geojson")]
        return Kept(len(sizes), sum(sizes))

    def overlays(self) -> tuple[list[Overlay], list[OverlayUnusable]]:
        """All overlays by name, and the descriptions that are none."""
        found: list[Overlay] = []
        unusable: list[OverlayUnusable] = []
        for path in sorted(self.directory.glob("*.json")):
            try:
                found.append(_description(path))
            except (OSError, ValueError, KeyError, TypeError, RecursionError):
                unusable.append(OverlayUnusable(path.name))
        return sorted(found, key=lambda overlay: overlay.name.casefold()), unusable

    def delete(self, overlay_id: str) -> None:
        """Raises NotStored."""
        path = self.path(overlay_id)
        path.with_suffix(".json").unlink(missing_ok=True)
        path.unlink()

    async def store(
        self, body: AsyncIterator[bytes], name: str, announced_bytes: int | None, now: datetime, workers: Workers
    ) -> Overlay:
        """Write an upload to disk, read it, and keep what it holds. Raises MapRefused, WorkStopped."""
        async with received(body, announced_bytes, self.directory, self.reserve_bytes, _look, now) as upload:
            return await workers.run(self.keep_file, upload.path, name, now)

    def keep_file(self, path: Path, name: str, added_at: datetime) -> Overlay:
        """What a file holds; the file itself is not needed any more."""
        return self.keep(path.read_bytes(), name, added_at)

    def keep(self, content: bytes, name: str, added_at: datetime) -> Overlay:
        """Read a file and keep what it holds. MapRefused when there is nothing in it that can be drawn, or no room."""
        overlay_id = hashlib.sha256(content).hexdigest()[:ID_DIGITS]
        kind, reading = read_overlay(content)
        if not reading.features:
            raise MapRefused(NothingToDraw(tuple(reading.all_notes())))
        bounds = reading.bounds()
        features, thinned = simplified(reading.features)
        overlay = Overlay(
            overlay_id=overlay_id,
            name=storable(name) or f"Overlay {overlay_id[:6]}",
            format=kind,
            features=len(features),
            bounds=bounds,
            notes=[*([] if thinned is None else [thinned]), *reading.all_notes()],
            added_at_utc=added_at,
        )
        collection = OverlayCollection(features=features).model_dump_json().encode()
        self._must_fit(overlay_id, len(collection))
        self._write(f"{overlay_id}.geojson", collection)
        self._write(f"{overlay_id}.json", overlay.model_dump_json().encode())
        return overlay

    def _must_fit(self, overlay_id: str, size: int) -> None:
        """What was stored before under the same id is replaced."""
        self.directory.mkdir(parents=True, exist_ok=True)
        kept, before = self.kept(), self.directory / f"{overlay_id}.geojson"
        old_bytes = before.stat().st_size if before.is_file() else None
        more = 0 if old_bytes is not None else 1
        if kept.number + more > self.most or kept.size_bytes - (old_bytes or 0) + size > self.most_bytes:
            raise MapRefused(StockFull("overlays", self.most, self.most_bytes))
        room = max(0, shutil.disk_usage(self.directory).free - self.reserve_bytes)
        if size > room:
            raise MapRefused(NoRoomForMap(size, room, self.reserve_bytes))

    def path(self, overlay_id: str) -> Path:
        """The GeoJSON file. Raises NotStored."""
        path = self.directory / f"{overlay_id}.geojson"
        if not path.is_file():
            raise NotStored("overlay", overlay_id)
        return path

    def _write(self, name: str, content: bytes) -> None:
        part = self.directory / f"{name}.part"
        part.write_bytes(content)
        os.replace(part, self.directory / name)


def _look(first_bytes: bytes, size: int) -> None:
    if size > MOST_OVERLAY_BYTES:
        raise MapRefused(BodyTooLarge(MOST_OVERLAY_BYTES, "other"))


def _description(path: Path) -> Overlay:
    """Notes that this version does not know, such as sentences of before they had names, are dropped."""
    stored = json.loads(path.read_bytes())
    notes = [note for note in stored["notes"] if _is_reason(note)]
    return Overlay.model_validate_json(json.dumps({**stored, "notes": notes}))


def _is_reason(note: object) -> bool:
    try:
        REASONS.adapter.validate_python(note)
    except ValidationError:
        return False
    return True


def read_overlay(content: bytes) -> tuple[OverlayFormat, Reading]:
    """By what the file is, not by its name."""
    start = content.removeprefix(b"\xef\xbb\xbf").lstrip()[:1]
    if content.startswith(b"PK\x03\x04"):
        return "kmz", read_kmz(content)
    if start == b"<":
        return "kml", read_kml(content)
    if start in (b"{", b"["):
        return "geojson", read_geojson(content)
    raise MapRefused(NotReadableAs(None, "other_format" if content else "empty"))
