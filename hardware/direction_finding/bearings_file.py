"""Bearings as files: UAV-RT bearing files (10 columns, no header), plain CSV (lat, lon or UTM, bearing_deg[,
sigma_deg])."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np

from hardware.direction_finding.plain_columns import ROUND_DEG, names_power, turned_deg
from hardware.direction_finding.plain_units import LARGEST_RAD
from hardware.direction_finding.table_file import RecordingError, Row, Table, column_of, plain_name
from hardware.direction_finding.table_places import (
    EASTING,
    LATITUDE,
    LONGITUDE,
    NORTHING,
    PlaceColumns,
    Places,
    place_columns,
)
from hardware.direction_finding.table_tags import Naming, as_written, tags_in
from hardware.direction_finding.uavrt import is_uavrt
from hardware.frame import LocalFrame
from hardware.readings import Place
from hardware.reasons.table import (
    CellUnusable,
    FileUnusable,
    HeadingsInRadians,
    NothingUsable,
    RowLeftOut,
    TooManyCells,
)

DEFAULT_SIGMA_DEG = 7.0
"""The field system's (spec section 8), for bearings whose file states none."""
EARLIEST_S = 1e8
"""Times from here on are UTC epoch seconds; smaller ones count from somewhere else."""
LATEST_S = 4_102_444_800.0
"""2100: no bearing was taken so late."""
FEWEST_BEARINGS = 3
"""Fewer may well all lie within six degrees of north."""
FEWEST_READINGS = 8
"""An antenna's turn has at least this many. No list of bearings has as many from one spot in all directions."""
HOVERS_M = 10.0
"""All readings of a turn are within this distance of its first. Bearings taken around an animal are farther apart."""
EXPECTED = ("lat", "lon", "bearing_deg")
EXPECTED_UTM = ("easting", "northing", "utm_zone", "bearing_deg")
_BEARING = ("bearing_deg", "bearing", "azimuth", "azimuth_deg")
POWER = ("power_db", "power_dbm", "power", "rssi", "rssi_dbm", "level_db", "snr_db")
"""A table that names one of these holds headings with what was heard there."""
_SIGMA = ("sigma_deg", "sigma", "std_deg")


@dataclass(frozen=True, slots=True)
class RecordedBearing:
    """One bearing: degrees clockwise from true north, taken at `place`. line: where it stands in the file.

    stated: whether the file gives its sigma, or the device that wrote it has a known one. at_s: UTC epoch seconds at
    which it was taken, frequency_hz: of what was heard; None: the file does not tell. live_id: under which its station
    reports it while it is taken, None: it does not.
    """

    line: int
    place: Place
    bearing_deg: float
    sigma_deg: float
    tag: str | None = None
    stated: bool = True
    at_s: float | None = None
    frequency_hz: float | None = None
    live_id: str | None = None


@dataclass(frozen=True, slots=True)
class RecordedBearings:
    """bearings: in file order. remarks: what was left out and why."""

    bearings: tuple[RecordedBearing, ...]
    remarks: tuple[CellUnusable | RowLeftOut, ...]


@dataclass(frozen=True, slots=True)
class _Columns:
    """Indices from 0. width: how many there are, None: as many as a row likes. noted: the last one is none of these,
    and may hold anything. in_degrees: the bearing's name says so, or the device that writes such files."""

    places: Places
    bearing: int
    sigma: int | None
    tags: Naming | None = None
    at: int | None = None
    width: int | None = None
    noted: bool = False
    in_degrees: bool = False


def holds_bearings(table: Table) -> bool:
    """Rather than headings with power: its columns are named, or it has the ten of UAV-RT."""
    heads = {head.cells: head for head in reversed(table.heads)}
    if any(_names_all(head) and not _holds_a_turn(table, head) for head in heads.values()):
        return True
    first = table.rows[0]
    return len(first.cells) == 10 and all(first.number(column) is not None for column in (2, 4, 5))


