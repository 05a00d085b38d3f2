"""Polygons in the plane: clipping, hulls, tests, areas. Vectorised numpy, no dependency beyond it.

Frame: local ENU metres. A `Ring` is (n, 2), not closed; a `Region` combines rings by the even-odd rule.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from planner.reasons import AreaCrossesItself, UnusableArea
from planner.types import BoolArray, FloatArray, PlannerError, Region, Ring

_EMPTY = np.empty((0, 2))

AT_ONCE = 2**17
"""Pairs of a point and an edge: a megabyte an array."""


def signed_area(ring: Ring) -> float:
    """Shoelace area in m^2, positive when counter-clockwise."""
    if len(ring) < 3:
        return 0.0
    x, y = ring[:, 0] - ring[0, 0], ring[:, 1] - ring[0, 1]
    return 0.5 * float(np.dot(x, np.roll(y, -1)) - np.dot(np.roll(x, -1), y))


def region_area(region: Region) -> float:
    """Area in m^2 under the even-odd rule (rings must not cross each other)."""
    total = 0.0
    for index, ring in enumerate(region):
        others = tuple(other for k, other in enumerate(region) if k != index)
        depth = sum(bool(contains((other,), ring[:1])[0]) for other in others)
        total += (-1.0) ** depth * abs(signed_area(ring))
    return total


def bounds(region: Region) -> tuple[float, float, float, float]:
    """(x_min, y_min, x_max, y_max) of all vertices, m."""
    points = np.concatenate(region)
    (x_min, y_min), (x_max, y_max) = points.min(axis=0), points.max(axis=0)
    return float(x_min), float(y_min), float(x_max), float(y_max)


def edges(region: Region) -> tuple[FloatArray, FloatArray]:
    """Start and end points (m, 2) of every edge of every ring."""
    if not region:
        return _EMPTY, _EMPTY
    corners = np.concatenate(region)
    lasts = np.cumsum([len(ring) for ring in region]) - 1
    following = np.arange(1, len(corners) + 1)
    following[lasts] = np.concatenate([[0], lasts[:-1] + 1])
    return corners, corners[following]


def contains(region: Region, points: FloatArray) -> BoolArray:
    """Even-odd test. points: (n, 2). Returns (n,) bool; points on the border may fall on either side."""
    return np.count_nonzero(_east_of(*edges(region), points), axis=1) % 2 == 1


def contains_each(rings: Sequence[Ring], points: FloatArray) -> BoolArray:
    """(rings, n) bool: as `contains`, of every ring alone."""
    points = np.asarray(points, dtype=float).reshape(-1, 2)
    inside = np.zeros((len(rings), len(points)), dtype=bool)
    if len(rings) == 0:
        return inside
    start, end = edges(tuple(rings))
    firsts = np.cumsum([0, *(len(ring) for ring in rings[:-1])])
    step = max(1, AT_ONCE // len(start))
    for k in range(0, len(points), step):
        counts = np.add.reduceat(_east_of(start, end, points[k : k + step]), firsts, axis=1, dtype=np.int64)
        inside[:, k : k + step] = counts.T % 2 == 1
    return inside


def _east_of(start: FloatArray, end: FloatArray, points: FloatArray) -> BoolArray:
    """(n, m) bool: which of (m, 2) edges a ray from each of (n, 2) points to the east crosses."""
    points = np.asarray(points, dtype=float).reshape(-1, 2)
    x, y = points[:, :1], points[:, 1:]
    spans = (start[:, 1] > y) != (end[:, 1] > y)
    rise = np.where(end[:, 1] == start[:, 1], 1.0, end[:, 1] - start[:, 1])
    crossing = start[:, 0] + (y - start[:, 1]) / rise * (end[:, 0] - start[:, 0])
    return spans & (x < crossing)


def clip_half_plane(ring: Ring, point: FloatArray, normal: FloatArray) -> Ring:
    """The part of `ring` where normal . (p - point) >= 0 (Sutherland and Hodgman 1974), (0, 2) when nothing is left."""
    if len(ring) == 0:
        return _EMPTY
    depth = (ring - point) @ normal
    if (depth >= 0).all():
        return ring
    following, depth_following = np.roll(ring, -1, axis=0), np.roll(depth, -1)
    kept: list[FloatArray] = []
    for p, q, dp, dq in zip(ring, following, depth, depth_following, strict=True):
        if dp >= 0:
            kept.append(p)
        if (dp >= 0) != (dq >= 0):
            kept.append(p + (dp / (dp - dq)) * (q - p))
    return np.array(kept) if kept else _EMPTY


def clip_convex(ring: Ring, window: Ring) -> Ring:
    """Intersection of `ring` with the convex polygon `window` (either orientation)."""
    if signed_area(window) < 0:
        window = window[::-1]
    for p, q in zip(window, np.roll(window, -1, axis=0), strict=True):
        ring = clip_half_plane(ring, p, np.array([-(q[1] - p[1]), q[0] - p[0]]))
    return ring


def clip_wedge(ring: Ring, x: float, y: float, angle: float, half_angle: float) -> Ring:
    """The part of `ring` seen from (x, y) within `half_angle` < pi/2 of direction `angle` (rad ccw from east)."""
    apex = np.array([x, y])
    right, left = angle - half_angle, angle + half_angle
    ring = clip_half_plane(ring, apex, np.array([-np.sin(right), np.cos(right)]))
    return clip_half_plane(ring, apex, np.array([np.sin(left), -np.cos(left)]))


def wedge_polygon(x: float, y: float, angle: float, half_angle: float, length: float) -> Ring:
    """Triangle from the apex (x, y) reaching `length` m along `angle`, (3, 2)."""
    reach = length / np.cos(half_angle)
    directions = np.array([angle - half_angle, angle + half_angle])
    far = np.column_stack([x + reach * np.cos(directions), y + reach * np.sin(directions)])
    return np.vstack([[x, y], far])


def centres(start: float, h: float, n: int) -> FloatArray:
    """(n,) m: the middles of n intervals of length h from `start`."""
    return np.asarray(start + (np.arange(n) + 0.5) * h, dtype=np.float64)


def convex_hull(points: FloatArray) -> Ring:
    """Counter-clockwise convex hull of (n, 2) points by Andrew's monotone chain; collinear points are dropped."""
    ordered = np.unique(np.asarray(points, dtype=float).reshape(-1, 2), axis=0)
    if len(ordered) < 3:
        return ordered
    # plain numbers: the same arithmetic, without an array for every point
    x, y = ordered[:, 0].tolist(), ordered[:, 1].tolist()

    def left_of(o: int, p: int, q: int) -> float:
        return (x[p] - x[o]) * (y[q] - y[o]) - (y[p] - y[o]) * (x[q] - x[o])

    def half(order: Iterable[int]) -> list[int]:
        chain: list[int] = []
        for q in order:
            while len(chain) > 1 and left_of(chain[-2], chain[-1], q) <= 0.0:
                chain.pop()
            chain.append(q)
        return chain[:-1]

    return np.asarray(ordered[half(range(len(x))) + half(range(len(x) - 1, -1, -1))], dtype=np.float64)


