"""A mission as files for other programs, from its stored events and track. Positions WGS84, bearings true north."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Iterator, Mapping, Sequence
from datetime import UTC, datetime
from typing import Any
from xml.sax.saxutils import escape

import pymap3d.vincenty

from backend.events import FORM, BearingMeasured, CraftSource, MissionStarted, Recorded, SweepStarted
from backend.ports import TrackPoint
from backend.search.emitter import EmitterState
from backend.search.state import SearchState, evolve
from backend.spec import Area, Place
from backend.version import VERSION

Tracks = Mapping[str, Sequence[TrackPoint]]
"""The flown paths by craft id."""
RAY_M = 500.0
"""Length of a bearing line when there is no estimate to reach."""


def journal_json(recorded: Sequence[Recorded], tracks: Tracks) -> str:
    """Everything: each event as it was stored, and the flown paths."""
    mission_id = recorded[0].mission_id if recorded else ""
    return json.dumps(
        {
            "mission_id": mission_id,
            "software": f"crossfix {VERSION}",
            "form": FORM,
            "events": [record.model_dump(mode="json") for record in recorded],
            "tracks": {
                craft_id: [[_time(p.at_s), p.lat_deg, p.lon_deg, p.altitude_amsl_m, p.heading_deg] for p in track]
                for craft_id, track in tracks.items()
            },
        },
        indent=1,
    )


def bearings_csv(recorded: Sequence[Recorded], tracks: Tracks) -> str:
    """The bearing file of the UAV-RT project, without header: tag id (the emitter's number), sweep, bearing (deg true),
    quality, lat, lon, altitude above the home (m; theirs is above ground), altitude AMSL (m), start and end (UTC epoch
    seconds; of a bearing that no craft of the mission took, both are when it was brought in)."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    emitters = tuple(_state(recorded).emitters.values())
    counted = {fact.bearing_id: number for number, e in enumerate(emitters, start=1) for fact in e.bearings}
    home_amsl_m, began_s = 0.0, dict[str, float]()
    for record in recorded:
        event = record.event
        if isinstance(event, MissionStarted):
            home_amsl_m = event.home_amsl_m
        elif isinstance(event, SweepStarted):
            began_s[event.craft_id] = record.at_utc.timestamp()
        elif isinstance(event, BearingMeasured) and event.bearing_id in counted:
            place, altitude = event.place, event.altitude_amsl_m
            row = [
                counted[event.bearing_id],
                event.sweep_id or "",
                f"{event.bearing_deg:.6f}",
                f"{event.quality:.6f}",
                f"{place.lat:.8f}",
            ]
            row += [f"{place.lon:.8f}", f"{altitude - home_amsl_m:.3f}", f"{altitude:.3f}"]
            end_s = record.at_utc.timestamp()
            start_s = began_s.get(event.source.craft_id, end_s) if isinstance(event.source, CraftSource) else end_s
            writer.writerow([*row, f"{start_s:.6f}", f"{end_s:.6f}"])
    return text.getvalue()


def geojson(recorded: Sequence[Recorded], tracks: Tracks) -> str:
    """A FeatureCollection; each feature's `what` says what it is."""
    features = [
        {"type": "Feature", "geometry": geometry, "properties": properties}
        for geometry, properties in _features(recorded, tracks)
    ]
    return json.dumps({"type": "FeatureCollection", "features": features}, indent=1)


def kml(recorded: Sequence[Recorded], tracks: Tracks) -> str:
    """The same features as placemarks."""
    parts: list[str] = []
    for geometry, properties in _features(recorded, tracks):
        words = "".join(
            f"<Data name={_quoted(name)}><value>{_escaped(value)}</value></Data>"
            for name, value in properties.items()
            if name != "name" and value is not None
        )
        parts.append(
            f"<Placemark><name>{_escaped(properties['name'])}</name><styleUrl>#{properties['what']}</styleUrl>"
            f"<ExtendedData>{words}</ExtendedData>{_kml_geometry(geometry)}</Placemark>"
        )
    name = _escaped(_state(recorded).mission.name)
    return (
        '<?xml version="1.0" encoding="UTF-8"?>\n<kml xmlns="http://www.opengis.net/kml/2.2"><Document>'
        f"<name>{name}</name>{_STYLES}{''.join(parts)}</Document></kml>\n"
    )


_STYLES = "".join(
    f'<Style id="{what}"><LineStyle><color>{colour}</color><width>2</width></LineStyle>'
    f"<PolyStyle><fill>{fill}</fill><color>{colour}</color></PolyStyle></Style>"
    for what, colour, fill in (
        ("area", "ff808080", 0),
        ("no_fly", "ff3030c0", 0),
        ("track", "ffc08020", 0),
        ("bearing", "ff00a5ff", 0),
        ("place", "ff00a5ff", 0),
        ("estimate", "ff20c020", 0),
        ("c95", "6020c020", 1),
    )
)


def _state(recorded: Sequence[Recorded]) -> SearchState:
    state = SearchState()
    for record in recorded:
        state = evolve(state, record.event, record.at_utc.timestamp())
    return state


def _features(recorded: Sequence[Recorded], tracks: Tracks) -> Iterator[tuple[dict[str, Any], dict[str, Any]]]:
    """(geometry, properties) pairs; properties begin with what and name."""
    state = _state(recorded)
    if state.spec is not None:
        yield _area(state.spec.area), {"what": "area", "name": state.spec.name}
        for number, zone in enumerate(state.spec.flight.no_fly, start=1):
            yield _area(zone), {"what": "no_fly", "name": f"no-fly area {number}"}
    for craft_id, track in tracks.items():
        if len(track) > 1:
            times = {"from_utc": _time(track[0].at_s), "to_utc": _time(track[-1].at_s)}
            path = {"type": "LineString", "coordinates": [[p.lon_deg, p.lat_deg] for p in track]}
            yield path, {"what": "track", "name": "flown path", "craft": craft_id, **times}
    times_utc = {r.event.bearing_id: r.at_utc for r in recorded if isinstance(r.event, BearingMeasured)}
    for emitter in state.emitters.values():
        yield from _emitter_features(state, emitter, times_utc)


def _emitter_features(
    state: SearchState, emitter: EmitterState, times_utc: Mapping[str, datetime]
) -> Iterator[tuple[dict[str, Any], dict[str, Any]]]:
    belief, estimate = emitter.belief, emitter.belief.estimate if emitter.belief else None
    sought = state.mission.emitter(emitter.emitter_id)
    several: dict[str, Any] = {"emitter": sought.label} if len(state.emitters) > 1 else {}
    if sought.priority is not None:
        several["priority"] = sought.priority
    target = Place(lat=estimate.lat, lon=estimate.lon) if estimate else None
    for number, fact in enumerate(emitter.measured, start=1):
        properties = {
            "name": f"bearing {number}",
            **several,
            "bearing_deg": fact.bearing_deg,
            "sigma_deg": fact.sigma_deg,
            "quality": fact.quality,
            "excluded": not emitter.counts(fact),
            "at_utc": times_utc[fact.bearing_id].isoformat(),
        }
        here = [fact.place.lon, fact.place.lat]
        yield {"type": "Point", "coordinates": here}, {"what": "place", **properties}
        ray = {"type": "LineString", "coordinates": [here, _ray_end(fact, target)]}
        yield ray, {"what": "bearing", **properties}
    for leg in emitter.ways:
        for stretch in leg.stretches:
            line = [[place.lon, place.lat] for place in (stretch.begin, stretch.end)]
            properties = {
                "name": f"heard on the way to place {leg.place_number}",
                **several,
                "turned_deg": stretch.turned_deg,
                "excluded": leg not in emitter.legs,
            }
            yield {"type": "LineString", "coordinates": line}, {"what": "listened", **properties}
    if belief is not None and estimate is not None:
        properties = {
            **several,
            "expected_rmse_m": estimate.expected_rmse_m,
            "localized": belief.localized,
            "bearings": belief.bearings,
        }
        point = {"type": "Point", "coordinates": [estimate.lon, estimate.lat]}
        yield point, {"what": "estimate", "name": "estimate", **properties}
        area_m2 = {"area_m2": estimate.c95_area_m2}
        yield _area(estimate.c95), {"what": "c95", "name": "95 % region", **properties, **area_m2}


def _ray_end(fact: BearingMeasured, target: Place | None) -> list[float]:
    """As far as the estimate and a little more."""
    length_m = RAY_M
    if target is not None:
        away_m, _ = pymap3d.vincenty.vdist(fact.place.lat, fact.place.lon, target.lat, target.lon)
        length_m = 1.2 * float(away_m) + 20.0
    lat, lon = pymap3d.vincenty.vreckon(fact.place.lat, fact.place.lon, length_m, fact.bearing_deg)
    return [(float(lon) + 180.0) % 360.0 - 180.0, float(lat)]


def _area(area: Area) -> dict[str, Any]:
    return area.model_dump(mode="json")


def _time(at_s: float) -> str:
    return datetime.fromtimestamp(at_s, UTC).isoformat()


def _escaped(value: object) -> str:
    """XML 1.0 has no control characters, not even escaped."""
    return escape("".join(c for c in str(value) if c in "\t\n" or ord(c) >= 32))


def _quoted(value: str) -> str:
    return f'"{_escaped(value)}"'


def _kml_geometry(geometry: dict[str, Any]) -> str:
    coordinates = geometry["coordinates"]
    match geometry["type"]:
        case "Point":
            return f"<Point>{_kml_coordinates([coordinates])}</Point>"
        case "LineString":
            return f"<LineString><tessellate>1</tessellate>{_kml_coordinates(coordinates)}</LineString>"
        case "Polygon":
            return _kml_polygon(coordinates)
        case _:
            return f"<MultiGeometry>{''.join(_kml_polygon(rings) for rings in coordinates)}</MultiGeometry>"


def _kml_polygon(rings: list[list[list[float]]]) -> str:
    sides = ["outerBoundaryIs", *["innerBoundaryIs"] * (len(rings) - 1)]
    return "<Polygon>{}</Polygon>".format(
        "".join(
            f"<{side}><LinearRing>{_kml_coordinates(ring)}</LinearRing></{side}>"
            for side, ring in zip(sides, rings, strict=False)
        )
    )


def _kml_coordinates(places: list[list[float]]) -> str:
    return f"<coordinates>{' '.join(f'{lon:.8f},{lat:.8f}' for lon, lat in places)}</coordinates>"
