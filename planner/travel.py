"""Ways the platform may fly: straight, or around what may not be crossed, by a visibility graph.

The graph's nodes are the corners of no-fly areas and of the flight area, moved `CLEARANCE` m into free space.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse.csgraph import dijkstra

from planner.geometry import contains, edges, segments_cross, signed_area
from planner.policy.actions import may_fly
from planner.types import FloatArray, PlannerError, Problem, Region

CLEARANCE = 1.0


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
    lengths = _lengths(barriers, nodes, nodes)
    distances, before = dijkstra(np.where(np.isfinite(lengths), lengths, 0.0), return_predecessors=True)
    return RoadMap(barriers, nodes, distances, before)


def travel_distances(problem: Problem, roads: RoadMap, start: FloatArray, ends: FloatArray) -> FloatArray:
    """(n,) m of the shortest free way from `start` (2,) to each of `ends` (n, 2); infinite where there is none."""
    start, ends = _freed(problem, roads, np.asarray(start, dtype=float)), np.asarray(ends, dtype=float).reshape(-1, 2)
    direct = _lengths(roads.barriers, start[None], ends)[0]
    if len(roads.nodes) == 0 or np.isfinite(direct).all():
        return direct
    first = _lengths(roads.barriers, start[None], roads.nodes)[0]
    last = _lengths(roads.barriers, roads.nodes, ends)
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
    if np.isfinite(_lengths(roads.barriers, freed[None], end[None])[0, 0]):
        return np.array([*way, end])
    if len(roads.nodes) == 0:
        raise _no_way(start, end)
    first = _lengths(roads.barriers, freed[None], roads.nodes)[0]
    last = _lengths(roads.barriers, roads.nodes, end[None])[:, 0]
    total = first[:, None] + roads.distances + last
    a, b = np.unravel_index(int(np.argmin(total)), total.shape)
    if not np.isfinite(total[a, b]):
        raise _no_way(start, end)
    chain = [int(b)]
    while chain[-1] != a:
        chain.append(int(roads.before[a, chain[-1]]))
    return np.array([*way, *roads.nodes[chain[::-1]], end])


def may_cross(problem: Problem, start: FloatArray, end: FloatArray) -> bool:
    """Whether the straight flight start -> end stays inside the flight area and out of every no-fly area."""
    ends = np.array([start, end], dtype=float)
    barriers = (*(problem.flight_area or ()), *problem.no_fly)
    return bool(may_fly(problem, ends).all()) and not bool(segments_cross(ends[:1], ends[1:], barriers)[0])


def _lengths(barriers: Region, starts: FloatArray, ends: FloatArray) -> FloatArray:
    """(n, m) m of straight flights, infinite where a barrier is crossed."""
    if len(starts) == 0 or len(ends) == 0:
        return np.empty((len(starts), len(ends)))
    lengths = np.hypot(*(starts[:, None] - ends).transpose(2, 0, 1))
    p, q = np.repeat(starts, len(ends), axis=0), np.tile(ends, (len(starts), 1))
    return np.where(segments_cross(p, q, barriers).reshape(lengths.shape), np.inf, lengths)


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


def inside(region: Region, place: FloatArray) -> bool:
    """Whether one place (2,) lies in the region."""
    return bool(contains(region, np.asarray(place, dtype=float)[None])[0])