def cells_hull(cells: BoolArray, x0: float, y0: float, h: float) -> Ring:
    """Counter-clockwise convex hull of the marked cells, (ny, nx) bool, of size h from the corner (x0, y0)."""
    rows = np.flatnonzero(cells.any(axis=1))
    first, past = cells[rows].argmax(axis=1), cells.shape[1] - cells[rows, ::-1].argmax(axis=1)
    corners = [
        np.column_stack([x0 + columns * h, y0 + (rows + above) * h]) for columns in (first, past) for above in (0, 1)
    ]
    return convex_hull(np.asarray(np.concatenate(corners), dtype=np.float64))


def distance_to_edges(points: FloatArray, region: Region) -> FloatArray:
    """Distance in m from each of (n, 2) points to the nearest edge of any ring, from inside or outside."""
    points = np.asarray(points, dtype=float).reshape(-1, 2)
    start, end = edges(region)
    along = end - start
    length2 = np.maximum((along**2).sum(axis=1), 1e-300)
    offset = points[:, None, :] - start
    t = np.clip((offset * along).sum(axis=2) / length2, 0.0, 1.0)
    return np.sqrt(((offset - t[..., None] * along) ** 2).sum(axis=2)).min(axis=1)


def distance_to_convex(points: FloatArray, hull: Ring) -> FloatArray:
    """Distance in m from each of (n, 2) points to a convex polygon (0 inside); the hull may be a point or a segment."""
    points = np.asarray(points, dtype=float).reshape(-1, 2)
    distance = distance_to_edges(points, (hull,))
    if len(hull) >= 3:
        along, offset = np.roll(hull, -1, axis=0) - hull, points[:, None, :] - hull
        turn = along[:, 0] * offset[..., 1] - along[:, 1] * offset[..., 0]
        inside = (turn >= 0).all(axis=1) | (turn <= 0).all(axis=1)
        distance = np.where(inside, 0.0, distance)
    return distance


