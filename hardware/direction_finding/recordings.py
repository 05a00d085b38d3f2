"""Recorded sweeps as files: UAV-RT rotations (uavrt.py) and plain tables of heading and power (plain_sweeps.py)."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

from hardware.direction_finding.antenna import AntennaPattern
from hardware.direction_finding.bearings_file import RecordedBearing
from hardware.direction_finding.plain_sweeps import read_plain
from hardware.direction_finding.table_file import read_table
from hardware.direction_finding.uavrt import is_uavrt, read_rotations
from hardware.readings import Sweep
from hardware.reasons.union import RecordingReason


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
    sweeps, remarks = read_plain(table, tag)
    return Recording(tuple(RecordedSweep(sweep, None, known) for sweep, known in sweeps), tuple(remarks))
