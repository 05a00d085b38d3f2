"""Whose bearings the rows of a table are: by a column that names tags, collars or animals, or by their frequencies."""

from __future__ import annotations

import re
from collections.abc import Collection, Sequence

from hardware.direction_finding.table_file import Row, column_of, number_of

_TAGS = ("tag", "tag_id", "tagid")
_OTHERS = ("transmitter", "transmitter_id", "collar", "collar_id", "animal", "animal_id")
_FREQUENCIES = tuple(f"{name}{unit}" for name in ("frequency", "freq") for unit in ("", "_hz", "_khz", "_mhz"))
_UNIT = re.compile(r" ?[kMG]?Hz$", re.IGNORECASE)
SAME_FREQUENCY = 1e-5
"""Of a frequency: a tag's own drifts by so much (1.5 kHz of 150 MHz); others are 5 kHz away and more."""


def tags_in(names: tuple[str, ...], rows: Sequence[Row]) -> tuple[int | None, dict[str, str]]:
    """The column of tags if it names one in each row, else the one that names most, and the tags by its cells. A single
    frequency names none."""
    best: tuple[int | None, dict[str, str]] = None, {}
    for name in (*_TAGS, *_OTHERS, *_FREQUENCIES):
        column = column_of(names, name)
        if column is None:
            continue
        cells = {row.cells[column] if column < len(row.cells) else "" for row in rows}
        told = cells - {""}
        tags = _frequencies(told) if name in _FREQUENCIES else {cell: cell for cell in told}
        if name in _TAGS and told == cells:
            return column, tags
        several = len(set(tags.values()))
        if several > max(len(set(best[1].values())), name in _FREQUENCIES):
            best = column, tags
    return best


def _frequencies(cells: Collection[str]) -> dict[str, str]:
    """Those that are one tag's, measured or written otherwise, by one name."""
    names: dict[str, str] = {}
    name, first = "", 0.0
    for value, cell in sorted(
        (value, cell) for cell in cells if (value := number_of(_UNIT.sub("", cell)) or 0.0) > 0.0
    ):
        if value - first > SAME_FREQUENCY * value:
            name, first = f"{value:.12g}", value
        names[cell] = name
    return names
