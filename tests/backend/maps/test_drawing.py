"""Every known schema is drawn; whatever the archive, layers refer to what is there."""

from __future__ import annotations

from datetime import UTC, datetime
from typing import Literal

import pytest

from backend.maps.drawing import map_layers
from backend.maps.schemas import SCHEMAS
from backend.reasons.maps import MapDrawnPlainly
from backend.wire.maps import MapPackage, VectorLayer


def package(kind: Literal["raster", "vector"], layers: list[str], fields: list[str] | None = None) -> MapPackage:
    return MapPackage(
        map_id="0123456789abcdef",
        name="m",
        kind=kind,
        tile_type="mvt" if kind == "vector" else "png",
        bounds=(7, 50, 8, 51),
        centre=(7.5, 50.5),
        min_zoom=0,
        max_zoom=14,
        tiles=1,
        size_bytes=1,
        attribution="somebody",
        vector_layers=[
            VectorLayer(id=each, description="", min_zoom=0, max_zoom=14, fields=fields or ["name"]) for each in layers
        ],
        added_at_utc=datetime(2026, 1, 1, tzinfo=UTC),
    )


@pytest.mark.parametrize(("name", "known_by", "rules"), SCHEMAS)
@pytest.mark.parametrize("theme", ["light", "dark"])
def test_a_known_schema_is_drawn_whole(name, known_by, rules, theme) -> None:
    there = sorted({rule.tile_layer for rule in rules} | known_by)
    drawn = map_layers(package("vector", there), theme, None)
    assert drawn.notes == []
    assert {layer["source-layer"] for layer in drawn.layers} == {rule.tile_layer for rule in rules}
    assert len({layer["id"] for layer in drawn.layers}) == len(drawn.layers)
    assert {layer["source"] for layer in drawn.layers} == {drawn.source_id}
    labels = [number for number, layer in enumerate(drawn.layers) if layer["type"] == "symbol"]
    fills = [number for number, layer in enumerate(drawn.layers) if layer["type"] == "fill"]
    assert max(fills) < min(labels)


def test_layers_that_are_not_there_are_not_drawn() -> None:
    drawn = map_layers(package("vector", ["earth", "roads", "landuse"]), "light", None)
    assert {layer["source-layer"] for layer in drawn.layers} == {"earth", "roads", "landuse"}


def test_an_unknown_schema_is_drawn_by_geometry_and_said_so() -> None:
    drawn = map_layers(package("vector", ["contours", "my_lakes"], ["height"]), "light", None)
    assert {layer["type"] for layer in drawn.layers} == {"fill", "line", "circle"}
    assert drawn.notes == [MapDrawnPlainly("schema_unknown")]
    fills = {layer["source-layer"]: layer["paint"]["fill-color"] for layer in drawn.layers if layer["type"] == "fill"}
    assert fills["contours"] != fills["my_lakes"]


def test_an_archive_without_layer_names_says_so() -> None:
    drawn = map_layers(package("vector", []), "light", None)
    assert drawn.layers == []
    assert drawn.notes == [MapDrawnPlainly("layers_not_named")]


def test_pictures_keep_their_pixels_and_are_dimmed_in_the_dark() -> None:
    light, dark = (map_layers(package("raster", []), theme, 512) for theme in ("light", "dark"))
    assert light.source == {
        "type": "raster",
        "url": "pmtiles:///api/maps/0123456789abcdef/tiles.pmtiles",
        "attribution": "somebody",
        "tileSize": 512,
    }
    assert "raster-brightness-max" not in light.layers[0]["paint"]
    assert dark.layers[0]["paint"]["raster-brightness-max"] < 1
