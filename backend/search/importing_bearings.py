"""Bearings out of a file as facts of a mission: one source with errors of its own, or one a station. Pure."""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence
from dataclasses import replace
from itertools import count

import numpy as np

from backend.events import BearingMeasured, BearingSource, ImportSource, PersonSource
from backend.reasons import search as reasons
from backend.reasons.maps import KindLeftOut
from backend.search.area import corner_of, target_area
from backend.search.errors import MissionInputError
from backend.search.importing import (
    Import,
    Upload,
    bearing_id,
    begun,
    emitter_heard,
    import_fact,
    refuse_far,
    same_channel,
    with_beliefs,
)
from backend.search.reported import COMPASS_SIGMA_DEG, compass_share_deg
from backend.search.state import SearchState
from backend.spec import EmitterSpec, MissionSpec
from hardware.direction_finding.bearing_scatter import bearing_scatter
from hardware.direction_finding.bearings_file import RecordedBearing
from hardware.frame import LocalFrame
from hardware.readings import Place

LEAST_SIGMA_DEG, MOST_SIGMA_DEG = 1.0, 60.0
SAME_S, SAME_M, SAME_DEG = 1.0, 15.0, 0.1
"""Two bearings of an emitter that differ by no more than all three are one bearing given twice."""


def bearing_facts(mission_id: str, state: SearchState, upload: Upload, by: str, *, believed: bool) -> Import:
    """Every bearing of the emitter and, where nobody else makes it, the belief after the last (believed): all bearings
    are weighed again at each of them, which takes a processor most of a minute for 150. What was known before, from its
    station or another file, is left out. Raises MissionInputError."""
    mission, recording = state.mission, upload.recording
    heard_hz = [one.frequency_hz for one in recording.bearings]
    upload = replace(upload, emitter_id=emitter_heard(mission, upload.emitter_id, heard_hz))
    emitter, remarks, last = begun(state, upload, len(recording.bearings))
    heard = [one for one in recording.bearings if _of(emitter, one)]
    if not heard:
        raise MissionInputError(reasons.HeardElsewhere(recording.bearings[0].frequency_hz or 0.0), "files")
    if upload.place is not None or upload.offset_deg is not None or upload.pattern is not None:
        remarks.append(reasons.ImportRemark(upload.filename, "bearings_stand"))
    others = (one.frequency_hz for one in recording.bearings if not _of(emitter, one))
    elsewhere = sorted({hz for hz in others if hz is not None})
    remarks += [reasons.OtherFrequency(upload.filename, hz, emitter.frequency_hz) for hz in elsewhere]
    times = [upload.at_s if upload.at_s is not None else one.at_s for one in heard]
    first_s = min((at_s for at_s in times if at_s is not None), default=None)
    for one in heard:
        refuse_far(one.place, mission)
    sure = _with_sigmas(heard, mission, state.home or corner_of(mission.area))
    measured, stations = state.emitters[emitter.emitter_id].measured, {one.tag for one in recording.bearings}
    before = [_told_before(one, stations - {one.tag}, measured) for one in heard]
    if (known := sum(told is not None for told in before)) > 0:
        remarks.append(KindLeftOut("known_bearing", known))
    sources = _sources(upload, heard, before)
    numbers = count(last + 1)
    facts = [
        _fact(mission_id, state, upload, emitter, source, one, next(numbers), at_s)
        for one, source, at_s, told in zip(sure, sources, times, before, strict=True)
        if told is None
    ]
    begins = import_fact(upload, emitter, by, first_s, remarks, sweep_ids=[], antenna=None)
    if not believed:
        return Import((begins, *facts), ())
    return Import((begins, *with_beliefs(state, emitter.emitter_id, facts, first_s, each=False)), ())


def _with_sigmas(bearings: Sequence[RecordedBearing], mission: MissionSpec, home: Place) -> list[RecordedBearing]:
    """Those whose file states no sigma get the one that their missing one another in the search area shows, and the
    compass' share, which shows in no scatter."""
    open_ = [one for one in bearings if not one.stated]
    if not open_:
        return list(bearings)
    frame = LocalFrame(home)
    west, south, east, north = target_area(mission, frame).bounds
    places = np.array([frame.to_enu(one.place) for one in open_])
    degrees = np.array([one.bearing_deg for one in open_])
    found = bearing_scatter(places, degrees, np.array([west, south]), np.array([east, north]))
    sigma_deg = math.hypot(found.sigma_deg, COMPASS_SIGMA_DEG)
    return [one if one.stated else replace(one, sigma_deg=sigma_deg) for one in bearings]


def _of(emitter: EmitterSpec, one: RecordedBearing) -> bool:
    return one.frequency_hz is None or same_channel(emitter, one.frequency_hz)


def _told_before(
    one: RecordedBearing, others: Collection[str | None], measured: Sequence[BearingMeasured]
) -> BearingMeasured | None:
    """The same one, reported by its station or out of another file. others: stations of its log, whose are not it."""
    for fact in measured:
        if one.live_id is not None and fact.bearing_id == one.live_id:
            return fact
        if isinstance(fact.source, PersonSource) and fact.source.name in others:
            continue
        if one.at_s is None or fact.taken_at_s is None or abs(fact.taken_at_s - one.at_s) > SAME_S:
            continue
        off_deg = math.remainder(fact.bearing_deg - one.bearing_deg, 360.0)
        away_m = math.hypot(*LocalFrame(one.place).to_enu(fact.place))
        if abs(off_deg) <= SAME_DEG and away_m <= SAME_M:
            return fact
    return None


def _sources(
    upload: Upload, bearings: Sequence[RecordedBearing], before: Sequence[BearingMeasured | None]
) -> list[BearingSource]:
    """Of a log of several stations each of them, by the name under which it reports live: each has a compass. So has
    one alone that has reported live; where the file names none and several did, nobody knows whose the others are.
    bearings: of one emitter, which may be those of one of the stations; before: the same as they are known."""
    several = len({one.tag for one in upload.recording.bearings if one.tag}) > 1
    live: dict[str | None, set[str]] = {}
    for one, told in zip(bearings, before, strict=True):
        if told is not None and isinstance(told.source, PersonSource):
            live.setdefault(one.tag, set()).add(told.source.name)
    of = {tag: PersonSource(name=name) for tag, (name, *others) in live.items() if not others}
    other = ImportSource(recording_id=upload.recording_id)
    return [of.get(one.tag) or (PersonSource(name=str(one.tag)) if several else other) for one in bearings]


def _fact(
    mission_id: str,
    state: SearchState,
    upload: Upload,
    emitter: EmitterSpec,
    source: BearingSource,
    one: RecordedBearing,
    number: int,
    at_s: float | None,
) -> BearingMeasured:
    """Under the id of the station's own report, where it has one: should that arrive later, it is known."""
    sigma_deg = min(max(one.sigma_deg, LEAST_SIGMA_DEG), MOST_SIGMA_DEG)
    free = one.live_id is not None and state.bearing(one.live_id) is None
    return BearingMeasured(
        emitter_id=emitter.emitter_id,
        source=source,
        bearing_id=str(one.live_id) if free else bearing_id(mission_id, upload.recording_id, one.line),
        sweep_id=None,
        place_number=number,
        place=one.place,
        altitude_amsl_m=state.home_amsl_m,
        bearing_deg=one.bearing_deg % 360.0,
        sigma_deg=sigma_deg,
        quality=1.0,
        peaks=[],
        snr_db=None,
        drift_m=0.0,
        binned_db=[],
        fitted_db=[],
        heading_sigma_deg=compass_share_deg(sigma_deg),
        taken_at_s=at_s,
    )
