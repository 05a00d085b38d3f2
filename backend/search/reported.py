"""A bearing that somebody reports, with an antenna in their hand or on their roof, as the fact it becomes. Pure.

No sweep stands behind it, so what it is worth is what its reporter states. The share that a compass contributes is the
same for all bearings of a source: a joint belief finds it out.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from backend.events import BearingMeasured, PersonSource
from backend.reasons import Reason
from backend.reasons import search as reasons
from backend.reasons.refusals import NoSuchEmitter
from backend.search.area import centre_of
from backend.search.errors import MissionInputError
from backend.search.state import SearchState
from backend.spec import MissionSpec, Place
from hardware.frame import LocalFrame

FAR_M = 50_000.0
"""What was heard from farther away, or found there, belongs to another search."""
COMPASS_SIGMA_DEG = 5.0
"""Of a hand-held compass, as all bearings of one source have it in common."""
COMPASS_SHARE = 0.4
"""Of the stated sigma, at most. Who states one mostly means the error of one bearing: with 0.8 C95 held the truth in
88 % of files whose errors were all their own (docs/direction-finding.md)."""
AT_ONCE_S = 5.0
LATEST_S = 24 * 3600.0
AHEAD_S = 120.0
"""The clock of a phone may be so far ahead."""
SAME_CHANNEL_HZ = 25_000.0
"""A station that tells its frequency hears an emitter within this of it."""
NO_PLACE_NUMBER = 0
"""Places are counted for the craft's sake, which may fly to a limited number; nobody else uses them up."""


@dataclass(frozen=True, slots=True)
class ReportedBearing:
    """bearing_id: made by whoever reports, the same when it is sent again. emitter_id None: of the search's only one.

    bearing_deg: from true north. sigma_deg: standard deviation of all its errors. snr_db None: not said. taken_at_s:
    UTC epoch seconds. frequency_hz None: not said; else it has to be that of an emitter.
    """

    bearing_id: str
    by: str
    place: Place
    bearing_deg: float
    sigma_deg: float
    taken_at_s: float
    emitter_id: str | None = None
    snr_db: float | None = None
    frequency_hz: float | None = None


def reported_fact(state: SearchState, report: ReportedBearing, now_s: float) -> BearingMeasured:
    """Raises MissionInputError for a place far off, a time that cannot be, or an emitter that is not told."""
    must_be_near(state.mission, report.place)
    age_s = now_s - report.taken_at_s
    if not -AHEAD_S <= age_s <= LATEST_S:
        raise MissionInputError(reasons.BearingTimeImpossible(age_s), "taken_at_utc")
    remarks: list[Reason] = [reasons.TakenEarlier(age_s)] if age_s > AT_ONCE_S else []
    return BearingMeasured(
        emitter_id=_emitter_id(state, report.emitter_id, report.frequency_hz),
        source=PersonSource(name=report.by),
        bearing_id=report.bearing_id,
        sweep_id=None,
        place_number=NO_PLACE_NUMBER,
        place=report.place,
        altitude_amsl_m=state.home_amsl_m,
        bearing_deg=report.bearing_deg % 360.0,
        sigma_deg=report.sigma_deg,
        quality=1.0,
        peaks=[],
        snr_db=report.snr_db,
        drift_m=0.0,
        binned_db=[],
        fitted_db=[],
        heading_sigma_deg=compass_share_deg(report.sigma_deg),
        remarks=remarks,
        taken_at_s=report.taken_at_s,
    )


def must_be_near(mission: MissionSpec, place: Place) -> None:
    """Of a place that somebody tells. Raises MissionInputError."""
    east, north = LocalFrame(centre_of(mission.area)).to_enu(place)
    away_m = math.hypot(east, north)
    if not away_m <= FAR_M:
        raise MissionInputError(reasons.PlaceTooFar(away_m), "place")


def on_our_clock(report: ReportedBearing, now_s: float, wall_s: float) -> ReportedBearing:
    """Its moment on the mission's clock instead of the world's, by how long it is past: the two part where the machine
    was suspended, its clock was set, or a simulated mission runs faster. now_s, wall_s: what the two show."""
    return replace(report, taken_at_s=now_s - (wall_s - report.taken_at_s))


def compass_share_deg(sigma_deg: float) -> float:
    """Of a stated sigma, what all bearings of its source have in common."""
    return min(COMPASS_SIGMA_DEG, COMPASS_SHARE * sigma_deg)


def _emitter_id(state: SearchState, wanted: str | None, frequency_hz: float | None) -> str:
    known = [emitter.emitter_id for emitter in state.mission.emitters]
    if wanted is None and frequency_hz is not None:
        nearest = min(state.mission.emitters, key=lambda emitter: abs(emitter.frequency_hz - frequency_hz))
        if abs(nearest.frequency_hz - frequency_hz) > SAME_CHANNEL_HZ:
            raise MissionInputError(reasons.HeardElsewhere(frequency_hz), "frequency_hz")
        return nearest.emitter_id
    if wanted is None and len(known) == 1:
        return known[0]
    if wanted is None:
        raise MissionInputError(reasons.WhichEmitter(len(known)), "emitter_id")
    if wanted not in known:
        raise MissionInputError(NoSuchEmitter(wanted), "emitter_id")
    return wanted
