"""UAV-RT rotation files: pulses of a tag with the vehicle's attitude, in their layouts of several years.

Rows `10` / `11` open and close a rotation (lat, lon, altitude AMSL), rows `7` are pulses. Layouts seen in the project's
history (dynamic-and-active-systems-lab/uavrt_bearing, DonLakeFlyer/TagTracker):

    19 columns  no noise PSD; attitude as a unit quaternion x, y, z, w
    20 columns  with noise PSD; attitude as roll, pitch, yaw in degrees (or quaternion)
    21 columns  the same with the antenna's offset in one of the last two columns

A header line, commented out or not, may name the columns; then the names decide.

Received power of a pulse = SNR + noise PSD in decibels: the SNR alone is no measure of strength, because a strong pulse
leaks into the noise estimate of its own segment. Without a PSD column there is only the SNR.
"""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass, field

import numpy as np

from hardware.direction_finding.plain_columns import is_plain
from hardware.direction_finding.table_file import RecordingError, Row, Table, column_of, some_of
from hardware.direction_finding.table_tags import meant
from hardware.frame import middle_of
from hardware.readings import Place, Sweep
from hardware.reasons.table import (
    CellUnusable,
    FileUnusable,
    NothingUsable,
    OtherTagsLeftOut,
    PulsesOutsideRotations,
    Quantity,
    RotationIrregular,
    RowLeftOut,
    TableRemark,
    TagNotHeard,
)

PULSE, OPEN, CLOSE = "7", "10", "11"
NAMES = ("position_x", "orientation_x", "detection_status")
"""Columns that a header line must name at least."""
COMMANDS = {PULSE, OPEN, CLOSE}
MISSING = -9999.0
_NO_DETECTION = 3.0


@dataclass(frozen=True, slots=True)
class _Layout:
    """Column indices from 0; None: not in this layout. `offset`: columns that may carry the antenna's offset."""

    noise_psd: int | None
    detection: int
    lat: int
    attitude: int
    offset: tuple[int, ...]
    quaternion: bool

    @property
    def width(self) -> int:
        return self.attitude + (4 if self.quaternion else 3)


@dataclass(frozen=True, slots=True)
class Pulse:
    """One received pulse. heading_deg: yaw of the nose. power_db: see module text."""

    line: int
    tag: str
    frequency_hz: float
    at_s: float
    power_db: float
    position: Place
    height_agl_m: float
    heading_deg: float
    antenna_offset_deg: float


@dataclass(slots=True)
class _Rotation:
    """line: where it begins. opened: its row 10, None when there is none."""

    line: int
    opened: Row | None
    closed: Row | None = None
    pulses: list[Pulse] = field(default_factory=list[Pulse])


def is_uavrt(table: Table) -> bool:
    """Whether the table's rows are UAV-RT commands: a table of headings has a 7, 10 and 11 among others. A header that
    names other columns decides."""
    if is_plain(table):
        return False
    commands = sum(row.cells[0] in COMMANDS and len(row.cells) >= 4 for row in table.rows)
    return 0 < commands >= len(table.rows) / 2


