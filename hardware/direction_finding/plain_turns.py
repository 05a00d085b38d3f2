"""The turns in a plain table: as a column numbers them, or by place, or between blank lines, comments and repeated
headers, where several parts went round."""

from __future__ import annotations

import math
from bisect import bisect
from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from hardware.direction_finding.heard_at import HeardAt
from hardware.direction_finding.plain_columns import HALF_TURN_DEG, HEADING, ROUND_DEG, Columns, turned_deg
from hardware.direction_finding.plain_tags import Tags, tags_of_turns
from hardware.direction_finding.table_file import Row, column_of
from hardware.frame import LocalFrame, middle_of
from hardware.readings import Place

ELSEWHERE_M = 20.0
"""A hovering vehicle stays nearer to where its turn began."""
MOST_PLACES = 200
"""Of a table with more the rows were taken on the way."""


def turns_in(
    heard: Sequence[HeardAt], columns: Columns, rows: Sequence[Row]
) -> tuple[list[list[HeardAt]], Tags | None]:
    """(the usable rows of each turn, in the order in which turns begin; whose they are). At least one turn of at least
    one row."""
    numbering = [column for column in columns.turns if _numbers_turns(heard, column)]
    if not numbering:
        turns = _by_place(heard)
        return _by_blocks(heard, rows, columns) if turns is None else (turns, tags_of_turns(columns.names, turns))
    numbered: dict[tuple[str, ...], list[HeardAt]] = {}
    for one in heard:
        numbered.setdefault(tuple(_cell(one, column) for column in numbering), []).append(one)
    turns = list(numbered.values())
    return turns, tags_of_turns(columns.names, turns)


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


def _by_blocks(
    heard: Sequence[HeardAt], rows: Sequence[Row], columns: Columns
) -> tuple[list[list[HeardAt]], Tags | None]:
    """One turn unless it went round in several blocks of lines. Blocks of one tag each are those of each tag."""
    begins = [
        after.line for before, after in pairwise(rows) if after.line - before.line > 1 or _is_header(after, columns)
    ]
    blocks: list[list[HeardAt]] = [[] for _ in range(len(begins) + 1)]
    for one in heard:
        blocks[bisect(begins, one.row.line)].append(one)
    blocks = [block for block in blocks if block]
    several = _went_round(blocks) > 1
    tags = tags_of_turns(columns.names, blocks if several else [heard])
    of_tag: dict[str, list[list[HeardAt]]] = {}
    for block in blocks:
        name, *others = {"" if tags is None else tags[one.row.line] for one in block}
        if others or tags is None or not (name or several):
            return blocks if several else [list(heard)], tags
        of_tag.setdefault(name, []).append(block)
    turns = [turn for of_one in of_tag.values() for turn in _of_one_tag(of_one)]
    return sorted(turns, key=lambda turn: turn[0].row.line), tags


def _of_one_tag(blocks: list[list[HeardAt]]) -> list[list[HeardAt]]:
    return blocks if _went_round(blocks) > 1 else [[one for block in blocks for one in block]]


def _went_round(turns: Sequence[Sequence[HeardAt]]) -> int:
    """How many did."""
    return sum(len(turn) > 1 and _turned_deg(turn) >= ROUND_DEG for turn in turns)


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
