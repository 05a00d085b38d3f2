"""Bearings out of a file as facts of a mission: one source with errors of its own, or one a station. Pure."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from backend.events import BearingMeasured, BearingSource, ImportSource, PersonSource
from backend.reasons import search as reasons
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


def bearing_facts(mission_id: str, state: SearchState, upload: Upload, by: str, *, believed: bool) -> Import:
    """Every bearing of the emitter and, where nobody else makes it, the belief after the last (believed): all bearings
    are weighed again at each of them, which takes a processor most of a minute for 150. Raises MissionInputError."""
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
    facts = [
        _fact(mission_id, state, upload, emitter, source, one, number, at_s)
        for number, (one, source, at_s) in enumerate(zip(sure, _sources(upload, heard), times, strict=True), last + 1)
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


def _sources(upload: Upload, bearings: Sequence[RecordedBearing]) -> list[BearingSource]:
    """Of a log of several stations each of them, by the name under which it reports live: each has a compass. bearings:
    of one emitter, which may be those of one of the stations."""
    if len({one.tag for one in upload.recording.bearings if one.tag}) > 1:
        return [PersonSource(name=str(one.tag)) for one in bearings]
    return [ImportSource(recording_id=upload.recording_id)] * len(bearings)


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
    sigma_deg = min(max(one.sigma_deg, LEAST_SIGMA_DEG), MOST_SIGMA_DEG)
    return BearingMeasured(
        emitter_id=emitter.emitter_id,
        source=source,
        bearing_id=bearing_id(mission_id, upload.recording_id, one.line),
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
