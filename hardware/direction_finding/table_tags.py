"""Whose bearings the rows of a table are: by a column that names tags, collars or animals, or by their frequencies."""

from __future__ import annotations

from collections.abc import Collection, Sequence

from hardware.direction_finding.table_file import Row, column_of, number_of

_TAGS = ("tag", "tag_id", "tagid", "transmitter", "transmitter_id", "collar", "collar_id", "animal", "animal_id")
_FREQUENCIES = tuple(f"{name}{unit}" for name in ("frequency", "freq") for unit in ("", "_hz", "_khz", "_mhz"))
SAME_FREQUENCY = 2e-5
"""Of a frequency: a tag's own drifts by so much (3 kHz of 150 MHz); others are 5 kHz away and more."""


def tags_in(names: tuple[str, ...], rows: Sequence[Row]) -> tuple[int | None, dict[str, str]]:
    """The first column of those that may name tags which names several, else the first that names any, and the tags by
    its cells. A single frequency names none."""
    one: tuple[int | None, dict[str, str]] = None, {}
    for name in (*_TAGS, *_FREQUENCIES):
        column = column_of(names, name)
        cells = {row.cells[column] for row in rows if column is not None and column < len(row.cells)} - {""}
        tags = _frequencies(cells) if name in _FREQUENCIES else {cell: cell for cell in cells}
        if len(set(tags.values())) > 1:
            return column, tags
        if tags and one[0] is None and name in _TAGS:
            one = column, tags
    return one


def _frequencies(cells: Collection[str]) -> dict[str, str]:
    """Those that are one tag's, measured or written otherwise, by one name."""
    names: dict[str, str] = {}
    name, before = "", 0.0
    for value, cell in sorted((value, cell) for cell in cells if (value := number_of(cell) or 0.0) > 0.0):
        if value - before > SAME_FREQUENCY * value:
            name = f"{value:.12g}"
        names[cell], before = name, value
    return names
