"""How the page draws a map: a MapLibre source and quiet layers, so that belief and bearings stay the loudest.

Labels name no glyph server: without `glyphs` in the style MapLibre draws them from the machine's own fonts.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Literal

from backend.maps.schemas import SCHEMAS, Rule
from backend.reasons.maps import MapDrawnPlainly
from backend.wire.maps import MapLayers, MapPackage, VectorLayer

Theme = Literal["light", "dark"]
Layer = dict[str, Any]

COLOURS: dict[Theme, dict[str, str]] = {
    "light": {
        "land": "#f4f3ef",
        "water": "#bcd3e2",
        "wood": "#d6e2cc",
        "grass": "#e3eadb",
        "built": "#e6e4df",
        "building": "#d3cfc8",
        "road": "#ffffff",
        "casing": "#b5b1a9",
        "path": "#9c978d",
        "rail": "#8f8b84",
        "border": "#a79fb0",
        "text": "#2f3338",
        "halo": "#ffffff",
    },
    "dark": {
        "land": "#1b1e22",
        "water": "#1f3442",
        "wood": "#202b24",
        "grass": "#22291f",
        "built": "#23262a",
        "building": "#31353a",
        "road": "#484d54",
        "casing": "#15171a",
        "path": "#5a5f66",
        "rail": "#5f5a66",
        "border": "#5d5768",
        "text": "#c9ced4",
        "halo": "#14161a",
    },
}


def map_layers(package: MapPackage, theme: Theme, tile_pixels: int | None) -> MapLayers:
    """The source and the layers of one map, bottom first. `tile_pixels`: side of a raster tile."""
    source_id = f"map-{package.map_id}"
    source: dict[str, Any] = {
        "type": package.kind,
        "url": f"pmtiles:///api/maps/{package.map_id}/tiles.pmtiles",
        "attribution": package.attribution,
    }
    if package.kind == "raster":
        source["tileSize"] = tile_pixels or 256
        dimmed = {"raster-brightness-max": 0.6, "raster-saturation": -0.3} if theme == "dark" else {}
        paint = {"raster-fade-duration": 0, **dimmed}
        raster = {"id": f"{source_id}-raster", "type": "raster", "source": source_id, "paint": paint}
        return MapLayers(source_id=source_id, source=source, layers=[raster], notes=[])
    layers, notes = _vector(package, COLOURS[theme])
    for number, layer in enumerate(layers):
        layer["id"] = f"{source_id}-{number}-{layer['source-layer']}"
        layer["source"] = source_id
    return MapLayers(source_id=source_id, source=source, layers=layers, notes=[*notes])


def _vector(package: MapPackage, colours: dict[str, str]) -> tuple[list[Layer], list[MapDrawnPlainly]]:
    there = {layer.id for layer in package.vector_layers}
    if not there:
        return [], [MapDrawnPlainly("layers_not_named")]
    for _, known_by, rules in SCHEMAS:
        if known_by <= there:
            drawn = [rule for rule in rules if rule.tile_layer in there]
            return [layer for rule in drawn for layer in _by_rule(rule, colours)], []
    layers = [drawn for layer in package.vector_layers for drawn in _by_geometry(layer, colours)]
    return layers, [MapDrawnPlainly("schema_unknown")]


def _by_rule(rule: Rule, colours: dict[str, str]) -> Iterator[Layer]:
    conditions: list[Any] = []
    if rule.field is not None and rule.values is not None:
        conditions.append(["in", ["get", rule.field], ["literal", list(rule.values)]])
    if rule.paint == "label":
        yield _label(
            rule.tile_layer, conditions, along_line=rule.role == "road", colours=colours, min_zoom=rule.min_zoom
        )
        return
    geometry = "Polygon" if rule.paint == "fill" else "LineString"
    base: Layer = {
        "source-layer": rule.tile_layer,
        "minzoom": rule.min_zoom,
        "filter": ["all", ["==", ["geometry-type"], geometry], *conditions],
    }
    if rule.paint == "fill":
        yield {**base, "type": "fill", "paint": {"fill-color": colours[rule.role], "fill-antialias": True}}
        return
    if rule.role == "road":
        yield {**base, **_line(colours["casing"], rule.width + 1.5)}
    dashes = _DASHES.get(rule.role)
    yield {**base, **_line(colours[rule.role], rule.width, dashes)}


_DASHES: dict[str, list[float]] = {"path": [2, 1.5], "border": [4, 2]}


def _line(colour: str, width: float, dashes: list[float] | None = None) -> Layer:
    """Full width at zoom 16, a quarter at zoom 8, growing further in."""
    widths = ["interpolate", ["exponential", 1.5], ["zoom"], 8, width / 4, 16, width, 20, width * 3]
    paint: Layer = {"line-color": colour, "line-width": widths}
    if dashes:
        paint["line-dasharray"] = dashes
    return {"type": "line", "layout": {"line-cap": "butt" if dashes else "round", "line-join": "round"}, "paint": paint}


def _label(tile_layer: str, conditions: list[Any], along_line: bool, colours: dict[str, str], min_zoom: int) -> Layer:
    layout: Layer = {
        "text-field": ["coalesce", ["get", "name"], ["get", "name_en"], ["get", "name:latin"], ""],
        "text-font": ["sans-serif"],
        "text-size": 12 if along_line else 14,
    }
    if along_line:
        layout["symbol-placement"] = "line"
    return {
        "source-layer": tile_layer,
        "type": "symbol",
        "minzoom": min_zoom,
        "filter": ["all", ["has", "name"], *conditions],
        "layout": layout,
        "paint": {"text-color": colours["text"], "text-halo-color": colours["halo"], "text-halo-width": 1.5},
    }


def _by_geometry(layer: VectorLayer, colours: dict[str, str]) -> Iterator[Layer]:
    base: Layer = {"source-layer": layer.id}
    water = any(word in layer.id.casefold() for word in ("water", "river", "lake", "sea", "ocean"))
    yield {
        **base,
        "type": "fill",
        "filter": ["==", ["geometry-type"], "Polygon"],
        "paint": {"fill-color": colours["water" if water else "building"], "fill-opacity": 0.6},
    }
    yield {
        **base,
        "filter": ["==", ["geometry-type"], "LineString"],
        **_line(colours["water" if water else "path"], 1.5),
    }
    yield {
        **base,
        "type": "circle",
        "filter": ["==", ["geometry-type"], "Point"],
        "paint": {"circle-radius": 3, "circle-color": colours["path"]},
    }
    if "name" in layer.fields:
        yield _label(layer.id, [], False, colours, 0)
