"""Ways the platform may fly: straight, or around what may not be crossed, by a visibility graph.

The graph's nodes are the corners of no-fly areas and of the flight area, moved `CLEARANCE` m into free space.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from planner.geometry import edges, segments_cross, segments_touch, signed_area
from planner.policy.actions import may_fly
from planner.types import FloatArray, PlannerError, Problem, Region

CLEARANCE = 1.0

_KEPT_LATTICES = 4
_LATTICES: dict[tuple[bytes, ...], FloatArray] = {}


@dataclass(frozen=True, slots=True)
class RoadMap:
    """What may not be crossed, and the corners to fly around. barriers: rings. nodes: (n, 2) m.

    distances: (n, n) m along free ways, infinite where there is none. before: (n, n) predecessors on them.
    """

    barriers: Region
    nodes: FloatArray
    distances: FloatArray
    before: np.ndarray


def road_map(problem: Problem) -> RoadMap:
    """The visibility graph of the problem's flight area and no-fly areas."""
    barriers = (*(problem.flight_area or ()), *problem.no_fly)
    corners = [_corners(ring, side) for ring in barriers for side in (1.0, -1.0)]
    nodes = np.concatenate(corners) if corners else np.empty((0, 2))
    nodes = nodes[may_fly(problem, nodes)] if len(nodes) else nodes
    lengths = _lengths(problem, barriers, nodes, nodes)
    return RoadMap(barriers, nodes, *_shortest_ways(lengths))


def travel_distances(problem: Problem, roads: RoadMap, start: FloatArray, ends: FloatArray) -> FloatArray:
    """(n,) m of the shortest free way from `start` (2,) to each of `ends` (n, 2); infinite where there is none."""
    start, ends = _freed(problem, roads, np.asarray(start, dtype=float)), np.asarray(ends, dtype=float).reshape(-1, 2)
    direct = _lengths(problem, roads.barriers, start[None], ends)[0]
    if len(roads.nodes) == 0 or np.isfinite(direct).all():
        return direct
    first = _lengths(problem, roads.barriers, start[None], roads.nodes)[0]
    last = _lengths(problem, roads.barriers, roads.nodes, ends)
    to_node = (first[:, None] + roads.distances).min(axis=0)
    return np.minimum(direct, (to_node[:, None] + last).min(axis=0))


def travel_path(problem: Problem, start: FloatArray, end: FloatArray) -> FloatArray:
    """(n, 2) m: the way points of the shortest free way, both ends included. PlannerError when there is none.

    A platform outside its flight area or inside a no-fly area first leaves by the nearest free place.
    """
    start, end = np.asarray(start, dtype=float), np.asarray(end, dtype=float)
    roads = road_map(problem)
    freed = _freed(problem, roads, start)
    way = [start] if (freed == start).all() else [start, freed]
    if np.isfinite(_lengths(problem, roads.barriers, freed[None], end[None])[0, 0]):
        return np.array([*way, end])
    if len(roads.nodes) == 0:
        raise _no_way(start, end)
    first = _lengths(problem, roads.barriers, freed[None], roads.nodes)[0]
    last = _lengths(problem, roads.barriers, roads.nodes, end[None])[:, 0]
    total = first[:, None] + roads.distances + last
    a, b = np.unravel_index(int(np.argmin(total)), total.shape)
    if not np.isfinite(total[a, b]):
        raise _no_way(start, end)
    chain = [int(b)]
    while chain[-1] != a:
        chain.append(int(roads.before[a, chain[-1]]))
    return np.array([*way, *roads.nodes[chain[::-1]], end])


def straight_suffices(problem: Problem) -> bool:
    """Whether every straight flight between allowed places is allowed: no no-fly area, a convex flight area or none."""
    if problem.no_fly:
        return False
    if problem.flight_area is None:
        return True
    if len(problem.flight_area) != 1:
        return False
    ring = problem.flight_area[0]
    along = np.roll(ring, -1, axis=0) - ring
    turn = along[:, 0] * np.roll(along[:, 1], -1) - along[:, 1] * np.roll(along[:, 0], -1)
    return bool((turn >= 0).all() or (turn <= 0).all())


def lattice_distances(problem: Problem, roads: RoadMap, places: FloatArray) -> FloatArray:
    """(l, l) m of the shortest free ways between (l, 2) places. Kept for the last few areas, since it takes a while."""
    key = tuple(ring.tobytes() for ring in (places, *roads.barriers))
    if key not in _LATTICES:
        while len(_LATTICES) >= _KEPT_LATTICES:
            _LATTICES.pop(next(iter(_LATTICES)))
        _LATTICES[key] = _all_distances(problem, roads, places)
    return _LATTICES[key]


def _all_distances(problem: Problem, roads: RoadMap, places: FloatArray) -> FloatArray:
    direct = np.concatenate([_lengths(problem, roads.barriers, some, places) for some in _portions(places)])
    if len(roads.nodes) == 0:
        return direct
    to_node = _lengths(problem, roads.barriers, places, roads.nodes)
    from_node = np.min(to_node[:, :, None] + roads.distances, axis=1)
    around = np.full_like(direct, np.inf)
    for k in range(len(roads.nodes)):
        np.minimum(around, from_node[:, k, None] + to_node[:, k], out=around)
    return np.minimum(direct, around)


