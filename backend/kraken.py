"""Bearings of KrakenSDR direction finders: the line of CSV that its page DOA_value.html holds, and its JSON records.

CSV ("Kraken App"): epoch ms, direction in degrees clockwise from the array's front, confidence, power dB, frequency Hz,
array, latency ms, station, latitude, longitude, GPS heading, compass heading, which of the two counts, and more.
JSON ("Kraken Pro", "Full POST"): radioBearing counts the other way round, counter-clockwise from the front. Both are
turned by the station's heading: what counts is where its front points.
"""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import cast

from backend.search.reported import ReportedBearing
from hardware.direction_finding.bearings_file import LATEST_S
from hardware.readings import Place

LARGEST_BYTES = 64 * 2**10
FEWEST_COLUMNS = 11
SIGMA_DEG = 12.0
"""Of a station whose heading is known by GPS or compass."""
EVERY_S = 60.0
"""A station that stands still sends the same errors again and again: one bearing a minute counts."""


class KrakenRefused(ValueError):
    """What is wrong with a record, in words."""


@dataclass(frozen=True, slots=True)
class _Record:
    at_ms: object
    clockwise: float
    frequency_hz: object
    station: object
    lat: object
    lon: object
    heading: object


def read_kraken(data: bytes, now_s: float) -> ReportedBearing:
    """The last line of CSV, or one JSON object. The same station's bearings of one minute have one id.

    Raises KrakenRefused.
    """
    if len(data) > LARGEST_BYTES:
        raise KrakenRefused(f"it has {len(data)} bytes; {LARGEST_BYTES} are the most")
    try:
        text = data.decode().strip()
    except UnicodeDecodeError:
        raise KrakenRefused("it is no text") from None
    record = _from_json(text) if text.startswith("{") else _from_csv(text)
    place = Place(_number(record.lat, "latitude", -90.0, 90.0), _number(record.lon, "longitude", -180.0, 180.0))
    if place == Place(0.0, 0.0):
        raise KrakenRefused("its place is 0, 0: the station has no GPS fix; set its place by hand")
    heading = _number(record.heading, "heading", -360.0, 720.0)
    at_s = _number(record.at_ms, "time", 0.0, 1e3 * LATEST_S) / 1e3 if record.at_ms is not None else now_s
    by = _name(record.station)
    frequency_hz = _number(record.frequency_hz, "frequency", 1.0, 1e12)
    where = f"{round(place.lat, 4)}/{round(place.lon, 4)}"
    minute = f"{by}/{where}/{math.floor(at_s / EVERY_S)}/{frequency_hz:.0f}"
    return ReportedBearing(
        bearing_id=f"kraken-{hashlib.sha256(minute.encode()).hexdigest()[:20]}",
        by=by,
        place=place,
        bearing_deg=(heading + record.clockwise) % 360.0,
        sigma_deg=SIGMA_DEG,
        taken_at_s=at_s,
        frequency_hz=frequency_hz,
    )


def _from_csv(text: str) -> _Record:
    lines = [line for line in text.splitlines() if line.strip()]
    columns = [column.strip() for column in lines[-1].split(",")] if lines else []
    if len(columns) < FEWEST_COLUMNS:
        raise KrakenRefused(
            f'it has {len(columns)} columns, {FEWEST_COLUMNS} are needed: choose "Kraken App" as the output format'
        )
    compass = columns[11] if len(columns) > 12 and columns[12].lower().startswith("comp") else columns[10]
    direction = _number(columns[1], "direction", 0.0, 360.0)
    return _Record(columns[0], direction, columns[4], columns[7], columns[8], columns[9], compass)


def _from_json(text: str) -> _Record:
    try:
        found: object = json.loads(text)
    except (ValueError, RecursionError):
        raise KrakenRefused("it is not JSON") from None
    said = cast("Mapping[str, object]", found)

    def value(*names: str) -> object:
        return next((said[name] for name in names if name in said), None)

    direction = _number(value("radioBearing", "radiobearing"), "radioBearing", 0.0, 360.0)
    return _Record(
        at_ms=value("tStamp", "time"),
        clockwise=-direction,
        frequency_hz=value("freq"),
        station=value("station_id", "id"),
        lat=value("latitude", "lat"),
        lon=value("longitude", "lng"),
        heading=value("gpsBearing", "gpsheading"),
    )


def _number(value: object, name: str, low: float, high: float) -> float:
    """Numbers come as text, too."""
    try:
        found = float(value) if isinstance(value, str | int | float) and not isinstance(value, bool) else math.nan
    except (ValueError, OverflowError):
        found = math.nan
    if not math.isfinite(found):
        raise KrakenRefused(f"its {name} is no number")
    if not low <= found <= high:
        raise KrakenRefused(f"its {name} is {found:g}; it must be between {low:g} and {high:g}")
    return found


def _name(station: object) -> str:
    said = station if isinstance(station, str) else ""
    return "".join(c for c in said if c.isprintable()).strip()[:40] or "kraken"
