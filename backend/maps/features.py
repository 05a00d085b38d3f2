"""What reading an overlay file gives: features, the box around them, and notes on what was left out."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

from backend.maps.refusal import MapRefused
from backend.wire.maps import Box, OverlayCollection, OverlayFeature

MOST_FEATURES = 50_000
MOST_NOTES = 20
MOST_PROPERTIES = 50
MOST_TEXT = 4000


@dataclass
class Reading:
    features: list[OverlayFeature] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    unnamed_notes: int = 0

    def add(self, geometry: dict[str, Any], properties: dict[str, Any]) -> None:
        if len(self.features) >= MOST_FEATURES:
            raise MapRefused(
                f"The overlay has more than {MOST_FEATURES} features.",
                "Leave out what is not needed, or make a map package (PMTiles) of it.",
            )
        self.features.append(OverlayFeature(geometry=geometry, properties=plain_properties(properties)))

    def note(self, sentence: str) -> None:
        if len(self.notes) < MOST_NOTES:
            self.notes.append(sentence[:500])
        else:
            self.unnamed_notes += 1

    def all_notes(self) -> list[str]:
        more = [f"{self.unnamed_notes} more parts were left out."] if self.unnamed_notes else []
        return self.notes + more

    def collection(self) -> OverlayCollection:
        return OverlayCollection(features=self.features)

    def bounds(self) -> Box:
        positions = [position for feature in self.features for position in _positions(feature.geometry["coordinates"])]
        lon, lat = zip(*positions, strict=True)
        return min(lon), min(lat), max(lon), max(lat)


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
        if isinstance(value, str):
            plain[str(name)] = value[:MOST_TEXT]
        elif value is None or isinstance(value, bool | int | float):
            plain[str(name)] = value
        else:
            plain[str(name)] = json.dumps(value)[:MOST_TEXT]
    return plain
