"""Files of bearings that others took: UAV-RT's and ours, plain CSV, and what a KrakenSDR's page held, line by line."""

from __future__ import annotations

from pathlib import Path

from backend.kraken import FEWEST_COLUMNS, KrakenRefused, read_kraken
from backend.search.reported import ReportedBearing
from hardware.direction_finding.bearings_file import EARLIEST_S, RecordedBearing, bearings_in, holds_bearings
from hardware.direction_finding.recordings import Recording
from hardware.direction_finding.table_file import RecordingError, Row, Table, read_table, some_of
from hardware.direction_finding.table_tags import meant
from hardware.reasons.table import CellUnusable, NothingUsable, OneTagOnly

EPOCH_MS = 1e3 * EARLIEST_S


def read_bearing_file(path: Path, tag: str | None) -> Recording | None:
    """None for a file of something else. tag: whose bearings, in a file of several. Raises RecordingError."""
    table = read_table(path)
    kraken = kraken_in(table)
    if kraken is not None:
        return kraken
    if not holds_bearings(table):
        return None
    found = bearings_in(table)
    tags = {one.tag for one in found.bearings if one.tag is not None}
    wanted = None if tag is None or not tags else meant(tag, tags)
    if wanted == "" or (tag is None and len(tags) > 1):
        raise RecordingError(OneTagOnly(str(path), some_of(tags)))
    chosen = tuple(one for one in found.bearings if wanted is None or one.tag == wanted)
    return Recording((), found.remarks, chosen)


def kraken_in(table: Table) -> Recording | None:
    """Of the bearings that a KrakenSDR took standing still, one a minute, as of those that it sends itself; None for
    another file. Raises RecordingError."""
    first = table.rows[0]
    if len(first.cells) < FEWEST_COLUMNS or (first.number(0) or 0.0) <= EPOCH_MS:
        return None
    kept: dict[str, RecordedBearing] = {}
    remarks: list[CellUnusable] = []
    for row in table.rows:
        try:
            told = read_kraken(",".join(row.cells).encode(), 0.0)
        except KrakenRefused:
            remarks.append(table.cell_unusable(row, 1, "bearing"))
        else:
            kept.setdefault(told.bearing_id, _recorded(row, told))
    if not kept:
        raise RecordingError(NothingUsable(str(table.path), "bearing", remarks[0]))
    return Recording((), tuple(remarks), tuple(kept.values()))


def _recorded(row: Row, told: ReportedBearing) -> RecordedBearing:
    return RecordedBearing(
        row.line,
        told.place,
        told.bearing_deg,
        told.sigma_deg,
        told.by,
        True,
        told.taken_at_s,
        told.frequency_hz,
        told.bearing_id,
    )
