"""Plain tables of heading and power as sweeps: one of each turn, of the tag that is asked for or heard most."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence

import numpy as np

from hardware.direction_finding.heard_at import HeardAt
from hardware.direction_finding.plain_columns import Columns, columns_of
from hardware.direction_finding.plain_tags import Tags, as_asked, turn_of
from hardware.direction_finding.plain_turns import ELSEWHERE_M, place_of, turns_in
from hardware.direction_finding.plain_units import decibels_doubted, refuse_radians
from hardware.direction_finding.table_file import LONGEST_CELL, RecordingError, Row, Table, some_of
from hardware.direction_finding.table_places import Places
from hardware.readings import Place, Sweep
from hardware.reasons.table import (
    FrequenciesUnread,
    NothingUsable,
    OtherTagsLeftOut,
    PlacesApart,
    RowLeftOut,
    TableRemark,
    TagNotHeard,
    TooManyCells,
)

NOTHING_DB = -200.0
"""So little, or less, no receiver hears: files write it for "nothing"."""
UNKNOWN_PLACE = Place(0.0, 0.0)


def read_plain(table: Table, tag: str | None) -> tuple[list[tuple[Sweep, bool]], list[TableRemark]]:
    """([(sweep, whether the file tells where it was taken)], remarks). Raises RecordingError when nothing is left.

    Two columns (heading, power), or a header that names them and, if known, time, lat, lon, frequency, tag and sweep.
    """
    columns, rows = columns_of(table)
    heard, remarks = _heard(table, columns, rows)
    file = str(table.path)
    turns, tags = turns_in(heard, columns, rows)
    if tag is not None:
        tags, tag = as_asked(tag, columns.names, turns, tags)
    named = set[str]() if tags is None else {*tags.values()} - {""}
    if tag is not None and named and tag not in named:
        raise RecordingError(TagNotHeard(file, heard[0].row.line, tag, some_of(named)))
    sweeps = [sweep for turn in turns if (sweep := _sweep(file, turn, columns, tags, tag, remarks)) is not None]
    return sweeps, remarks


def _heard(table: Table, columns: Columns, rows: Sequence[Row]) -> tuple[list[HeardAt], list[TableRemark]]:
    """The usable rows. Raises RecordingError when there is none, and for units that are not degrees and decibels."""
    file = str(table.path)
    remarks: list[TableRemark] = []
    good: list[tuple[Row, float, float]] = []
    for row in rows:
        heading, power = row.number(columns.heading), row.decibels(columns.power)
        if columns.width is not None and row.numbers_beyond(columns.width):
            remarks.append(RowLeftOut(file, row.line, "wide"))
        elif heading is None or not math.isfinite(heading):
            remarks.append(table.cell_unusable(row, columns.heading, "heading"))
        elif power is None or not NOTHING_DB < power < math.inf:
            remarks.append(table.cell_unusable(row, columns.power, "power"))
        else:
            good.append((row, heading, power))
    if not good:
        raise RecordingError(_nothing(file, columns, rows, remarks))
    refuse_radians(file, columns, [heading for _, heading, _ in good])
    doubt = decibels_doubted(file, columns, [power for _, _, power in good])
    heard = [
        HeardAt(row, _value(row, columns.time, float(k)), heading % 360.0, power, _place(row, columns.places))
        for k, (row, heading, power) in enumerate(good)
    ]
    doubts = [one for one in (doubt, _frequencies_unread(file, columns, heard)) if one is not None]
    return heard, [*doubts, *remarks]


def _frequencies_unread(file: str, columns: Columns, heard: Sequence[HeardAt]) -> FrequenciesUnread | None:
    """None where one can be read, or there is none."""
    column = columns.frequency
    if column is None:
        return None
    told = [one.row for one in heard if column < len(one.row.cells) and one.row.cells[column]]
    if not told or any(columns.frequency_of(row) is not None for row in told):
        return None
    return FrequenciesUnread(file, told[0].line, column + 1, told[0].cells[column][:LONGEST_CELL])


def _nothing(
    file: str, columns: Columns, rows: Sequence[Row], remarks: Sequence[TableRemark]
) -> TooManyCells | NothingUsable:
    first, row = remarks[0], rows[0]
    if isinstance(first, RowLeftOut) and columns.width is not None:
        return TooManyCells(file, row.line, len(row.cells), columns.width)
    return NothingUsable(file, "power", first)


def _sweep(
    file: str, turn: list[HeardAt], columns: Columns, tags: Tags | None, tag: str | None, remarks: list[TableRemark]
) -> tuple[Sweep, bool] | None:
    """None, with a remark, where the tag was not heard."""
    line, wanted = turn[0].row.line, tag
    named = Counter(name for one in turn if (name := "" if tags is None else tags[one.row.line]))
    if tags is not None and tag is not None and tag not in named:
        remarks.append(TagNotHeard(file, line, tag, some_of(named or "-")))
        return None
    if tags is not None and named:
        wanted = named.most_common(1)[0][0] if tag is None else tag
        own = turn_of(wanted, turn, tags)
        if tag is None and len(own) < len(turn):
            others = {tags[one.row.line] for one in turn} - {tags[one.row.line] for one in own}
            left = some_of(name or "-" for name in others)
            remarks.append(OtherTagsLeftOut(file, line, wanted, len(turn) - len(own), left))
        turn = own
    found = place_of(turn)
    if found is not None and found[1] > ELSEWHERE_M:
        remarks.append(PlacesApart(file, line, found[1]))
    frequencies = [value for one in turn if (value := columns.frequency_of(one.row)) is not None]
    sweep = Sweep(
        at_s=np.array([one.at_s for one in turn]),
        heading_deg=np.array([one.heading_deg for one in turn]),
        power_db=np.array([one.power_db for one in turn]),
        frequency_hz=float(np.median(frequencies)) if frequencies else 0.0,
        position=UNKNOWN_PLACE if found is None else found[0],
        altitude_amsl_m=0.0,
        tag=wanted,
    )
    return sweep, found is not None


def _place(row: Row, columns: Places | None) -> Place | None:
    place = None if columns is None else columns.place(row)
    return place if isinstance(place, Place) else None


def _value(row: Row, column: int | None, otherwise: float) -> float:
    value = None if column is None else row.number(column)
    return otherwise if value is None or not math.isfinite(value) else value
