"""One line about a mission, folded from its events; stored beside them so that a list of missions is one query."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from typing import Literal

from backend.events import (
    BearingExcluded,
    BearingMeasured,
    MissionDrafted,
    MissionEdited,
    MissionEnded,
    MissionStarted,
    Phase,
    PhaseChanged,
    Recorded,
    SweepRejected,
)

EPOCH = datetime(1970, 1, 1, tzinfo=UTC)


def to_us(at: datetime) -> int:
    """UTC microseconds since the epoch, exact."""
    since = at - EPOCH
    return (since.days * 86_400 + since.seconds) * 1_000_000 + since.microseconds


@dataclass(frozen=True, slots=True)
class MissionDigest:
    """The columns of the missions table. `bearings`: those that count (taken and not excluded)."""

    mission_id: str
    name: str
    phase: Phase
    outcome: Literal["localized", "not_localized", "aborted", "failed"] | None
    drafted_at_us: int
    started_at_us: int | None
    ended_at_us: int | None
    mission_time_s: float | None
    bearings: int
    rejected_sweeps: int
    last_seq: int


def fold(before: MissionDigest | None, recorded: Sequence[Recorded]) -> MissionDigest:
    """The digest after these events. The first event of a mission is its draft; ValueError otherwise."""
    digest = before
    for record in recorded:
        digest = _advance(digest, record)
    if digest is None:
        raise ValueError("no events: there is nothing to fold")
    return digest


def _advance(digest: MissionDigest | None, record: Recorded) -> MissionDigest:
    event, at_us = record.event, to_us(record.at_utc)
    if digest is None:
        if not isinstance(event, MissionDrafted):
            raise ValueError(f"mission {record.mission_id} has no draft: its first event is {event.kind}")
        return MissionDigest(
            mission_id=record.mission_id,
            name=event.spec.name,
            phase="draft",
            outcome=None,
            drafted_at_us=at_us,
            started_at_us=None,
            ended_at_us=None,
            mission_time_s=None,
            bearings=0,
            rejected_sweeps=0,
            last_seq=record.seq,
        )
    digest = replace(digest, last_seq=record.seq)
    match event:
        case MissionDrafted() | MissionEdited():
            return replace(digest, name=event.spec.name)
        case PhaseChanged():
            return replace(digest, phase=event.after)
        case MissionStarted():
            return replace(digest, started_at_us=at_us)
        case BearingMeasured():
            return replace(digest, bearings=digest.bearings + 1)
        case BearingExcluded():
            return replace(digest, bearings=digest.bearings - 1)
        case SweepRejected():
            return replace(digest, rejected_sweeps=digest.rejected_sweeps + 1)
        case MissionEnded():
            return replace(digest, outcome=event.outcome, ended_at_us=at_us, mission_time_s=event.mission_time_s)
        case _:
            return digest
