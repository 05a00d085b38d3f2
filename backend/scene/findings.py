"""What was measured and concluded: sweeps as roses, bearings as lines with wedges and curtains, C95, estimate."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import shapely
from shapely import LineString, box
from shapely.geometry.base import BaseGeometry

from backend.scene.colours import Palette, between, fading, flat
from backend.scene.content import Content, EstimateMark, SweepMark
from backend.scene.items import Item, Label, Surface
from backend.scene.shapes import ball, circle, fan, outline, rings, segments, towards, wall
from backend.scene.surroundings import one_line

ROSE_RADIUS, ROSE_FLOOR = 0.07, 0.12
"""Radius of a rose in extents, and of the weakest bin in radii."""

WEDGE_SIGMAS = 1.0
LOWEST_QUALITY, HIGHEST_QUALITY = 0.6, 0.95


def findings(content: Content, palette: Palette, extent_m: float, surface_top_m: float) -> Iterator[Item]:
    """surface_top_m: lines of estimates reach above the belief's surface."""
    counted = [number for number, sweep in enumerate(content.sweeps) if sweep.counted]
    for number, sweep in enumerate(content.sweeps):
        age = counted[::-1].index(number) if sweep.counted else 4
        yield from _rose(number, sweep, age, palette, extent_m)
        if sweep.bearing_deg is not None:
            yield from _bearing(number, sweep, age, content.area, palette, extent_m)
    labelled = {(sweep.place_number, sweep.x, sweep.y): sweep for sweep in content.sweeps}
    for sweep in labelled.values():
        z = sweep.z + 0.02 * extent_m
        yield Label(f"places/{sweep.place_number}", "labels", str(sweep.place_number), (sweep.x, sweep.y, z))
    for mark in content.estimates:
        yield from _confidence(mark, palette, extent_m)
        yield from _estimate(mark, palette, extent_m, surface_top_m)


def _rose(number: int, sweep: SweepMark, age: int, palette: Palette, extent_m: float) -> Iterator[Item]:
    """Power against direction around the place, at the height where it was measured; the newest is the strongest."""
    post = segments([(sweep.x, sweep.y, 0.0), (sweep.x, sweep.y, sweep.z)])
    yield one_line(f"sweeps/{number}/post", "roses", post, palette.faint, 1.0)
    power = sweep.power_db
    if not np.isfinite(power).any():
        return
    low, high = np.nanmin(power), np.nanmax(power)
    share = np.nan_to_num((power - low) / max(high - low, 1e-9), nan=0.0)
    radius = extent_m * ROSE_RADIUS * (ROSE_FLOOR + (1 - ROSE_FLOOR) * share)
    width = 360.0 / len(power)
    direction = towards((np.arange(len(power)) + 0.5) * width)
    rim = np.column_stack((np.array([sweep.x, sweep.y]) + radius[:, None] * direction, np.full(len(power), sweep.z)))
    colour = palette.rose if sweep.counted else palette.faint
    strength = max(0.25, 0.8 - 0.14 * age)
    vertices, faces = fan((sweep.x, sweep.y, sweep.z), rim)
    alphas = strength * np.concatenate(([0.35], 0.25 + 0.75 * share))
    yield Surface(f"sweeps/{number}/rose", "roses", vertices, faces, fading(colour, alphas))
    yield one_line(f"sweeps/{number}/rim", "roses", segments(rim, closed=True), colour, 2.0 if age == 0 else 1.2)


