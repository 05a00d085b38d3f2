"""A flown path in a ninth of its rows' room: whole numbers of the steps in which autopilots tell, their differences,
byte planes, zlib.

Time, place and altitudes come back as they were told; a heading comes back to the hundredth of a degree.
"""

from __future__ import annotations

import json
import zlib
from collections.abc import Sequence
from typing import cast

import numpy as np
from numpy.typing import NDArray

from backend.ports import TrackPoint

STEPS = (1e7, 1e7, 1e3, 1e3, 1e2, 1e2)
"""A degree of latitude and longitude, a metre above the sea and above the home, a degree of heading, a percent."""
UNKNOWN = -(2**40)
"""Beyond every value: of an altitude, heading, charge or mode that nobody told."""
LEVEL = 9
MOST_POINTS = 7200
"""Of one packed piece: an hour."""
MOST_HEAD_BYTES = 64 * 1024
MOST_BYTES = MOST_POINTS * (2 + len(STEPS)) * 8 + MOST_HEAD_BYTES
"""Of one piece, unpacked."""
MOST_STEPS = 2**39
"""A value further from zero is none that an autopilot tells: 550,000 km of altitude."""


def packed_path(points: Sequence[TrackPoint]) -> bytes:
    """One to MOST_POINTS of them, in time order, with finite times and places. Raises ValueError for what could not be
    unpacked again."""
    modes = sorted({point.mode for point in points if point.mode is not None})
    table = np.array([[round(p.at_s * 1e6), *_whole(p), _number(p.mode, modes)] for p in points], dtype=np.int64).T
    steps = np.diff(table, axis=1, prepend=0)
    head = json.dumps({"points": len(points), "modes": modes}).encode() + b"\n"
    if len(points) > MOST_POINTS or len(head) > MOST_HEAD_BYTES:
        raise ValueError(f"a path of {len(points)} points and {len(modes)} modes is no piece of an hour")
    return zlib.compress(head + _planes((steps << 1) ^ (steps >> 63)), LEVEL)


def unpacked_path(kept: bytes) -> list[TrackPoint]:
    """Raises ValueError for what `packed_path` never made."""
    unpacking = zlib.decompressobj()
    try:
        head, _, body = unpacking.decompress(kept, MOST_BYTES).partition(b"\n")
        told = json.loads(head)
        count, modes = int(told["points"]), [str(mode) for mode in told["modes"]]
        crossed = _from_planes(body, count)
        table = np.cumsum((crossed >> 1) ^ -(crossed & 1), axis=1)
        return [_point(row, modes) for row in table.T.tolist()]
    except (zlib.error, LookupError, TypeError, ValueError) as error:
        raise ValueError(f"a stored path cannot be unpacked: {error}") from error


def _whole(point: TrackPoint) -> list[int]:
    told = (
        point.lat_deg,
        point.lon_deg,
        point.altitude_amsl_m,
        point.altitude_relative_m,
        point.heading_deg,
        point.battery_percent,
    )
    return [_steps(value, a_unit) for value, a_unit in zip(told, STEPS, strict=True)]


def _steps(value: float | None, a_unit: float) -> int:
    return UNKNOWN if value is None or not abs(value) * a_unit < MOST_STEPS else round(value * a_unit)


def _number(mode: str | None, modes: Sequence[str]) -> int:
    return UNKNOWN if mode is None else modes.index(mode)


def _planes(table: NDArray[np.int64]) -> bytes:
    """All lowest bytes of a row, then the next: those that are always zero take no room."""
    rows, count = table.shape
    single = np.ascontiguousarray(table, dtype="<i8").view(np.uint8).reshape(rows, count, 8)
    return single.transpose(0, 2, 1).tobytes()


def _from_planes(body: bytes, count: int) -> NDArray[np.int64]:
    """Raises ValueError when it is not a table of `count` points."""
    planes = np.frombuffer(body, np.uint8).reshape(2 + len(STEPS), 8, count)
    return np.ascontiguousarray(planes.transpose(0, 2, 1)).view("<i8")[:, :, 0].astype(np.int64)


def _point(row: Sequence[int], modes: Sequence[str]) -> TrackPoint:
    """What was not known is None, as in the rows."""
    at_us, lat, lon, amsl, relative, heading, battery, mode = row
    lat_deg, lon_deg = lat / STEPS[0], lon / STEPS[1]
    amsl_m, relative_m, heading_deg, percent = (
        cast("float", None) if value == UNKNOWN else value / a_unit
        for value, a_unit in zip((amsl, relative, heading, battery), STEPS[2:], strict=True)
    )
    named = None if mode == UNKNOWN else modes[mode]
    return TrackPoint(at_us / 1e6, lat_deg, lon_deg, amsl_m, relative_m, heading_deg, percent, named)
