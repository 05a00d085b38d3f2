"""The belief as a landscape: where the emitter probably is, the ground rises and turns from blue to yellow."""

from __future__ import annotations

import math

import numpy as np
import shapely
from numpy.typing import NDArray

from backend.scene.colours import cividis
from backend.scene.items import Surface
from planner.belief.grid import GridBelief

MOST_CELLS = 128
"""A finer grid is averaged down to this many cells a side: more than a screen shows."""

INVISIBLE_SHARE = 2e-3
"""Cells with less than this share of the peak are left out: the surface fades to nothing at 0."""

FLATTEST, RISE, HIGHEST = 0.03, 0.045, 0.34
"""Height of the peak in extents: without information, for each doubling of the peak's density, and at most."""

FOOT_Z = 0.3


def peak_height_m(belief: GridBelief, extent_m: float) -> float:
    """How high the peak is drawn: it grows with the logarithm of the density gained over a uniform one."""
    gained = math.log2(max(1.0, peak_density(belief) * _area_m2(belief)))
    return extent_m * min(HIGHEST, FLATTEST + RISE * gained)


def peak_density(belief: GridBelief) -> float:
    """1/m^2."""
    return float(belief.density.max()) / belief.h**2


def _area_m2(belief: GridBelief) -> float:
    """Of the target area (its rings combine by the even-odd rule)."""
    shape = shapely.Polygon()
    for ring in belief.area:
        shape = shape.symmetric_difference(shapely.Polygon(ring))
    return float(shape.area)


def coarsened(density: NDArray[np.float64]) -> tuple[NDArray[np.float64], int]:
    """Block means, and how many cells a block has along a side; a grid that is small enough stays as it is."""
    block = -(-max(density.shape) // MOST_CELLS)
    if block == 1:
        return density, 1
    ny, nx = (-(-n // block) * block for n in density.shape)
    padded = np.zeros((ny, nx))
    padded[: density.shape[0], : density.shape[1]] = density
    return padded.reshape(ny // block, block, nx // block, block).mean(axis=(1, 3)), block


def height_at(belief: GridBelief, x: float, y: float, height_m: float) -> float:
    """Height of the surface over a place; the ground's where the grid does not reach."""
    column, row = math.floor((x - belief.x0) / belief.h), math.floor((y - belief.y0) / belief.h)
    if not (0 <= column < belief.nx and 0 <= row < belief.ny):
        return FOOT_Z
    return FOOT_Z + height_m * float(belief.density[row, column] / belief.density.max())


def belief_surface(belief: GridBelief, height_m: float) -> Surface | None:
    """Vertices at the cell centres, z = height * p / peak, colour by cividis(sqrt(p / peak)) with light from the west.

    A rim of zeros is put around the grid, so that the surface comes down to the ground where the area ends.
    """
    density, block = coarsened(belief.density)
    share = np.pad(density / density.max(), 1)
    ny: int
    nx: int
    ny, nx = share.shape
    cell = belief.h * block
    x = belief.x0 + (np.arange(nx) - 0.5) * cell
    y = belief.y0 + (np.arange(ny) - 0.5) * cell
    z = height_m * share
    vertices = np.column_stack((*(part.ravel() for part in np.meshgrid(x, y)), FOOT_Z + z.ravel())).astype(np.float32)
    corner = (np.arange(ny - 1)[:, None] * nx + np.arange(nx - 1)).ravel()
    quads = np.stack((corner, corner + 1, corner + nx + 1, corner + nx), axis=1)
    seen = share.ravel()[quads].max(axis=1) > INVISIBLE_SHARE
    quads = quads[seen]
    if not len(quads):
        return None
    used, renumbered = np.unique(quads, return_inverse=True)
    quads = renumbered.reshape(quads.shape)
    faces = np.concatenate((quads[:, [0, 1, 2]], quads[:, [0, 2, 3]])).astype(np.uint32)
    shaded = cividis(np.sqrt(share)) * _light(z, cell)[..., None]
    alpha = 0.92 * np.minimum(1.0, 2.2 * np.sqrt(share))
    colours = np.rint(np.dstack((shaded, 255 * alpha))).clip(0, 255).astype(np.uint8).reshape(-1, 4)
    return Surface("belief/surface", "belief", vertices[used], faces, colours[used])


def _light(z: NDArray[np.float64], cell: float) -> NDArray[np.float64]:
    """(ny, nx) brightness 0.72..1.12 of a lamp in the north-west, by the slope of the surface (hill shading)."""
    slope_y, slope_x = np.gradient(z, cell)
    normal = np.dstack((-slope_x, -slope_y, np.ones_like(z)))
    normal /= np.linalg.norm(normal, axis=2, keepdims=True)
    lamp = np.array([-0.5, 0.4, 0.77])
    return 0.72 + 0.4 * np.clip(normal @ (lamp / np.linalg.norm(lamp)), 0.0, 1.0)
