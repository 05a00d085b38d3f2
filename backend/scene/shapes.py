"""Meshes and line segments from geometry: pure numbers in, pure numbers out. Metres, z up.

A mesh is (vertices (n, 3) float32, faces (m, 3) uint32).
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
import shapely
from numpy.typing import ArrayLike, NDArray
from shapely import Polygon
from shapely.geometry.base import BaseGeometry

Mesh = tuple[NDArray[np.float32], NDArray[np.uint32]]


def join(meshes: Iterable[Mesh]) -> Mesh:
    """Several meshes as one."""
    vertices, faces, count = [np.empty((0, 3), np.float32)], [np.empty((0, 3), np.uint32)], 0
    for part_vertices, part_faces in meshes:
        vertices.append(part_vertices)
        faces.append(part_faces + count)
        count += len(part_vertices)
    return np.concatenate(vertices).astype(np.float32), np.concatenate(faces).astype(np.uint32)


def segments(points: ArrayLike, closed: bool = False) -> NDArray[np.float32]:
    """(n, 3) corners of a polyline to (n - 1, 2, 3) segments, or n when it is closed."""
    corners = np.asarray(points, np.float32).reshape(-1, 3)
    if closed and len(corners) > 1:
        corners = np.concatenate((corners, corners[:1]))
    return np.stack((corners[:-1], corners[1:]), axis=1)


def at_height(xy: ArrayLike, z: float) -> NDArray[np.float32]:
    """(n, 2) to (n, 3)."""
    flat = np.asarray(xy, np.float32).reshape(-1, 2)
    return np.column_stack((flat, np.full(len(flat), z, np.float32)))


def rings(geometry: BaseGeometry) -> list[NDArray[np.float64]]:
    """Outlines and holes of polygons, (n, 2) each, not closed."""
    found: list[NDArray[np.float64]] = []
    for part in shapely.get_parts(geometry):
        if isinstance(part, Polygon) and not part.is_empty:
            found += [np.asarray(ring.coords)[:-1, :2] for ring in (part.exterior, *part.interiors)]
    return found


def outline(geometry: BaseGeometry, z: float) -> NDArray[np.float32]:
    """Segments along every ring."""
    parts = [segments(at_height(ring, z), closed=True) for ring in rings(geometry)]
    return np.concatenate(parts) if parts else np.empty((0, 2, 3), np.float32)


def plate(geometry: BaseGeometry, z: float) -> Mesh:
    """The polygons filled, holes left out."""
    triangles = [
        triangle
        for part in shapely.get_parts(geometry)
        if isinstance(part, Polygon) and not part.is_empty
        for triangle in shapely.get_parts(shapely.constrained_delaunay_triangles(part))
    ]
    if not triangles:
        return np.empty((0, 3), np.float32), np.empty((0, 3), np.uint32)
    corners = np.concatenate([np.asarray(triangle.exterior.coords)[:3, :2] for triangle in triangles])
    return at_height(corners, z), np.arange(len(corners), dtype=np.uint32).reshape(-1, 3)


def wall(ring: ArrayLike, low: float, high: float, closed: bool = True) -> Mesh:
    """A vertical wall along a ring: vertices first of the foot, then of the top."""
    xy = np.asarray(ring, np.float32).reshape(-1, 2)
    n = len(xy)
    here = np.arange(n if closed else n - 1, dtype=np.uint32)
    there = (here + 1) % n
    faces = np.concatenate((np.stack((here, there, n + there), 1), np.stack((here, n + there, n + here), 1)))
    return np.concatenate((at_height(xy, low), at_height(xy, high))), faces.astype(np.uint32)


def fan(centre: Sequence[float], rim: ArrayLike, closed: bool = True) -> Mesh:
    """Triangles from a centre to a rim (n, 3); vertex 0 is the centre."""
    edge = np.asarray(rim, np.float32).reshape(-1, 3)
    n = len(edge)
    here = np.arange(n if closed else n - 1, dtype=np.uint32)
    faces = np.stack((np.zeros_like(here), 1 + here, 1 + (here + 1) % n), 1)
    return np.concatenate((np.asarray([centre], np.float32), edge)), faces.astype(np.uint32)


def circle(x: float, y: float, z: float, radius: float, corners: int = 48) -> NDArray[np.float32]:
    """(corners, 3) points of a horizontal circle."""
    angle = np.linspace(0.0, 2 * np.pi, corners, endpoint=False)
    return at_height(np.column_stack((x + radius * np.cos(angle), y + radius * np.sin(angle))), z)


def disc(x: float, y: float, z: float, radius: float, corners: int = 24) -> Mesh:
    """Level, at height z."""
    return fan((x, y, z), circle(x, y, z, radius, corners))


def towards(bearing_deg: ArrayLike) -> NDArray[np.float64]:
    """(..., 2) unit vectors east, north of bearings clockwise from north."""
    angle = np.radians(np.asarray(bearing_deg, float))
    return np.stack((np.sin(angle), np.cos(angle)), axis=-1)


def ball(radius: float) -> Mesh:
    """An octahedron with its faces split twice and blown up to a sphere, around the origin."""
    vertices = np.array([(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)], float)
    faces = np.array([(0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4), (2, 0, 5), (1, 2, 5), (3, 1, 5), (0, 3, 5)])
    corners = vertices[faces]
    for _ in range(2):
        a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
        ab, bc, ca = (a + b) / 2, (b + c) / 2, (c + a) / 2
        quarters = ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))
        corners = np.concatenate([np.stack(quarter, 1) for quarter in quarters])
    points = corners.reshape(-1, 3)
    points = radius * points / np.linalg.norm(points, axis=1, keepdims=True)
    return points.astype(np.float32), np.arange(len(points), dtype=np.uint32).reshape(-1, 3)


def box(low: Sequence[float], high: Sequence[float]) -> Mesh:
    """An upright box between two corners."""
    xy = [(low[0], low[1]), (high[0], low[1]), (high[0], high[1]), (low[0], high[1])]
    sides = wall(xy, low[2], high[2])
    lids = [(at_height(xy, z), np.array([(0, 1, 2), (0, 2, 3)], np.uint32)) for z in (low[2], high[2])]
    return join([sides, *lids])
