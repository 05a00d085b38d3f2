"""Ways from a file: what they say they are, cut to the search, joined where they meet; hostile files are refused."""

from __future__ import annotations

import json
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest
from shapely.geometry import shape

from backend.maps.refusal import MapRefused
from backend.maps.upload import ABANDONED_S, remove_abandoned
from backend.maps.ways import MOST_POSITIONS, kind_of, read_ways
from backend.maps.ways_folder import WaysFolder
from backend.reasons.maps import NotReadableAs, PartLeftOut
from backend.reasons.ways import FarFromSearch, NeitherWayNorBarrier, NoWaysInFile, WaysTooFar, WaysTooMany
from backend.store.ways_files import WaysFiles
from backend.wire.ways import MissionWays

NOW = datetime(2026, 5, 1, 12, tzinfo=UTC)
AREA = [(7.0, 50.0), (7.01, 50.0), (7.01, 50.01), (7.0, 50.01)]
DATE_LINE = [(179.995, -17.0), (-179.995, -17.0), (-179.995, -16.99), (179.995, -16.99)]


def feature(kind: str, of: str, coordinates: object, **properties: object) -> dict[str, object]:
    geometry = {"type": of, "coordinates": coordinates}
    return {"type": "Feature", "geometry": geometry, "properties": {"kind": kind} | properties}


def road(*points: tuple[float, float], **properties: object) -> dict[str, object]:
    return feature("road", "LineString", points, **properties)


def read(*features: object, area=AREA) -> MissionWays:
    document = {"type": "FeatureCollection", "features": list(features)}
    return read_ways(json.dumps(document).encode(), area, "roads.geojson", NOW)


def refusal(*features: object, area=AREA):
    with pytest.raises(MapRefused) as refused:
        read(*features, area=area)
    return refused.value.reason


def shapes(ways: MissionWays, kind: str) -> list:
    return [shape(one.geometry) for one in ways.features if one.properties.kind == kind]


@pytest.mark.parametrize(
    ("properties", "kind"),
    [
        ({"kind": "barrier"}, "barrier"),
        ({"kind": "road", "natural": "water"}, "road"),
        ({"highway": "residential"}, "road"),
        ({"highway": "footway", "bridge": "yes"}, "path"),
        ({"highway": "motorway"}, None),
        ({"highway": "service", "access": "private"}, None),
        ({"natural": "cliff"}, "barrier"),
        ({"waterway": "river"}, "barrier"),
        ({"waterway": "river", "tunnel": "culvert"}, None),
        ({"name": "somewhere"}, None),
        ({"kind": ["road"]}, None),
        ({"kind": "Road?"}, None),
    ],
)
def test_a_part_is_what_it_says_it_is(properties: dict[str, object], kind: str | None) -> None:
    assert kind_of(properties) == kind


def test_lengths_barriers_and_what_was_left_out_are_told() -> None:
    ways = read(
        road((7.0, 50.0), (7.0, 50.01)),
        feature("path", "LineString", [(7.0, 50.0), (7.01, 50.0)]),
        feature("barrier", "Polygon", [[(7.0, 50.0), (7.001, 50.0), (7.001, 50.001), (7.0, 50.0)]]),
        feature("barrier", "LineString", [(7.005, 50.0), (7.005, 50.01)]),
        feature("", "LineString", [(7.0, 50.0), (7.0, 50.01)]),
        feature("road", "Point", (7.0, 50.0)),
        road((8.0, 52.0), (8.1, 52.0)),
        road((7.0, 5000.0), (7.0, 50.0)),
    )
    assert ways.roads_m == pytest.approx(1113.0, rel=0.01)
    assert ways.paths_m == pytest.approx(715.0, rel=0.01)
    assert ways.barriers == 2
    assert ways.notes == [
        PartLeftOut("feature", "8", "in_metres"),
        NeitherWayNorBarrier(2),
        FarFromSearch(1, 20_000.0),
    ]


def test_roads_that_cross_meet_but_a_bridge_passes_over() -> None:
    east_west, south_north = ((7.0, 50.005), (7.01, 50.005)), ((7.005, 50.0), (7.005, 50.01))
    (level,) = shapes(read(road(*east_west), road(*south_north)), "road")
    assert len(level.geoms) == 4
    (over,) = shapes(read(road(*east_west), road(*south_north, bridge="yes")), "road")
    assert len(over.geoms) == 2


def test_only_what_lies_on_the_ground_of_the_search_is_kept() -> None:
    ocean = feature("barrier", "Polygon", [[(-20, 20), (30, 20), (30, 70), (-20, 70), (-20, 20)]])
    (water,) = shapes(read(ocean, road((7.0, 50.0), (9.0, 50.0))), "barrier")
    assert water.bounds == pytest.approx((6.72, 49.82, 7.29, 50.19), abs=0.01)
    (kept,) = shapes(read(ocean, road((7.0, 50.0), (9.0, 50.0))), "road")
    assert kept.bounds[2] == pytest.approx(7.29, abs=0.01)


def test_a_barrier_that_crosses_itself_is_made_sound() -> None:
    bow_tie = [[(7.0, 50.0), (7.01, 50.01), (7.01, 50.0), (7.0, 50.01), (7.0, 50.0)]]
    (water,) = shapes(read(feature("barrier", "Polygon", bow_tie)), "barrier")
    assert water.is_valid
    assert water.area == pytest.approx(0.5 * 0.01 * 0.01, rel=0.01)


