"""A large overlay is thinned so that every look at the map stays quick, and says so."""

from __future__ import annotations

import math

from backend.maps.simplify import MOST_POSITIONS, simplified
from backend.reasons.maps import PositionsThinned
from backend.wire.maps import OverlayFeature


def feature(kind: str, coordinates: list) -> OverlayFeature:
    return OverlayFeature(geometry={"type": kind, "coordinates": coordinates}, properties={"name": kind})


def wave(positions: int) -> list[list[float]]:
    return [[7 + k / positions, 50 + 0.01 * math.sin(k / positions * 20)] for k in range(positions)]


def test_a_small_overlay_stays_as_it_is() -> None:
    features = [feature("LineString", wave(1000)), feature("Point", [7.0, 50.0])]
    assert simplified(features) == (features, None)


def test_a_large_one_is_thinned_within_the_stated_tolerance() -> None:
    line, point = feature("LineString", wave(3 * MOST_POSITIONS)), feature("Point", [7.0, 50.0])
    (thinner, same), note = simplified([line, point])
    assert same == point
    assert isinstance(note, PositionsThinned)
    assert (note.before, note.after) == (3 * MOST_POSITIONS + 1, len(thinner.geometry["coordinates"]) + 1)
    assert note.after <= MOST_POSITIONS
    assert thinner.properties == line.properties
    off_deg = max(abs(lat - (50 + 0.01 * math.sin((lon - 7) * 20))) for lon, lat in thinner.geometry["coordinates"])
    assert off_deg * 111_320 <= note.tolerance_m


def test_small_rings_keep_their_shape_when_there_are_too_many() -> None:
    ring = [[7.0, 50.0], [7.00001, 50.0], [7.00001, 50.00001], [7.0, 50.00001], [7.0, 50.0]]
    features = [feature("Polygon", [ring]) for _ in range(30)]
    thinner, note = simplified(features, most=100)
    assert note is not None
    assert all(one.geometry["type"] == "Polygon" and len(one.geometry["coordinates"][0]) >= 4 for one in thinner)