def _names_all(head: Row) -> bool:
    in_utm = not names_power(head.cells) and _has(head, EASTING, NORTHING)
    return _has(head, _BEARING) and (in_utm or _has(head, LATITUDE, LONGITUDE))


def _holds_a_turn(table: Table, head: Row) -> bool:
    """Whether it is power that the rows tell: by its name, or, where that may be a bearing's strength, since an antenna
    was turned round at one place."""
    if column_of(head.cells, *POWER) is not None:
        return True
    places, bearing = place_columns(head.cells, table.below(head)), column_of(head.cells, *_BEARING)
    if places is None or bearing is None or not names_power(head.cells):
        return False
    told = [(row.number(bearing), places.place(row)) for row in table.below(head)]
    taken = [
        (value, place)
        for value, place in told
        if value is not None and math.isfinite(value) and isinstance(place, Place)
    ]
    turns = _taken_together([place for _, place in taken])
    around = [[taken[k][0] for k in turn] for turn in turns]
    return any(len(turn) >= FEWEST_READINGS and turned_deg(turn) >= ROUND_DEG for turn in around)


def _taken_together(places: Sequence[Place]) -> list[list[int]]:
    """Which were taken within HOVERS_M of the first of them."""
    if not places:
        return []
    points = LocalFrame(places[0]).to_enu_points(np.array([(place.lon, place.lat) for place in places]))
    together: list[list[int]] = []
    begun: dict[tuple[int, int], list[int]] = defaultdict(list)
    squares = np.floor(points / HOVERS_M).astype(int).tolist()
    for k, (point, (x, y)) in enumerate(zip(points.tolist(), squares, strict=True)):
        near = (number for square in product((x - 1, x, x + 1), (y - 1, y, y + 1)) for number in begun.get(square, ()))
        now = next((n for n in near if math.dist(point, points[together[n][0]]) <= HOVERS_M), len(together))
        if now == len(together):
            together.append([])
            begun[x, y].append(now)
        together[now].append(k)
    return together


def _has(head: Row, *columns: Sequence[str]) -> bool:
    return all(column_of(head.cells, *names) is not None for names in columns)


def bearings_in(table: Table, sigma_deg: float = DEFAULT_SIGMA_DEG) -> RecordedBearings:
    """Those of a bearing file of either kind; `sigma_deg` for bearings without their own. Raises RecordingError."""
    if not holds_bearings(table) and (
        is_uavrt(table) or any(map(_names_all, table.heads)) or names_power(table.rows[0].cells)
    ):
        raise RecordingError(FileUnusable(str(table.path), "sweeps"))
    columns, rows = _columns(table)
    if not rows:
        raise RecordingError(FileUnusable(str(table.path), "empty"))
    bearings: list[RecordedBearing] = []
    used: list[float] = []
    remarks: list[CellUnusable | RowLeftOut] = []
    for row in rows:
        if _is_wide(row, columns):
            remarks.append(RowLeftOut(str(table.path), row.line, "wide"))
            continue
        bearing = _bearing(table, row, columns, sigma_deg)
        if isinstance(bearing, CellUnusable):
            remarks.append(bearing)
        else:
            bearings.append(bearing)
            used.append(row.number(columns.bearing) or 0.0)
    if not bearings:
        raise RecordingError(_nothing(table, columns, rows, remarks[0]))
    if not columns.in_degrees:
        _refuse_radians(table, columns.bearing, used)
    return RecordedBearings(tuple(bearings), tuple(remarks))


def _is_wide(row: Row, columns: _Columns) -> bool:
    """Whether it has more numbers than there are columns; a note may hold commas."""
    width = columns.width
    if width is None or not row.numbers_beyond(width):
        return False
    return not columns.noted or row.number(width - 1) is not None


def _nothing(
    table: Table, columns: _Columns, rows: tuple[Row, ...], first: CellUnusable | RowLeftOut
) -> TooManyCells | NothingUsable:
    if isinstance(first, RowLeftOut) and columns.width is not None:
        return TooManyCells(str(table.path), rows[0].line, len(rows[0].cells), columns.width)
    return NothingUsable(str(table.path), "bearing", first)


