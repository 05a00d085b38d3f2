"""Ways the platform may fly: straight, or around what may not be crossed, by a visibility graph.

The graph's nodes are the corners of no-fly areas and of the flight area, moved `CLEARANCE` m into free space.
"""

from __future__ import annotations

import importlib
from dataclasses import dataclass, field
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from planner.airspace import may_fly
from planner.geometry import edges, signed_area
from planner.kernels.crossing import CROSSES, FREE, TOUCHES, meetings
from planner.reasons import NoPlaceToFly, NoWay
from planner.types import BoolArray, FloatArray, PlannerError, Problem, Region

if TYPE_CHECKING:  # takes a while to load: only where there is something to fly around
    from scipy.sparse import csr_array

CLEARANCE = 1.0
SAME_PLACE = 1e-8
"""m. Nodes so near to each other, as of an area that is given twice, are not flown between."""

_KEPT = 4
"""Areas whose graph, and lattices whose distances, are kept: they stay the same for a mission and take a while."""


@dataclass(frozen=True, slots=True, eq=False)
class VisibilityGraph:
    """What may not be crossed, and the corners to fly around. barriers: rings. nodes: (n, 2) m.

    flights: (n, n) m of the free straight flights between nodes; None without nodes. Of thousands of corners few see
    each other, and the shortest ways are looked for when asked from somewhere: all of them would take seconds, and
    hundreds of megabytes.
    """

    barriers: Region
    nodes: FloatArray
    flights: csr_array | None


@dataclass(frozen=True, slots=True)
class _Airspace:
    """Where a problem lets the platform fly; equal for problems that differ in nothing else."""

    flight_area: tuple[bytes, ...]
    no_fly: tuple[bytes, ...]
    problem: Problem = field(compare=False)


def _airspace(problem: Problem) -> _Airspace:
    flight_area = tuple(ring.tobytes() for ring in problem.flight_area or ())
    return _Airspace(flight_area, tuple(ring.tobytes() for ring in problem.no_fly), problem)


def visibility_graph(problem: Problem) -> VisibilityGraph:
    """The visibility graph of the problem's flight area and no-fly areas."""
    return _visibility_graph(_airspace(problem))


@lru_cache(_KEPT)
def _visibility_graph(airspace: _Airspace) -> VisibilityGraph:
    problem = airspace.problem
    barriers = (*(problem.flight_area or ()), *problem.no_fly)
    corners = [_corners(ring, side) for ring in barriers for side in (1.0, -1.0)]
    nodes = np.concatenate(corners) if corners else np.empty((0, 2))
    nodes = nodes[may_fly(problem, nodes)] if len(nodes) else nodes
    return VisibilityGraph(barriers, nodes, _flights(problem, barriers, nodes) if len(nodes) else None)


def _flights(problem: Problem, barriers: Region, nodes: FloatArray) -> csr_array:
    from scipy.sparse import csr_array

    importlib.import_module("scipy.sparse.csgraph")  # now, in a thread: `_ways_from` is asked on the event loop, too
    a, b = np.nonzero(_free(problem, barriers, nodes, nodes))
    lengths = np.hypot(*(nodes[a] - nodes[b]).T)
    apart = lengths > SAME_PLACE
    return csr_array((lengths[apart], (a[apart], b[apart])), shape=(len(nodes), len(nodes)))


def travel_distances(problem: Problem, graph: VisibilityGraph, start: FloatArray, ends: FloatArray) -> FloatArray:
    """(n,) m of the shortest free way from `start` (2,) to each of `ends` (n, 2); infinite where there is none."""
    start, ends = _freed(problem, graph, np.asarray(start, dtype=float)), np.asarray(ends, dtype=float).reshape(-1, 2)
    direct = _lengths(problem, graph.barriers, start[None], ends)[0]
    if graph.flights is None or np.isfinite(direct).all():
        return direct
    to_node, _ = _ways_from(graph.flights, _lengths(problem, graph.barriers, start[None], graph.nodes)[0])
    last = _lengths(problem, graph.barriers, graph.nodes, ends)
    return np.minimum(direct, (to_node[:, None] + last).min(axis=0))


def travel_path(problem: Problem, start: FloatArray, end: FloatArray) -> FloatArray:
    """(n, 2) m: the way points of the shortest free way, both ends included. PlannerError when there is none.

    A platform outside its flight area or inside a no-fly area first leaves by the nearest free place.
    """
    start, end = np.asarray(start, dtype=float), np.asarray(end, dtype=float)
    graph = visibility_graph(problem)
    freed = _freed(problem, graph, start)
    way = [start] if (freed == start).all() else [start, freed]
    # what is compiled is not asked without need: while anything is compiled, a first question waits for that to end
    straight = straight_suffices(problem) and bool(may_fly(problem, end[None])[0])
    if straight or np.isfinite(_lengths(problem, graph.barriers, freed[None], end[None])[0, 0]):
        return np.array([*way, end])
    if graph.flights is None:
        raise _no_way(start, end)
    to_node, before = _ways_from(graph.flights, _lengths(problem, graph.barriers, freed[None], graph.nodes)[0])
    total = to_node + _lengths(problem, graph.barriers, graph.nodes, end[None])[:, 0]
    if not np.isfinite(total).any():
        raise _no_way(start, end)
    chain = [int(np.argmin(total))]
    while before[chain[-1]] < len(graph.nodes):
        chain.append(int(before[chain[-1]]))
    return np.array([*way, *graph.nodes[chain[::-1]], end])


