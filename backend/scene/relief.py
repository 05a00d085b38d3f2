"""The ground's relief as a mesh in the scene: heights above the home, lit from the north-west, and seen through."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from backend.scene.colours import Palette
from backend.scene.items import Surface
from backend.search.ground import Ground

SIDE_NODES = 110
SPREAD = 0.9
"""How far the mesh reaches from the middle, in extents of the scene."""
ALPHA = 190
"""What lies on the level of home shows through a hill."""
LIGHT = np.array([-0.5, 0.5, 0.7])


@dataclass(frozen=True, eq=False, slots=True)
class Relief:
    """x: (n,), y: (m,) m ENU. heights: (m, n) m above the home, NaN unknown."""

    x: NDArray[np.float64]
    y: NDArray[np.float64]
    heights: NDArray[np.float64]


def relief_around(ground: Ground, centre: tuple[float, float], extent_m: float) -> Relief | None:
    """None without terrain, and where it knows nothing."""
    if ground.terrain is None:
        return None
    along = np.linspace(-SPREAD * extent_m, SPREAD * extent_m, SIDE_NODES)
    x, y = centre[0] + along, centre[1] + along
    points = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    heights = ground.heights_at(points).reshape(SIDE_NODES, SIDE_NODES) - ground.home_amsl_m
    return None if np.isnan(heights).all() else Relief(x, y, heights)


def relief_surface(relief: Relief, palette: Palette) -> Surface:
    """Faces between four known heights; others are holes."""
    rows, columns = relief.heights.shape
    known = np.isfinite(relief.heights)
    z = np.where(known, relief.heights, 0.0)
    vertices = np.stack((*np.meshgrid(relief.x, relief.y), z), axis=-1).reshape(-1, 3).astype(np.float32)
    number: NDArray[np.int64] = np.arange(rows * columns, dtype=np.int64).reshape(rows, columns)
    corners = (number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1])
    whole = known[:-1, :-1] & known[:-1, 1:] & known[1:, 1:] & known[1:, :-1]
    a, b, c, d = (corner[whole] for corner in corners)
    faces = np.concatenate((np.column_stack((a, b, c)), np.column_stack((a, c, d)))).astype(np.uint32)
    return Surface("terrain/relief", "terrain", vertices, faces, _lit(relief, z, palette))


def _lit(relief: Relief, z: NDArray[np.float64], palette: Palette) -> NDArray[np.uint8]:
    """(n, 4): between the darker of ground and grid in shadow and the brighter in the light."""
    north, east = np.gradient(z, relief.y, relief.x)
    slope = np.stack((-east, -north, np.ones_like(z)), axis=-1)
    light = (slope @ (LIGHT / np.linalg.norm(LIGHT))) / np.linalg.norm(slope, axis=-1)
    share = np.clip((light - 0.35) / 0.6, 0.0, 1.0)[..., None]
    dark, bright = (np.array(colour, float) for colour in sorted((palette.grid_major, palette.ground), key=sum))
    colour = (1 - share) * dark + share * bright
    return np.concatenate((colour, np.full((*z.shape, 1), ALPHA)), axis=-1).reshape(-1, 4).astype(np.uint8)
