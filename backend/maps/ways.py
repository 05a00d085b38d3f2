"""Ways and barriers from a file: told apart by their properties, cut to the ground of a search, roads joined where they
meet. For a worker: what it takes depends on the file.

A part says what it is by a property "kind" of ours, else by its OpenStreetMap tags. What says neither is left out: a
guess could lead over a cliff.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import LineString, MultiLineString, MultiPolygon, Polygon
from shapely.geometry import mapping
from shapely.geometry.base import BaseGeometry

from backend.maps.features import storable
from backend.maps.overlay_folder import read_overlay
from backend.maps.refusal import MapRefused
from backend.reasons import Reason
from backend.reasons.ways import FarFromSearch, NeitherWayNorBarrier, NoWaysInFile, WaysTooFar, WaysTooMany
from backend.search.ground_ways import FARTHEST_M, WayKind
from backend.spec import LonLat
from backend.wire.ways import MissionWays, WayFeature, WayProperties

KINDS: tuple[WayKind, ...] = ("road", "path", "barrier")
MOST_POSITIONS = 100_000
METRES_A_DEGREE = 111_320.0
NARROWEST = 0.01
"""Of the cosine of the latitude: at the poles degrees of longitude have no width."""

CLASSES = ("trunk", "primary", "secondary", "tertiary")
ROADS = frozenset(
    (
        *CLASSES,
        *(f"{one}_link" for one in CLASSES),
        *("unclassified", "residential", "living_street", "service", "track", "road"),
    )
)
"""Values of OpenStreetMap's `highway`. Nobody may stop on a motorway."""
PATHS = frozenset(["path", "footway", "steps", "cycleway", "bridleway", "pedestrian"])
BARRIERS = {
    "natural": frozenset(["water", "cliff", "coastline", "bay", "strait", "glacier"]),
    "waterway": frozenset(["river", "canal", "riverbank", "dock"]),
    "landuse": frozenset(["reservoir", "basin"]),
    "barrier": frozenset(["wall", "city_wall", "retaining_wall", "fence", "hedge"]),
}
SHUT = frozenset(("no", "private"))


@dataclass(frozen=True, slots=True)
class Found:
    """apart: above or below others, met at its ends only. parts: lines or polygons, degrees."""

    kind: WayKind
    apart: bool
    parts: list[BaseGeometry]


def read_ways(content: bytes, area: Sequence[LonLat], name: str, added_at: datetime) -> MissionWays:
    """What of a file (GeoJSON, KML or KMZ) lies on the ground of a search. area: its corners.

    Raises MapRefused when nothing does, or too much.
    """
    _, reading = read_overlay(content)
    found: list[Found] = []
    unlike = 0
    for feature in reading.features:
        kind = kind_of(feature.properties)
        parts = [] if kind is None else list(_parts(feature.geometry, kind))
        if kind is None or not parts:
            unlike += 1
        else:
            found.append(Found(kind, _is_apart(feature.properties), parts))
    if not found:
        raise MapRefused(NoWaysInFile(unlike))
    window = _Window.around(area)
    near = [Found(one.kind, one.apart, window.cut(one.parts)) for one in found]
    far = sum(not one.parts for one in near)
    if far == len(near):
        raise MapRefused(WaysTooFar(min(window.distance_m(part) for one in found for part in one.parts), FARTHEST_M))
    features = list(_features(near))
    positions = sum(len(shapely.get_coordinates(geometry)) for _, geometry in features)
    if positions > MOST_POSITIONS:
        raise MapRefused(WaysTooMany(positions, MOST_POSITIONS))
    notes: list[Reason] = [*reading.all_notes()]
    notes += [NeitherWayNorBarrier(unlike)] if unlike else []
    notes += [FarFromSearch(far, FARTHEST_M)] if far else []
    return MissionWays(
        name=storable(name) or None,
        added_at_utc=added_at,
        roads_m=window.length_m(geometry for kind, geometry in features if kind == "road"),
        paths_m=window.length_m(geometry for kind, geometry in features if kind == "path"),
        barriers=sum(len(one.parts) for one in near if one.kind == "barrier"),
        notes=notes,
        features=[
            WayFeature(geometry=dict(mapping(geometry)), properties=WayProperties(kind=kind))
            for kind, geometry in features
        ],
    )


def kind_of(properties: dict[str, Any]) -> WayKind | None:
    """By "kind", else by OpenStreetMap's tags."""
    stated = properties.get("kind")
    for kind in KINDS:
        if stated == kind:
            return kind
    if (highway := properties.get("highway")) is not None:
        if properties.get("access") in SHUT:
            return None
        return "road" if highway in ROADS else "path" if highway in PATHS else None
    if properties.get("tunnel") not in (None, "no"):
        return None
    return "barrier" if any(properties.get(tag) in values for tag, values in BARRIERS.items()) else None


def _is_apart(properties: dict[str, Any]) -> bool:
    return any(properties.get(tag) not in (None, "no", "0", 0) for tag in ("bridge", "tunnel", "layer"))


