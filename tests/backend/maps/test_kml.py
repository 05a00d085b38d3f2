"""KML and KMZ as other programs write them."""

from __future__ import annotations

import io
import zipfile

import pytest

from backend.maps.kml import read_kml, read_kmz
from backend.maps.refusal import MapRefused
from backend.reasons.maps import FileLeftOut, KindLeftOut, PartLeftOut


def kml(body: str) -> bytes:
    return (
        f'<?xml version="1.0"?><kml xmlns="http://www.opengis.net/kml/2.2"><Document>{body}</Document></kml>'.encode()
    )


def placemark(inside: str) -> str:
    return f"<Placemark>{inside}</Placemark>"


POINT = "<Point><coordinates>7.0,50.0,300</coordinates></Point>"


def test_placemarks_become_features_with_names_and_attributes() -> None:
    reading = read_kml(
        kml(
            placemark(
                "<name>Nest</name><description><![CDATA[<b>bold</b> words]]></description>"
                '<ExtendedData><Data name="count"><value>3</value></Data>'
                '<SchemaData><SimpleData name="kind">owl</SimpleData></SchemaData></ExtendedData>' + POINT
            )
        )
    )
    (feature,) = reading.features
    assert feature.geometry == {"type": "Point", "coordinates": [7.0, 50.0]}
    assert feature.properties == {"count": "3", "kind": "owl", "name": "Nest", "description": "bold  words"}


def test_a_polygon_keeps_its_holes_behind_its_outline() -> None:
    ring = "<LinearRing><coordinates>{}</coordinates></LinearRing>"
    outer = ring.format("7,50 7.3,50 7.3,50.3 7,50")
    inner = ring.format("7.1 ,50.05\n7.2, 50.05\t7.2 , 50.1 7.1,50.05")
    reading = read_kml(
        kml(
            placemark(
                f"<Polygon><innerBoundaryIs>{inner}</innerBoundaryIs><outerBoundaryIs>{outer}</outerBoundaryIs></Polygon>"
            )
        )
    )
    outline, hole = reading.features[0].geometry["coordinates"]
    assert outline[0] == [7.0, 50.0]
    assert hole == [[7.1, 50.05], [7.2, 50.05], [7.2, 50.1], [7.1, 50.05]]


def test_multigeometry_and_tracks_are_taken_apart() -> None:
    coords = "<gx:coord>7 50 1</gx:coord><gx:coord>8 51 1</gx:coord>"
    track = f'<gx:Track xmlns:gx="http://www.google.com/kml/ext/2.2">{coords}</gx:Track>'
    reading = read_kml(kml(placemark(f"<MultiGeometry>{POINT}{POINT}</MultiGeometry>") + placemark(track)))
    assert [feature.geometry["type"] for feature in reading.features] == ["Point", "Point", "LineString"]
    assert reading.features[2].geometry["coordinates"] == [[7.0, 50.0], [8.0, 51.0]]


def test_styles_shared_mapped_and_own() -> None:
    shared = (
        '<Style id="s"><LineStyle><color>80ff0000</color><width>3</width></LineStyle>'
        "<PolyStyle><color>ff0000ff</color><fill>0</fill></PolyStyle></Style>"
        '<StyleMap id="m"><Pair><key>normal</key><styleUrl>#s</styleUrl></Pair></StyleMap>'
    )
    own = "<Style><LineStyle><color>ff00ff00</color></LineStyle></Style>"
    reading = read_kml(kml(shared + placemark(f"<styleUrl>#m</styleUrl>{own}{POINT}")))
    properties = reading.features[0].properties
    assert properties == {
        "stroke": "#00ff00",
        "stroke-opacity": 1.0,
        "stroke-width": 3.0,
        "fill": "#ff0000",
        "fill-opacity": 0.0,
    }


def test_what_is_not_drawn_is_named() -> None:
    reading = read_kml(
        kml(
            "<NetworkLink/><GroundOverlay/><GroundOverlay/>"
            + placemark("<name>empty</name>")
            + placemark("<Point><coordinates>north,east</coordinates></Point>")
            + placemark("<Point><coordinates>7,500</coordinates></Point>")
            + placemark("<Point/>")
            + placemark(POINT)
        )
    )
    assert len(reading.features) == 1
    assert reading.notes == [
        PartLeftOut("placemark", '1 "empty"', "missing"),
        PartLeftOut("placemark", "2", "not_numbers"),
        PartLeftOut("placemark", "3", "in_metres"),
        PartLeftOut("placemark", "4", "no_position"),
        KindLeftOut("NetworkLink", 1),
        KindLeftOut("GroundOverlay", 2),
    ]


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"<kml>", "not valid XML"),
        (b"<gpx></gpx>", "first element is not <kml>"),
        (b'<!DOCTYPE kml [<!ENTITY a "b">]><kml>&a;</kml>', "document type definition"),
    ],
)
def test_other_xml_is_refused(content: bytes, words: str) -> None:
    with pytest.raises(MapRefused, match=words):
        read_kml(content)


def test_nested_without_end_is_named() -> None:
    deep = "<MultiGeometry>" * 200 + POINT + "</MultiGeometry>" * 200
    assert read_kml(kml(placemark(deep))).notes == [PartLeftOut("placemark", "1", "nested_too_deep")]


def kmz(**files: bytes) -> bytes:
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        for name, content in files.items():
            archive.writestr(name.replace("_", "."), content)
    return stream.getvalue()


def test_a_kmz_is_its_main_file() -> None:
    other = kml(placemark("<Point><coordinates>1,1</coordinates></Point>"))
    reading = read_kmz(kmz(a_kml=other, doc_kml=kml(placemark(POINT))))
    assert reading.features[0].geometry["coordinates"] == [7.0, 50.0]
    assert reading.notes == [FileLeftOut("a.kml")]


def test_a_kmz_without_kml_or_damaged_is_refused() -> None:
    with pytest.raises(MapRefused, match="there is no KML file in it"):
        read_kmz(kmz(a_png=b"x"))
    with pytest.raises(MapRefused, match="cannot be unpacked"):
        read_kmz(b"PK\x03\x04 nonsense")


@pytest.mark.parametrize(
    "inside",
    [
        f"<Point><coordinates>7,{' ' * 2_000_000}50</coordinates></Point>",
        f"<LineString><coordinates>{' ' * 2_000_000}7,50 8,51</coordinates></LineString>",
        f"<description>{'&lt;' * 500_000}</description>{POINT}",
    ],
)
def test_blanks_and_brackets_without_end_take_as_long_as_their_number(inside: str) -> None:
    """A pattern that tries each blank against all others needs hours for these; the suite's time limit ends it."""
    assert len(read_kml(kml(placemark(inside))).features) == 1
