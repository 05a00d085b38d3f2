"""Areas out of files, and what is said about files that hold none."""

from __future__ import annotations

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st
from shapely import GEOSException

from backend.api import areas
from backend.api.areas import read_area
from backend.reasons.maps import NotAreas, PolygonsUnited
from backend.reasons.search import OutlineUnusable
from backend.search.errors import MissionInputError
from backend.wire.resources import AreaUpload
from planner.reason import remedy_of

RING = [[7.2, 50.6], [7.203, 50.6], [7.203, 50.602], [7.2, 50.602], [7.2, 50.6]]
FAR = [[7.21, 50.6], [7.213, 50.6], [7.213, 50.602], [7.21, 50.6]]
HOLE = [[7.201, 50.6005], [7.202, 50.6005], [7.202, 50.601], [7.201, 50.6005]]
POLYGON = {"type": "Polygon", "coordinates": [RING]}
COORDINATES = " ".join(f"{lon},{lat},0" for lon, lat in RING)
KML = f"""<?xml version="1.0"?><kml xmlns="http://www.opengis.net/kml/2.2"><Document><Placemark><name>A</name>
<Polygon><outerBoundaryIs><LinearRing><coordinates>{COORDINATES}</coordinates></LinearRing></outerBoundaryIs></Polygon>
</Placemark></Document></kml>"""


def read(document) -> tuple:
    text = document if isinstance(document, str) else json.dumps(document)
    found = read_area(AreaUpload(text=text))
    return found, found.area.model_dump(mode="json")


@pytest.mark.parametrize(
    "document",
    [
        POLYGON,
        {"type": "Feature", "properties": None, "geometry": POLYGON},
        {"type": "FeatureCollection", "features": [{"type": "Feature", "properties": {}, "geometry": POLYGON}]},
        {"type": "GeometryCollection", "geometries": [POLYGON]},
        {"type": "MultiPolygon", "coordinates": [[RING]]},
        {"type": "Polygon", "coordinates": [RING[:-1]]},
        {"type": "Polygon", "coordinates": [[[lon, lat, 120.0] for lon, lat in RING]]},
        "\ufeff" + json.dumps(POLYGON),
        KML,
    ],
)
def test_one_polygon_is_found_in_every_wrapping(document):
    found, area = read(document)
    assert area["type"] == "Polygon"
    assert sorted(map(tuple, area["coordinates"][0][:-1])) == sorted(map(tuple, RING[:-1]))
    assert found.vertices == 4
    assert found.area_m2 == pytest.approx(212.3 * 222.5, rel=0.02)
    assert found.format == ("kml" if isinstance(document, str) and "<kml" in document else "geojson")


def test_a_hole_stays_a_hole_and_islands_stay_apart():
    found, area = read({"type": "MultiPolygon", "coordinates": [[RING, HOLE], [FAR]]})
    assert area["type"] == "MultiPolygon"
    assert sorted(len(rings) for rings in area["coordinates"]) == [1, 2]
    assert found.vertices == 10


def test_overlapping_polygons_are_united_and_it_says_so():
    shifted = [[lon + 0.001, lat] for lon, lat in RING]
    found, area = read({"type": "MultiPolygon", "coordinates": [[RING], [shifted]]})
    assert area["type"] == "Polygon"
    assert found.notes == [PolygonsUnited(polygons=2, areas=1)]


def test_what_is_left_out_is_named():
    point = {"type": "Feature", "properties": {}, "geometry": {"type": "Point", "coordinates": [7, 50]}}
    area = {"type": "Feature", "properties": {}, "geometry": POLYGON}
    found, _ = read({"type": "FeatureCollection", "features": [point, area]})
    assert found.notes == [NotAreas(1)]


@pytest.mark.parametrize(
    ("document", "says"),
    [
        ("no file at all", "JSON"),
        ("<html></html>", "KML"),
        ("<!DOCTYPE kml [<!ENTITY a 'b'>]><kml>&a;</kml>", "document type"),
        ({"type": "LineString", "coordinates": RING}, "no polygon"),
        ({"type": "FeatureCollection", "features": []}, "no polygon"),
        ({"type": "Polygon", "coordinates": [[[7, 50], [8, 51], [8, 50], [7, 51], [7, 50]]]}, "cross"),
        ({"type": "Polygon", "coordinates": [[[7, 50], [7, 50], [7, 50], [7, 50]]]}, "corners"),
        ({"type": "Polygon", "coordinates": [[[500000, 5600000], [500100, 5600000], [500100, 5600100]]]}, "no polygon"),
    ],
)
def test_what_is_wrong_is_said_in_a_sentence(document, says):
    with pytest.raises(MissionInputError, match=says) as refused:
        read(document)
    assert remedy_of(refused.value.reason)


@given(st.text(min_size=1) | st.recursive(st.none() | st.floats() | st.text(), st.lists).map(json.dumps))
def test_no_text_makes_it_stumble(text):
    with pytest.raises(MissionInputError):
        read_area(AreaUpload(text=text))


EAST = [[179.995, 50.0], [180.0, 50.0], [180.0, 50.005], [179.995, 50.005], [179.995, 50.0]]
WEST = [[-180.0, 50.0], [-179.995, 50.0], [-179.995, 50.005], [-180.0, 50.005], [-180.0, 50.0]]
ACROSS = [[179.995, 50.0], [-179.995, 50.0], [-179.995, 50.005], [179.995, 50.005], [179.995, 50.0]]
BESIDE_IT = [[179.999, 50.001], [-179.999, 50.001], [-179.999, 50.002], [179.999, 50.001]]


@pytest.mark.parametrize("rings", [[[ACROSS]], [[EAST], [WEST]], [[ACROSS], [BESIDE_IT]], [[ACROSS, BESIDE_IT]]])
def test_an_area_across_the_antimeridian_is_one(rings):
    """As drawn, as an export cut it in two, and with what an export has beside it."""
    found, area = read({"type": "MultiPolygon", "coordinates": rings})
    assert area["type"] == "Polygon"
    lons = [lon for lon, _ in area["coordinates"][0]]
    assert all(-180.0 <= lon <= 180.0 for lon in lons)
    assert (min(abs(lon) for lon in lons), min(lons) < 0.0 < max(lons)) == (pytest.approx(179.995), True)
    hole = 0.5 * 143.4 * 111.2 if len(rings[0]) > 1 else 0.0
    assert found.area_m2 == pytest.approx(717.0 * 556.2 - hole, rel=0.02)


def test_an_outline_that_the_geometry_library_cannot_unite_is_refused(monkeypatch):
    def broken(shapes):
        raise GEOSException("TopologyException: side location conflict")

    monkeypatch.setattr(areas, "unary_union", broken)
    with pytest.raises(MissionInputError) as refused:
        read(POLYGON)
    assert refused.value.reason == OutlineUnusable("area", "not_simple")
