"""A mission's result for TAK: Cursor on Target events, in a data package that ATAK and WinTAK import.

The emitter is a point of unknown affiliation whose `ce` is the radius that holds it with 95 %; around it an ellipse of
95 % (2.4477 standard deviations, from the chi-square distribution with two degrees of freedom). Each bearing that
counts is a range-and-bearing line. CoT times are those of the facts; they go stale after a day.
"""

from __future__ import annotations

import io
import zipfile
from collections.abc import Mapping, Sequence
from datetime import UTC, datetime, timedelta
from uuid import NAMESPACE_URL, uuid5
from xml.etree.ElementTree import Element, SubElement, indent, tostring

from backend.events import BearingMeasured, BeliefUpdated, EstimateFact, Recorded
from backend.search.emitter import EmitterState
from backend.spec import MissionSpec
from backend.wire.export import Tracks
from backend.wire.export_facts import altitude_amsl_m, folded, measured_quality, mission_name, ray_lengths_m, xml_words

SIGMAS_95 = 2.4477
UNKNOWN = "9999999.0"
STALE = timedelta(days=1)


def cot_package(recorded: Sequence[Recorded], tracks: Tracks) -> bytes:
    """A zip with a manifest and one file an event. The track is not part of it."""
    events = cot_events(recorded)
    mission = recorded[0].mission_id if recorded else "none"
    package = Element("MissionPackageManifest", version="2")
    configuration = SubElement(package, "Configuration")
    SubElement(configuration, "Parameter", name="uid", value=_uid(mission, "package"))
    SubElement(configuration, "Parameter", name="name", value=xml_words(mission_name(recorded)) or "empty")
    contents = SubElement(package, "Contents")
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
        for event in events:
            uid = event.get("uid", "")
            name = f"{uid}/{uid}.cot"
            content = SubElement(contents, "Content", ignore="false", zipEntry=name)
            SubElement(content, "Parameter", name="uid", value=uid)
            archive.writestr(_entry(name), _xml(event))
        archive.writestr(_entry("MANIFEST/manifest.xml"), _xml(package))
    return stream.getvalue()


def cot_events(recorded: Sequence[Recorded]) -> list[Element]:
    """Each emitter with its ellipse when there is an estimate, and a line for each bearing that counts."""
    if not recorded:
        return []
    state, mission_id = folded(recorded), recorded[0].mission_id
    times = {r.event.bearing_id: r.at_utc for r in recorded if isinstance(r.event, BearingMeasured)}
    beliefs = {r.event.emitter_id: r.at_utc for r in recorded if isinstance(r.event, BeliefUpdated)}
    events: list[Element] = []
    for emitter in state.emitters.values():
        events += _events_of(f"{mission_id}/{emitter.emitter_id}", emitter, state.mission, beliefs, times)
    return events


def _events_of(
    key: str,
    emitter: EmitterState,
    mission: MissionSpec,
    beliefs: Mapping[str, datetime],
    times: Mapping[str, datetime],
) -> list[Element]:
    """key: what the events' ids are made from."""
    belief, label = emitter.belief, xml_words(mission.name_of(emitter.emitter_id))
    events: list[Element] = []
    estimate = None if belief is None else belief.measured_estimate
    if belief is not None and estimate is not None:
        words, at = "localized" if belief.localized else "not yet localized", beliefs[emitter.emitter_id]
        priority = mission.emitter(emitter.emitter_id).priority
        if priority is not None:
            words += f", priority {priority}"
        events.append(_emitter(key, estimate, at, label, words))
        events.append(_ellipse(key, estimate, at, label))
    of_whom = f"{label} " if len(mission.emitters) > 1 else ""
    ranges_m = ray_lengths_m(emitter.bearings, estimate)
    for number, (fact, range_m) in enumerate(zip(emitter.bearings, ranges_m, strict=True), start=1):
        events.append(_bearing(key, f"{of_whom}bearing {number}", fact, times[fact.bearing_id], range_m))
    return events


def _emitter(mission_id: str, estimate: EstimateFact, at: datetime, label: str, words: str) -> Element:
    radius_m = SIGMAS_95 * estimate.major_axis_m
    event, detail = _event(_uid(mission_id, "emitter"), "a-u-G", at, estimate.lat, estimate.lon, radius_m)
    SubElement(detail, "contact", callsign=label)
    SubElement(detail, "remarks").text = f"{label}: {words}, expected error {estimate.expected_rmse_m:.1f} m"
    return event


def _ellipse(mission_id: str, estimate: EstimateFact, at: datetime, label: str) -> Element:
    """Axes in metres, angle of the major axis clockwise from true north."""
    event, detail = _event(_uid(mission_id, "ellipse"), "u-d-c-e", at, estimate.lat, estimate.lon, None)
    shape = SubElement(detail, "shape")
    SubElement(
        shape,
        "ellipse",
        major=f"{SIGMAS_95 * estimate.major_axis_m:.2f}",
        minor=f"{SIGMAS_95 * estimate.minor_axis_m:.2f}",
        angle=f"{estimate.major_axis_deg % 360.0:.2f}",
    )
    SubElement(detail, "contact", callsign=f"{label} 95 %")
    return event


def _bearing(mission_id: str, callsign: str, fact: BearingMeasured, at: datetime, range_m: float) -> Element:
    uid, place = _uid(mission_id, fact.bearing_id), fact.place
    event, detail = _event(uid, "u-rb-a", at, place.lat, place.lon, None, altitude_amsl_m(fact))
    SubElement(detail, "range", value=f"{range_m:.2f}")
    SubElement(detail, "bearing", value=f"{fact.bearing_deg % 360.0:.2f}")
    SubElement(detail, "inclination", value="0.0")
    SubElement(detail, "contact", callsign=callsign)
    quality = measured_quality(fact)
    said = "" if quality is None else f", quality {quality:.2f}"
    SubElement(detail, "remarks").text = f"sigma {fact.sigma_deg:.1f} degrees{said}"
    return event


def _event(
    uid: str, kind: str, at: datetime, lat: float, lon: float, radius_m: float | None, amsl_m: float | None = None
) -> tuple[Element, Element]:
    """`hae` is the height above the ellipsoid, which is not known here; heights above sea level stand beside it."""
    event = Element("event", version="2.0", uid=uid, type=kind, how="m-g")
    for name, moment in (("time", at), ("start", at), ("stale", at + STALE)):
        event.set(name, moment.astimezone(UTC).strftime("%Y-%m-%dT%H:%M:%S.%fZ"))
    ce = UNKNOWN if radius_m is None else f"{radius_m:.2f}"
    SubElement(event, "point", lat=f"{lat:.7f}", lon=f"{lon:.7f}", hae=UNKNOWN, ce=ce, le=UNKNOWN)
    detail = SubElement(event, "detail")
    if amsl_m is not None:
        SubElement(detail, "height_amsl", value=f"{amsl_m:.1f}")
    return event, detail


def _uid(mission_id: str, what: str) -> str:
    """The same mission exported twice replaces itself on the map."""
    return str(uuid5(NAMESPACE_URL, f"crossfix/{mission_id}/{what}"))


def _entry(name: str) -> zipfile.ZipInfo:
    entry = zipfile.ZipInfo(name, date_time=(2020, 1, 1, 0, 0, 0))
    entry.compress_type = zipfile.ZIP_DEFLATED
    return entry


def _xml(element: Element) -> bytes:
    indent(element)
    return tostring(element, encoding="UTF-8", xml_declaration=True) + b"\n"
