"""Antenna patterns as files: JSON, and the import of a turntable table.

The JSON format (one object):
    {"format": "crossfix antenna pattern", "name": "...", "unit": "dB" | "dBi" | "linear power",
     "frequency_hz": 868300000 | null, "polarization": "vertical" | null, "measured_on": "2026-05-01" | null,
     "offset_to_nose_deg": 0, "pointing_sigma_deg": 1.5 | null, "relative_bearing_deg": [0, 10, ...],
     "gain": [9.4, 9.3, ...]}
Angles: degrees clockwise from the antenna's front seen from above. The absolute level does not matter.
pointing_sigma_deg: what bearings found with the pattern are uncertain by together, measured with the antenna on its
vehicle (`crossfix calibrate` writes it); without it the antenna may point 10 degrees beside where it should.
"""

from __future__ import annotations

import csv
import json
from dataclasses import replace
from pathlib import Path
from typing import Any, Literal, cast

import numpy as np
from numpy.typing import NDArray

from hardware.direction_finding.antenna import AntennaPattern
from hardware.direction_finding.table_file import (
    LONGEST_CELL,
    Row,
    cells_of,
    commas_in_numbers,
    decoded,
    lines_of,
    number_of,
    plain_name,
)
from hardware.reasons.pattern import (
    AngleTwice,
    ImplausibleGains,
    NotAPattern,
    PatternGap,
    PatternReason,
    PatternRowUnusable,
    PatternUnitUnknown,
    TooFewPoints,
)
from hardware.reasons.table import FileUnreadable, TooManyCells
from planner.reason import ReasonedError

FORMAT = "crossfix antenna pattern"
SMALL_YAGI = Path(__file__).parent / "patterns" / "small_yagi.json"
KEYS: tuple[Literal["relative_bearing_deg", "gain", "unit"], ...] = ("relative_bearing_deg", "gain", "unit")
MINIMUM_POINTS = 8
MAXIMUM_GAP_DEG = 60.0
MINIMUM_DIRECTIVITY_DB = 3.0
MAXIMUM_DIRECTIVITY_DB = 200.0
MAXIMUM_POINTING_SIGMA_DEG = 90.0


class PatternError(ReasonedError):
    """A pattern that cannot be used."""

    def __init__(self, reason: PatternReason) -> None:
        super().__init__(reason)
        self._pattern_reason: PatternReason = reason

    @property
    def reason(self) -> PatternReason:
        """Which entry of the file cannot be used, and why."""
        return self._pattern_reason


def make_pattern(
    name: str,
    relative_bearing_deg: NDArray[np.float64],
    gain_db: NDArray[np.float64],
    offset_to_nose_deg: float = 0.0,
    frequency_hz: float | None = None,
    polarization: str | None = None,
    measured_on: str | None = None,
    pointing_sigma_deg: float | None = None,
) -> AntennaPattern:
    """A checked pattern: angles taken modulo 360 and sorted. Raises PatternError."""
    angle = np.asarray(relative_bearing_deg, dtype=np.float64) % 360.0
    gain = np.asarray(gain_db, dtype=np.float64)
    if angle.ndim != 1 or angle.shape != gain.shape:
        raise PatternError(NotAPattern(name, "counts"))
    if angle.size < MINIMUM_POINTS:
        raise PatternError(TooFewPoints(name, angle.size, MINIMUM_POINTS))
    if not (np.isfinite(angle).all() and np.isfinite(gain).all() and np.isfinite(offset_to_nose_deg)):
        raise PatternError(NotAPattern(name, "numbers"))
    order = np.argsort(angle, kind="stable")
    angle, gain = angle[order], gain[order]
    step = np.diff(angle, append=angle[0] + 360.0)
    if (step < 1e-9).any():
        raise PatternError(AngleTwice(name, float(angle[np.argmin(step)])))
    if step.max() > MAXIMUM_GAP_DEG:
        start = float(angle[np.argmax(step)])
        raise PatternError(PatternGap(name, float(step.max()), start, MAXIMUM_GAP_DEG))
    if np.ptp(gain) < MINIMUM_DIRECTIVITY_DB:
        raise PatternError(ImplausibleGains(name, "small", MINIMUM_DIRECTIVITY_DB))
    if np.ptp(gain) > MAXIMUM_DIRECTIVITY_DB:
        raise PatternError(ImplausibleGains(name, "large", MAXIMUM_DIRECTIVITY_DB))
    if pointing_sigma_deg is not None and not 0.0 <= pointing_sigma_deg <= MAXIMUM_POINTING_SIGMA_DEG:
        raise PatternError(NotAPattern(name, "numbers"))
    return AntennaPattern(
        name, angle, gain, float(offset_to_nose_deg), frequency_hz, polarization, measured_on, pointing_sigma_deg
    )


