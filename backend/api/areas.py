"""The polygons of a file as a mission area."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Any

from pydantic import ValidationError
from shapely import GEOSException, MultiPolygon, Polygon
from shapely.ops import unary_union

from backend import spec
from backend.api.problems import MOST_NAMED
from backend.maps.geojson import read_geojson
from backend.maps.kml import read_kml
from backend.maps.refusal import MapRefused
from backend.reasons import Reason
from backend.reasons.maps import NoPolygon, NotAreas, PolygonsUnited
from backend.reasons.search import OutlineUnusable
from backend.search.area import area_geometry
from backend.search.covering import in_one_piece
from backend.search.errors import MissionInputError
from backend.wire.resources import AreaImport, AreaUpload
from hardware.frame import LocalFrame
from hardware.readings import Place


class AreaRefused(ValueError):
    """What was sent is no upload of an area. errors: as pydantic tells them."""

    def __init__(self, errors: list[dict[str, Any]]) -> None:
        super().__init__(errors)
        self.errors = errors


def area_of(body: bytes) -> AreaImport:
    """The same for a request's body. Raises AreaRefused, MissionInputError."""
    try:
        upload = AreaUpload.model_validate_json(body)
    except ValidationError as error:
        found = error.errors(include_url=False, include_input=False)[:MOST_NAMED]
        raise AreaRefused([{**each, "loc": ("body", *each["loc"])} for each in found]) from error
    return read_area(upload)


def read_area(upload: AreaUpload) -> AreaImport:
    """Raises MissionInputError."""
    content = upload.text.encode("utf-8", "replace")
    is_xml = upload.text.lstrip("\ufeff \t\r\n").startswith("<")
    try:
        reading = read_kml(content) if is_xml else read_geojson(content)
    except MapRefused as refused:
        raise MissionInputError(refused.reason, "text") from refused
    geometries = [feature.geometry for feature in reading.features]
    polygons = list(_polygons(geometries))
    if not polygons:
        raise MissionInputError(NoPolygon(lines=bool(geometries)), "text")
    notes: list[Reason] = [*reading.all_notes()]
    others = sum(geometry["type"] not in {"Polygon", "MultiPolygon"} for geometry in geometries)
    if others:
        notes.append(NotAreas(others))
    area, area_m2 = _united(polygons, notes)
    rings = (
        area.coordinates if isinstance(area, spec.Polygon) else [ring for rings in area.coordinates for ring in rings]
    )
    vertices = sum(len(ring) - 1 for ring in rings)
    return AreaImport(area=area, format="kml" if is_xml else "geojson", area_m2=area_m2, vertices=vertices, notes=notes)


def _polygons(geometries: Sequence[dict[str, Any]]) -> Iterator[list[Any]]:
    for geometry in geometries:
        if geometry["type"] == "Polygon":
            yield geometry["coordinates"]
        elif geometry["type"] == "MultiPolygon":
            yield from geometry["coordinates"]


def _united(polygons: Sequence[list[Any]], notes: list[Reason]) -> tuple[spec.Area, float]:
    """The area in lon/lat and its size; overlapping polygons are united, self-crossing ones refused."""
    drawn: spec.Area = spec.MultiPolygon(
        coordinates=[[[tuple(p) for p in ring] for ring in rings] for rings in polygons]
    )
    lon, lat = drawn.coordinates[0][0][0]
    metric = area_geometry(drawn, LocalFrame(Place(lat, lon)), "text", "area")
    try:
        united = unary_union(list(in_one_piece(drawn.coordinates).geoms))
    except GEOSException as error:  # that is sound in metres, and not in degrees
        raise MissionInputError(OutlineUnusable("area", "not_simple"), "text") from error
    parts = list(united.geoms) if isinstance(united, MultiPolygon) else [united]
    if len(parts) < len(polygons):
        notes.append(PolygonsUnited(len(polygons), len(parts)))
    rings = [_rings(part) for part in parts if isinstance(part, Polygon)]
    area = spec.Polygon(coordinates=rings[0]) if len(rings) == 1 else spec.MultiPolygon(coordinates=rings)
    return area, metric.area


def _rings(polygon: Polygon) -> list[list[spec.LonLat]]:
    return [[(_on_earth(x), y) for x, y in ring.coords] for ring in (polygon.exterior, *polygon.interiors)]


def _on_earth(lon_deg: float) -> float:
    return lon_deg if -180.0 <= lon_deg <= 180.0 else math.remainder(lon_deg, 360.0)
