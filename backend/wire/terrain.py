"""Uploaded terrain, and the ground below a way, as the API tells of them."""

from __future__ import annotations

from datetime import datetime
from typing import Literal

from backend.reasons import Reason
from backend.spec import Model
from backend.wire.maps import Box


class TerrainFile(Model):
    """One uploaded file of heights. `terrain_id` is made from its content. spacing_m: between two heights, at most."""

    terrain_id: str
    name: str
    format: Literal["geotiff", "terrarium"]
    bounds: Box
    spacing_m: float
    size_bytes: int
    added_at_utc: datetime


class TerrainList(Model):
    """By name. `room_bytes`: how large an upload may be. `unusable`: files in the folder that are no terrain."""

    terrains: list[TerrainFile]
    room_bytes: int
    unusable: list[Reason]


class Profile(Model):
    """The ground below the next leg, straight or around what may not be crossed. Heights in metres AMSL.

    distance_m, ground_m: (n,) along the way; None where the terrain does not know it. altitude_amsl_m: at which it is
    flown. lowest_m, highest_m: the ground within tolerance of the way, at worst. known: there is terrain; else the
    ground is taken to be level with home. objections: what safety has against it.
    """

    distance_m: list[float]
    ground_m: list[float | None]
    altitude_amsl_m: float
    home_amsl_m: float
    lowest_m: float | None
    highest_m: float | None
    minimum_clearance_m: float
    maximum_above_ground_m: float
    known: bool
    objections: list[Reason]