@pytest.mark.parametrize(
    "points",
    [
        [(179.99, -17.0), (-179.99, -17.0)],
        [(-179.99, -17.0), (179.99, -17.0)],
        [(180.01, -17.0), (179.99, -17.0)],
    ],
)
def test_a_road_over_the_antimeridian_is_as_short_as_it_is(points: list) -> None:
    if points[0][0] > 180.0:
        assert isinstance(refusal(road(*points), area=DATE_LINE), NoWaysInFile)
        return
    ways = read(road(*points), area=DATE_LINE)
    assert ways.roads_m == pytest.approx(2130.0, rel=0.01)
    (line,) = shapes(ways, "road")
    assert line.bounds == pytest.approx((179.99, -17.0, 180.01, -17.0))


def test_a_lake_cut_at_the_antimeridian_is_one_lake_again() -> None:
    west = [[(179.99, -17.0), (180.0, -17.0), (180.0, -16.99), (179.99, -16.99), (179.99, -17.0)]]
    east = [[(-180.0, -17.0), (-179.99, -17.0), (-179.99, -16.99), (-180.0, -16.99), (-180.0, -17.0)]]
    (lake,) = shapes(read(feature("barrier", "MultiPolygon", [west, east]), area=DATE_LINE), "barrier")
    assert len(lake.geoms) == 1
    assert lake.area == pytest.approx(0.02 * 0.01)


@pytest.mark.parametrize("at", [(7.0, 52.0), (-173.0, -50.0), (7.0, -50.0), (-7.0, 50.0)])
def test_what_lies_elsewhere_is_refused_with_how_far(at: tuple[float, float]) -> None:
    lon, lat = at
    reason = refusal(road((lon, lat), (lon + 0.01, lat)))
    assert isinstance(reason, WaysTooFar)
    assert reason.nearest_m > 100_000.0


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        (b"", NotReadableAs(None, "empty")),
        (b"hello", NotReadableAs(None, "other_format")),
        (b'{"type": "FeatureCollection", "features": []}', NoWaysInFile(0)),
        (json.dumps(feature("river", "LineString", AREA)).encode(), NoWaysInFile(1)),
    ],
)
def test_a_file_without_ways_says_what_is_missing(content: bytes, reason: object) -> None:
    with pytest.raises(MapRefused) as refused:
        read_ways(content, AREA, "", NOW)
    assert refused.value.reason == reason


def test_half_a_surrogate_pair_does_no_harm() -> None:
    content = json.dumps(road((7.0, 50.0), (7.0, 50.01), name="\ud800", **{"\udfff": "x"})).encode()
    ways = read_ways(content, AREA, "\ud800.geojson", NOW)
    assert ways.name == "?.geojson"
    ways.model_dump_json().encode("utf-8")


def test_more_positions_than_can_be_planned_on_are_refused() -> None:
    points = np.column_stack([np.linspace(7.0, 7.01, MOST_POSITIONS + 1), np.full(MOST_POSITIONS + 1, 50.0)])
    assert refusal(feature("path", "LineString", points.tolist())) == WaysTooMany(MOST_POSITIONS + 1, MOST_POSITIONS)


def test_the_last_upload_counts_until_it_is_forgotten(tmp_path: Path) -> None:
    folder = WaysFolder(WaysFiles(tmp_path))
    assert folder.traced("m-1") == ()
    assert MissionWays.model_validate_json(folder.json("m-1")) == MissionWays()
    for content, kinds in (
        (road((7.0, 50.0), (7.0, 50.01)), ["road"]),
        (feature("barrier", "LineString", [(7.0, 50.0), (7.0, 50.01)]), ["barrier"]),
    ):
        path = tmp_path / "sent"
        path.write_bytes(json.dumps(content).encode())
        assert folder.keep_file("m-1", AREA, path, "Roads", NOW).features == []
        assert [one.kind for one in folder.traced("m-1")] == kinds
    assert MissionWays.model_validate_json(folder.json("m-1")).name == "Roads"
    folder.forget("m-1")
    folder.forget("m-1")
    assert folder.traced("m-1") == ()


def test_notes_of_another_version_keep_nobody_from_the_ways(tmp_path: Path) -> None:
    files = WaysFiles(tmp_path)
    folder = WaysFolder(files)
    path = tmp_path / "upload"
    path.write_bytes(json.dumps(road((7.001, 50.001), (7.002, 50.001))).encode())
    folder.keep_file("m", AREA, path, "w", NOW)
    told = json.loads(folder.json("m"))
    files.path("m").write_text(json.dumps(told | {"notes": [{"code": "of_a_later_version"}]}))
    assert [one.kind for one in folder.traced("m")] == ["road"]


def test_the_rest_of_an_upload_that_ends_meanwhile_is_no_trouble(tmp_path: Path, monkeypatch) -> None:
    ended, abandoned = tmp_path / ".upload-ended.part", tmp_path / ".upload-abandoned.part"
    abandoned.touch()
    monkeypatch.setattr(Path, "glob", lambda folder, pattern: iter([ended, abandoned]))
    remove_abandoned(tmp_path, abandoned.stat().st_mtime + ABANDONED_S + 1.0)
    assert not abandoned.exists()