def cells_touching(region: Region, x0: float, y0: float, h: float, nx: int, ny: int) -> BoolArray:
    """(ny, nx) bool: the square cells of size h from the south-west corner (x0, y0) that the region touches."""
    columns, rows = np.meshgrid(centres(x0 - 0.5 * h, h, nx + 1), centres(y0 - 0.5 * h, h, ny + 1))
    corners = contains(region, np.column_stack([columns.ravel(), rows.ravel()])).reshape(ny + 1, nx + 1)
    touched = corners[:-1, :-1] | corners[:-1, 1:] | corners[1:, :-1] | corners[1:, 1:]
    for p, q in zip(*edges(region), strict=True):
        low, high = (p, q) if p[1] <= q[1] else (q, p)
        first = np.clip(int(np.floor((low[1] - y0) / h)), 0, ny - 1)
        last = np.clip(int(np.ceil((high[1] - y0) / h)) - 1, first, ny - 1)
        for row in range(first, last + 1):
            band = np.clip([y0 + row * h, y0 + (row + 1) * h], low[1], high[1])
            rise = high[1] - low[1]
            ends = low[0] + (band - low[1]) / rise * (high[0] - low[0]) if rise > 0 else np.array([low[0], high[0]])
            left = np.clip(int(np.floor((ends.min() - x0) / h + 1e-9)), 0, nx - 1)
            right = np.clip(int(np.ceil((ends.max() - x0) / h - 1e-9)) - 1, left, nx - 1)
            touched[row, left : right + 1] = True
    return touched


def validate_area(region: Region) -> Region:
    """The search area with finite float64 rings that are not closed. PlannerError when it is not usable."""
    if len(region) == 0:
        raise PlannerError(UnusableArea("no_ring"))
    return tuple(_validate_ring(np.asarray(ring, dtype=float)) for ring in region)


def _validate_ring(ring: Ring) -> Ring:
    if ring.ndim != 2 or ring.shape[1] != 2 or len(ring) < 3:
        raise PlannerError(UnusableArea("too_few_corners"))
    if not np.isfinite(ring).all():
        raise PlannerError(UnusableArea("not_finite"))
    if (ring[0] == ring[-1]).all():
        ring = ring[:-1]
    crossing = _self_crossing(ring)
    if crossing is not None:
        raise PlannerError(AreaCrossesItself(float(crossing[0]), float(crossing[1])))
    extent = np.ptp(ring, axis=0).max() if len(ring) else 0.0
    if abs(signed_area(ring)) <= 1e-12 * max(extent, 1e-150) ** 2:
        raise PlannerError(UnusableArea("no_extent"))
    return np.ascontiguousarray(ring)


def _self_crossing(ring: Ring) -> FloatArray | None:
    following = np.roll(ring, -1, axis=0)
    for k in range(len(ring)):
        others = np.arange(len(ring)) != k
        p, q = ring[k], following[k]
        a, b = ring[others], following[others]
        sides = _cross(p, q, a) * _cross(p, q, b) < 0
        hit = sides & (_cross(a, b, p) * _cross(a, b, q) < 0)
        if hit.any():
            return 0.5 * (p + q)
    return None


def _cross(o: FloatArray, p: FloatArray, q: FloatArray) -> FloatArray:
    """z of (p - o) x (q - o); positive when q lies left of o -> p. Broadcasts over leading axes."""
    return (p[..., 0] - o[..., 0]) * (q[..., 1] - o[..., 1]) - (p[..., 1] - o[..., 1]) * (q[..., 0] - o[..., 0])
