"""A mission as an MCAP recording for Foxglove, Lichtblick and other robotics tools: JSON messages, zstd chunks.

Topics: /mission/events (every event as stored), /vehicle/fix and /vehicle/state (the flown path, 2 Hz), /estimate/fix
(with its covariance), /findings (bearings and C95 as GeoJSON, for map panels, which show the last message of a topic).
Where there are several craft or emitters, each has topics of its own: /vehicle/craft-1/fix, /findings/emitter-1. Times
are UTC nanoseconds.
"""

from __future__ import annotations

import io
import json
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Any, Literal

from mcap.writer import CompressionType, Writer

from backend.events import BearingMeasured, BeliefUpdated, EstimateFact, Recorded
from backend.search.state import SearchState, evolve
from backend.version import VERSION
from backend.wire.export import Tracks, area_features, collection, emitter_features
from backend.wire.export_facts import mission_name, taken_utc

NUMBER, TEXT = {"type": "number"}, {"type": "string"}
STAMP = {"type": "object", "title": "time", "properties": {"sec": {"type": "integer"}, "nsec": {"type": "integer"}}}

KNOWN_COVARIANCE = 3
"""foxglove.LocationFix position_covariance_type: 0 unknown, 3 all of the matrix is known."""

Message = tuple[int, str, str, dict[str, Any]]
"""(UTC ns, topic, of which craft or emitter, content)"""


@dataclass(frozen=True, slots=True)
class Topic:
    """schema_name: well-known names let the tools draw the messages. of: what has topics of its own, where there are
    several."""

    schema_name: str
    properties: dict[str, Any]
    of: Literal["mission", "craft", "emitter"] = "mission"


TOPICS = {
    "/mission/events": Topic(
        "crossfix.Recorded",
        {"seq": {"type": "integer"}, "mission_id": TEXT, "at_utc": TEXT, "event": {"type": "object"}},
    ),
    "/vehicle/fix": Topic("foxglove.LocationFix", {}, "craft"),
    "/vehicle/state": Topic(
        "crossfix.VehicleState",
        {"heading_deg": NUMBER, "altitude_relative_m": NUMBER, "battery_percent": NUMBER, "mode": TEXT},
        "craft",
    ),
    "/estimate/fix": Topic("foxglove.LocationFix", {}, "emitter"),
    "/findings": Topic("foxglove.GeoJSON", {"geojson": TEXT}, "emitter"),
}
LOCATION_FIX = {
    "timestamp": STAMP,
    "frame_id": TEXT,
    "latitude": NUMBER,
    "longitude": NUMBER,
    "altitude": NUMBER,
    "position_covariance": {"type": "array", "items": NUMBER, "minItems": 9, "maxItems": 9},
    "position_covariance_type": {"type": "integer"},
}


def mcap(recorded: Sequence[Recorded], tracks: Tracks) -> bytes:
    """The whole recording, messages in time order."""
    stream = io.BytesIO()
    writer = Writer(stream, compression=CompressionType.ZSTD)
    writer.start(profile="", library=f"crossfix {VERSION}")
    ids = {"mission": [""], "craft": list(tracks) or [""], "emitter": _emitters(recorded) or [""]}
    channels: dict[tuple[str, str], int] = {}
    for name, topic in TOPICS.items():
        properties = LOCATION_FIX if topic.schema_name == "foxglove.LocationFix" else topic.properties
        schema = json.dumps({"type": "object", "title": topic.schema_name, "properties": properties}).encode()
        schema_id = writer.register_schema(topic.schema_name, "jsonschema", schema)
        for one in ids[topic.of]:
            full = name if len(ids[topic.of]) == 1 else _named(name, one)
            channels[name, one] = writer.register_channel(full, "json", schema_id)
    messages = sorted([*_events(recorded), *_flights(tracks)], key=lambda message: message[0])
    for number, (at_ns, name, one, content) in enumerate(messages):
        writer.add_message(channels[name, one], at_ns, json.dumps(content, allow_nan=False).encode(), at_ns, number)
    writer.finish()
    return stream.getvalue()


