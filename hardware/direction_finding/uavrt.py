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

from hardware.direction_finding.table_file import RecordingError, Row, Table, column_of
from hardware.readings import GeoPoint, Sweep

PULSE, OPEN, CLOSE = "7", "10", "11"
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
    position: GeoPoint
    height_agl_m: float
    heading_deg: float
    antenna_offset_deg: float


@dataclass(slots=True)
class _Rotation:
    opened: Row | None
    closed: Row | None = None
    pulses: list[Pulse] = field(default_factory=list)


def is_uavrt(table: Table) -> bool:
    """Whether the table's rows are UAV-RT commands."""
    return any(row.cells[0] in COMMANDS and len(row.cells) >= 4 for row in table.rows)


def read_rotations(table: Table, tag: str | None = None) -> tuple[list[tuple[Sweep, float]], list[str]]:
    """([(sweep, antenna offset to the nose in degrees)], remarks naming file and line).

    One sweep a rotation, of `tag`, or of the tag heard most often in it. Raises RecordingError when nothing is left.
    """
    layout = _layout(table)
    remarks: list[str] = []
    rotations: list[_Rotation] = []
    current: _Rotation | None = None
    outside: list[Pulse] = []
    for row in table.rows:
        command = row.cells[0]
        if row is table.rows[0] and _names(row):
            continue
        if command == OPEN:
            if current is not None:
                remarks.append(f"{table.where(row)}: a rotation opens while another is open; the first ends here")
            current = _Rotation(row)
            rotations.append(current)
        elif command == CLOSE:
            if current is None:
                remarks.append(f"{table.where(row)}: a rotation closes that was never opened; line left out")
            else:
                current.closed = row
            current = None
        elif command == PULSE:
            pulse = _pulse(row, layout)
            if isinstance(pulse, str):
                remarks.append(f"{table.where(row)}: {pulse}")
            elif pulse is not None:
                (outside if current is None else current.pulses).append(pulse)
        else:
            remarks.append(f'{table.where(row)}: "{row.cells[0]}" is no known kind of row (7, 10 or 11); line left out')
    if current is not None and rotations:
        remarks.append(f"{table.path}: the last rotation was never closed (no row 11); its pulses are used")
    if not rotations and outside:
        rotations = [_Rotation(None, None, outside)]
    elif outside:
        remarks.append(f"{table.path}: {len(outside)} pulses lie outside every rotation; they are left out")
    sweeps = [_sweep(table, rotation, tag, remarks) for rotation in rotations]
    found = [sweep for sweep in sweeps if sweep is not None]
    if not found:
        wanted = f"of tag {tag} " if tag is not None else ""
        detail = remarks[0] if remarks else f"{table.path}: no row 7 found"
        raise RecordingError(f"{table.path}: no usable pulse {wanted}in any rotation; first remark: {detail}")
    return found, remarks


def _names(row: Row) -> bool:
    return column_of(row.cells, "tag_id", "tagid") is not None


def _layout(table: Table) -> _Layout:
    pulses = [row for row in table.rows if row.cells[0] == PULSE and not _names(row)]
    if not pulses:
        raise RecordingError(f"{table.path}: holds no pulse (no row that starts with 7); is it the right file?")
    header = next((row for row in (*table.rows[:1], *table.comments) if _names(row)), None)
    if header is not None:
        return _layout_from(table, header, pulses)
    width = Counter(len(row.cells) for row in pulses).most_common(1)[0][0]
    if width == 19:
        return _Layout(None, 10, 12, 15, (), _unit_quaternions(pulses, 15))
    if width < 19:
        raise RecordingError(
            f"{table.where(pulses[0])}: a pulse has {width} columns; known layouts have 19, 20 or 21: "
            "add a header line that names the columns"
        )
    quaternion = width >= 20 and _unit_quaternions(pulses, 16)
    return _Layout(10, 11, 13, 16, (20,) if quaternion else (19, 20), quaternion)


def _layout_from(table: Table, header: Row, pulses: list[Row]) -> _Layout:
    names = header.cells
    lat = column_of(names, "position_x", "lat", "latitude", "latitude_deg", "lat_deg")
    attitude = column_of(names, "orientation_x", "roll", "roll_deg")
    detection = column_of(names, "detection_status", "detect_status")
    if lat is None or attitude is None or detection is None:
        raise RecordingError(
            f"{table.where(header)}: the header lacks position_x, orientation_x (or roll) or detection_status; "
            "name these columns, or remove the header line"
        )
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