def _columns(table: Table) -> tuple[_Columns, tuple[Row, ...]]:
    first = table.rows[0]
    heads = [head for head in table.heads if column_of(head.cells, *_BEARING) is not None]
    if heads:
        header = next(filter(_names_all, heads), heads[0])
        return _named(table, header), table.below(header)
    if len(first.cells) == 10:
        tags = as_written(0, table.rows)
        return _Columns(PlaceColumns(4, 5), bearing=2, sigma=None, tags=tags, at=9, in_degrees=True), table.rows
    if len(first.cells) in (3, 4):
        unread = first.number(0) is None or (first.cells[1] and first.number(1) is None)
        if unread or _unlike_sigmas(table) or _counts_rows(table):
            raise table.columns_unknown(first, *EXPECTED)
        return _Columns(PlaceColumns(0, 1), bearing=2, sigma=3), table.rows
    raise table.columns_unknown(first, *EXPECTED)


def _named(table: Table, header: Row) -> _Columns:
    names, rows = header.cells, table.below(header)
    bearing, sigma = column_of(names, *_BEARING), column_of(names, *_SIGMA)
    places = place_columns(names, rows)
    if places is None or bearing is None:
        in_utm = column_of(names, *EASTING) is not None
        raise table.columns_unknown(header, *(EXPECTED_UTM if in_utm else EXPECTED))
    last = max(k for k, name in enumerate(names) if name)
    tags = tags_in(names, [row for row in rows if row.number(bearing) is not None])
    return _Columns(
        places,
        bearing,
        sigma,
        tags,
        width=last + 1,
        noted=last not in (*places.columns, bearing, sigma, None if tags is None else tags.column),
        in_degrees=plain_name(names[bearing]).endswith("_deg"),
    )


def _refuse_radians(table: Table, column: int, bearings: Sequence[float]) -> None:
    """Raises RecordingError where no bearing is more than a turn's radians: several would all point north."""
    least, most = min(bearings), max(bearings)
    whole = all(bearing.is_integer() for bearing in bearings)
    if len(bearings) >= FEWEST_BEARINGS and max(-least, most) <= LARGEST_RAD and not whole:
        raise RecordingError(HeadingsInRadians(str(table.path), column + 1, least, most))


def _counts_rows(table: Table) -> bool:
    """Whether the first of four columns numbers the rows."""
    first = [row.number(0) for row in table.rows]
    return len(table.rows[0].cells) == 4 and first in ([*range(len(first))], [*range(1, 1 + len(first))])


def _unlike_sigmas(table: Table) -> bool:
    """Whether the fourth column holds no degrees: nobody takes bearings to less than one, and shares are so small."""
    fourth = [sigma for row in table.rows if (sigma := row.number(3)) is not None]
    return len(table.rows[0].cells) == 4 and bool(fourth) and 0.0 < min(fourth) <= max(fourth) < 1.0


def _bearing(table: Table, row: Row, columns: _Columns, default_sigma_deg: float) -> RecordedBearing | CellUnusable:
    place = columns.places.place(row)
    if not isinstance(place, Place):
        return table.cell_unusable(row, *place)
    bearing = row.number(columns.bearing)
    if bearing is None or not abs(bearing) <= 360.0:
        return table.cell_unusable(row, columns.bearing, "bearing")
    sigma, given = default_sigma_deg, False
    if columns.sigma is not None and columns.sigma < len(row.cells) and row.cells[columns.sigma]:
        stated = row.number(columns.sigma)
        if stated is None or not 0.0 < stated <= 180.0:
            return table.cell_unusable(row, columns.sigma, "sigma")
        sigma, given = stated, True
    tag = "" if columns.tags is None else columns.tags.of(row)
    at_s = None if columns.at is None else row.number(columns.at)
    at_s = at_s if at_s is not None and EARLIEST_S < at_s < LATEST_S else None
    return RecordedBearing(row.line, place, bearing % 360.0, sigma, tag or None, given, at_s)
