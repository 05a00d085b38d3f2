"""What the list of missions shows and asks of one besides its state: where it was, what it looked for, a small map.

Folded from the facts beside the digest, so that a list is one query however many missions there are.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from backend.events import (
    AreaChanged,
    BearingMeasured,
    BeliefUpdated,
    Event,
    MissionDeleted,
    MissionDrafted,
    MissionEdited,
    MissionLabelled,
    MissionRestored,
    MissionStarted,
    TruthNoted,
)
from backend.spec import Area, MissionSpec, Place, Polygon

Point = list[float]
"""Longitude, latitude, to a tenth of a metre."""

MOST_CORNERS, MOST_PLACES = 24, 40


@dataclass(frozen=True, slots=True)
class LibraryEntry:
    """Columns of the missions table. tags: one a line. sought, vehicles: what is searched in, lower case. west, south,
    east, north: of the area, degrees, west of one across the antimeridian larger than east; None before there is one.
    truths: emitters of which somebody told whether and where it was found.

    sketch: outline (rings of the area, thinned), places (of bearings), found and truth (by emitter id; truth None:
    looked for and not found).
    """

    tags: str = ""
    notes: str = ""
    deleted_at_us: int | None = None
    sought: str = ""
    vehicles: str = ""
    west: float | None = None
    south: float | None = None
    east: float | None = None
    north: float | None = None
    truths: int = 0
    sketch: Mapping[str, Any] = field(default_factory=dict[str, Any])


def advance(entry: LibraryEntry, event: Event, at_us: int) -> LibraryEntry:
    """After one fact."""
    match event:
        case MissionDrafted(spec=spec) | MissionEdited(spec=spec):
            return replace(_somewhere(entry, spec.area), sought=_sought(spec))
        case AreaChanged(search=search):
            return _somewhere(entry, search.area)
        case MissionStarted(craft_id=craft_id) if craft_id.lower() not in entry.vehicles.split():
            return replace(entry, vehicles=f"{entry.vehicles} {craft_id.lower()}".strip())
        case BearingMeasured(place=place):
            before = entry.sketch.get("places", [])
            return _drawn(entry, places=[*before, _point(place)]) if len(before) < MOST_PLACES else entry
        case BeliefUpdated(emitter_id=emitter_id, measured_estimate=estimate):
            found = {name: at for name, at in entry.sketch.get("found", {}).items() if name != emitter_id}
            if estimate is not None:
                found[emitter_id] = _point(Place(lat=estimate.lat, lon=estimate.lon))
            return _drawn(entry, found=found)
        case TruthNoted(emitter_id=emitter_id, place=place):
            truth = {**entry.sketch.get("truth", {}), emitter_id: None if place is None else _point(place)}
            return replace(_drawn(entry, truth=truth), truths=len(truth))
        case MissionLabelled(tags=tags, notes=notes):
            return replace(entry, tags="\n".join(tags), notes=notes.replace("\x00", ""))
        case MissionDeleted():
            return replace(entry, deleted_at_us=at_us)
        case MissionRestored():
            return replace(entry, deleted_at_us=None)
        case _:
            return entry


def _drawn(entry: LibraryEntry, **parts: object) -> LibraryEntry:
    return replace(entry, sketch={**entry.sketch, **parts})


def _somewhere(entry: LibraryEntry, area: Area) -> LibraryEntry:
    polygons = [area.coordinates] if isinstance(area, Polygon) else area.coordinates
    outlines = [[_rounded(lon, lat) for lon, lat in rings[0]] for rings in polygons]
    lons, lats = zip(*(corner for ring in outlines for corner in ring), strict=True)
    west, east = min(lons), max(lons)
    if east - west > 180.0:  # no area is that wide: it lies across the antimeridian
        west, east = min(lon for lon in lons if lon > 0.0), max(lon for lon in lons if lon <= 0.0)
    placed = replace(entry, west=west, south=min(lats), east=east, north=max(lats))
    return _drawn(placed, outline=[ring[:: max(1, -(-len(ring) // MOST_CORNERS))] for ring in outlines])


def _sought(spec: MissionSpec) -> str:
    words = [word for one in spec.emitters for word in (one.emitter_id, one.label, f"{one.frequency_hz / 1e6:.10g}")]
    return " ".join(words).lower().replace("\x00", "")


def _point(place: Place) -> Point:
    return _rounded(place.lon, place.lat)


def _rounded(lon: float, lat: float) -> Point:
    return [round(lon, 6), round(lat, 6)]
