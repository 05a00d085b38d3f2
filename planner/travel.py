"""Ways the platform may fly: straight, or around what may not be crossed, by a visibility graph.

The graph's nodes are the corners of no-fly areas and of the flight area, moved `CLEARANCE` m into free space.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np

from planner.geometry import edges, signed_area
from planner.kernels.crossing import CROSSES, TOUCHES, meetings
from planner.policy.actions import may_fly
from planner.types import FloatArray, PlannerError, Problem, Region

CLEARANCE = 1.0

_KEPT = 4
"""Areas whose road map, and lattices whose distances, are kept: they stay the same for a mission and take a while."""


@dataclass(frozen=True, slots=True, eq=False)
class RoadMap:
    """What may not be crossed, and the corners to fly around. barriers: rings. nodes: (n, 2) m.

    distances: (n, n) m along free ways, infinite where there is none. before: (n, n) predecessors on them.
    """

    barriers: Region
    nodes: FloatArray
    distances: FloatArray
    before: np.ndarray


@dataclass(frozen=True, slots=True)
class _Air:
    """Where a problem lets the platform fly; equal for problems that differ in nothing else."""

    flight_area: tuple[bytes, ...]
    no_fly: tuple[bytes, ...]
    problem: Problem = field(compare=False)


def _air(problem: Problem) -> _Air:
    flight_area = tuple(ring.tobytes() for ring in problem.flight_area or ())
    return _Air(flight_area, tuple(ring.tobytes() for ring in problem.no_fly), problem)


def road_map(problem: Problem) -> RoadMap:
    """The visibility graph of the problem's flight area and no-fly areas."""
    return _road_map(_air(problem))


@lru_cache(_KEPT)
def _road_map(air: _Air) -> RoadMap:
    problem = air.problem
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


def lattice_distances(problem: Problem, places: FloatArray) -> FloatArray:
    """(l, l) m of the shortest free ways between (l, 2) places."""
    return _lattice_distances(_air(problem), np.asarray(places, dtype=float).tobytes())


@lru_cache(_KEPT)
def _lattice_distances(air: _Air, packed: bytes) -> FloatArray:
    problem, places, roads = air.problem, np.frombuffer(packed).reshape(-1, 2), _road_map(air)
    direct = _lengths(problem, roads.barriers, places, places)
    to_node = _lengths(problem, roads.barriers, places, roads.nodes)
    from_node, around = np.full_like(to_node, np.inf), np.full_like(direct, np.inf)
    for k in range(len(roads.nodes)):
        np.minimum(from_node, to_node[:, k, None] + roads.distances[k], out=from_node)
    for k in range(len(roads.nodes)):
        np.minimum(around, from_node[:, k, None] + to_node[:, k], out=around)
    return np.minimum(direct, around)


def _shortest_ways(lengths: FloatArray) -> tuple[FloatArray, np.ndarray]:
    """All shortest ways between (n, n) nodes: lengths, infinite without a way, and predecessors, negative for none."""
    if len(lengths) == 0:
        return lengths, np.empty((0, 0), dtype=np.int32)
    from scipy.sparse.csgraph import shortest_path  # takes a while to load: only where there is something to fly around

    return shortest_path(np.where(np.isfinite(lengths), lengths, 0.0), return_predecessors=True)


def _lengths(problem: Problem, barriers: Region, starts: FloatArray, ends: FloatArray) -> FloatArray:
    """(n, m) m of straight flights, infinite where a barrier is crossed.

    One that only touches barriers (a corner, along a side) is held against what may be flown between the touches.
    """
    met = meetings(starts, ends, barriers)
    a, _ = edges(barriers)
    for i, j in zip(*np.nonzero(met == TOUCHES), strict=True):
        p, along = starts[i], ends[j] - starts[i]
        t = (a - p) @ along / max(float(along @ along), 1e-300)
        stops = np.unique(np.concatenate([[0.0, 1.0], t[(t > 0) & (t < 1)]]))
        middles = p + (0.5 * (stops[1:] + stops[:-1]))[:, None] * along
        if not _near_free(problem, middles).all():
            met[i, j] = CROSSES
    return np.where(met == CROSSES, np.inf, np.hypot(*(starts[:, None] - ends).transpose(2, 0, 1)))


def _near_free(problem: Problem, places: FloatArray, step: float = 1e-6) -> np.ndarray:
    """(n,) bool: a place may be flown at, or lies on a border beside such a place."""
    free = may_fly(problem, places)
    for dx, dy in ((step, 0.0), (-step, 0.0), (0.0, step), (0.0, -step)):
        free |= may_fly(problem, places + np.array([dx, dy]))
    return free


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
