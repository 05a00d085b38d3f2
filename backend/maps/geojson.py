"""GeoJSON (RFC 7946) from elsewhere as features to draw: checked, heights dropped, collections taken apart."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from typing import Any

from backend.maps.features import Reading
from backend.maps.refusal import MapRefused

SMALLEST_LINE, SMALLEST_RING = 2, 4
DEEPEST_COLLECTION = 8
WGS84_NAMES = ("CRS84", "EPSG::4326", "EPSG:4326", "WGS84")
EXPECTED = "Export the overlay as GeoJSON in WGS84 (longitude, latitude), or as KML."


def read_geojson(content: bytes) -> Reading:
    """All features of a document; those that cannot be drawn are named in `notes`. MapRefused: it is no GeoJSON."""
    try:
        document = json.loads(content.decode("utf-8-sig"), parse_constant=_no_constant)
    except (ValueError, RecursionError) as error:
        raise MapRefused(f"The file is not valid JSON: {error}.", EXPECTED) from error
    if not isinstance(document, dict) or "type" not in document:
        raise MapRefused("The file is JSON, but no GeoJSON: it has no `type`.", EXPECTED)
    _refuse_other_systems(document.get("crs"))
    reading = Reading()
    for label, feature in _features(document):
        properties = feature.get("properties")
        plain = properties if isinstance(properties, dict) else {}
        name = plain.get("name") or plain.get("Name") or plain.get("title")
        where = f'{label} "{name}"' if isinstance(name, str) else label
        try:
            for geometry in plain_geometries(feature.get("geometry")):
                reading.add(geometry, plain)
        except MapRefused as error:
            reading.note(f"{where} is left out: {error}")
    return reading


def _no_constant(name: str) -> float:
    raise ValueError(f"{name} is no JSON number")


def _refuse_other_systems(crs: Any) -> None:
    """The `crs` member of old GeoJSON: other coordinate systems would be drawn at the wrong place."""
    if crs is None:
        return
    properties = crs.get("properties") if isinstance(crs, dict) else None
    name = properties.get("name") if isinstance(properties, dict) else None
    if not (isinstance(name, str) and any(known in name for known in WGS84_NAMES)):
        raise MapRefused(f"The file uses the coordinate system {name or crs!r}, not WGS84.", EXPECTED)


def _features(document: dict[str, Any]) -> Iterator[tuple[str, dict[str, Any]]]:
    if document["type"] == "FeatureCollection":
        features = document.get("features")
        if not isinstance(features, list):
            raise MapRefused("The FeatureCollection has no list of `features`.", EXPECTED)
        for number, feature in enumerate(features, start=1):
            yield f"Feature {number}", feature if isinstance(feature, dict) else {"geometry": feature}
    elif document["type"] == "Feature":
        yield "The feature", document
    else:
        yield "The geometry", {"geometry": document}


def plain_geometries(geometry: Any, depth: int = 0) -> Iterator[dict[str, Any]]:
    """The geometry checked and in two dimensions; a GeometryCollection becomes its members."""
    if depth > DEEPEST_COLLECTION:
        raise MapRefused(f"its geometries are nested more than {DEEPEST_COLLECTION} deep.")
    if not isinstance(geometry, dict):
        raise MapRefused("it has no geometry.")
    kind = geometry.get("type")
    if kind == "GeometryCollection":
        members = geometry.get("geometries")
        for member in members if isinstance(members, list) else []:
            yield from plain_geometries(member, depth + 1)
        return
    if not isinstance(kind, str) or kind not in READERS:
        raise MapRefused(f"a geometry of type {kind!r} is not known.")
    yield {"type": kind, "coordinates": READERS[kind](geometry.get("coordinates"))}


def _position(value: Any) -> list[float]:
    if not isinstance(value, list) or len(value) < 2:
        raise MapRefused(f"{_shown(value)} is not a position of longitude and latitude.")
    lon, lat = value[0], value[1]
    if not all(isinstance(part, int | float) and not isinstance(part, bool) for part in (lon, lat)):
        raise MapRefused(f"the position {_shown(value)} does not consist of numbers.")
    if not (abs(lon) <= 180 and abs(lat) <= 90):
        hint = "longitude and latitude may be swapped" if abs(lon) <= 90 and abs(lat) <= 180 else "it may be in metres"
        raise MapRefused(f"the position {_shown(value[:2])} is not on Earth; {hint}.")
    return [float(lon), float(lat)]


def _shown(value: Any) -> str:
    text = json.dumps(value)
    return text if len(text) <= 60 else f"{text[:57]}..."


def _list(value: Any, read: Callable[[Any], Any], fewest: int, what: str) -> list[Any]:
    if not isinstance(value, list) or len(value) < fewest:
        raise MapRefused(f"{what} needs at least {fewest} {'entry' if fewest == 1 else 'entries'}.")
    return [read(part) for part in value]


def _line(value: Any) -> list[Any]:
    return _list(value, _position, SMALLEST_LINE, "a line")


def _ring(value: Any) -> list[Any]:
    ring = _list(value, _position, SMALLEST_RING - 1, "a ring")
    if ring[0] != ring[-1]:
        ring.append(ring[0])
    if len(ring) < SMALLEST_RING:
        raise MapRefused("a ring needs at least three corners.")
    return ring


def _polygon(value: Any) -> list[Any]:
    return _list(value, _ring, 1, "a polygon")


READERS: dict[str, Callable[[Any], list[Any]]] = {
    "Point": _position,
    "MultiPoint": lambda value: _list(value, _position, 1, "a MultiPoint"),
    "LineString": _line,
    "MultiLineString": lambda value: _list(value, _line, 1, "a MultiLineString"),
    "Polygon": _polygon,
    "MultiPolygon": lambda value: _list(value, _polygon, 1, "a MultiPolygon"),
}
