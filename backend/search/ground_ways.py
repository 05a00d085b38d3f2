"""Ways on foot and by car, as a network for the planner: around what cannot be crossed, and along what was drawn.

Who walks goes anywhere but over barriers, in cells whose size bounds the work, and on each way that was drawn: where
one meets a barrier there is a bridge, a ford or a gate. A cell that a barrier touches is closed, so that no way is
found where there is none; one that leads through a gap of less than two cells is found only where it was drawn. Who
drives keeps to roads.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import STRtree
from shapely.geometry.base import BaseGeometry

from backend.reasons.ways import NoRoadNear, NoWayLeadsThere
from backend.search.errors import MissionInputError
from hardware.frame import LocalFrame
from planner.ways import Ways, parts, ways_from

WayKind = Literal["road", "path", "barrier"]
Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Flags = NDArray[np.bool_]

FARTHEST_M = 20_000.0
"""From the area: who is further away is not advised, and no ground is looked at there."""
CELLS = 96
"""Of the ground that is looked at, along its longer side."""
AROUND_SHARE = 0.5
"""Of the size of where one may listen, by which the ground that is looked at reaches beyond it: room for detours."""
SAMPLES_A_CELL = 4
"""Of a line, to find the cells that it touches: consecutive samples then lie in the same or in neighbouring cells."""
SEGMENTS_AT_ONCE = 5_000
MOST_ROAD_NODES = 40_000
SAME_NODE_M = 0.5
NEAR_ROAD_M = 150.0
"""Who stands further from every road is not at a car."""
MOST_ROADS_NEAR = 500
"""Nodes, of those near enough, that are looked at."""
MAIN_SHARE = 0.5
"""Of the places that the best road near a car leads to: a yard that leads to fewer is not the road that it takes."""
WALK_M_S = 1.3
START_CELLS = 3
"""Who stands in a closed cell, on a shore, may step out of it into an open one as near as this."""
MOVES = np.array([(1, 0), (0, 1), (1, 1), (1, -1), (2, 1), (1, 2), (2, -1), (1, -2)])
BETWEEN: tuple[tuple[tuple[int, int], ...], ...] = (
    (),
    (),
    ((1, 0), (0, 1)),
    ((1, 0), (0, -1)),
    ((1, 0), (1, 1)),
    ((0, 1), (1, 1)),
    ((1, 0), (1, -1)),
    ((0, -1), (1, -1)),
)
"""Columns and rows, of each move and of the cells that it passes: with these ways are at most 3 % too long."""


@dataclass(frozen=True, slots=True)
class Traced:
    """What a file traced on the ground, WGS84, longitude first. A barrier: areas that do not overlap, or lines."""

    kind: WayKind
    geometry: BaseGeometry


@dataclass(frozen=True)
class Ground:
    """m ENU. roads, paths: lines. walls, waters: what cannot be crossed, lines and areas. closed: nobody goes there, on
    a way or not."""

    roads: Sequence[BaseGeometry]
    paths: Sequence[BaseGeometry]
    walls: Sequence[BaseGeometry]
    waters: Sequence[BaseGeometry]
    closed: BaseGeometry

    @cached_property
    def borders(self) -> list[BaseGeometry]:
        """Lines of everything that cannot be crossed."""
        areas = [*self.waters, *shapely.get_parts(self.closed)]
        return _lines([*self.walls, *(area.boundary for area in areas)])

    @cached_property
    def segments(self) -> STRtree:
        """The same, stretch by stretch."""
        return STRtree(np.asarray(shapely.linestrings(_pairs(self.borders)), dtype=object))

    def free(self, start: Floats, ends: Floats) -> Flags:
        """(k,) whether nothing lies between start (2,) and each of ends (k, 2)."""
        free = np.ones(len(ends), dtype=bool)
        straight = shapely.linestrings(np.stack([np.broadcast_to(start, ends.shape), ends], axis=1))
        free[self.segments.query(straight, predicate="intersects")[0]] = False
        return free

    def open_to_ways(self, stretches: Floats) -> Flags:
        """(m,) which of the stretches (m, 2, 2) of a way stay out of what is closed."""
        if self.closed.is_empty or len(stretches) == 0:
            return np.ones(len(stretches), dtype=bool)
        shapely.prepare(self.closed)
        return ~np.asarray(shapely.intersects(self.closed, shapely.linestrings(stretches)), dtype=bool)


@dataclass(frozen=True, slots=True)
class LaidOut:
    """places: where one could listen, reached or not. on_roads: who drives, along them only."""

    ways: Ways
    places: int
    on_roads: bool

    @property
    def unreached(self) -> int:
        """How many of the places no way leads to."""
        return self.places - len(self.ways.measured)


def within_reach(traced: Sequence[Traced], frame: LocalFrame, around: BaseGeometry) -> tuple[Traced, ...]:
    """Those that come as near to a search (m ENU) as any that is read for it: its area may be another than it was."""

    def distance(one: Traced) -> float:
        return shapely.transform(shapely.box(*one.geometry.bounds), frame.to_enu_points).distance(around)

    return tuple(one for one in traced if distance(one) <= FARTHEST_M)


def ground_of(traced: Sequence[Traced], frame: LocalFrame, closed: BaseGeometry) -> Ground:
    """closed: m ENU."""

    def of(*kinds: WayKind, areas: bool = False) -> list[BaseGeometry]:
        found = [shapely.transform(one.geometry, frame.to_enu_points) for one in traced if one.kind in kinds]
        return [part for part in _lines(found) if (part.geom_type == "Polygon") == areas]

    return Ground(of("road"), of("path"), of("barrier"), of("barrier", areas=True), closed)


def along_roads(
    ground: Ground, start: tuple[float, float], around: BaseGeometry, spacing: float, speed_m_s: float
) -> LaidOut:
    """Of a car. around: where one may listen, m ENU; there a place about every `spacing` m of road.

    The car stands on the nearest road that leads to many such places. The way to it is walked, and counts as the longer
    one that could be driven meanwhile. Raises MissionInputError when no road is near, or none leads anywhere.
    """
    here = np.array(start)
    total = sum(road.length for road in ground.roads)
    nodes, stretches = _network(ground.roads, max(min(0.5 * spacing, NEAR_ROAD_M), total / MOST_ROAD_NODES))
    stretches = stretches[ground.open_to_ways(nodes[stretches])]
    away = np.hypot(*(nodes - here).T)
    near = np.argsort(away)[:MOST_ROADS_NEAR]
    near = near[away[near] <= NEAR_ROAD_M]
    near = near[ground.free(here, nodes[near])]
    if len(near) == 0:
        raise MissionInputError(NoRoadNear(float(away.min()), NEAR_ROAD_M), "place")
    wanted = np.flatnonzero(shapely.contains_xy(around, nodes))
    own, part = len(nodes), parts(len(nodes), stretches)
    leads_to = np.bincount(part[wanted], minlength=part.max() + 1)[part[near]]
    car = near[np.argmax(leads_to >= MAIN_SHARE * leads_to.max())]
    wanted = wanted[np.argsort(part[wanted] != part[car], kind="stable")]  # where there are two roads, the car's
    _, one_each = np.unique(np.floor(nodes[wanted] / spacing), axis=0, return_index=True)
    joined = np.array([[own, car]])
    nodes, stretches = np.vstack([nodes, here]), np.vstack([stretches, joined])
    lengths = np.hypot(*(nodes[stretches[:, 0]] - nodes[stretches[:, 1]]).T)
    lengths[-1] *= max(1.0, speed_m_s / WALK_M_S)
    return _laid_out(ways_from(own, nodes, stretches, lengths, wanted[one_each]), len(one_each), on_roads=True)


def on_foot(ground: Ground, start: tuple[float, float], around: BaseGeometry, spacing: float) -> LaidOut:
    """Of somebody who walks. around: where one may listen, m ENU; there a place every `spacing` m, about.

    Raises MissionInputError when no way leads to any of them.
    """
    here = np.array(start)
    field = _Field.of(ground, here, around)
    every = max(1, round(spacing / field.step))
    index = np.arange(field.columns * field.rows)
    column, row = index % field.columns, index // field.columns
    listed = (column % every == every // 2) & (row % every == every // 2) & shapely.contains_xy(around, field.nodes)
    wanted = index[listed & field.open]

    nodes, stretches = [field.nodes], [field.stretches()]
    beside, along = _network(_within([*ground.roads, *ground.paths], field.window), field.step)
    if len(beside):
        cell, is_inside = field.cell_of(beside)
        joins = is_inside & field.open[cell]
        own = len(index) + np.arange(len(beside))
        kept = along[ground.open_to_ways(beside[along])]
        stretches += [len(index) + kept, np.column_stack([own[joins], cell[joins]])]
        nodes.append(beside)
    count = sum(len(part) for part in nodes)
    steps = np.concatenate([field.steps_out(ground, here), wanted[ground.free(here, field.nodes[wanted])]])
    stretches.append(np.column_stack([np.full(len(steps), count), steps]))
    every_node, every_stretch = np.vstack([*nodes, here]), np.concatenate(stretches).astype(np.int64)
    lengths = np.hypot(*(every_node[every_stretch[:, 0]] - every_node[every_stretch[:, 1]]).T)
    return _laid_out(ways_from(count, every_node, every_stretch, lengths, wanted), len(wanted), on_roads=False)


def _laid_out(ways: Ways, places: int, on_roads: bool) -> LaidOut:
    if len(ways.measured) == 0:
        raise MissionInputError(NoWayLeadsThere(places, on_roads), "place")
    return LaidOut(ways, places, on_roads)


@dataclass(frozen=True, slots=True)
class _Field:
    """Cells of the ground. nodes: (n, 2) m, their middles, west to east first. open: (n,) no barrier touches it."""

    west: float
    south: float
    step: float
    columns: int
    rows: int
    nodes: Floats
    open: Flags

    @classmethod
    def of(cls, ground: Ground, here: Floats, around: BaseGeometry) -> _Field:
        x_min, y_min, x_max, y_max = around.bounds
        margin = AROUND_SHARE * max(x_max - x_min, y_max - y_min)
        x_min, y_min, x_max, y_max = around.union(shapely.Point(here)).bounds
        west, south, width, height = x_min - margin, y_min - margin, x_max - x_min, y_max - y_min
        width, height = width + 2 * margin, height + 2 * margin
        step = max(width, height) / CELLS
        columns, rows = int(np.ceil(width / step)), int(np.ceil(height / step))
        x, y = west + (np.arange(columns) + 0.5) * step, south + (np.arange(rows) + 0.5) * step
        nodes: Floats = np.column_stack([np.tile(x, rows), np.repeat(y, columns)]).astype(np.float64)
        field = cls(west, south, step, columns, rows, nodes, np.ones(len(nodes), dtype=bool))
        areas = np.array([*ground.waters, *shapely.get_parts(ground.closed)], dtype=object)
        middles = STRtree(np.asarray(shapely.points(nodes), dtype=object))
        field.open[middles.query(areas, predicate="contains")[1]] = False
        pairs = _pairs(_within(ground.borders, field.window))
        for some in np.array_split(pairs, len(pairs) // SEGMENTS_AT_ONCE + 1):
            dense = shapely.segmentize(shapely.linestrings(some), step / SAMPLES_A_CELL)
            cell, is_inside = field.cell_of(shapely.get_coordinates(dense))
            field.open[cell[is_inside]] = False
        return field

    @property
    def window(self) -> tuple[float, float, float, float]:
        """m: x_min, y_min, x_max, y_max, a cell further than the cells reach."""
        east, north = self.west + self.columns * self.step, self.south + self.rows * self.step
        return self.west - self.step, self.south - self.step, east + self.step, north + self.step

    def cell_of(self, points: Floats) -> tuple[Ints, Flags]:
        """(k,) the cells that points (k, 2) lie in, and (k,) whether that is one of ours."""
        column = np.floor((points[:, 0] - self.west) / self.step).astype(np.int64)
        row = np.floor((points[:, 1] - self.south) / self.step).astype(np.int64)
        is_inside = (column >= 0) & (column < self.columns) & (row >= 0) & (row < self.rows)
        return np.where(is_inside, row * self.columns + column, 0), is_inside

    def stretches(self) -> Ints:
        """(m, 2) cells between whose middles one can walk."""
        is_open = self.open.reshape(self.rows, self.columns)
        row, column = np.nonzero(is_open)

        def open_at(shift: tuple[int, int]) -> Flags:
            r, c = row + shift[1], column + shift[0]
            is_inside = (r >= 0) & (r < self.rows) & (c >= 0) & (c < self.columns)
            return is_inside & is_open[np.where(is_inside, r, 0), np.where(is_inside, c, 0)]

        found: list[Ints] = []
        for (right, up), passed in zip(MOVES.tolist(), BETWEEN, strict=True):
            may = open_at((right, up))
            for cell in passed:
                may &= open_at(cell)
            first = row[may] * self.columns + column[may]
            found.append(np.column_stack([first, first + up * self.columns + right]))
        return np.concatenate(found)

    def steps_out(self, ground: Ground, here: Floats) -> Ints:
        """(k,) the open cells next to where somebody stands."""
        near = np.flatnonzero(self.open & (np.abs(self.nodes - here).max(axis=1) <= START_CELLS * self.step))
        return near[ground.free(here, self.nodes[near])]


def _lines(geometries: Sequence[BaseGeometry]) -> list[BaseGeometry]:
    return [part for one in geometries for part in shapely.get_parts(one) if not part.is_empty]


def _within(lines: Sequence[BaseGeometry], window: tuple[float, float, float, float]) -> list[BaseGeometry]:
    """What of lines lies in a rectangle."""
    return _lines([shapely.clip_by_rect(line, *window) for line in lines])


def _pairs(lines: Sequence[BaseGeometry]) -> Floats:
    """(k, 2, 2) their stretches."""
    points, line = shapely.get_coordinates(lines, return_index=True)
    joined = line[:-1] == line[1:]
    return np.stack([points[:-1][joined], points[1:][joined]], axis=1)


def _network(lines: Sequence[BaseGeometry], longest: float) -> tuple[Floats, Ints]:
    """Nodes (n, 2) m no further than `longest` along the lines, those at the same place as one; (m, 2) stretches."""
    dense = shapely.segmentize(np.array(_lines(lines), dtype=object), longest)
    points, line = shapely.get_coordinates(dense, return_index=True)
    if len(points) == 0:
        return np.empty((0, 2)), np.empty((0, 2), dtype=np.int64)
    _, first, node = np.unique(np.round(points / SAME_NODE_M), axis=0, return_index=True, return_inverse=True)
    node = node.reshape(-1)
    joined = line[:-1] == line[1:]
    return points[first], np.column_stack([node[:-1][joined], node[1:][joined]]).astype(np.int64)
