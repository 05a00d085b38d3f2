"""The overlay folder: KML and GeoJSON files as GeoJSON feature collections on disk, each described beside it.

`ID.geojson` is the collection, ID the start of the SHA-256 of the file that was uploaded. Blocking; use threads.
"""

from __future__ import annotations

import hashlib
import json
import os
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path

from backend.maps.features import Reading
from backend.maps.geojson import read_geojson
from backend.maps.kml import read_kml, read_kmz
from backend.maps.refusal import MapRefused, NotStored
from backend.reasons.maps import NothingToDraw, NotReadableAs, OverlayFormat
from backend.wire.maps import Overlay, OverlayCollection

MOST_OVERLAY_BYTES = 20 * 10**6
ID_DIGITS = 16


@dataclass(frozen=True)
class OverlayFolder:
    directory: Path

    def overlays(self) -> list[Overlay]:
        """By name."""
        found = [_description(path) for path in self.directory.glob("*.json")]
        return sorted(found, key=lambda overlay: overlay.name.casefold())

    def collection(self, overlay_id: str) -> OverlayCollection:
        return OverlayCollection.model_validate_json(self._path(overlay_id).read_bytes())

    def delete(self, overlay_id: str) -> None:
        path = self._path(overlay_id)
        path.with_suffix(".json").unlink(missing_ok=True)
        path.unlink()

    def store(self, content: bytes, name: str, added_at: datetime) -> Overlay:
        """Read a file and keep what it holds. MapRefused when there is nothing in it that can be drawn."""
        kind, reading = read_overlay(content)
        if not reading.features:
            raise MapRefused(NothingToDraw(tuple(reading.all_notes())))
        overlay_id = hashlib.sha256(content).hexdigest()[:ID_DIGITS]
        overlay = Overlay(
            overlay_id=overlay_id,
            name=name or f"Overlay {overlay_id[:6]}",
            format=kind,
            features=len(reading.features),
            bounds=reading.bounds(),
            notes=[*reading.all_notes()],
            added_at_utc=added_at,
        )
        self.directory.mkdir(parents=True, exist_ok=True)
        self._write(f"{overlay_id}.geojson", reading.collection().model_dump_json())
        self._write(f"{overlay_id}.json", overlay.model_dump_json())
        return overlay

    def _path(self, overlay_id: str) -> Path:
        path = self.directory / f"{overlay_id}.geojson"
        if not path.is_file():
            raise NotStored("overlay", overlay_id)
        return path

    def _write(self, name: str, text: str) -> None:
        part = self.directory / f"{name}.part"
        part.write_text(text, "utf-8")
        os.replace(part, self.directory / name)


def _description(path: Path) -> Overlay:
    """Notes that were stored as sentences, before they had names, are dropped."""
    stored = json.loads(path.read_bytes())
    named = [note for note in stored["notes"] if not isinstance(note, str)]
    return Overlay.model_validate_json(json.dumps({**stored, "notes": named}))


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
