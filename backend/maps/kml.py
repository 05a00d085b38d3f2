"""KML 2.2 and KMZ as features: placemarks with their names, attributes and plain styles.

Read: Point, LineString, LinearRing, Polygon, MultiGeometry, gx:Track, shared and own styles, ExtendedData.
Not drawable here, so named in the notes: linked files, pictures on the ground or the screen, models, tours.
"""

from __future__ import annotations

import io
import re
import zipfile
import zlib
from collections import Counter
from collections.abc import Iterator
from typing import Any, get_args
from xml.etree.ElementTree import Element, ParseError, TreeBuilder

from defusedxml import DefusedXmlException
from defusedxml.ElementTree import DefusedXMLParser

from backend.maps.features import MARKUP, MOST_FEATURES, MOST_NAME, Reading
from backend.maps.geojson import DEEPEST_COLLECTION, plain_geometries
from backend.maps.refusal import MapRefused, PartUnusable
from backend.reasons.maps import FileLeftOut, KindLeftOut, NotDrawn, NotReadableAs, TooManyFeatures

MOST_KML_BYTES = 100 * 2**20
MOST_ELEMENTS = 500_000
"""Ten for each placemark."""
BLOCK_BYTES = 2**16
NOT_DRAWN: tuple[NotDrawn, ...] = get_args(NotDrawn)

Style = dict[str, Any]

SIMPLESTYLE = {
    "LineStyle": ("stroke", "stroke-opacity"),
    "PolyStyle": ("fill", "fill-opacity"),
    "IconStyle": ("marker-color", ""),
}


def read_kmz(content: bytes) -> Reading:
    """The main KML file of a KMZ archive: doc.kml, or else the first .kml in it."""
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            names = [name for name in archive.namelist() if name.casefold().endswith(".kml")]
            if not names:
                raise MapRefused(NotReadableAs("kmz", "no_kml_inside"))
            main = "doc.kml" if "doc.kml" in names else names[0]
            with archive.open(main) as file:
                reading = _reading(_tree(iter(lambda: file.read(BLOCK_BYTES), b"")))
    except (zipfile.BadZipFile, zlib.error, NotImplementedError, RuntimeError, EOFError) as error:
        raise MapRefused(NotReadableAs("kmz", "not_unpacked")) from error
    for other in names:
        if other != main:
            reading.note(FileLeftOut(other[:MOST_NAME]))
    return reading


def read_kml(content: bytes) -> Reading:
    """All placemarks. MapRefused when it is no KML; what cannot be drawn is named in `notes`."""
    return _reading(_tree(iter((content,))))


class _Bounded(TreeBuilder):
    """Ends a document that has more in it than can be drawn before it has filled the memory."""

    def __init__(self) -> None:
        super().__init__()
        self._elements = self._placemarks = 0

    def start(self, tag: str, attrs: dict[str, str]) -> Element:  # type: ignore[override]  # its stub names them otherwise
        """Raises MapRefused."""
        self._elements += 1
        self._placemarks += tag.endswith("Placemark")
        if self._placemarks > MOST_FEATURES:
            raise MapRefused(TooManyFeatures(MOST_FEATURES))
        if self._elements > MOST_ELEMENTS:
            raise MapRefused(NotReadableAs("kml", "too_large"))
        return super().start(tag, attrs)


def _tree(blocks: Iterator[bytes]) -> Element:
    """Raises MapRefused for what is no XML, or too much of it."""
    parser = DefusedXMLParser(target=_Bounded(), forbid_dtd=True)
    taken = 0
    try:
        for block in blocks:
            taken += len(block)
            if taken > MOST_KML_BYTES:
                raise MapRefused(NotReadableAs("kml", "too_large"))
            parser.feed(block)
        return parser.close()
    except (ParseError, ValueError, LookupError) as error:
        fault = "document_type" if isinstance(error, DefusedXmlException) else "not_xml"
        raise MapRefused(NotReadableAs("kml", fault)) from error


def _reading(root: Element) -> Reading:
    if _tag(root) != "kml":
        raise MapRefused(NotReadableAs("kml", "other_xml"))
    reading = Reading()
    styles = _shared_styles(root)
    for number, placemark in enumerate((each for each in root.iter() if _tag(each) == "Placemark"), start=1):
        try:
            geometries = [found for child in placemark for found in _geometries(child)]
            if not geometries:
                raise PartUnusable("missing")
            properties = {**_attributes(placemark), **_style_of(placemark, styles)}
            for geometry in [plain for found in geometries for plain in plain_geometries(found)]:
                reading.add(geometry, properties)
        except PartUnusable as error:
            reading.leave_out("placemark", number, _text(placemark, "name"), error.fault)
    counts = Counter(_tag(each) for each in root.iter())
    for kind in NOT_DRAWN:
        if counts[kind]:
            reading.note(KindLeftOut(kind, counts[kind]))
    return reading


