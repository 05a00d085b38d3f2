"""Where each room and arrow is drawn: rows from importers down to what they import, with few crossings.

The usual four steps of a layered drawing (Sugiyama, Tagawa and Toda 1981): rows by the longest way from above, bends
where an arrow passes a row, order in each row by the mean of the neighbours, then places that keep order and distances.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import isotonic_regression

from docs.drawing.rooms import HOUSE, Arrow, Rooms

SWEEPS = 24
ROOM_HEIGHT = 28
ROW_HEIGHT = 66
FLOOR_GAP = 34
MARGIN = 24
GAP = 16
BEND_WIDTH = 4
CHARACTER_WIDTH = 7.6
"""Of the drawing's font at its size, a little generous. All lengths are pixels."""

Bend = tuple[Arrow, int]
Spot = str | Bend


@dataclass(frozen=True, slots=True)
class Box:
    """x, y: the centre."""

    x: int
    y: int
    width: int


@dataclass(frozen=True, slots=True)
class Layout:
    """lines: the points that each arrow passes, first its room's centre. floors: top and bottom of each."""

    width: int
    height: int
    boxes: Mapping[str, Box]
    lines: Mapping[Arrow, tuple[tuple[int, int], ...]]
    floors: Mapping[str, tuple[int, int]]


def lay_out(house: Rooms) -> Layout:
    row_of = _rows(house)
    chains = {arrow: _chain(arrow, row_of) for arrow in house.arrows}
    rows = _start(row_of, chains.values())
    neighbours = _neighbours(chains.values())
    for sweep in range(SWEEPS):
        _order(rows, neighbours, downwards=sweep % 2 == 0)
    x = _places(rows, neighbours)
    y, floors = _heights(house, row_of)
    boxes = {
        room.name: Box(round(x[room.name]), y[row_of[room.name]], round(_width(room.name))) for room in house.rooms
    }
    lines = {
        arrow: tuple((round(x[spot]), y[row]) for row, spot in enumerate(chain, row_of[arrow[0]]))
        for arrow, chain in chains.items()
    }
    right = max(box.x + box.width // 2 for box in boxes.values())
    bends = max((point[0] for line in lines.values() for point in line), default=0)
    return Layout(max(right, bends) + MARGIN, y[-1] + ROOM_HEIGHT // 2 + FLOOR_GAP, boxes, lines, floors)


def _rows(house: Rooms) -> dict[str, int]:
    """Each room just below the lowest of its own floor that imports it; each floor below the one above."""
    above: dict[str, list[str]] = {room.name: [] for room in house.rooms}
    floor = {room.name: room.floor for room in house.rooms}
    for importer, imported in house.arrows:
        if floor[importer] == floor[imported]:
            above[imported].append(importer)
    depth: dict[str, int] = {}

    def measured(name: str) -> int:
        if name not in depth:
            depth[name] = 1 + max((measured(importer) for importer in above[name]), default=-1)
        return depth[name]

    first = 0
    rows: dict[str, int] = {}
    for name_of_floor in HOUSE:
        names = [name for name in floor if floor[name] == name_of_floor]
        rows.update({name: first + measured(name) for name in names})
        first += 1 + max((depth[name] for name in names), default=-1)
    return rows


def _chain(arrow: Arrow, row_of: Mapping[str, int]) -> list[Spot]:
    bends: list[Spot] = [(arrow, row) for row in range(row_of[arrow[0]] + 1, row_of[arrow[1]])]
    return [arrow[0], *bends, arrow[1]]


def _start(row_of: Mapping[str, int], chains: Iterable[list[Spot]]) -> list[list[Spot]]:
    rows: list[list[Spot]] = [[] for _ in range(max(row_of.values()) + 1)]
    for name in sorted(row_of):
        rows[row_of[name]].append(name)
    for chain in chains:
        for bend in chain[1:-1]:
            rows[bend[1]].append(bend)  # type: ignore[index]
    return rows


def _neighbours(chains: Iterable[list[Spot]]) -> dict[Spot, tuple[list[Spot], list[Spot]]]:
    """Of each spot those in the row above and those in the row below."""
    found: dict[Spot, tuple[list[Spot], list[Spot]]] = {}
    for chain in chains:
        for upper, lower in pairwise(chain):
            found.setdefault(upper, ([], []))[1].append(lower)
            found.setdefault(lower, ([], []))[0].append(upper)
    return found


def _order(rows: list[list[Spot]], neighbours: Mapping[Spot, tuple[list[Spot], list[Spot]]], downwards: bool) -> None:
    """Sort every row by the mean place of the neighbours in the row before it; whoever has none keeps their place."""
    side = 0 if downwards else 1
    place = {spot: (index + 0.5) / len(row) for row in rows for index, spot in enumerate(row)}
    for row in rows if downwards else reversed(rows):
        wanted: dict[Spot, float] = {}
        for spot in row:
            seen = neighbours.get(spot, ([], []))[side]
            wanted[spot] = round(sum(place[other] for other in seen) / len(seen), 9) if seen else place[spot]
        row.sort(key=wanted.__getitem__)
        place.update({spot: (index + 0.5) / len(row) for index, spot in enumerate(row)})


def _width(spot: Spot) -> float:
    return CHARACTER_WIDTH * len(spot.split(".")[1]) + 26 if isinstance(spot, str) else BEND_WIDTH


def _places(rows: list[list[Spot]], neighbours: Mapping[Spot, tuple[list[Spot], list[Spot]]]) -> dict[Spot, float]:
    """Least squares to the mean of all neighbours, row by row, with the order and the distances kept."""
    offsets: list[NDArray[np.float64]] = []
    for row in rows:
        steps = [(_width(left) + _width(right)) / 2 + GAP for left, right in pairwise(row)]
        offsets.append(np.concatenate([[0.0], np.cumsum(steps)]))
    x = {
        spot: float(at - offset[-1] / 2) for row, offset in zip(rows, offsets, strict=True)
        for spot, at in zip(row, offset, strict=True)
    }  # fmt: skip
    for sweep in range(2 * SWEEPS):
        numbered = list(zip(rows, offsets, strict=True))
        for row, offset in numbered if sweep % 2 == 0 else reversed(numbered):
            wanted = [
                _mean([x[other] for side in neighbours.get(spot, ([], [])) for other in side], x[spot]) for spot in row
            ]
            kept: NDArray[np.float64] = isotonic_regression(np.array(wanted) - offset).x + offset
            x.update(zip(row, map(float, kept), strict=True))
    left = min(at - _width(spot) / 2 for spot, at in x.items())
    return {spot: at - left + MARGIN for spot, at in x.items()}


def _mean(values: list[float], otherwise: float) -> float:
    return sum(values) / len(values) if values else otherwise


def _heights(house: Rooms, row_of: Mapping[str, int]) -> tuple[list[int], dict[str, tuple[int, int]]]:
    """The middle of each row; top and bottom of each floor."""
    floor_of_row = {row_of[room.name]: room.floor for room in house.rooms}
    middle: list[int] = []
    floors: dict[str, tuple[int, int]] = {}
    at = FLOOR_GAP + ROOM_HEIGHT // 2
    for row in range(len(floor_of_row)):
        if row > 0:
            at += ROW_HEIGHT + (FLOOR_GAP if floor_of_row[row] != floor_of_row[row - 1] else 0)
        middle.append(at)
        top = floors.get(floor_of_row[row], (at - ROOM_HEIGHT // 2 - FLOOR_GAP + 8, 0))[0]
        floors[floor_of_row[row]] = (top, at + ROOM_HEIGHT // 2 + 14)
    return middle, floors
