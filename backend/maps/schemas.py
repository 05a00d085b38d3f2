"""What the tile layers of well-known vector maps mean: Protomaps basemaps, OpenMapTiles, Shortbread.

Vector tiles name their layers and attributes after a schema; a rule says what of them is drawn, and as what.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal


@dataclass(frozen=True, slots=True)
class Rule:
    """Features of one tile layer (`values` of `field`, None: all) drawn as `role`, filled, as a line or as a label."""

    tile_layer: str
    paint: Literal["fill", "line", "label"]
    role: str
    field: str | None = None
    values: tuple[str, ...] | None = None
    width: float = 1.0
    min_zoom: int = 0


WOODS = ("wood", "forest", "scrub")
GREENS = (
    *("grass", "grassland", "meadow", "park", "heath", "nature_reserve"),
    *("farmland", "farmyard", "orchard", "vineyard"),
)
BUILT = (
    *("residential", "industrial", "commercial", "urban_area", "pedestrian"),
    *("school", "hospital", "cemetery", "military"),
)
MAIN = (
    *("highway", "major_road", "motorway", "trunk", "primary", "secondary"),
    *("motorway_link", "trunk_link", "primary_link"),
)
MINOR = ("minor_road", "tertiary", "minor", "service", "unclassified", "residential", "living_street", "other")
PATHS = ("path", "track", "footway", "cycleway", "steps", "bridleway", "pedestrian")

PROTOMAPS = (
    Rule("earth", "fill", "land"),
    Rule("landcover", "fill", "wood", "kind", ("forest", "scrub")),
    Rule("landcover", "fill", "grass", "kind", ("grassland", "farmland")),
    Rule("landuse", "fill", "built", "kind", BUILT),
    Rule("landuse", "fill", "grass", "kind", GREENS),
    Rule("landuse", "fill", "wood", "kind", WOODS),
    Rule("water", "fill", "water"),
    Rule("water", "line", "water", "kind", ("river", "stream", "canal", "ditch", "drain"), 1.5),
    Rule("buildings", "fill", "building", min_zoom=13),
    Rule("roads", "line", "path", "kind", PATHS, 1.0, 12),
    Rule("roads", "line", "rail", "kind", ("rail",), 1.2),
    Rule("roads", "line", "road", "kind", MINOR, 3.0, 11),
    Rule("roads", "line", "road", "kind", MAIN, 5.0),
    Rule("boundaries", "line", "border"),
    Rule("roads", "label", "road", "kind", (*MAIN, *MINOR), min_zoom=14),
    Rule("water", "label", "water", min_zoom=12),
    Rule("places", "label", "place"),
)
OPENMAPTILES = (
    Rule("landcover", "fill", "wood", "class", ("wood",)),
    Rule("landcover", "fill", "grass", "class", ("grass", "farmland", "wetland")),
    Rule("landuse", "fill", "built", "class", BUILT),
    Rule("park", "fill", "grass"),
    Rule("water", "fill", "water"),
    Rule("waterway", "line", "water", width=1.5),
    Rule("building", "fill", "building", min_zoom=13),
    Rule("transportation", "line", "path", "class", PATHS, 1.0, 12),
    Rule("transportation", "line", "rail", "class", ("rail", "transit"), 1.2),
    Rule("transportation", "line", "road", "class", MINOR, 3.0, 11),
    Rule("transportation", "line", "road", "class", MAIN, 5.0),
    Rule("boundary", "line", "border"),
    Rule("transportation_name", "label", "road", min_zoom=14),
    Rule("water_name", "label", "water"),
    Rule("place", "label", "place"),
)
SHORTBREAD = (
    Rule("land", "fill", "wood", "kind", WOODS),
    Rule("land", "fill", "grass", "kind", GREENS),
    Rule("land", "fill", "built", "kind", BUILT),
    Rule("ocean", "fill", "water"),
    Rule("water_polygons", "fill", "water"),
    Rule("water_lines", "line", "water", width=1.5),
    Rule("buildings", "fill", "building", min_zoom=13),
    Rule("streets", "line", "path", "kind", PATHS, 1.0, 12),
    Rule("streets", "line", "rail", "kind", ("rail", "light_rail", "narrow_gauge"), 1.2),
    Rule("streets", "line", "road", "kind", MINOR, 3.0, 11),
    Rule("streets", "line", "road", "kind", MAIN, 5.0),
    Rule("boundaries", "line", "border"),
    Rule("street_labels", "label", "road", min_zoom=14),
    Rule("water_polygons_labels", "label", "water"),
    Rule("place_labels", "label", "place"),
)
SCHEMAS: tuple[tuple[str, frozenset[str], tuple[Rule, ...]], ...] = (
    ("Protomaps", frozenset({"earth", "roads", "landuse"}), PROTOMAPS),
    ("OpenMapTiles", frozenset({"transportation", "landcover"}), OPENMAPTILES),
    ("Shortbread", frozenset({"streets", "land"}), SHORTBREAD),
)
"""Name, tile layers by which it is known, rules."""
