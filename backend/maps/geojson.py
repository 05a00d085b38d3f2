"""GeoJSON (RFC 7946) from elsewhere as features to draw: checked, heights dropped, collections taken apart."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from typing import Any, TypeVar, cast

from pydantic import JsonValue

from backend.maps.features import MOST_NAME, Reading
from backend.maps.refusal import MapRefused, PartUnusable
from backend.reasons.maps import NotReadableAs, OtherCoordinates

SMALLEST_LINE, SMALLEST_RING = 2, 4
DEEPEST_COLLECTION = 8
WGS84_NAMES = ("CRS84", "EPSG::4326", "EPSG:4326", "WGS84")

T = TypeVar("T")


def read_geojson(content: bytes) -> Reading:
    """All features of a document; those that cannot be drawn are named in `notes`. MapRefused: it is no GeoJSON."""
    try:
        document: JsonValue = json.loads(content.decode("utf-8-sig"), parse_constant=_no_constant)
    except (ValueError, RecursionError) as error:
        raise MapRefused(NotReadableAs("geojson", "not_json")) from error
    if not isinstance(document, dict) or "type" not in document:
        raise MapRefused(NotReadableAs("geojson", "no_type"))
    _refuse_other_systems(document.get("crs"))
    reading = Reading()
    for number, feature in enumerate(_features(document), start=1):
        properties = feature.get("properties")
        plain = properties if isinstance(properties, dict) else {}
        try:
            for geometry in plain_geometries(feature.get("geometry")):
                reading.add(geometry, plain)
        except PartUnusable as error:
            name = plain.get("name") or plain.get("Name") or plain.get("title")
            reading.leave_out("feature", number, name, error.fault)
    return reading


def _no_constant(name: str) -> float:
    raise ValueError(f"{name} is no JSON number")


def _refuse_other_systems(crs: JsonValue) -> None:
    """The `crs` member of old GeoJSON: other coordinate systems would be drawn at the wrong place."""
    if crs is None:
        return
    properties = crs.get("properties") if isinstance(crs, dict) else None
    name = properties.get("name") if isinstance(properties, dict) else None
    if not (isinstance(name, str) and any(known in name for known in WGS84_NAMES)):
        raise MapRefused(OtherCoordinates(str(name or crs)[:MOST_NAME]))


def _features(document: dict[str, JsonValue]) -> Iterator[dict[str, JsonValue]]:
    if document["type"] == "FeatureCollection":
        features = document.get("features")
        if not isinstance(features, list):
            raise MapRefused(NotReadableAs("geojson", "no_features"))
        for feature in features:
            yield feature if isinstance(feature, dict) else {"geometry": feature}
    elif document["type"] == "Feature":
        yield document
    else:
        yield {"geometry": document}


def plain_geometries(geometry: JsonValue, depth: int = 0) -> Iterator[dict[str, Any]]:
    """The geometry checked and in two dimensions; a GeometryCollection becomes its members. Raises PartUnusable."""
    if depth > DEEPEST_COLLECTION:
        raise PartUnusable("nested_too_deep")
    if not isinstance(geometry, dict):
        raise PartUnusable("missing")
    kind = geometry.get("type")
    if kind == "GeometryCollection":
        members = geometry.get("geometries")
        for member in members if isinstance(members, list) else []:
            yield from plain_geometries(member, depth + 1)
        return
    if not isinstance(kind, str) or kind not in READERS:
        raise PartUnusable("type_unknown")
    yield {"type": kind, "coordinates": READERS[kind](geometry.get("coordinates"))}


def _position(value: JsonValue) -> list[float]:
    if not isinstance(value, list) or len(value) < 2:
        raise PartUnusable("no_position")
    lon, lat = _number(value[0]), _number(value[1])
    if not (abs(lon) <= 180 and abs(lat) <= 90):
        raise PartUnusable("swapped" if abs(lon) <= 90 and abs(lat) <= 180 else "in_metres")
    value[:] = (float(lon), float(lat))
    return cast("list[float]", value)


def _number(value: JsonValue) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise PartUnusable("not_numbers")
    return value


def _list(value: JsonValue, read: Callable[[JsonValue], T], fewest: int) -> list[T]:
    """In place: a second copy of a million positions takes a hundred megabytes."""
    if not isinstance(value, list) or len(value) < fewest:
        raise PartUnusable("too_few_positions")
    parts = cast("list[Any]", value)
    for index, part in enumerate(parts):
        parts[index] = read(part)
    return parts


def _line(value: JsonValue) -> list[list[float]]:
    return _list(value, _position, SMALLEST_LINE)


def _ring(value: JsonValue) -> list[list[float]]:
    ring = _list(value, _position, SMALLEST_RING - 1)
    if ring[0] != ring[-1]:
        ring.append(ring[0])
    if len(ring) < SMALLEST_RING:
        raise PartUnusable("too_few_positions")
    return ring


def _polygon(value: JsonValue) -> list[list[list[float]]]:
    return _list(value, _ring, 1)


READERS: dict[str, Callable[[JsonValue], list[Any]]] = {
    "Point": _position,
    "MultiPoint": lambda value: _list(value, _position, 1),
    "LineString": _line,
    "MultiLineString": lambda value: _list(value, _line, 1),
    "Polygon": _polygon,
    "MultiPolygon": lambda value: _list(value, _polygon, 1),
}
