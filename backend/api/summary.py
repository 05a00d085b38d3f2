"""Stored facts as the resources of the wire."""

from __future__ import annotations

import math
from collections.abc import Sequence
from datetime import UTC, datetime, timedelta

import numpy as np
from numpy.typing import NDArray

from backend.events import Recorded
from backend.mission.drafts import SPECIFIED
from backend.ports import TrackPoint
from backend.search.emitter import EmitterState
from backend.search.state import SearchState, evolve
from backend.store.digest import EPOCH, MissionDigest
from backend.store.entries import SweepEntry
from backend.store.retention import DELETED_DAYS
from backend.wire.resources import EmitterFound, Mission, MissionSummary, SweepRecord, Track, TrackFact
from planner.reasons import NoBearingYet

DETAIL_KINDS = (
    *SPECIFIED,
    "area_changed",
    "priorities_changed",
    "preflight_checked",
    "mission_started",
    "bearing_measured",
    "bearing_excluded",
    "bearing_included",
    "source_mute_changed",
    "belief_updated",
    "mission_ended",
)
"""The events that `mission` needs."""


def _utc(at_us: int | None) -> datetime | None:
    return None if at_us is None else EPOCH + timedelta(microseconds=at_us)


def _summary(digest: MissionDigest, iq_bytes: int) -> dict[str, object]:
    deleted = _utc(digest.entry.deleted_at_us)
    return {
        "mission_id": digest.mission_id,
        "name": digest.name,
        "phase": digest.phase,
        "flying": digest.flying,
        "emitters": digest.emitters,
        "outcome": digest.outcome,
        "drafted_at_utc": _utc(digest.drafted_at_us),
        "started_at_utc": _utc(digest.started_at_us),
        "ended_at_utc": _utc(digest.ended_at_us),
        "mission_time_s": digest.mission_time_s,
        "bearings": digest.bearings,
        "rejected_sweeps": digest.rejected_sweeps,
        "last_seq": digest.last_seq,
        "tags": [tag for tag in digest.entry.tags.split("\n") if tag],
        "notes": digest.entry.notes,
        "deleted_at_utc": deleted,
        "gone_at_utc": None if deleted is None else deleted + timedelta(days=DELETED_DAYS),
        "sketch": digest.entry.sketch,
        "iq_bytes": iq_bytes,
    }


def mission_summary(digest: MissionDigest, iq_bytes: int) -> MissionSummary:
    """From the digest alone: no fact is read for a list. iq_bytes: that are kept of the mission."""
    return MissionSummary.model_validate(_summary(digest, iq_bytes))


def mission(digest: MissionDigest, iq_bytes: int, recorded: Sequence[Recorded]) -> Mission:
    """iq_bytes: that are kept. recorded: the mission's events of DETAIL_KINDS, in order."""
    search = SearchState()
    for record in recorded:
        search = evolve(search, record.event, record.at_utc.timestamp())
    specified = [record.seq for record in recorded if record.event.kind in SPECIFIED]
    return Mission.model_validate(
        {
            **_summary(digest, iq_bytes),
            "spec": search.mission,
            "spec_seq": specified[-1],
            "editable": search.stage in ("draft", "ready"),
            "home": search.home,
            "localized": all(e.belief is not None and e.belief.localized for e in search.emitters.values()),
            "found": [_found(emitter) for emitter in search.emitters.values()],
            "outcome_reason": search.outcome_reason,
        }
    )


def _found(emitter: EmitterState) -> EmitterFound:
    belief = emitter.belief
    return EmitterFound(
        emitter_id=emitter.emitter_id,
        bearings=len(emitter.bearings),
        estimate=None if belief is None else belief.measured_estimate,
        localized=belief is not None and belief.localized,
        not_yet=[NoBearingYet()] if belief is None and not emitter.bearings else list(emitter.not_yet),
    )


def sweep_record(entry: SweepEntry) -> SweepRecord:
    """NaN, which JSON does not have, becomes None; a sweep without times begins at 1970."""
    sweep = entry.sweep()
    began_s = float(sweep.at_s[0]) if len(sweep.at_s) else 0.0
    return SweepRecord.model_validate(
        {
            "sweep_id": entry.sweep_id,
            "mission_id": entry.mission_id,
            "craft_id": entry.craft_id,
            "emitter_id": entry.emitter_id,
            "place_number": entry.place_number,
            "attempt": entry.attempt,
            "began_at_utc": datetime.fromtimestamp(began_s if math.isfinite(began_s) else 0.0, UTC),
            "place": {"lat": entry.lat_deg, "lon": entry.lon_deg},
            "altitude_amsl_m": entry.altitude_amsl_m,
            "frequency_hz": entry.frequency_hz,
            "drift_m": entry.drift_m,
            "clipped_samples": entry.clipped_samples,
            "noise_floor_db": entry.noise_floor_db,
            "tag": entry.tag,
            "at_s": _numbers(sweep.at_s - began_s),
            "heading_deg": _numbers(sweep.heading_deg),
            "power_db": _numbers(sweep.power_db),
        }
    )


def _numbers(values: NDArray[np.float64]) -> list[float | None]:
    return [value if math.isfinite(value) else None for value in values.tolist()]


def track_text(mission_id: str, craft_id: str, points: Sequence[TrackPoint]) -> str:
    """The JSON of a Track."""
    track = Track(mission_id=mission_id, craft_id=craft_id, points=[track_fact(point) for point in points])
    return track.model_dump_json()


def track_fact(point: TrackPoint) -> TrackFact:
    """Degrees WGS84, times UTC."""
    return TrackFact(
        at_utc=datetime.fromtimestamp(point.at_s, UTC),
        lat=point.lat_deg,
        lon=point.lon_deg,
        altitude_amsl_m=point.altitude_amsl_m,
        altitude_relative_m=point.altitude_relative_m,
        heading_deg=point.heading_deg,
        battery_percent=point.battery_percent,
        mode=point.mode,
    )