def _named(topic: str, one: str) -> str:
    _, first, *rest = topic.split("/")
    return "/".join(("", first, one, *rest))


def _emitters(recorded: Sequence[Recorded]) -> list[str]:
    """By id, those that something is believed of, in the order of their first beliefs."""
    return list(dict.fromkeys(r.event.emitter_id for r in recorded if isinstance(r.event, BeliefUpdated)))


def _events(recorded: Sequence[Recorded]) -> Iterator[Message]:
    """Folded once on the way. A finding is of its own emitter: all of them at each belief were quadratic."""
    state, times_utc, name = SearchState(), dict[str, datetime](), mission_name(recorded)
    for record in recorded:
        event, at_ns = record.event, _nanoseconds(record.at_utc.timestamp())
        state = evolve(state, event, record.at_utc.timestamp())
        yield at_ns, "/mission/events", "", record.model_dump(mode="json")
        if isinstance(event, BearingMeasured):
            times_utc[event.bearing_id] = taken_utc(record, event)
        elif isinstance(event, BeliefUpdated):
            found = emitter_features(state, state.emitters[event.emitter_id], times_utc)
            shown = [*area_features(state.mission, name), *found]
            yield at_ns, "/findings", event.emitter_id, {"geojson": collection(shown)}
            if event.measured_estimate is not None:
                yield at_ns, "/estimate/fix", event.emitter_id, _estimate_fix(at_ns, event.measured_estimate)


def _flights(tracks: Tracks) -> Iterator[Message]:
    """Numbers that are not known are left out; points without a place too."""
    for craft_id, point in ((craft_id, point) for craft_id, track in tracks.items() for point in track):
        if not (_finite(point.lat_deg) and _finite(point.lon_deg)):
            continue
        at_ns = _nanoseconds(point.at_s)
        fix = _fix(at_ns, point.lat_deg, point.lon_deg)
        if _finite(point.altitude_amsl_m):
            fix["altitude"] = point.altitude_amsl_m
        yield at_ns, "/vehicle/fix", craft_id, fix
        state = {
            "heading_deg": point.heading_deg,
            "altitude_relative_m": point.altitude_relative_m,
            "battery_percent": point.battery_percent,
            "mode": point.mode,
        }
        yield at_ns, "/vehicle/state", craft_id, {name: value for name, value in state.items() if _known(value)}


def _fix(at_ns: int, lat_deg: float, lon_deg: float) -> dict[str, Any]:
    seconds, rest = divmod(at_ns, 10**9)
    stamp = {"sec": seconds, "nsec": rest}
    return {"timestamp": stamp, "frame_id": "wgs84", "latitude": lat_deg, "longitude": lon_deg}


def _estimate_fix(at_ns: int, estimate: EstimateFact) -> dict[str, Any]:
    east, cross, north = _covariance(estimate)
    matrix = [east, cross, 0.0, cross, north, 0.0, 0.0, 0.0, 0.0]
    fix = _fix(at_ns, estimate.lat, estimate.lon)
    return {**fix, "position_covariance": matrix, "position_covariance_type": KNOWN_COVARIANCE}


def _covariance(estimate: EstimateFact) -> tuple[float, float, float]:
    """East-east, east-north, north-north, m^2: R diag(major^2, minor^2) R^T with the major axis at its bearing."""
    angle = math.radians(estimate.major_axis_deg)
    east, north = math.sin(angle), math.cos(angle)
    major, minor = estimate.major_axis_m**2, estimate.minor_axis_m**2
    return (
        major * east**2 + minor * north**2,
        (major - minor) * east * north,
        major * north**2 + minor * east**2,
    )


def _nanoseconds(at_s: float) -> int:
    return round(at_s * 1e6) * 1000


def _finite(value: float | None) -> bool:
    return value is not None and math.isfinite(value)


def _known(value: float | str | None) -> bool:
    return isinstance(value, str) or _finite(value)