def _bearing(
    number: int, sweep: SweepMark, age: int, area: BaseGeometry, palette: Palette, extent_m: float
) -> Iterator[Item]:
    """A line at the height of the antenna, its wedge of one sigma on the ground, and a curtain between the two."""
    unmeasured = 0.5 * (LOWEST_QUALITY + HIGHEST_QUALITY)
    measured = unmeasured if sweep.quality is None else sweep.quality
    quality = (measured - LOWEST_QUALITY) / (HIGHEST_QUALITY - LOWEST_QUALITY)
    colour = between(palette.bearing_low, palette.bearing_high, quality if sweep.counted else 0.0)
    colour = between(palette.grid_major, colour, max(0.45, 1.0 - 0.13 * age))
    reach = _reach(sweep, area, extent_m)
    foot = np.array([sweep.x, sweep.y])
    here = sweep.bearing_deg or 0.0
    end = foot + reach * towards(here)
    line = segments([(*foot, sweep.z), (*end, sweep.z)])
    yield one_line(f"sweeps/{number}/bearing", "bearings", line, colour, max(1.5, 3.0 - 0.4 * age))
    for index, (peak_deg, weight) in enumerate(sweep.peaks):
        tip = foot + reach * towards(peak_deg)
        weak = between(palette.grid_major, colour, weight)
        other = segments([(*foot, sweep.z), (*tip, sweep.z)])
        yield one_line(f"sweeps/{number}/peak/{index}", "bearings", other, weak, 1.0)
    if not sweep.counted:
        return
    strength = max(0.2, 1.0 - 0.2 * age)
    steps = np.linspace(0.0, 1.0, 12)
    curtain, faces = wall(foot + steps[:, None] * (end - foot), 0.0, sweep.z, closed=False)
    veil = np.concatenate((0.03 * strength * (1 - steps), 0.16 * strength * (1 - steps) + 0.02))
    yield Surface(f"sweeps/{number}/curtain", "bearings", curtain, faces, fading(colour, veil))
    spread = WEDGE_SIGMAS * sweep.sigma_deg
    rim = foot + reach * towards(np.linspace(here - spread, here + spread, 13))
    wedge, faces = fan((*foot, 0.2), np.column_stack((rim, np.full(len(rim), 0.2))), closed=False)
    alphas = strength * np.concatenate(([0.34], np.full(len(rim), 0.10)))
    yield Surface(f"sweeps/{number}/wedge", "bearings", wedge, faces, fading(colour, alphas))


def _reach(sweep: SweepMark, area: BaseGeometry, extent_m: float) -> float:
    """To where the bearing leaves the area's surroundings; half an extent when it does not meet them."""
    west, south, east, north = area.bounds
    margin = 0.04 * extent_m
    around = box(west - margin, south - margin, east + margin, north + margin)
    foot = np.array([sweep.x, sweep.y])
    far = foot + 4 * extent_m * towards(sweep.bearing_deg or 0.0)
    crossing = LineString([foot, far]).intersection(around)
    if crossing.is_empty:
        return 0.5 * extent_m
    return float(np.linalg.norm(shapely.get_coordinates(crossing) - foot, axis=1).max())


def _confidence(mark: EstimateMark, palette: Palette, extent_m: float) -> Iterator[Item]:
    """The smallest region with 95 % of the belief, as a low wall."""
    top, name = 0.025 * extent_m, f"c95/{mark.emitter_id}"
    yield one_line(f"{name}/foot", "c95", outline(mark.c95, 0.4), palette.ink, 1.5)
    yield one_line(f"{name}/top", "c95", outline(mark.c95, top), palette.ink, 2.5)
    for number, ring in enumerate(rings(mark.c95)):
        vertices, faces = wall(ring, 0.0, top)
        yield Surface(f"{name}/wall/{number}", "c95", vertices, faces, flat(palette.ink, 0.22, len(vertices)))


def _estimate(mark: EstimateMark, palette: Palette, extent_m: float, surface_top_m: float) -> Iterator[Item]:
    """A pin that rises above the belief, with a circle of the expected error around its foot."""
    top, name = surface_top_m + 0.07 * extent_m, f"estimate/{mark.emitter_id}"
    pin = segments([(mark.x, mark.y, 0.0), (mark.x, mark.y, top)])
    yield one_line(f"{name}/pin", "estimate", pin, palette.ink, 2.5)
    vertices, faces = ball(0.012 * extent_m)
    colour = palette.accent if mark.localized else palette.ink
    head = (mark.x, mark.y, top)
    yield Surface(f"{name}/head", "estimate", vertices, faces, flat(colour, 1.0, len(vertices)), position=head)
    ring = segments(circle(mark.x, mark.y, 0.5, mark.expected_rmse_m), closed=True)
    yield one_line(f"{name}/error", "estimate", ring, colour, 2.5)
    state = "localized" if mark.localized else "not yet"
    words = f"{mark.name}  {state}  ± {mark.expected_rmse_m:.1f} m".lstrip()
    yield Label(f"{name}/label", "labels", words, (mark.x, mark.y, top + 0.02 * extent_m), size=1.15)