def _portions(places: FloatArray, size: int = 64) -> list[FloatArray]:
    return [places[first : first + size] for first in range(0, len(places), size)]


def may_cross(problem: Problem, start: FloatArray, end: FloatArray) -> bool:
    """Whether the straight flight start -> end stays inside the flight area and out of every no-fly area."""
    ends = np.array([start, end], dtype=float)
    if not may_fly(problem, ends).all():
        return False
    return not _blocked(problem, (*(problem.flight_area or ()), *problem.no_fly), ends[:1], ends[1:])[0]


def _shortest_ways(lengths: FloatArray) -> tuple[FloatArray, np.ndarray]:
    """All shortest ways between (n, n) nodes after Floyd and Warshall: lengths and predecessors."""
    n = len(lengths)
    distances = lengths.copy()
    before = np.where(np.isfinite(lengths), np.arange(n)[:, None], -1)
    for k in range(n):
        through = distances[:, k, None] + distances[k]
        shorter = through < distances
        distances = np.where(shorter, through, distances)
        before = np.where(shorter, before[k], before)
    return distances, before


def _blocked(problem: Problem, barriers: Region, starts: FloatArray, ends: FloatArray) -> np.ndarray:
    """(n,) bool: straight flights that cross a barrier. One that only touches barriers (a corner, along a side) is held
    against what may be flown at half way between touches.
    """
    blocked = segments_cross(starts, ends, barriers)
    for k in np.flatnonzero(~blocked & segments_touch(starts, ends, barriers)):
        p, q = starts[k], ends[k]
        a, _ = edges(barriers)
        along = q - p
        t = (a - p) @ along / max(float(along @ along), 1e-300)
        stops = np.unique(np.concatenate([[0.0, 1.0], t[(t > 0) & (t < 1)]]))
        middles = p + (0.5 * (stops[1:] + stops[:-1]))[:, None] * along
        blocked[k] = bool((~_near_free(problem, middles)).any())
    return blocked


def _near_free(problem: Problem, places: FloatArray, step: float = 1e-6) -> np.ndarray:
    """(n,) bool: a place may be flown at, or lies on a border beside such a place."""
    free = may_fly(problem, places)
    for dx, dy in ((step, 0.0), (-step, 0.0), (0.0, step), (0.0, -step)):
        free |= may_fly(problem, places + np.array([dx, dy]))
    return free


def _lengths(problem: Problem, barriers: Region, starts: FloatArray, ends: FloatArray) -> FloatArray:
    """(n, m) m of straight flights, infinite where a barrier is crossed."""
    if len(starts) == 0 or len(ends) == 0:
        return np.empty((len(starts), len(ends)))
    lengths = np.hypot(*(starts[:, None] - ends).transpose(2, 0, 1))
    p, q = np.repeat(starts, len(ends), axis=0), np.tile(ends, (len(starts), 1))
    return np.where(_blocked(problem, barriers, p, q).reshape(lengths.shape), np.inf, lengths)


def _corners(ring: FloatArray, side: float) -> FloatArray:
    """The ring's corners moved by CLEARANCE along their bisector, outward (side 1) or inward (-1), where that is round.

    Only corners that stick out towards that side can be turned around on a shortest way.
    """
    if signed_area(ring) < 0:
        ring = ring[::-1]
    back, forth = ring - np.roll(ring, 1, axis=0), np.roll(ring, -1, axis=0) - ring
    back, forth = (v / np.linalg.norm(v, axis=1, keepdims=True) for v in (back, forth))
    turn = back[:, 0] * forth[:, 1] - back[:, 1] * forth[:, 0]
    bisector = back - forth
    bisector /= np.maximum(np.linalg.norm(bisector, axis=1, keepdims=True), 1e-12)
    return (ring + CLEARANCE * bisector)[side * turn > 1e-12]


def _freed(problem: Problem, roads: RoadMap, place: FloatArray) -> FloatArray:
    """The place itself when it may be flown at, else the nearest place that may."""
    if bool(may_fly(problem, place[None])[0]):
        return place
    a, b = edges(roads.barriers)
    along = b - a
    t = np.clip(((place - a) * along).sum(axis=1) / np.maximum((along**2).sum(axis=1), 1e-300), 0.0, 1.0)
    nearest = a + t[:, None] * along
    away = np.column_stack([-along[:, 1], along[:, 0]]) / np.maximum(np.linalg.norm(along, axis=1)[:, None], 1e-12)
    options = np.concatenate([nearest + CLEARANCE * away, nearest - CLEARANCE * away, roads.nodes])
    options = options[may_fly(problem, options)]
    if len(options) == 0:
        raise PlannerError("no place may be flown to: flight area and no-fly areas leave none, enlarge the fence")
    return options[int(np.argmin(np.hypot(*(options - place).T)))]


def _no_way(start: FloatArray, end: FloatArray) -> PlannerError:
    return PlannerError(
        f"there is no way from ({start[0]:.0f}, {start[1]:.0f}) m to ({end[0]:.0f}, {end[1]:.0f}) m "
        "inside the flight area and around the no-fly areas"
    )