def load_pattern(path: Path | str) -> AntennaPattern:
    """Read a JSON pattern, or a turntable table (.csv, see `read_turntable`). Raises PatternError."""
    return parse_pattern(str(path), _text_of(path))


def borrowed_pattern() -> AntennaPattern:
    """The small Yagi that ships, for whoever has no pattern of their own: it says that it is another antenna's."""
    return replace(load_pattern(SMALL_YAGI), borrowed=True)


def parse_pattern(filename: str, text: str) -> AntennaPattern:
    """The same from a file's text. Raises PatternError naming the file."""
    if Path(filename).suffix.lower() in {".csv", ".txt", ".tsv"}:
        return _turntable(filename, text, "dB", 0.0)
    try:
        data = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise PatternError(NotAPattern(filename, "json")) from error
    return _from_json(filename, data)


def _text_of(path: Path | str) -> str:
    try:
        return decoded(Path(path).read_bytes())
    except OSError as error:
        raise PatternError(FileUnreadable(str(path), error.strerror or str(error))) from error


def _from_json(filename: str, parsed: object) -> AntennaPattern:
    data = cast(dict[str, Any], parsed) if isinstance(parsed, dict) else {}
    if data.get("format") != FORMAT:
        raise PatternError(NotAPattern(filename, "format"))
    for key in KEYS:
        if key not in data:
            raise PatternError(NotAPattern(filename, key))
    try:
        angle = np.array(data["relative_bearing_deg"], dtype=np.float64)
        gain = np.array(data["gain"], dtype=np.float64)
        offset = float(data.get("offset_to_nose_deg", 0.0))
        frequency = None if data.get("frequency_hz") is None else float(data["frequency_hz"])
        pointing = None if data.get("pointing_sigma_deg") is None else float(data["pointing_sigma_deg"])
    except (TypeError, ValueError, OverflowError) as error:
        raise PatternError(NotAPattern(filename, "numbers")) from error
    return make_pattern(
        str(data.get("name") or Path(filename).stem),
        angle,
        _to_db(filename, gain, str(data["unit"])),
        offset,
        frequency,
        data.get("polarization"),
        data.get("measured_on"),
        pointing,
    )


def _to_db(filename: str, gain: NDArray[np.float64], unit: str) -> NDArray[np.float64]:
    if unit in {"dB", "dBi", "dBd", "dBm"}:
        return gain
    if unit == "linear power":
        if not (gain > 0).all():
            raise PatternError(NotAPattern(filename, "positive"))
        return 10.0 * np.log10(gain)
    raise PatternError(PatternUnitUnknown(filename, unit))


def pattern_json(pattern: AntennaPattern) -> str:
    """The JSON format above, unit dB."""
    data = {
        "format": FORMAT,
        "name": pattern.name,
        "unit": "dB",
        "frequency_hz": pattern.frequency_hz,
        "polarization": pattern.polarization,
        "measured_on": pattern.measured_on,
        "offset_to_nose_deg": pattern.offset_to_nose_deg,
        "pointing_sigma_deg": pattern.pointing_sigma_deg,
        "relative_bearing_deg": [round(float(a), 3) for a in pattern.relative_bearing_deg],
        "gain": [round(float(g), 3) for g in pattern.gain_db],
    }
    rows = ",\n".join(f" {json.dumps(key)}: {json.dumps(value)}" for key, value in data.items())
    return "{\n" + rows + "\n}\n"


