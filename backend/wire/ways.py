"""Ways and barriers of a mission, as the API tells of them."""

from __future__ import annotations

from datetime import datetime
from typing import Any, Literal

from pydantic import Field

from backend.reasons import Reason
from backend.spec import Model


class WayProperties(Model):
    """road: for cars and on foot. path: on foot. barrier: what cannot be crossed but by a road or path."""

    kind: Literal["road", "path", "barrier"]


class WayFeature(Model):
    """A GeoJSON feature, MultiLineString or MultiPolygon. Across the antimeridian longitudes go on beyond 180."""

    type: Literal["Feature"] = "Feature"
    geometry: dict[str, Any]
    properties: WayProperties


class MissionWays(Model):
    """A GeoJSON FeatureCollection of what can be gone along and what cannot be crossed; empty, without a name, when
    nothing was uploaded. roads_m, paths_m: their lengths. barriers: how many. notes: what was left out of the file."""

    type: Literal["FeatureCollection"] = "FeatureCollection"
    name: str | None = None
    added_at_utc: datetime | None = None
    roads_m: float = 0.0
    paths_m: float = 0.0
    barriers: int = 0
    notes: list[Reason] = Field(default_factory=list[Reason])
    features: list[WayFeature] = Field(default_factory=list[WayFeature])
