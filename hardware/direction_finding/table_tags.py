"""Whose bearings or readings the rows of a table are: by a column that names tags, collars or animals, or by their
frequencies."""

from __future__ import annotations

import math
import re
from collections.abc import Collection, Sequence

from hardware.direction_finding.table_file import Row, column_of, number_of, plain_name

TAGS = ("tag", "tag_id", "tagid")
OTHERS = tuple(f"{name}{number}" for name in ("transmitter", "collar", "animal") for number in ("", "_id", "id"))
_FREQUENCIES = ("frequency", "freq", "frequenz", "fréquence", "center_frequency", "core:frequency")
FREQUENCIES = tuple(f"{name}{unit}" for name in _FREQUENCIES for unit in ("", "_hz", "_khz", "_mhz", "_ghz"))
_UNIT = re.compile(r" ?([kMG]?)Hz$", re.IGNORECASE)
_HZ = {"": 1.0, "k": 1e3, "m": 1e6, "g": 1e9}
_MOST_MHZ = 30e3
"""A number without a unit is no more than this in MHz: nobody listens below 30 kHz."""
SAME_FREQUENCY = 1e-5
"""Of a frequency: a tag's own drifts by so much (1.5 kHz of 150 MHz); others are 5 kHz away and more."""


def tags_in(names: tuple[str, ...], rows: Sequence[Row]) -> tuple[int | None, dict[str, str]]:
    """The column of tags if it names one in each row, else the one that names most, and the tags by its cells. A single
    frequency names none."""
    best: tuple[int | None, dict[str, str]] = None, {}
    for name in (*TAGS, *OTHERS, *FREQUENCIES):
        column = column_of(names, name)
        if column is None:
            continue
        cells = {row.cells[column] if column < len(row.cells) else "" for row in rows}
        told = cells - {""}
        tags = _frequencies(told) if name in FREQUENCIES else {cell: cell for cell in told}
        if name in TAGS and told == cells:
            return column, tags
        several = len(set(tags.values()))
        if several > max(len(set(best[1].values())), name in FREQUENCIES):
            best = column, tags
    return best


def frequency_hz(name: str, cell: str) -> float | None:
    """What a cell of the column `name` says, in the unit behind it or the one that the column names; None: nothing."""
    value = number_of(_UNIT.sub("", cell))
    if value is None or not 0.0 < value < math.inf:
        return None
    unit = _UNIT.search(cell) or _UNIT.search(plain_name(name).replace("_", " "))
    if unit is None:
        return value * (_HZ["m"] if value < _MOST_MHZ else 1.0)
    return value * _HZ[unit[1].lower()]


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
