"""What one row of a plain table tells."""

from __future__ import annotations

from dataclasses import dataclass

from hardware.direction_finding.table_file import Row
from hardware.readings import Place


@dataclass(frozen=True, slots=True)
class HeardAt:
    """One usable row. heading_deg: [0, 360). at_s: as the table tells, else its number in the file. place None: it does
    not tell."""

    row: Row
    at_s: float
    heading_deg: float
    power_db: float
    place: Place | None