def read_rotations(table: Table, tag: str | None = None) -> tuple[list[tuple[Sweep, float]], list[TableRemark]]:
    """([(sweep, antenna offset to the nose in degrees)], remarks).

    One sweep a rotation, of `tag`, or of the tag heard most often in it. Raises RecordingError when nothing is left.
    """
    layout = _layout(table)
    file = str(table.path)
    remarks: list[TableRemark] = []
    rotations: list[_Rotation] = []
    current: _Rotation | None = None
    outside: list[Pulse] = []
    for row in table.rows:
        command = row.cells[0]
        if row is table.rows[0] and _names(row):
            continue
        if command == OPEN:
            if current is not None:
                remarks.append(RotationIrregular(file, current.line, "not_closed"))
            current = _Rotation(row.line, row)
            rotations.append(current)
        elif command == CLOSE:
            if current is None:
                remarks.append(RowLeftOut(file, row.line, "not_open"))
            else:
                current.closed = row
            current = None
        elif command == PULSE:
            pulse = _pulse(table, row, layout)
            if isinstance(pulse, CellUnusable | RowLeftOut):
                remarks.append(pulse)
            elif pulse is not None:
                (outside if current is None else current.pulses).append(pulse)
        else:
            remarks.append(table.cell_unusable(row, 0, "kind_of_row"))
    if current is not None:
        remarks.append(RotationIrregular(file, current.line, "not_closed"))
    if not rotations:
        rotations = [_Rotation(table.rows[0].line, None, None, outside)]
    elif outside:
        remarks.append(PulsesOutsideRotations(file, len(outside)))
    heard = {pulse.tag for rotation in rotations for pulse in rotation.pulses}
    asked = None if tag is None else meant(tag, heard) or tag
    sweeps = [_sweep(table, rotation, asked, remarks) for rotation in rotations]
    found = [sweep for sweep in sweeps if sweep is not None]
    if not found:
        unheard = next((remark for remark in remarks if isinstance(remark, TagNotHeard)), None)
        raise RecordingError(unheard or NothingUsable(file, "pulse", remarks[0]))
    return found, remarks


def _names(row: Row) -> bool:
    return column_of(row.cells, "tag_id", "tagid") is not None


def _layout(table: Table) -> _Layout:
    pulses = [row for row in table.rows if row.cells[0] == PULSE and not _names(row)]
    if not pulses:
        raise RecordingError(FileUnusable(str(table.path), "no_pulse"))
    header = next((row for row in (*table.rows[:1], *table.comments) if _names(row)), None)
    if header is not None:
        return _layout_from(table, header, pulses)
    width = Counter(len(row.cells) for row in pulses).most_common(1)[0][0]
    if width == 19:
        return _Layout(None, 10, 12, 15, (), _unit_quaternions(pulses, 15))
    if width < 19:
        raise table.columns_unknown(pulses[0], *NAMES)
    quaternion = width >= 20 and _unit_quaternions(pulses, 16)
    return _Layout(10, 11, 13, 16, (20,) if quaternion else (19, 20), quaternion)


def _layout_from(table: Table, header: Row, pulses: list[Row]) -> _Layout:
    names = header.cells
    lat = column_of(names, "position_x", "lat", "latitude", "latitude_deg", "lat_deg")
    attitude = column_of(names, "orientation_x", "roll", "roll_deg")
    detection = column_of(names, "detection_status", "detect_status")
    if lat is None or attitude is None or detection is None:
        raise table.columns_unknown(header, *NAMES)
    offset = column_of(names, "antenna_offset", "antenna_offset_deg")
    quaternion = _unit_quaternions(pulses, attitude)
    psd = column_of(names, "noise_psd", "noisepsd")
    return _Layout(psd, detection, lat, attitude, () if offset is None else (offset,), quaternion)


def _unit_quaternions(pulses: list[Row], first: int) -> bool:
    """Whether four columns from `first` are unit quaternions in every pulse (degrees never are, all along)."""
    parts = [[row.number(first + k) for k in range(4)] for row in pulses]
    complete = [[v for v in row if v is not None] for row in parts]
    complete = [row for row in complete if len(row) == 4]
    return bool(complete) and all(abs(math.sqrt(sum(v * v for v in row)) - 1.0) < 0.01 for row in complete)