def way_back(problem: Problem, start: FloatArray, home: FloatArray, beside: float) -> FloatArray:
    """(n, 2) m: as `travel_path`, to a home that may itself lie where nothing is flown: in the margin of a no-fly area,
    on the fence. The way then ends by the nearest place where it may. PlannerError when there is no way, or none that
    nears home to `beside` m: then a no-fly area encloses it.
    """
    home = np.asarray(home, dtype=float)
    gate = _freed(problem, visibility_graph(problem), home)
    if np.hypot(*(gate - home)) > beside:
        raise _no_way(np.asarray(start, dtype=float), home)
    way = travel_path(problem, start, gate)
    return way if (gate == home).all() else np.vstack([way, home])


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
    return _lattice_distances(_airspace(problem), np.asarray(places, dtype=float).tobytes())


@lru_cache(_KEPT)
def _lattice_distances(airspace: _Airspace, packed: bytes) -> FloatArray:
    problem, places, graph = airspace.problem, np.frombuffer(packed).reshape(-1, 2), _visibility_graph(airspace)
    direct = _lengths(problem, graph.barriers, places, places)
    to_node = _lengths(problem, graph.barriers, places, graph.nodes)
    if graph.flights is None:
        return direct
    around = np.full_like(direct, np.inf)
    from_place = np.array([_ways_from(graph.flights, first)[0] for first in to_node])
    for k in range(len(graph.nodes)):
        np.minimum(around, from_place[:, k, None] + to_node[:, k], out=around)
    return np.minimum(direct, around)


def _ways_from(flights: csr_array, first: FloatArray) -> tuple[FloatArray, NDArray[np.int32]]:
    """The shortest ways from a place from which the nodes are `first` (n,) m away, infinite where they are not seen.

    (n,) m to each node, infinite without a way, and (n,) the nodes before them: n, the place itself, for the first.
    """
    from scipy.sparse import csr_array
    from scipy.sparse.csgraph import dijkstra

    n, seen = len(first), np.flatnonzero(np.isfinite(first))
    # the place is node n, which no flight leads to: one row more
    lengths, to = np.concatenate([flights.data, first[seen]]), np.concatenate([flights.indices, seen])
    rows = np.append(flights.indptr, len(lengths))
    onward = csr_array((lengths, to, rows), shape=(n + 1, n + 1))
    distances, before = dijkstra(onward, indices=np.array([n]), return_predecessors=True)
    return distances[0, :n], before[0, :n]


def _lengths(problem: Problem, barriers: Region, starts: FloatArray, ends: FloatArray) -> FloatArray:
    """(n, m) m of straight flights, infinite where a barrier is crossed."""
    free = _free(problem, barriers, starts, ends)
    return np.where(free, np.hypot(*(starts[:, None] - ends).transpose(2, 0, 1)), np.inf)


def _free(problem: Problem, barriers: Region, starts: FloatArray, ends: FloatArray) -> BoolArray:
    """(n, m) bool: whether a straight flight crosses no barrier.

    One that only touches barriers (a corner, along a side) is held against what may be flown between the touches.
    """
    met = meetings(starts, ends, barriers)
    for i, j in zip(*np.nonzero(met == TOUCHES), strict=True):
        a, _ = edges(barriers)
        p, along = starts[i], ends[j] - starts[i]
        t = (a - p) @ along / max(float(along @ along), 1e-300)
        stops = np.unique(np.concatenate([[0.0, 1.0], t[(t > 0) & (t < 1)]]))
        middles = p + (0.5 * (stops[1:] + stops[:-1]))[:, None] * along
        met[i, j] = FREE if _near_free(problem, middles).all() else CROSSES
    return met == FREE


def _near_free(problem: Problem, places: FloatArray, step: float = 1e-6) -> BoolArray:
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
    back, forth = back / _norms(back), forth / _norms(forth)
    turn = back[:, 0] * forth[:, 1] - back[:, 1] * forth[:, 0]
    bisector = back - forth
    bisector /= np.maximum(_norms(bisector), 1e-12)
    return (ring + CLEARANCE * bisector)[side * turn > 1e-12]


def _norms(vectors: FloatArray) -> FloatArray:
    """(n, 1) lengths of (n, 2) vectors."""
    return np.asarray(np.linalg.norm(vectors, axis=1, keepdims=True), dtype=np.float64)


def _freed(problem: Problem, graph: VisibilityGraph, place: FloatArray) -> FloatArray:
    """The place itself when it may be flown at, else the nearest place that may."""
    if bool(may_fly(problem, place[None])[0]):
        return place
    a, b = edges(graph.barriers)
    along = b - a
    t = np.clip(((place - a) * along).sum(axis=1) / np.maximum((along**2).sum(axis=1), 1e-300), 0.0, 1.0)
    nearest = a + t[:, None] * along
    away = np.column_stack([-along[:, 1], along[:, 0]]) / np.maximum(_norms(along), 1e-12)
    options = np.concatenate([nearest + CLEARANCE * away, nearest - CLEARANCE * away, graph.nodes])
    options = options[may_fly(problem, options)]
    if len(options) == 0:
        raise PlannerError(NoPlaceToFly())
    return options[int(np.argmin(np.hypot(*(options - place).T)))]


def _no_way(start: FloatArray, end: FloatArray) -> PlannerError:
    return PlannerError(NoWay(float(np.hypot(*(end - start)))))
