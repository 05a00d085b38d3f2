"""Where the antenna, or the vehicle's nose, pointed while IQ was recorded: annotations, or a table beside it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path

import numpy as np

from hardware.direction_finding.table_file import RecordingError, Row, column_of, read_table
from hardware.readings import GeoPoint, HeadingSample
from hardware.sdr.sigmf_file import AZIMUTH_KEY, SigmfRecording

EPOCH_S = 1e8
"""Times in a table from here on are UTC epoch seconds, smaller ones seconds since the recording began."""
STEADY_S = 0.25
"""An azimuth that holds for longer is repeated so often."""


def annotated_headings(recorded: SigmfRecording) -> list[HeadingSample]:
    """The antenna's direction as the recording carries it: short annotations at their middle, long ones held.

    Raises RecordingError when it carries none.
    """
    if len(recorded.azimuths) < 2:
        raise RecordingError(
            f"{recorded.path}: does not tell where the antenna pointed ({AZIMUTH_KEY} in its annotations); "
            "give a table of time and heading beside it (--headings)"
        )
    headings: list[HeadingSample] = []
    for azimuth in recorded.azimuths:
        begin_s = recorded.time_of(azimuth.first)
        length_s = min(azimuth.count, recorded.samples.size) / recorded.sample_rate_hz
        repeats = max(math.ceil(length_s / STEADY_S), 1)
        inside = begin_s + length_s * (np.arange(repeats) + 0.5) / repeats
        headings += [HeadingSample(float(at_s), azimuth.azimuth_deg) for at_s in inside]
    return headings


def headings_from(path: Path, recorded: SigmfRecording, remarks: list[str]) -> list[HeadingSample]:
    """The nose's headings of a table of time, heading[, lat, lon]; adds a remark a row that is left out.

    Times: UTC epoch seconds, ISO 8601, or seconds since the recording began. Raises RecordingError.
    """
    table = read_table(path)
    first = table.rows[0]
    named = _time_s(first, 0) is None
    names = first.cells if named else ()
    time_at = column_of(names, "at_s", "time_s", "time", "t", "timestamp", "at_utc", "time_utc") if named else 0
    heading_at = column_of(names, "heading_deg", "heading", "yaw_deg", "yaw") if named else 1
    lat_at, lon_at = column_of(names, "lat", "lat_deg", "latitude"), column_of(names, "lon", "lon_deg", "longitude")
    if time_at is None or heading_at is None:
        raise RecordingError(
            f"{table.where(first)}: the header names no time and heading column; name the columns at_s and heading_deg"
        )
    headings: list[HeadingSample] = []
    for row in table.rows[1:] if named else table.rows:
        at_s, heading = _time_s(row, time_at), row.number(heading_at)
        if at_s is None or heading is None or not (math.isfinite(at_s) and math.isfinite(heading)):
            remarks.append(f'{table.where(row)}: "{", ".join(row.cells)}" is not time and heading; line left out')
        else:
            headings.append(HeadingSample(at_s, heading % 360.0, _position(row, lat_at, lon_at)))
    if len(headings) < 2:
        raise RecordingError(f"{path}: needs at least two rows of time and heading")
    if max(h.at_s for h in headings) < EPOCH_S:
        headings = [replace(h, at_s=h.at_s + recorded.start_s) for h in headings]
    elif recorded.segments[0].at_s is None:
        raise RecordingError(
            f"{path}: has clock times, but the recording does not tell when it began (core:datetime); "
            "write the times as seconds since its beginning"
        )
    _remark_span(path, recorded, headings, remarks)
    return headings


def _time_s(row: Row, column: int) -> float | None:
    number = row.number(column)
    if number is not None or column >= len(row.cells):
        return number
    try:
        moment = datetime.fromisoformat(row.cells[column])
    except ValueError:
        return None
    return (moment if moment.tzinfo else moment.replace(tzinfo=UTC)).timestamp()


def _position(row: Row, lat_at: int | None, lon_at: int | None) -> GeoPoint | None:
    lat = None if lat_at is None else row.number(lat_at)
    lon = None if lon_at is None else row.number(lon_at)
    if lat is None or lon is None or not (abs(lat) <= 90.0 and abs(lon) <= 180.0):
        return None
    return GeoPoint(lat, lon)


def _span_s(recorded: SigmfRecording, headings: Sequence[HeadingSample]) -> tuple[float, float]:
    """First and last heading, seconds since the recording began."""
    times = [h.at_s - recorded.start_s for h in headings]
    return min(times), max(times)


def _remark_span(path: Path, recorded: SigmfRecording, headings: Sequence[HeadingSample], remarks: list[str]) -> None:
    """A wrong sample rate shows in that the samples end long before or after the headings."""
    first_s, last_s = _span_s(recorded, headings)
    length_s = recorded.duration_s
    if last_s >= 0.0 and first_s <= length_s and not 0.8 * length_s < last_s - first_s < 1.25 * length_s:
        remarks.append(
            f"{path}: the headings last {last_s - first_s:.1f} s, the samples {length_s:.1f} s; what they share is "
            f"used. Is the recording's sample rate ({recorded.sample_rate_hz:g} Hz) right?"
        )


def apart(recorded: SigmfRecording, headings: Sequence[HeadingSample]) -> str | None:
    """What to say when headings and samples share no time; None when they do."""
    first_s, last_s = _span_s(recorded, headings)
    if last_s >= 0.0 and first_s <= recorded.duration_s:
        return None
    return (
        f"the headings run from {first_s:.1f} to {last_s:.1f} s after its beginning, the samples from 0 to "
        f"{recorded.duration_s:.1f} s; check the times and the sample rate ({recorded.sample_rate_hz:g} Hz)"
    )