def _parts(geometry: dict[str, Any], kind: WayKind) -> Iterator[BaseGeometry]:
    """Lines, and of a barrier polygons; the outline of an area to walk on is a way."""
    match geometry["type"]:
        case "LineString":
            yield LineString(geometry["coordinates"])
        case "MultiLineString":
            yield from (LineString(line) for line in geometry["coordinates"])
        case "Polygon" | "MultiPolygon":
            polygons = [geometry["coordinates"]] if geometry["type"] == "Polygon" else geometry["coordinates"]
            for outline, *holes in polygons:
                yield Polygon(outline, holes) if kind == "barrier" else LineString(outline)
        case _:
            return


@dataclass(frozen=True, slots=True)
class _Window:
    """What is looked at, degrees. 180 degrees east and west are the same where the search is near them."""

    west: float
    south: float
    east: float
    north: float

    @classmethod
    def around(cls, area: Sequence[LonLat]) -> _Window:
        corners = np.array(area, dtype=float)
        lon, lat = _together(corners[:, 0]), corners[:, 1]
        up = FARTHEST_M / METRES_A_DEGREE
        side = up / _width(float(np.abs(lat).max()))
        return cls(lon.min() - side, max(lat.min() - up, -90.0), lon.max() + side, min(lat.max() + up, 90.0))

    @property
    def middle(self) -> tuple[float, float]:
        """lon, lat."""
        return 0.5 * (self.west + self.east), 0.5 * (self.south + self.north)

    def cut(self, parts: list[BaseGeometry]) -> list[BaseGeometry]:
        """What of the parts lies within; a polygon that crosses itself counts where a ray from afar enters it."""
        ground = shapely.box(self.west, self.south, self.east, self.north)
        kept: list[BaseGeometry] = []
        for one in parts:
            part = self._moved_here(one)
            if not shapely.box(*part.bounds).intersects(ground):
                continue
            sound = part if part.is_valid or part.geom_type == "LineString" else shapely.make_valid(part)
            within = sound if ground.contains(shapely.box(*part.bounds)) else shapely.intersection(sound, ground)
            wanted = ("Polygon",) if part.geom_type == "Polygon" else ("LineString",)
            kept += [each for each in _simple(within) if each.geom_type in wanted]
        return kept

    def _moved_here(self, part: BaseGeometry) -> BaseGeometry:
        if self.west > -180.0 and self.east < 180.0:
            return part
        middle = self.middle[0]

        def turned(corners: NDArray[np.float64]) -> NDArray[np.float64]:
            lon = _together(corners[:, 0])
            return np.column_stack([lon + 360.0 * round((middle - float(lon.mean())) / 360.0), corners[:, 1]])

        if part.geom_type == "LineString":
            return LineString(turned(shapely.get_coordinates(part)))
        outline, *holes = (turned(shapely.get_coordinates(ring)) for ring in shapely.get_rings(part))
        return Polygon(outline, holes)

    def distance_m(self, part: BaseGeometry) -> float:
        """From the middle to the nearest corner, on a sphere."""
        lon, lat = np.radians(shapely.get_coordinates(part)).T
        lon_0, lat_0 = (math.radians(value) for value in self.middle)
        half = np.sin(0.5 * (lat - lat_0)) ** 2 + np.cos(lat) * math.cos(lat_0) * np.sin(0.5 * (lon - lon_0)) ** 2
        return float(2.0 * math.degrees(1.0) * METRES_A_DEGREE * np.arcsin(np.sqrt(np.clip(half, 0.0, 1.0))).min())

    def length_m(self, geometries: Iterator[BaseGeometry]) -> float:
        """Of lines, near enough."""
        scale = np.array([METRES_A_DEGREE * _width(self.middle[1]), METRES_A_DEGREE])
        return sum(float(shapely.transform(one, lambda corners: corners * scale).length) for one in geometries)


def _together(lon: NDArray[np.float64]) -> NDArray[np.float64]:
    """Without jumps from 180 degrees east to west."""
    return lon - 360.0 * np.concatenate([[0.0], np.cumsum(np.round(np.diff(lon) / 360.0))])


def _width(lat: float) -> float:
    return max(math.cos(math.radians(lat)), NARROWEST)


def _simple(geometry: BaseGeometry) -> Iterator[BaseGeometry]:
    """Its parts, and theirs."""
    for part in shapely.get_parts(geometry):
        if part.geom_type.startswith(("Multi", "Geometry")):
            yield from _simple(part)
        elif not part.is_empty:
            yield part


def _features(near: Sequence[Found]) -> Iterator[tuple[WayKind, BaseGeometry]]:
    """One for each kind. Roads that cross get a position there, but for those that pass above or below; areas that
    overlap become one."""

    def parts(kind: WayKind, of: str, *apart: bool) -> list[BaseGeometry]:
        return [
            each
            for one in near
            for each in one.parts
            if one.kind == kind and one.apart in apart and each.geom_type == of
        ]

    level = list(_simple(shapely.unary_union(parts("road", "LineString", False))))
    lines: dict[WayKind, list[BaseGeometry]] = {
        "road": level + parts("road", "LineString", True),
        "path": parts("path", "LineString", True, False),
        "barrier": parts("barrier", "LineString", True, False),
    }
    for kind, each in lines.items():
        if each:
            yield kind, MultiLineString([line for line in each if isinstance(line, LineString)])
    united = _simple(shapely.unary_union(parts("barrier", "Polygon", True, False)))
    if areas := [area for area in united if isinstance(area, Polygon)]:
        yield "barrier", MultiPolygon(areas)