def _pulse(row: Row, layout: _Layout) -> Pulse | str | None:
    """The pulse, a remark why the row is left out, or None for a row that says "nothing heard" (heartbeat)."""
    if len(row.cells) < layout.width:
        return f"a pulse needs {layout.width} columns, this row has {len(row.cells)}; line left out"
    need = {2: "frequency", 3: "start time", 5: "SNR", layout.lat: "latitude", layout.lat + 1: "longitude"}
    need |= {layout.attitude + k: "attitude" for k in range(4 if layout.quaternion else 3)}
    value: dict[int, float] = {}
    for column, name in need.items():
        number = row.number(column)
        if number is None or not math.isfinite(number) or number == MISSING:
            cell = row.cells[column]
            return f'the {name} in column {column + 1} is "{cell}", not a usable number; line left out'
        value[column] = number
    if value[2] == 0.0 or row.number(layout.detection) == _NO_DETECTION:
        return None
    lat, lon = value[layout.lat], value[layout.lat + 1]
    if not (-90.0 <= lat <= 90.0 and -180.0 <= lon <= 180.0):
        return f"{lat:g}, {lon:g} is no place on earth; line left out"
    power = value[5]
    if layout.noise_psd is not None:
        psd = row.number(layout.noise_psd)
        if psd is None or not psd > 0.0 or math.isinf(psd):
            cell = row.cells[layout.noise_psd]
            return f'the noise PSD in column {layout.noise_psd + 1} is "{cell}", not above zero; line left out'
        power += 10.0 * math.log10(psd)
    offsets = {row.number(column) or 0.0 for column in layout.offset} - {0.0}
    if len(offsets) > 1:
        return "columns 20 and 21 both carry an antenna offset; add a header line that names the right one"
    height = row.number(layout.lat + 2)
    return Pulse(
        row.line,
        row.cells[1],
        value[2],
        value[3],
        power,
        GeoPoint(lat, lon),
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


def _sweep(table: Table, rotation: _Rotation, tag: str | None, remarks: list[str]) -> tuple[Sweep, float] | None:
    where = table.where(rotation.opened) if rotation.opened is not None else str(table.path)
    heard = Counter(pulse.tag for pulse in rotation.pulses)
    if not heard:
        remarks.append(f"{where}: the rotation holds no usable pulse; left out")
        return None
    wanted = heard.most_common(1)[0][0] if tag is None else tag
    if wanted not in heard:
        remarks.append(f"{where}: tag {wanted} was not heard in this rotation (heard: {', '.join(sorted(heard))})")
        return None
    others = {name: count for name, count in heard.items() if name != wanted}
    if others and tag is None:
        listed = ", ".join(f"{count} pulses of tag {name}" for name, count in sorted(others.items()))
        remarks.append(f"{where}: tag {wanted} is used; left out: {listed} (name another tag to use it)")
    pulses = [pulse for pulse in rotation.pulses if pulse.tag == wanted]
    offsets = Counter(pulse.antenna_offset_deg for pulse in pulses)
    if len(offsets) > 1:
        remarks.append(f"{where}: the antenna offset changes within the rotation; the commonest is used")
    ends = [end for row in (rotation.opened, rotation.closed) if row is not None and (end := _end(row)) is not None]
    # the rows that open and close a rotation carry more decimals than some files' pulses
    places = [place for place, _ in ends] or [pulse.position for pulse in pulses]
    return Sweep(
        at_s=np.array([pulse.at_s for pulse in pulses]),
        heading_deg=np.array([pulse.heading_deg for pulse in pulses]),
        power_db=np.array([pulse.power_db for pulse in pulses]),
        frequency_hz=float(np.median([pulse.frequency_hz for pulse in pulses])),
        position=GeoPoint(
            float(np.median([place.lat_deg for place in places])),
            float(np.median([place.lon_deg for place in places])),
        ),
        altitude_amsl_m=float(np.mean([altitude for _, altitude in ends])) if ends else 0.0,
        tag=wanted,
    ), offsets.most_common(1)[0][0]


def _end(row: Row) -> tuple[GeoPoint, float] | None:
    """Place and altitude AMSL of a row 10 or 11; None when they are not usable."""
    lat, lon, altitude = row.number(1), row.number(2), row.number(3)
    if lat is None or lon is None or not (-90.0 <= lat <= 90.0 and -180.0 <= lon <= 180.0):
        return None
    return GeoPoint(lat, lon), altitude if altitude is not None and math.isfinite(altitude) else 0.0
