"""Where the antenna, or the vehicle's nose, pointed while IQ was recorded: annotations, or a table beside it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path

from hardware.direction_finding.table_file import RecordingError, Row, column_of, read_table
from hardware.direction_finding.table_places import Places, place_columns
from hardware.readings import HeadingSample, Place
from hardware.reasons.iq_recording import HeadingsApart, HeadingsOfOtherLength, SigmfFieldMissing
from hardware.reasons.table import FileUnusable
from hardware.reasons.union import RecordingReason
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
        raise RecordingError(SigmfFieldMissing(str(recorded.path), AZIMUTH_KEY))
    headings: list[HeadingSample] = []
    for azimuth in recorded.azimuths:
        count = min(azimuth.count, recorded.samples.size)
        repeats = max(math.ceil(count / recorded.sample_rate_hz / STEADY_S), 1)
        inside = [azimuth.first + int(count * (k + 0.5) / repeats) for k in range(repeats)]
        headings += [HeadingSample(recorded.time_of(sample), azimuth.azimuth_deg) for sample in inside]
    return headings


def headings_from(path: Path, recorded: SigmfRecording, remarks: list[RecordingReason]) -> list[HeadingSample]:
    """The nose's headings of a table of time, heading[, lat, lon]; adds a remark a row that is left out.

    Times: UTC epoch seconds, ISO 8601, or seconds since the recording began. Raises RecordingError.
    """
    table = read_table(path)
    first = table.rows[0]
    named = _time_s(first, 0) is None
    names = first.cells if named else ()
    time_at = column_of(names, "at_s", "time_s", "time", "t", "timestamp", "at_utc", "time_utc") if named else 0
    heading_at = column_of(names, "heading_deg", "heading", "yaw_deg", "yaw") if named else 1
    if time_at is None or heading_at is None:
        raise table.columns_unknown(first, "at_s", "heading_deg")
    rows = table.rows[1:] if named else table.rows
    places = place_columns(names, rows)
    headings: list[HeadingSample] = []
    for row in rows:
        at_s, heading = _time_s(row, time_at), row.number(heading_at)
        if at_s is None or heading is None or not (math.isfinite(at_s) and math.isfinite(heading)):
            timeless = at_s is None or not math.isfinite(at_s)
            column, quantity = (time_at, "time") if timeless else (heading_at, "heading")
            remarks.append(table.cell_unusable(row, column, quantity))
        else:
            headings.append(HeadingSample(at_s, heading % 360.0, _position(row, places)))
    if len(headings) < 2:
        raise RecordingError(FileUnusable(str(path), "one_heading"))
    if max(h.at_s for h in headings) < EPOCH_S:
        headings = [replace(h, at_s=h.at_s + recorded.start_s) for h in headings]
    elif not recorded.dated:
        raise RecordingError(SigmfFieldMissing(str(recorded.path), "core:datetime"))
    first_s, last_s = _span_s(recorded, headings)
    length_s = recorded.duration_s
    # a wrong sample rate shows in that the samples end long before or after the headings
    if last_s >= 0.0 and first_s <= length_s and not 0.8 * length_s < last_s - first_s < 1.25 * length_s:
        remarks.append(HeadingsOfOtherLength(str(path), last_s - first_s, length_s, recorded.sample_rate_hz))
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


def _position(row: Row, places: Places | None) -> Place | None:
    found = None if places is None else places.place(row)
    return found if isinstance(found, Place) else None


def _span_s(recorded: SigmfRecording, headings: Sequence[HeadingSample]) -> tuple[float, float]:
    """First and last heading, seconds since the recording began."""
    times = [h.at_s - recorded.start_s for h in headings]
    return min(times), max(times)


def apart(recorded: SigmfRecording, headings: Sequence[HeadingSample]) -> HeadingsApart | None:
    """That headings and samples share no time; None when they do."""
    first_s, last_s = _span_s(recorded, headings)
    if last_s >= 0.0 and first_s <= recorded.duration_s:
        return None
    return HeadingsApart(str(recorded.path), first_s, last_s, recorded.duration_s, recorded.sample_rate_hz)