def _pulse(table: Table, row: Row, layout: _Layout) -> Pulse | CellUnusable | RowLeftOut | None:
    """The pulse, why the row is left out, or None for a row that says "nothing heard" (heartbeat)."""
    if len(row.cells) < layout.width:
        return RowLeftOut(str(table.path), row.line, "columns")
    need: dict[int, Quantity] = {
        2: "frequency",
        3: "time",
        5: "snr",
        layout.lat: "latitude",
        layout.lat + 1: "longitude",
        **dict.fromkeys(range(layout.attitude, layout.width), "attitude"),
    }
    value: dict[int, float] = {}
    for column, quantity in need.items():
        number = row.number(column)
        if number is None or not math.isfinite(number) or number == MISSING:
            return table.cell_unusable(row, column, quantity)
        value[column] = number
    if value[2] == 0.0 or row.number(layout.detection) == _NO_DETECTION:
        return None
    lat, lon = value[layout.lat], value[layout.lat + 1]
    if abs(lat) > 90.0:
        return table.cell_unusable(row, layout.lat, "latitude")
    if abs(lon) > 180.0:
        return table.cell_unusable(row, layout.lat + 1, "longitude")
    power = value[5]
    if layout.noise_psd is not None:
        psd = row.number(layout.noise_psd)
        if psd is None or not psd > 0.0 or math.isinf(psd):
            return table.cell_unusable(row, layout.noise_psd, "noise_psd")
        power += 10.0 * math.log10(psd)
    offsets = {row.number(column) or 0.0 for column in layout.offset} - {0.0}
    if len(offsets) > 1:
        return RowLeftOut(str(table.path), row.line, "two_offsets")
    height = row.number(layout.lat + 2)
    return Pulse(
        row.line,
        row.cells[1],
        value[2],
        value[3],
        power,
        Place(lat, lon),
        0.0 if height is None else height,
        _yaw_deg([value[layout.attitude + k] for k in range(4 if layout.quaternion else 3)]),
        offsets.pop() if offsets else 0.0,
    )


def _yaw_deg(attitude: list[float]) -> float:
    """Yaw clockwise from north, [0, 360), of (roll, pitch, yaw) in degrees or of a quaternion (x, y, z, w) in NED."""
    if len(attitude) == 3:
        return attitude[2] % 360.0
    x, y, z, w = attitude
    return math.degrees(math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))) % 360.0


def _sweep(
    table: Table, rotation: _Rotation, tag: str | None, remarks: list[TableRemark]
) -> tuple[Sweep, float] | None:
    file, line = str(table.path), rotation.line
    heard = Counter(pulse.tag for pulse in rotation.pulses)
    if not heard:
        remarks.append(RotationIrregular(file, line, "empty"))
        return None
    wanted = heard.most_common(1)[0][0] if tag is None else tag
    if wanted not in heard:
        remarks.append(TagNotHeard(file, line, wanted, some_of(heard)))
        return None
    others = some_of(set(heard) - {wanted})
    if others and tag is None:
        remarks.append(OtherTagsLeftOut(file, line, wanted, heard.total() - heard[wanted], others))
    pulses = [pulse for pulse in rotation.pulses if pulse.tag == wanted]
    offsets = Counter(pulse.antenna_offset_deg for pulse in pulses)
    if len(offsets) > 1:
        remarks.append(RotationIrregular(file, line, "offset_changes"))
    ends = [end for row in (rotation.opened, rotation.closed) if row is not None and (end := _end(row)) is not None]
    # the rows that open and close a rotation carry more decimals than some files' pulses
    places = [place for place, _ in ends] or [pulse.position for pulse in pulses]
    return Sweep(
        at_s=np.array([pulse.at_s for pulse in pulses]),
        heading_deg=np.array([pulse.heading_deg for pulse in pulses]),
        power_db=np.array([pulse.power_db for pulse in pulses]),
        frequency_hz=float(np.median([pulse.frequency_hz for pulse in pulses])),
        position=middle_of([place.lat for place in places], [place.lon for place in places]),
        altitude_amsl_m=float(np.mean([altitude for _, altitude in ends])) if ends else 0.0,
        tag=wanted,
    ), offsets.most_common(1)[0][0]


def _end(row: Row) -> tuple[Place, float] | None:
    """Place and altitude AMSL of a row 10 or 11; None when they are not usable."""
    lat, lon, altitude = row.number(1), row.number(2), row.number(3)
    if lat is None or lon is None or not (-90.0 <= lat <= 90.0 and -180.0 <= lon <= 180.0):
        return None
    return Place(lat, lon), altitude if altitude is not None and math.isfinite(altitude) else 0.0
