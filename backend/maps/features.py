"""What reading an overlay file gives: features, the box around them, and notes on what was left out."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any, Literal

from backend.maps.refusal import MapRefused
from backend.reasons.maps import GeometryFault, LeftOut, MoreLeftOut, PartLeftOut, TooManyFeatures
from backend.wire.maps import Box, OverlayFeature

MOST_FEATURES = 50_000
MOST_NOTES = 20
MOST_PROPERTIES = 50
MOST_TEXT = 4000
MOST_NAME = 200
"""Characters of a name in a note."""
MARKUP = re.compile(r"<[^<>]*>")
"""A tag of HTML. One that never closes ends at the next "<": a search through n of them takes n steps, not n²."""


def storable(text: str) -> str:
    """With a question mark for each half of a surrogate pair, which JSON can name and UTF-8 cannot hold."""
    return text.encode("utf-8", "replace").decode()


@dataclass
class Reading:
    """unnamed_notes: how many more there were than MOST_NOTES."""

    features: list[OverlayFeature] = field(default_factory=list[OverlayFeature])
    notes: list[LeftOut] = field(default_factory=list[LeftOut])
    unnamed_notes: int = 0

    def add(self, geometry: dict[str, Any], properties: dict[str, Any]) -> None:
        """geometry: GeoJSON, checked by the caller. Raises MapRefused beyond MOST_FEATURES."""
        if len(self.features) >= MOST_FEATURES:
            raise MapRefused(TooManyFeatures(MOST_FEATURES))
        self.features.append(OverlayFeature(geometry=geometry, properties=plain_properties(properties)))

    def note(self, left_out: LeftOut) -> None:
        """Beyond MOST_NOTES they are only counted."""
        if len(self.notes) < MOST_NOTES:
            self.notes.append(left_out)
        else:
            self.unnamed_notes += 1

    def leave_out(self, part: Literal["feature", "placemark"], number: int, name: object, fault: GeometryFault) -> None:
        """name: as the file calls it; only a text that is not empty is one."""
        called = f' "{storable(name[:MOST_NAME])}"' if isinstance(name, str) and name else ""
        self.note(PartLeftOut(part, f"{number}{called}", fault))

    def all_notes(self) -> list[LeftOut]:
        """With the count of the unnamed ones at the end."""
        more = [MoreLeftOut(self.unnamed_notes)] if self.unnamed_notes else []
        return [*self.notes, *more]

    def bounds(self) -> Box:
        """(west, south, east, north) degrees. Raises ValueError when nothing was read."""
        boxes = [_box(feature.geometry["coordinates"]) for feature in self.features]
        west, south, east, north = zip(*boxes, strict=True)
        return min(west), min(south), max(east), max(north)


def _box(coordinates: Any) -> Box:
    west = south = math.inf
    east = north = -math.inf
    for lon, lat in _positions(coordinates):
        west, south, east, north = min(west, lon), min(south, lat), max(east, lon), max(north, lat)
    return west, south, east, north


def _positions(coordinates: Any) -> Iterator[tuple[float, float]]:
    if coordinates and isinstance(coordinates[0], float):
        yield coordinates[0], coordinates[1]
        return
    for part in coordinates:
        yield from _positions(part)


def plain_properties(properties: dict[str, Any]) -> dict[str, Any]:
    """Numbers, truth values and texts as they are, anything nested as JSON text; long texts are cut."""
    plain: dict[str, Any] = {}
    for name, value in list(properties.items())[:MOST_PROPERTIES]:
        key = storable(str(name)[:MOST_NAME])
        if isinstance(value, str):
            plain[key] = storable(value[:MOST_TEXT])
        elif value is None or isinstance(value, bool | int | float):
            plain[key] = value
        else:
            plain[key] = json.dumps(value)[:MOST_TEXT]
    return plain