def save_pattern(pattern: AntennaPattern, path: Path | str) -> None:
    """Write `pattern_json` to a file."""
    Path(path).write_text(pattern_json(pattern), encoding="utf-8")


def read_turntable(path: Path | str, unit: str = "dB", offset_to_nose_deg: float = 0.0) -> AntennaPattern:
    """A turntable's table: rows `angle_deg, gain`, comma, semicolon or blank separated, `#` comments, optional header;
    decimal commas where no comma separates.

    Several rows at one angle (more than one turn) are averaged. Raises PatternError naming file and line.
    """
    return _turntable(str(path), _text_of(path), unit, offset_to_nose_deg)


def _turntable(filename: str, text: str, unit: str, offset_to_nose_deg: float) -> AntennaPattern:
    rows: list[Row] = []
    header: Row | None = None
    for number, line in lines_of(text):
        bare = line.split("#")[0].strip()
        try:
            cells, named = _turntable_cells(bare), cells_of(bare or " ")
        except csv.Error:  # a cell of more than 128 kB, for one
            raise PatternError(PatternRowUnusable(filename, number, line.strip()[:LONGEST_CELL])) from None
        if not any(cells):
            continue
        numbers = [number_of(cell) is not None for cell in cells[:2]]
        if numbers == [True, True]:
            rows.append(Row(number, cells))
        elif rows or numbers[0]:
            raise PatternError(PatternRowUnusable(filename, number, line.strip()))
        else:
            header = Row(number, named) if len(named) > 1 else None  # rather than a title
    if not rows:
        raise PatternError(NotAPattern(filename, "rows"))
    _refuse_commas(filename, header, rows)
    _refuse_units(filename, header)
    table = np.array([(number_of(row.cells[0]), number_of(row.cells[1])) for row in rows], dtype=np.float64)
    if not np.isfinite(table[:, 0]).all():
        raise PatternError(NotAPattern(Path(filename).stem, "numbers"))
    gain = _to_db(filename, table[:, 1], unit)
    angle, member = np.unique(np.round(table[:, 0] % 360.0, 6), return_inverse=True)
    mean = np.bincount(member, gain) / np.bincount(member)
    return make_pattern(Path(filename).stem, np.asarray(angle, dtype=np.float64), mean, offset_to_nose_deg)


def _turntable_cells(line: str) -> tuple[str, ...]:
    """Blanks separate numbers where nothing else does."""
    between_blanks = tuple(line.split())
    if len(between_blanks) > 1 and all(number_of(cell) is not None for cell in between_blanks):
        return between_blanks
    cells = cells_of(line or " ")
    return cells if len(cells) > 1 else between_blanks


def _refuse_units(filename: str, header: Row | None) -> None:
    """Raises PatternError where the header names other units than degrees and decibels of gain."""
    if header is None:
        return
    angle, gain = (plain_name(name).split("_") for name in header.cells[:2])
    if angle[-1] in {"rad", "radians", "gon"}:
        raise PatternError(NotAPattern(filename, "rows"))
    if gain[-1] in {"linear", "lin", "ratio", "mw", "w", "v"} or gain[0] in {"attenuation", "loss"}:
        raise PatternError(PatternUnitUnknown(filename, header.cells[1]))


def _refuse_commas(filename: str, header: Row | None, rows: list[Row]) -> None:
    """Raises PatternError where commas separate columns and stand in numbers as well."""
    if header is not None:
        wide = next((row for row in rows if row.numbers_beyond(len(header.cells))), None)
    else:
        wide = rows[0] if commas_in_numbers(rows) else None
    if wide is not None:
        columns = 2 if header is None else len(header.cells)
        raise PatternError(TooManyCells(filename, wide.line, len(wide.cells), columns))
