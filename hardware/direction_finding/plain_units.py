"""Whether a plain table's headings are degrees and its power decibels, by their names and their values."""

from __future__ import annotations

import math
from collections.abc import Sequence

from hardware.direction_finding.plain_columns import Columns, Unit
from hardware.direction_finding.table_file import RecordingError
from hardware.reasons.table import DecibelsAssumed, HeadingsInRadians, PowerLinear

FEWEST_ROWS = 10
"""So few headings, or fewer, may well lie within six degrees."""
LARGEST_RAD = 6.3
"""A whole turn, rounded up."""
SPAN_RAD = 3.0
LINEAR_FACTOR = 1000.0
LOUDEST_DB = 300.0
"""No receiver shows as much, whatever its zero is."""


def refuse_radians(file: str, columns: Columns, headings: Sequence[float]) -> None:
    """headings: as they stand in the file. Raises RecordingError for radians."""
    least, most = min(headings), max(headings)
    within = max(-least, most) <= LARGEST_RAD and most - least > SPAN_RAD and len(headings) > FEWEST_ROWS
    if columns.radians or within:
        raise RecordingError(HeadingsInRadians(file, columns.heading + 1, least, most))


def decibels_doubted(file: str, columns: Columns, powers: Sequence[float]) -> DecibelsAssumed | None:
    """What is to be remarked of power that names no unit. Raises RecordingError for power that is linear."""
    least, most, column = min(powers), max(powers), columns.power + 1
    if columns.unit == "linear":
        raise RecordingError(PowerLinear(file, column, "name", least, most))
    if _looks_linear(columns.unit, least, most):
        raise RecordingError(PowerLinear(file, column, "values", least, most))
    return DecibelsAssumed(file, column, least, most) if columns.unit == "unnamed" and least >= 0.0 else None


def _looks_linear(unit: Unit, least: float, most: float) -> bool:
    """Decibels of a turn differ by more than one, and those that a header names as such may begin near zero."""
    if not 0.0 < least < most:
        return False
    beyond = most < 1.0 or most > LOUDEST_DB
    return most / least > (LINEAR_FACTOR if unit == "unnamed" else math.inf) or (beyond and most / least > 10.0)
