"""GeoJSON from elsewhere: what can be drawn is drawn, what cannot is named."""

from __future__ import annotations

import json

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from backend.maps.geojson import read_geojson
from backend.maps.refusal import MapRefused
from backend.reasons.maps import GeometryFault, PartLeftOut
from planner.reason import remedy_of, text_of

SQUARE = [[7.0, 50.0], [7.1, 50.0], [7.1, 50.1], [7.0, 50.0]]


def read(document: object):
    return read_geojson(json.dumps(document).encode())


def read_or_refusal(document: object):
    try:
        return read(document)
    except MapRefused as refused:
        return refused


def collection(*geometries: object) -> dict[str, object]:
    features = [
        {"type": "Feature", "geometry": each, "properties": {"name": f"n{i}"}} for i, each in enumerate(geometries)
    ]
    return {"type": "FeatureCollection", "features": features}


def test_every_geometry_is_kept_without_its_heights() -> None:
    geometries = [
        {"type": "Point", "coordinates": [7.0, 50.0, 321.5]},
        {"type": "MultiPoint", "coordinates": [[7.0, 50.0], [7.1, 50.1]]},
        {"type": "LineString", "coordinates": [[7.0, 50.0], [7.1, 50.1]]},
        {"type": "MultiLineString", "coordinates": [[[7.0, 50.0], [7.1, 50.1]]]},
        {"type": "Polygon", "coordinates": [SQUARE]},
        {"type": "MultiPolygon", "coordinates": [[SQUARE]]},
    ]
    reading = read(collection(*geometries))
    assert reading.notes == []
    assert [feature.geometry["type"] for feature in reading.features] == [each["type"] for each in geometries]
    assert reading.features[0].geometry["coordinates"] == [7.0, 50.0]
    assert reading.features[4].geometry["coordinates"] == [SQUARE]
    assert reading.bounds() == (7.0, 50.0, 7.1, 50.1)
    assert reading.features[2].properties == {"name": "n2"}


def test_bare_geometries_and_features_are_read() -> None:
    point = {"type": "Point", "coordinates": [7, 50]}
    assert len(read(point).features) == 1
    assert len(read({"type": "Feature", "geometry": point, "properties": None}).features) == 1


def test_a_geometry_collection_becomes_its_members() -> None:
    members = [{"type": "Point", "coordinates": [7, 50]}, {"type": "LineString", "coordinates": [[7, 50], [8, 50]]}]
    reading = read(collection({"type": "GeometryCollection", "geometries": members}))
    assert [feature.geometry["type"] for feature in reading.features] == ["Point", "LineString"]


def test_a_ring_left_open_is_closed() -> None:
    reading = read(collection({"type": "Polygon", "coordinates": [SQUARE[:-1]]}))
    assert reading.features[0].geometry["coordinates"] == [SQUARE]


@pytest.mark.parametrize(
    ("geometry", "fault"),
    [
        (None, "missing"),
        ({"type": "Circle", "coordinates": [7, 50]}, "type_unknown"),
        ({"type": "Point", "coordinates": [50, 100]}, "swapped"),
        ({"type": "Point", "coordinates": [3_500_000, 5_600_000]}, "in_metres"),
        ({"type": "Point", "coordinates": ["7", "50"]}, "not_numbers"),
        ({"type": "Point", "coordinates": [True, False]}, "not_numbers"),
        ({"type": "Point", "coordinates": [7]}, "no_position"),
        ({"type": "LineString", "coordinates": [[7, 50]]}, "too_few_positions"),
        ({"type": "Polygon", "coordinates": [[[7, 50], [8, 50], [7, 50]]]}, "too_few_positions"),
        ({"type": "Polygon", "coordinates": []}, "too_few_positions"),
    ],
)
def test_what_cannot_be_drawn_is_left_out_and_named(geometry: object, fault: GeometryFault) -> None:
    reading = read(collection(geometry, {"type": "Point", "coordinates": [7, 50]}))
    assert len(reading.features) == 1
    assert reading.notes == [PartLeftOut("feature", '1 "n0"', fault)]


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"{", "not valid JSON"),
        (b"[1, 2]", "without a `type`"),
        (b"{}", "without a `type`"),
        (b'{"type": "FeatureCollection"}', "no list of `features`"),
        (b'{"type": "Point", "coordinates": [NaN, 1]}', "not valid JSON"),
        (b"[" * 100_000, "not valid JSON"),
        (b'{"type": "Point", "coordinates": [Infinity, 50]}', "not valid JSON"),
        ('{"type": "Punkt\u00e4"'.encode("latin-1"), "not valid JSON"),
    ],
)
def test_other_files_are_refused(content: bytes, words: str) -> None:
    with pytest.raises(MapRefused, match=words):
        read_geojson(content)


def test_another_coordinate_system_is_refused_by_its_name() -> None:
    crs = {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::25832"}}
    with pytest.raises(MapRefused, match="EPSG::25832, not WGS84"):
        read({**collection(), "crs": crs})
    known = {"type": "name", "properties": {"name": "urn:ogc:def:crs:OGC:1.3:CRS84"}}
    assert read({**collection({"type": "Point", "coordinates": [7, 50]}), "crs": known}).features


def test_nested_without_end_is_named() -> None:
    geometry: dict[str, object] = {"type": "Point", "coordinates": [7, 50]}
    for _ in range(50):
        geometry = {"type": "GeometryCollection", "geometries": [geometry]}
    assert read(collection(geometry)).notes == [PartLeftOut("feature", '1 "n0"', "nested_too_deep")]


NAMES = st.sampled_from(["type", "coordinates", "geometry", "geometries", "features", "properties", "crs", "name"])
KINDS = st.sampled_from(["Point", "LineString", "Polygon", "Feature", "FeatureCollection", "GeometryCollection"])
JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False, allow_infinity=False) | st.text(max_size=8),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(NAMES, inner | KINDS, max_size=5),
    max_leaves=25,
)


POSITION = st.lists(st.floats(-200, 200) | st.none(), max_size=3)
GEOMETRY = st.fixed_dictionaries(
    {"type": KINDS, "coordinates": st.recursive(POSITION, lambda inner: st.lists(inner, max_size=4), max_leaves=12)}
)


@settings(max_examples=200, deadline=None)
@given(JSON)
def test_any_json_is_read_as_what_reads_the_same_again_or_refused_with_a_remedy(document: object) -> None:
    reading = read_or_refusal(document)
    if isinstance(reading, MapRefused):
        assert str(reading)
        assert remedy_of(reading.reason)
        return
    again = read({"type": "FeatureCollection", "features": [feature.model_dump() for feature in reading.features]})
    assert again.features == reading.features
    assert again.notes == []


@settings(max_examples=200, deadline=None)
@given(st.lists(GEOMETRY | JSON, min_size=1, max_size=5))
def test_any_feature_is_drawn_on_earth_or_named(geometries: list[object]) -> None:
    reading = read(collection(*geometries))
    drawn = {feature.properties["name"] for feature in reading.features}
    empty = {"type": "GeometryCollection"}
    for number, geometry in enumerate(geometries):
        named = any(f'"n{number}"' in text_of(note) for note in reading.notes)
        assert named or f"n{number}" in drawn or (isinstance(geometry, dict) and empty.items() <= geometry.items())
    if reading.features:
        west, south, east, north = reading.bounds()
        assert -180 <= west <= east <= 180
        assert -90 <= south <= north <= 90
