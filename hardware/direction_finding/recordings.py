"""Recorded sweeps as files: UAV-RT rotations (uavrt.py) and plain tables of heading and power."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from hardware.direction_finding.antenna import AntennaPattern
from hardware.direction_finding.bearings_file import POWER, RecordedBearing
from hardware.direction_finding.table_file import RecordingError, Row, Table, column_of, read_table
from hardware.direction_finding.uavrt import is_uavrt, read_rotations
from hardware.readings import Place, Sweep
from hardware.reasons.table import CellUnusable, FileUnusable, NothingUsable
from hardware.reasons.union import RecordingReason

_HEADING = ("heading_deg", "heading", "yaw_deg", "yaw", "azimuth", "azimuth_deg", "angle", "angle_deg")
_UNKNOWN_PLACE = Place(0.0, 0.0)


@dataclass(frozen=True, slots=True)
class RecordedSweep:
    """A sweep from a file. antenna_offset_deg: as the file states it (None: it does not). place_known: whether the
    file told where it was taken (else `sweep.position` means nothing). of_antenna: `sweep.heading_deg` is the direction
    of the antenna's front already, not the nose's."""

    sweep: Sweep
    antenna_offset_deg: float | None
    place_known: bool
    of_antenna: bool = False


@dataclass(frozen=True, slots=True)
class Recording:
    """sweeps, bearings (of a file that holds no sweeps): in file order. remarks: what was left out or assumed."""

    sweeps: tuple[RecordedSweep, ...]
    remarks: tuple[RecordingReason, ...]
    bearings: tuple[RecordedBearing, ...] = ()


def mounted(antenna: AntennaPattern, recorded: RecordedSweep, offset_deg: float | None) -> AntennaPattern:
    """The pattern with the offset that holds for this sweep: the one that is given, else the file's, else its own."""
    if recorded.of_antenna:
        return replace(antenna, offset_to_nose_deg=offset_deg or 0.0)
    stated = offset_deg if offset_deg is not None else (recorded.antenna_offset_deg or None)
    return antenna if stated is None else replace(antenna, offset_to_nose_deg=stated)


def read_recording(path: Path | str, tag: str | None = None) -> Recording:
    """Read a UAV-RT rotation file or a plain CSV (heading_deg, power_db). Raises RecordingError."""
    table = read_table(path)
    if is_uavrt(table):
        rotations, remarks = read_rotations(table, tag)
        return Recording(tuple(RecordedSweep(sweep, offset, True) for sweep, offset in rotations), tuple(remarks))
    return _plain(table, tag)


def _plain(table: Table, tag: str | None) -> Recording:
    """Two columns (heading, power), or a header that names heading, power and, if known, time, lat, lon, frequency."""
    header, rows = _header(table)
    heading_at = 0 if header is None else column_of(header.cells, *_HEADING)
    power_at = 1 if header is None else column_of(header.cells, *POWER)
    if heading_at is None or power_at is None:
        raise table.columns_unknown(header or rows[0], "heading_deg", "power_db")
    if not rows:
        raise RecordingError(FileUnusable(str(table.path), "empty"))
    names = () if header is None else header.cells
    columns = {
        "time": column_of(names, "at_s", "time_s", "time", "t", "timestamp"),
        "lat": column_of(names, "lat", "lat_deg", "latitude"),
        "lon": column_of(names, "lon", "lon_deg", "longitude"),
        "frequency": column_of(names, "frequency_hz", "frequency"),
    }
    remarks: list[CellUnusable] = []
    good: list[tuple[Row, float, float]] = []
    for row in rows:
        heading, power = row.number(heading_at), row.number(power_at)
        if heading is None or power is None or not (math.isfinite(heading) and math.isfinite(power)):
            wrong = heading is None or not math.isfinite(heading)
            column, quantity = (heading_at, "heading") if wrong else (power_at, "power")
            remarks.append(table.cell_unusable(row, column, quantity))
        else:
            good.append((row, heading % 360.0, power))
    if not good:
        raise RecordingError(NothingUsable(str(table.path), "power", remarks[0]))
    place = _median_place(good, columns["lat"], columns["lon"])
    frequency = _median(good, columns["frequency"])
    sweep = Sweep(
        at_s=np.array([_value(row, columns["time"], float(k)) for k, (row, _, _) in enumerate(good)]),
        heading_deg=np.array([heading for _, heading, _ in good]),
        power_db=np.array([power for _, _, power in good]),
        frequency_hz=frequency or 0.0,
        position=place or _UNKNOWN_PLACE,
        altitude_amsl_m=0.0,
        tag=tag,
    )
    return Recording((RecordedSweep(sweep, None, place is not None),), tuple(remarks))


def _header(table: Table) -> tuple[Row | None, tuple[Row, ...]]:
    """The header row (a first line, or a comment, whose cells name a heading column) and the data rows."""
    first = table.rows[0]
    if first.number(0) is None and any(cell and not _is_number(cell) for cell in first.cells):
        return first, table.rows[1:]
    named = next((c for c in table.comments if column_of(c.cells, *_HEADING) is not None), None)
    return named, table.rows


def _is_number(cell: str) -> bool:
    try:
        float(cell)
    except ValueError:
        return False
    return True


def _value(row: Row, column: int | None, otherwise: float) -> float:
    value = None if column is None else row.number(column)
    return otherwise if value is None or not math.isfinite(value) else value


def _median(good: list[tuple[Row, float, float]], column: int | None) -> float | None:
    if column is None:
        return None
    values = [v for row, _, _ in good if (v := row.number(column)) is not None and math.isfinite(v)]
    return float(np.median(values)) if values else None


def _median_place(good: list[tuple[Row, float, float]], lat_at: int | None, lon_at: int | None) -> Place | None:
    lat, lon = _median(good, lat_at), _median(good, lon_at)
    if lat is None or lon is None or abs(lat) > 90.0 or abs(lon) > 180.0:
        return None
    return Place(lat, lon)