def _tag(element: Element) -> str:
    return element.tag.rpartition("}")[2]


def _child(element: Element, tag: str) -> Element | None:
    return next((child for child in element if _tag(child) == tag), None)


def _text(element: Element, tag: str) -> str:
    found = _child(element, tag)
    return (found.text or "").strip() if found is not None else ""


def _geometries(element: Element, depth: int = 0) -> Iterator[dict[str, Any]]:
    if depth > DEEPEST_COLLECTION:
        raise PartUnusable("nested_too_deep")
    match _tag(element):
        case "Point":
            positions = _coordinates(element)
            yield {"type": "Point", "coordinates": positions[0] if positions else None}
        case "LineString" | "LinearRing":
            yield {"type": "LineString", "coordinates": _coordinates(element)}
        case "Polygon":
            yield {"type": "Polygon", "coordinates": list(_rings(element))}
        case "MultiGeometry" | "MultiTrack":
            for child in element:
                yield from _geometries(child, depth + 1)
        case "Track":
            places = [(child.text or "").split() for child in element if _tag(child) == "coord"]
            yield {"type": "LineString", "coordinates": [_numbers(place) for place in places]}
        case _:
            return


def _rings(polygon: Element) -> Iterator[list[list[float]]]:
    """The outer ring first, whatever the order in the file."""
    for boundary in ("outerBoundaryIs", "innerBoundaryIs"):
        for child in polygon:
            if _tag(child) == boundary:
                for ring in child:
                    yield _coordinates(ring)


def _coordinates(element: Element) -> list[list[float]]:
    """Tuples "lon,lat[,height]" apart by white space; some programs put blanks behind the commas."""
    text = ",".join(part.strip() for part in _text(element, "coordinates").split(","))
    return [_numbers(part.split(",")) for part in text.split()]


def _numbers(parts: list[str]) -> list[float]:
    try:
        return [float(part) for part in parts[:2]]
    except ValueError as error:
        raise PartUnusable("not_numbers") from error


def _attributes(placemark: Element) -> dict[str, Any]:
    attributes: dict[str, Any] = {}
    extended = _child(placemark, "ExtendedData")
    for data in extended.iter() if extended is not None else ():
        name = data.get("name")
        if name and _tag(data) == "Data":
            attributes[name] = _text(data, "value")
        elif name and _tag(data) == "SimpleData":
            attributes[name] = (data.text or "").strip()
    for name in ("name", "description"):
        if words := MARKUP.sub(" ", _text(placemark, name)).strip():
            attributes[name] = words
    return attributes


def _shared_styles(root: Element) -> dict[str, Style]:
    """Styles by "#id"; a StyleMap stands for its normal state."""
    styles = {f"#{each.get('id')}": _style(each) for each in root.iter() if _tag(each) == "Style" and each.get("id")}
    for each in root.iter():
        if _tag(each) == "StyleMap" and each.get("id"):
            for pair in each:
                if _tag(pair) == "Pair" and _text(pair, "key") == "normal":
                    styles[f"#{each.get('id')}"] = styles.get(_text(pair, "styleUrl"), {})
    return styles


def _style_of(placemark: Element, styles: dict[str, Style]) -> Style:
    own = _child(placemark, "Style")
    return {**styles.get(_text(placemark, "styleUrl"), {}), **(_style(own) if own is not None else {})}


def _style(element: Element) -> Style:
    """KML colours (aabbggrr) and widths under their simplestyle names."""
    style: Style = {}
    for child in element:
        tag = _tag(child)
        if tag not in SIMPLESTYLE:
            continue
        colour = _text(child, "color").removeprefix("#")
        if re.fullmatch(r"[0-9a-fA-F]{8}", colour):
            alpha, blue, green, red = (colour[i : i + 2] for i in range(0, 8, 2))
            style[SIMPLESTYLE[tag][0]] = f"#{red}{green}{blue}".lower()
            if SIMPLESTYLE[tag][1]:
                style[SIMPLESTYLE[tag][1]] = round(int(alpha, 16) / 255, 3)
        width = _text(child, "width")
        if tag == "LineStyle" and re.fullmatch(r"\d+(\.\d+)?", width):
            style["stroke-width"] = float(width)
        if tag == "PolyStyle" and _text(child, "fill") == "0":
            style["fill-opacity"] = 0.0
    return style
