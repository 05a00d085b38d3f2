"""The turns in a plain table: as a column numbers them, or by place, or between blank lines, comments and repeated
headers, where several parts went round."""

from __future__ import annotations

import math
from bisect import bisect
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from hardware.direction_finding.plain_columns import HALF_TURN_DEG, HEADING, ROUND_DEG, Columns, turned_deg
from hardware.direction_finding.table_file import Row, column_of
from hardware.frame import LocalFrame, middle_of
from hardware.readings import Place

ELSEWHERE_M = 20.0
"""A hovering vehicle stays nearer to where its turn began."""
MOST_PLACES = 200
"""Of a table with more the rows were taken on the way."""


@dataclass(frozen=True, slots=True)
class HeardAt:
    """One usable row. heading_deg: [0, 360). at_s: as the table tells, else its number in the file. place None: it does
    not tell."""

    row: Row
    at_s: float
    heading_deg: float
    power_db: float
    place: Place | None


def turns_in(heard: Sequence[HeardAt], columns: Columns, rows: Sequence[Row]) -> list[list[HeardAt]]:
    """The usable rows of each turn, in the order in which turns begin; at least one turn of at least one row."""
    numbering = [column for column in columns.turns if _numbers_turns(heard, column)]
    if not numbering:
        return _by_place(heard) or _by_blocks(heard, rows, columns) or [list(heard)]
    turns: dict[tuple[str, ...], list[HeardAt]] = {}
    for one in heard:
        turns.setdefault(tuple(_cell(one, column) for column in numbering), []).append(one)
    return list(turns.values())


def _numbers_turns(heard: Sequence[HeardAt], column: int) -> bool:
    """Rather than holds something that was measured, and changes from row to row."""
    return 2 * len({_cell(one, column) for one in heard}) <= len(heard)


def _cell(one: HeardAt, column: int) -> str:
    return one.row.cells[column] if column < len(one.row.cells) else ""


def _by_place(heard: Sequence[HeardAt]) -> list[list[HeardAt]] | None:
    """None unless it went round at each of several places."""
    places = np.array([(one.place.lon, one.place.lat) for one in heard if one.place is not None])
    if not places.size:
        return None
    points = iter(LocalFrame(Place(*places[0, ::-1])).to_enu_points(places).tolist())
    stands: list[tuple[float, float]] = []
    turns: list[list[HeardAt]] = [[]]
    now = 0
    for one in heard:
        if one.place is not None:
            here = next(points)
            now = next((k for k, there in enumerate(stands) if math.dist(here, there) <= ELSEWHERE_M), len(stands))
            if now == MOST_PLACES:
                return None
            stands[now : now + 1] = [here]
        if now == len(turns):
            turns.append([])
        turns[now].append(one)
    return turns if len(turns) > 1 and all(_turned_deg(turn) >= HALF_TURN_DEG for turn in turns) else None


def _by_blocks(heard: Sequence[HeardAt], rows: Sequence[Row], columns: Columns) -> list[list[HeardAt]] | None:
    """None unless it went round in several blocks of lines; blocks of one tag each are not several turns,
    where a column of tags says so."""
    begins = [
        after.line for before, after in pairwise(rows) if after.line - before.line > 1 or _is_header(after, columns)
    ]
    turns: list[list[HeardAt]] = [[] for _ in range(len(begins) + 1)]
    for one in heard:
        turns[bisect(begins, one.row.line)].append(one)
    if sum(len(turn) > 1 and _turned_deg(turn) >= ROUND_DEG for turn in turns) < 2:
        return None
    turns = [turn for turn in turns if turn]
    if columns.tags:
        return turns
    tags = [{columns.tag_of(one.row) for one in turn} for turn in turns]
    return None if any(len(named) == 1 and named != tags[0] for named in tags) else turns


def _is_header(row: Row, columns: Columns) -> bool:
    return row.number(columns.heading) is None and column_of(row.cells, *HEADING) is not None


def _turned_deg(turn: Sequence[HeardAt]) -> float:
    return turned_deg([one.heading_deg for one in turn])


def place_of(turn: Sequence[HeardAt]) -> tuple[Place, float] | None:
    """Where a turn was made, and how far from there its farthest row was taken (m); None: no row tells."""
    places = np.array([(one.place.lon, one.place.lat) for one in turn if one.place is not None])
    if not places.size:
        return None
    middle = middle_of(places[:, 1].tolist(), places[:, 0].tolist())
    return middle, float(np.max(np.hypot(*LocalFrame(middle).to_enu_points(places).T)))
