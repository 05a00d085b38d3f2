"""A mission as files for other programs, from its stored events and track. Positions WGS84, bearings true north."""

from __future__ import annotations

import csv
import io
import json
import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from datetime import UTC, datetime
from typing import Any
from xml.sax.saxutils import escape

import numpy as np
import pymap3d.vincenty

from backend.events import (
    FORM,
    BearingMeasured,
    CraftSource,
    EstimateFact,
    MissionStarted,
    Recorded,
    SweepStarted,
)
from backend.ports import TrackPoint
from backend.search.emitter import EmitterState
from backend.search.state import SearchState
from backend.spec import MissionSpec
from backend.version import VERSION
from backend.wire.export_facts import (
    altitude_amsl_m,
    folded,
    measured_quality,
    mission_name,
    ray_lengths_m,
    taken_utc,
    xml_words,
)
from backend.wire.export_geometry import area_geometry, path_geometry

Tracks = Mapping[str, Sequence[TrackPoint]]
"""The flown paths by craft id."""
Feature = tuple[dict[str, Any], dict[str, Any]]
"""A GeoJSON geometry, and properties that begin with what and name."""


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
    quality, lat, lon, altitude above the home of its craft (m; theirs is above ground), altitude AMSL (m), start and
    end (UTC epoch seconds; of a bearing that no craft of the mission took, both are when it was taken, or brought in
    where nobody said). An altitude that is not known is empty, as is the quality of a bearing without a sweep."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    emitters = tuple(folded(recorded).emitters.values())
    counted = {fact.bearing_id: number for number, e in enumerate(emitters, start=1) for fact in e.bearings}
    homes_amsl_m, began_s = dict[str | None, float](), dict[str | None, float]()
    for record in recorded:
        event = record.event
        if isinstance(event, MissionStarted):
            homes_amsl_m.setdefault(None, event.home_amsl_m)
            homes_amsl_m[event.craft_id] = event.home_amsl_m
        elif isinstance(event, SweepStarted):
            began_s[event.craft_id] = record.at_utc.timestamp()
        elif isinstance(event, BearingMeasured) and event.bearing_id in counted:
            craft_id = event.source.craft_id if isinstance(event.source, CraftSource) else None
            altitude_m, home_m = altitude_amsl_m(event), homes_amsl_m.get(craft_id)
            above_m = None if altitude_m is None or home_m is None else altitude_m - home_m
            end_s = taken_utc(record, event).timestamp()
            start_s = began_s.get(craft_id, end_s)
            writer.writerow(
                [
                    counted[event.bearing_id],
                    _no_formula(event.sweep_id or ""),
                    f"{event.bearing_deg:.6f}",
                    "" if (quality := measured_quality(event)) is None else f"{quality:.6f}",
                    f"{event.place.lat:.8f}",
                    f"{event.place.lon:.8f}",
                    *("" if metres is None else f"{metres:.3f}" for metres in (above_m, altitude_m)),
                    f"{start_s:.6f}",
                    f"{end_s:.6f}",
                ]
            )
    return text.getvalue()


def _no_formula(text: str) -> str:
    """A bundle may name a sweep so that a spreadsheet would compute it."""
    return f"'{text}" if text.startswith(("=", "+", "-", "@", "\t", "\r")) else text


def geojson(recorded: Sequence[Recorded], tracks: Tracks) -> str:
    """A FeatureCollection; each feature's `what` says what it is."""
    return collection(_features(recorded, tracks), indent=1)


def collection(features: Iterable[Feature], indent: int | None = None) -> str:
    """Of those features; on one line without `indent`."""
    told = [{"type": "Feature", "geometry": geometry, "properties": properties} for geometry, properties in features]
    return json.dumps({"type": "FeatureCollection", "features": told}, indent=indent)


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
    name = _escaped(mission_name(recorded))
    return (
        '<?xml version="1.0" encoding="UTF-8"?>\n<kml xmlns="http://www.opengis.net/kml/2.2"><Document>'
        f"<name>{name}</name>{_STYLES}{''.join(parts)}</Document></kml>\n"
    )


_STYLES = "".join(
    f'<Style id="{what}"><LineStyle><color>{colour}</color><width>2</width></LineStyle>'
    f"<PolyStyle><color>{colour}</color><fill>{fill}</fill></PolyStyle></Style>"
    for what, colour, fill in (
        ("area", "ff808080", 0),
        ("no_fly", "ff3030c0", 0),
        ("track", "ffc08020", 0),
        ("bearing", "ff00a5ff", 0),
        ("place", "ff00a5ff", 0),
        ("listened", "ffa0a000", 0),
        ("estimate", "ff20c020", 0),
        ("c95", "6020c020", 1),
    )
)


