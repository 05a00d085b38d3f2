"""The place of the search: ground and grid, target area, fence, no-fly zones, home, north."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from shapely.geometry.base import BaseGeometry

from backend.scene.colours import Palette, flat
from backend.scene.content import Content
from backend.scene.items import Item, Label, Lines, Surface
from backend.scene.relief import relief_surface
from backend.scene.shapes import at_height, box, circle, outline, plate, rings, segments, wall
from backend.wire.scene import SceneLayer

GROUND_Z, GRID_Z, AREA_Z, OUTLINE_Z = -0.6, -0.4, -0.2, 0.1
"""Flat things one above the other, so that none hides another by chance."""

GRID_EXTENTS = 1.6


def line_colours(count: int, colour: tuple[int, int, int]) -> np.ndarray:
    """(count, 2, 3) uint8: the same at both ends of each segment."""
    return np.tile(np.array(colour, np.uint8), (count, 2, 1))


def one_line(name: str, layer: SceneLayer, points: np.ndarray, colour: tuple[int, int, int], width_px: float) -> Lines:
    """points: (n, 2, 3) m, a start and an end a segment."""
    return Lines(name, layer, points, line_colours(len(points), colour), width_px)


def grid_step(extent_m: float) -> float:
    """1, 2 or 5 times a power of ten, so that six to fifteen steps span the scene."""
    rough = extent_m / 6
    power = 10 ** math.floor(math.log10(rough))
    return next(step * power for step in (5, 2, 1) if step * power <= rough)


def surroundings(content: Content, palette: Palette, centre: tuple[float, float], extent_m: float) -> Iterator[Item]:
    """centre, extent_m: of the ground and its grid; the rest has its own place and size."""
    if content.relief is None:
        yield from _ground(palette, centre, extent_m)
    else:
        yield relief_surface(content.relief, palette)
    yield from _area(content, palette, extent_m)
    yield from _fence(content, palette)
    for number, zone in enumerate(content.no_fly):
        yield from _no_fly(number, zone, content.highest_m, palette)
    if content.home is not None:
        x, y = content.home
        ring = segments(circle(x, y, OUTLINE_Z, extent_m * 0.018), closed=True)
        yield one_line("home/ring", "area", ring, palette.ink, 2.0)
        yield Label("home/label", "labels", "home", (x, y, extent_m * 0.012), size=0.9)


def _ground(palette: Palette, centre: tuple[float, float], extent_m: float) -> Iterator[Item]:
    step = grid_step(extent_m)
    reach = math.ceil(GRID_EXTENTS * extent_m / step) * step
    x0, y0 = (round(value / step) * step for value in centre)
    vertices, faces = box((x0 - 3 * reach, y0 - 3 * reach, GROUND_Z - 1), (x0 + 3 * reach, y0 + 3 * reach, GROUND_Z))
    yield Surface("terrain/plane", "terrain", vertices, faces, flat(palette.ground, 1.0, len(vertices)))
    ticks = np.arange(-reach, reach + step / 2, step)
    ends = np.array([-reach, reach])
    along_y = [[(x0 + tick, y0 + end, GRID_Z) for end in ends] for tick in ticks]
    along_x = [[(x0 + end, y0 + tick, GRID_Z) for end in ends] for tick in ticks]
    lines = np.array(along_x + along_y, np.float32)
    major = np.round(np.concatenate((y0 + ticks, x0 + ticks)) / step) % 5 == 0
    colours = np.where(major[:, None, None], np.array(palette.grid_major), np.array(palette.grid)).astype(np.uint8)
    yield Lines("terrain/grid", "terrain", lines, np.repeat(colours, 2, axis=1), 1.0)


def _area(content: Content, palette: Palette, extent_m: float) -> Iterator[Item]:
    vertices, faces = plate(content.area, AREA_Z)
    yield Surface("area/plate", "area", vertices, faces, flat(palette.grid_major, 0.55, len(vertices)))
    yield one_line("area/outline", "area", outline(content.area, OUTLINE_Z), palette.area, 2.5)
    west, south, east, _ = content.area.bounds
    step = grid_step(extent_m)
    scale = np.array([[(west, south - 0.035 * extent_m, 0), (west + step, south - 0.035 * extent_m, 0)]], np.float32)
    yield one_line("scale/bar", "labels", scale, palette.ink, 3.0)
    middle = (west + step / 2, south - 0.05 * extent_m, 0.0)
    yield Label("scale/label", "labels", f"{step:g} m", middle, "top-center", 0.9)
    x, top = (west + east) / 2, content.fence.bounds[3] + 0.07 * extent_m
    tip = 0.035 * extent_m
    left, right = (x - tip / 3, top - tip / 2, 0), (x + tip / 3, top - tip / 2, 0)
    arrow = [(x, top - tip, 0), (x, top, 0), left, (x, top, 0), right]
    yield one_line("north/arrow", "labels", segments(arrow), palette.ink, 2.5)
    yield Label("north/label", "labels", "N", (x, top + 0.01 * extent_m, 0.0), size=1.1)


def _fence(content: Content, palette: Palette) -> Iterator[Item]:
    """A low see-through wall on the ground, its line, and the ceiling above it."""
    yield one_line("fence/foot", "fence", outline(content.fence, OUTLINE_Z), palette.fence, 2.0)
    yield one_line("fence/top", "fence", outline(content.fence, content.flight_altitude_m), palette.fence, 1.0)
    for number, ring in enumerate(rings(content.fence)):
        vertices, faces = wall(ring, 0.0, content.flight_altitude_m)
        yield Surface(f"fence/wall/{number}", "fence", vertices, faces, flat(palette.fence, 0.06, len(vertices)))


def _no_fly(number: int, zone: BaseGeometry, highest_m: float, palette: Palette) -> Iterator[Item]:
    yield one_line(f"no_fly/{number}/foot", "no_fly", outline(zone, OUTLINE_Z), palette.no_fly, 2.0)
    yield one_line(f"no_fly/{number}/top", "no_fly", outline(zone, highest_m), palette.no_fly, 1.5)
    corners = np.concatenate([*rings(zone), np.empty((0, 2))])
    posts = np.stack((at_height(corners, 0.0), at_height(corners, highest_m)), axis=1)
    yield one_line(f"no_fly/{number}/posts", "no_fly", posts, palette.no_fly, 1.0)
    for part, ring in enumerate(rings(zone)):
        vertices, faces = wall(ring, 0.0, highest_m)
        name = f"no_fly/{number}/wall/{part}"
        yield Surface(name, "no_fly", vertices, faces, flat(palette.no_fly, 0.16, len(vertices)))
    vertices, faces = plate(zone, AREA_Z + 0.1)
    yield Surface(f"no_fly/{number}/plate", "no_fly", vertices, faces, flat(palette.no_fly, 0.25, len(vertices)))
