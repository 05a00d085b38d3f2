"""Which column of a plain table holds what: by its name in a header, or, without one, by its place and its values."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from hardware.direction_finding.table_file import (
    LONGEST_CELL,
    RecordingError,
    Row,
    Table,
    column_of,
    commas_in_numbers,
    number_of,
    plain_name,
)
from hardware.direction_finding.table_places import Places, place_columns
from hardware.direction_finding.table_tags import FREQUENCIES, frequency_hz
from hardware.reasons.table import ColumnsAlike, FileUnusable, TooManyCells

Unit = Literal["decibels", "linear", "unnamed"]

_HEADINGS = ("heading", "yaw", "azimuth", "angle", "bearing", "direction", "kurs", "richtung", "azimut", "winkel")
_POWERS = ("power", "rssi", "level", "signal_strength", "snr", "leistung", "pegel")
_DECIBELS = ("_db", "_dbm", "_dbw", "_dbfs", "_dbµv", "_dbμv", "_dbuv")
_LINEAR = ("_mw", "_w", "_uw", "_µw", "_nw", "_pw", "_lin", "_linear")

_TIMES = ("at_s", "time_s", "time", "t", "timestamp")
HEADING = tuple(f"{name}{unit}" for name in _HEADINGS for unit in ("_deg", ""))
RADIANS = tuple(f"{name}_rad" for name in _HEADINGS)
POWER = tuple(f"{name}{unit}" for name in _POWERS for unit in (*_DECIBELS, ""))
LINEAR = (*(f"{name}{unit}" for name in _POWERS for unit in _LINEAR), "mw")
TURNS = ("sweep", "sweep_id", "rotation", "rotation_id", "turn", "turn_id", "place", "place_id", "drehung", "ort")
"""Columns of which a new value begins another sweep."""
EXPECTED = ("heading_deg", "power_db")

HALF_TURN_DEG = 180.0
ROUND_DEG = 240.0
"""Of the circle that is a turn of its own: a finder uses no less of a whole turn."""


@dataclass(frozen=True, slots=True)
class Columns:
    """Indices from 0, None: there is none. width: how many columns there are, None: as many as a row likes. radians:
    the heading's name says so. unit: what the power's name says. names: of all columns, as the header has them."""

    heading: int
    power: int
    width: int | None
    radians: bool = False
    unit: Unit = "unnamed"
    time: int | None = None
    places: Places | None = None
    frequency: int | None = None
    frequency_name: str = ""
    turns: tuple[int, ...] = ()
    names: tuple[str, ...] = ()

    def frequency_of(self, row: Row) -> float | None:
        """In hertz; None where the row tells none."""
        if self.frequency is None or self.frequency >= len(row.cells):
            return None
        return frequency_hz(self.frequency_name, row.cells[self.frequency])


def columns_of(table: Table) -> tuple[Columns, tuple[Row, ...]]:
    """The columns and the rows below their header. Raises RecordingError when they cannot be told apart."""
    header, rows = _header(table)
    columns = _unnamed(table, rows) if header is None else _named(table, header, rows)
    if not rows:
        raise RecordingError(FileUnusable(str(table.path), "empty"))
    return columns, rows


def is_plain(table: Table) -> bool:
    """Whether a header names heading and power, and not what every table of UAV-RT's names."""
    return any(
        _names_both(head.cells) and column_of(head.cells, "detection_status", "detect_status") is None
        for head in table.heads
    )


def names_power(cells: tuple[str, ...]) -> bool:
    """Whether a header does."""
    return column_of(cells, *POWER, *LINEAR) is not None


def _names_both(cells: tuple[str, ...]) -> bool:
    return column_of(cells, *HEADING, *RADIANS) is not None and names_power(cells)


def _header(table: Table) -> tuple[Row | None, tuple[Row, ...]]:
    """The row or comment that names heading and power, or what else a header would be, and the data rows."""
    first = table.rows[0]
    both = next((head for head in table.heads if _names_both(head.cells)), None)
    if both is not None:
        return both, table.below(both)
    if first.number(0) is None and any(cell and number_of(cell) is None for cell in first.cells):
        return first, table.rows[1:]
    named = next((c for c in table.comments if column_of(c.cells, *HEADING, *RADIANS) is not None), None)
    return named, table.rows


def _named(table: Table, header: Row, rows: Sequence[Row]) -> Columns:
    names = header.cells
    heading = column_of(names, *HEADING, *RADIANS)
    power = column_of(names, *POWER, *LINEAR)
    if heading is None or power is None:
        raise table.columns_unknown(header, *EXPECTED)
    alike = [k for k, name in enumerate(names) if plain_name(name) == plain_name(names[power])]
    if len(alike) > 1:
        one, other = alike[:2]
        told = names[one][:LONGEST_CELL], names[other][:LONGEST_CELL]
        raise RecordingError(ColumnsAlike(str(table.path), header.line, one + 1, told[0], other + 1, told[1]))
    frequency, turns = column_of(names, *FREQUENCIES), [column_of(names, name) for name in TURNS]
    return Columns(
        heading=heading,
        power=power,
        width=max(k for k, name in enumerate(names) if name) + 1,
        radians=plain_name(names[heading]) in RADIANS,
        unit=_unit(plain_name(names[power])),
        time=column_of(names, *_TIMES),
        places=place_columns(names, rows),
        frequency=frequency,
        frequency_name="" if frequency is None else names[frequency],
        turns=tuple(column for column in turns if column is not None),
        names=names,
    )


def turned_deg(headings: Sequence[float]) -> float:
    """Of the circle, without the widest gap in it; at least one heading, in degrees."""
    around = np.sort(np.asarray(headings) % 360.0)
    return 360.0 - float(np.max(np.diff(around, append=around[0] + 360.0)))


def _unit(name: str) -> Unit:
    if name in LINEAR:
        return "linear"
    return "decibels" if name.endswith(_DECIBELS) else "unnamed"


def _is_no_power(column: Sequence[float]) -> bool:
    """A latitude south of the equator stays; power changes as the antenna turns."""
    return not column or max(column) >= 0.0 or max(column) - min(column) < 1.0


def _unnamed(table: Table, rows: Sequence[Row]) -> Columns:
    """Heading and power; of more than two columns only where these cannot be a time and a heading."""
    wide = [row for row in rows if row.numbers_beyond(2)]
    if 2 * len(wide) < len(rows):
        return Columns(0, 1, 2)
    if commas_in_numbers(wide):
        raise RecordingError(TooManyCells(str(table.path), wide[0].line, len(wide[0].cells), 2))
    first = [value for row in wide if (value := row.number(0)) is not None]
    second = [value for row in wide if (value := row.decibels(1)) is not None]
    turned = bool(first) and max(map(abs, first)) <= 360.0 and max(first) - min(first) > HALF_TURN_DEG
    third = [value for row in wide if (value := row.decibels(2)) is not None]
    if not (turned and second and max(second) < 0.0 and _is_no_power(third)):
        raise table.columns_unknown(wide[0], *EXPECTED)
    return Columns(0, 1, None)
