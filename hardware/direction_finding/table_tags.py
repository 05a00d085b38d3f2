"""Whose bearings or readings the rows of a table are: by a column that names tags, collars or animals, or by their
frequencies."""

from __future__ import annotations

import math
import re
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass

from hardware.direction_finding.table_file import Row, column_of, number_of, plain_name

TAGS = ("tag", "tag_id", "tagid")
OTHERS = tuple(f"{name}{number}" for name in ("transmitter", "collar", "animal") for number in ("", "_id", "id"))
_FREQUENCIES = ("frequency", "freq", "frequenz", "fréquence", "center_frequency", "core:frequency")
FREQUENCIES = tuple(f"{name}{unit}" for name in _FREQUENCIES for unit in ("", "_hz", "_khz", "_mhz", "_ghz"))
_NO_NAMES = frozenset({"", "-", "--", "?", "na", "n/a", "nan", "none", "null"})
_EVERY_TAG = frozenset({"999", "vhf"})
"""What receivers of coded tags write for each that sends no code."""
_UNIT = re.compile(r" ?([kMG]?)Hz$", re.IGNORECASE)
_HZ = {"": 1.0, "k": 1e3, "m": 1e6, "g": 1e9}
_MOST_MHZ = 30e3
"""A number without a unit is no more than this in MHz: nobody listens below 30 kHz."""
_DRIFT, _MOST_DRIFT_HZ = 1e-5, 4e3
"""From one reading to the next of one tag, of its frequency, and at most: channels are 5 kHz apart."""


@dataclass(frozen=True, slots=True)
class Naming:
    """What a column names. names: by its cells, of those that name something. complete: each row has one.
    highest_hz: of frequencies; else 0."""

    column: int
    names: Mapping[str, str]
    complete: bool
    highest_hz: float = 0.0

    @property
    def frequencies(self) -> bool:
        """Whether the names are."""
        return self.highest_hz > 0.0

    @property
    def several(self) -> int:
        """How many it names."""
        return len(set(self.names.values()))

    @property
    def of_every_tag(self) -> bool:
        """Whether it may be written for tags that only their frequencies tell apart."""
        return {name.casefold() for name in self.names.values()} <= _EVERY_TAG

    def of(self, row: Row) -> str:
        """Empty where the row names none."""
        return self.names.get(_cell(row, self.column), "")


def namings(names: tuple[str, ...], rows: Sequence[Row]) -> list[Naming]:
    """Of each column that names something: tags first, frequencies last."""
    found: list[Naming] = []
    for name in (*TAGS, *OTHERS, *FREQUENCIES):
        column = column_of(names, name)
        if column is None:
            continue
        if name not in FREQUENCIES:
            found.append(as_written(column, rows))
            continue
        cells = {_cell(row, column) for row in rows}
        told = _frequencies(name, cells)
        highest_hz = max((hertz for cell in told if (hertz := frequency_hz(name, cell))), default=0.0)
        found.append(Naming(column, told, len(told) == len(cells), highest_hz))
    return [one for one in found if one.names]


def as_written(column: int, rows: Sequence[Row]) -> Naming:
    """Each cell is a name, but for those that say there is none."""
    cells = {_cell(row, column) for row in rows}
    names = {cell: cell for cell in cells if cell.casefold() not in _NO_NAMES}
    return Naming(column, names, len(names) == len(cells))


def tags_in(names: tuple[str, ...], rows: Sequence[Row]) -> Naming | None:
    """That of a list of bearings: the column of tags if it names one in each row, else the one that names most. A
    single frequency names none."""
    found = namings(names, rows)
    if any(one.frequencies and one.several > 1 for one in found):
        found = [one for one in found if one.frequencies or not one.of_every_tag]
    best: Naming | None = None
    for one in found:
        if one.complete and column_of(names, *TAGS) == one.column:
            return one
        if one.several > max(0 if best is None else best.several, one.frequencies):
            best = one
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


def _cell(row: Row, column: int) -> str:
    return row.cells[column] if column < len(row.cells) else ""


def _frequencies(column: str, cells: Collection[str]) -> dict[str, str]:
    """Those that are one tag's, measured or written otherwise, by the lowest of them."""
    told = sorted((hertz, cell) for cell in cells if (hertz := frequency_hz(column, cell)) is not None)
    names: dict[str, str] = {}
    name, before = "", 0.0
    for hertz, cell in told:
        if hertz - before > min(_DRIFT * hertz, _MOST_DRIFT_HZ):
            name = f"{number_of(_UNIT.sub('', cell)):.12g}"
        names[cell], before = name, hertz
    return names