def _features(recorded: Sequence[Recorded], tracks: Tracks) -> Iterator[Feature]:
    state = folded(recorded)
    if state.spec is not None:
        yield from area_features(state.spec, mission_name(recorded))
    for craft_id, track in tracks.items():
        flown = [p for p in track if math.isfinite(p.lat_deg) and math.isfinite(p.lon_deg)]
        if len(flown) > 1:
            times = {"from_utc": _time(flown[0].at_s), "to_utc": _time(flown[-1].at_s)}
            path = path_geometry([[p.lon_deg, p.lat_deg] for p in flown])
            yield path, {"what": "track", "name": "flown path", "craft": craft_id, **times}
    times_utc = {e.bearing_id: taken_utc(r, e) for r in recorded if isinstance(e := r.event, BearingMeasured)}
    for emitter in state.emitters.values():
        yield from emitter_features(state, emitter, times_utc)


def area_features(spec: MissionSpec, name: str) -> Iterator[Feature]:
    """Where is searched and where nobody flies. name: of the mission."""
    yield area_geometry(spec.area), {"what": "area", "name": name}
    for number, zone in enumerate(spec.flight.no_fly, start=1):
        yield area_geometry(zone), {"what": "no_fly", "name": f"no-fly area {number}"}


def emitter_features(state: SearchState, emitter: EmitterState, times_utc: Mapping[str, datetime]) -> Iterator[Feature]:
    """What is known of one emitter. times_utc: by the id of each of its bearings, when it was taken."""
    belief = emitter.belief
    estimate = None if belief is None else belief.measured_estimate
    sought = state.mission.emitter(emitter.emitter_id)
    several: dict[str, Any] = {"emitter": state.mission.name_of(emitter.emitter_id)} if len(state.emitters) > 1 else {}
    if sought.priority is not None:
        several["priority"] = sought.priority
    ends = _ray_ends(emitter.measured, estimate)
    for number, (fact, end) in enumerate(zip(emitter.measured, ends, strict=True), start=1):
        properties = {
            "name": f"bearing {number}",
            **several,
            "bearing_deg": fact.bearing_deg,
            "sigma_deg": fact.sigma_deg,
            "quality": measured_quality(fact),
            "excluded": not emitter.counts(fact),
            "at_utc": times_utc[fact.bearing_id].isoformat(),
        }
        here = [fact.place.lon, fact.place.lat]
        yield {"type": "Point", "coordinates": here}, {"what": "place", **properties}
        yield path_geometry([here, end]), {"what": "bearing", **properties}
    for leg in emitter.ways:
        for stretch in leg.stretches:
            line = [[place.lon, place.lat] for place in (stretch.begin, stretch.end)]
            properties = {
                "name": f"heard on the way to place {leg.place_number}",
                **several,
                "turned_deg": stretch.turned_deg,
                "excluded": leg not in emitter.legs,
            }
            yield path_geometry(line), {"what": "listened", **properties}
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
        yield area_geometry(estimate.c95), {"what": "c95", "name": "95 % region", **properties, **area_m2}


def _ray_ends(facts: Sequence[BearingMeasured], estimate: EstimateFact | None) -> list[list[float]]:
    """Longitude and latitude, of all at once: one by one they take most of an export's time."""
    if not facts:
        return []
    rows = np.array([(fact.place.lat, fact.place.lon, fact.bearing_deg) for fact in facts])
    lat, lon = pymap3d.vincenty.vreckon(rows[:, 0], rows[:, 1], ray_lengths_m(facts, estimate), rows[:, 2])
    return np.column_stack([(lon + 180.0) % 360.0 - 180.0, lat]).tolist()


def _time(at_s: float) -> str:
    return datetime.fromtimestamp(at_s, UTC).isoformat()


def _escaped(value: object) -> str:
    return escape(xml_words(value))


def _quoted(value: str) -> str:
    return f'"{_escaped(value)}"'


def _kml_geometry(geometry: dict[str, Any]) -> str:
    coordinates = geometry["coordinates"]
    match geometry["type"]:
        case "Point":
            return f"<Point>{_kml_coordinates([coordinates])}</Point>"
        case "LineString":
            return _kml_line(coordinates)
        case "Polygon":
            return _kml_polygon(coordinates)
        case "MultiLineString":
            return f"<MultiGeometry>{''.join(map(_kml_line, coordinates))}</MultiGeometry>"
        case _:
            return f"<MultiGeometry>{''.join(_kml_polygon(rings) for rings in coordinates)}</MultiGeometry>"


def _kml_line(places: list[list[float]]) -> str:
    return f"<LineString><tessellate>1</tessellate>{_kml_coordinates(places)}</LineString>"


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
