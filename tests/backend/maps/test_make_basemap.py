"""The basemap that ships, and how it is made."""

from __future__ import annotations

import gzip
import json
from itertools import accumulate
from pathlib import Path
from typing import Any

import pytest
from shapely.geometry import Point, Polygon

from backend.maps.make_basemap import LIMIT_BYTES, MADE, basemap, steps


def line_of(made: list[int], scale: int) -> list[tuple[float, float]]:
    return [(x / scale, y / scale) for x, y in zip(accumulate(made[::2]), accumulate(made[1::2]), strict=True)]


def test_what_ships_is_small_and_shows_the_world():
    stored = MADE.read_bytes()
    world = json.loads(gzip.decompress(stored))
    land = [Polygon(line_of(rings[0], world["scale"])) for rings in world["land"]]
    inside = {name: any(one.contains(Point(at)) for one in land) for name, at in PLACES.items()}
    assert inside == {"Bonn": True, "Nairobi": True, "the Atlantic": False, "the North Sea": False}
    assert "Berlin" in [name for *_, name in world["towns"]]
    assert len(stored) <= LIMIT_BYTES


PLACES = {"Bonn": (7.1, 50.7), "Nairobi": (36.8, -1.3), "the Atlantic": (-30.0, 30.0), "the North Sea": (3.0, 56.0)}


def test_a_line_is_told_by_its_steps_and_what_moves_nowhere_is_left_out():
    assert steps([(7.0, 50.0), (7.001, 50.001), (7.5, 49.98)]) == [700, 5000, 50, -2]


def theme(folder: Path, file: str, geometry: dict[str, Any], **told: Any) -> None:
    features = [{"type": "Feature", "properties": told, "geometry": geometry}]
    (folder / f"{file}.json").write_text(json.dumps({"features": features}))


def test_small_islands_are_left_out_and_the_same_files_make_the_same_bytes(tmp_path: Path):
    island = [[[0, 0], [0.05, 0], [0.05, 0.05], [0, 0]]]
    mainland = [[[10, 0], [12, 0], [12, 2], [10, 2], [10, 0]]]
    theme(tmp_path, "ne_50m_land", {"type": "MultiPolygon", "coordinates": [island, mainland]})
    theme(tmp_path, "ne_50m_lakes", {"type": "Polygon", "coordinates": island})
    theme(tmp_path, "ne_50m_rivers_lake_centerlines", {"type": "LineString", "coordinates": [[10, 0], [11, 1]]})
    theme(tmp_path, "ne_50m_populated_places_simple", {"type": "Point", "coordinates": [11, 1]}, name="Ax", scalerank=4)
    made = basemap(tmp_path)
    world = json.loads(gzip.decompress(made))
    assert [len(world[what]) for what in ("land", "lakes", "rivers")] == [1, 0, 1]
    assert world["towns"] == [[1100, 100, 4, "Ax"]]
    assert basemap(tmp_path) == made


def test_a_missing_theme_is_named(tmp_path: Path):
    with pytest.raises(FileNotFoundError, match=r"ne_50m_land\.json is missing"):
        basemap(tmp_path)
