"""One line about a mission, folded from its events; stored beside them so that a list of missions is one query."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field, fields, replace
from datetime import UTC, datetime
from typing import Any

from backend.events import (
    BearingExcluded,
    BearingIncluded,
    BearingMeasured,
    BeliefUpdated,
    MissionDrafted,
    MissionEdited,
    MissionEnded,
    MissionLabelled,
    MissionPhase,
    MissionStarted,
    Outcome,
    Phase,
    PhaseChanged,
    PreflightChecked,
    Recorded,
    SweepRejected,
)
from backend.mission.state import phase_of
from backend.spec import MissionSpec
from backend.store.library import LibraryEntry, advance

EPOCH = datetime(1970, 1, 1, tzinfo=UTC)


def to_us(at: datetime) -> int:
    """UTC microseconds since the epoch, exact."""
    since = at - EPOCH
    return (since.days * 86_400 + since.seconds) * 1_000_000 + since.microseconds


@dataclass(frozen=True, slots=True)
class MissionDigest:
    """The columns of the missions table.

    crafts: what each craft that is engaged does, by id; flying: there is one, perhaps on its way home after the end.
    emitters: how many are looked for. bearings: of all emitters, those that count: taken, and neither they nor their
    sources left out. counted: the same by emitter. spec_name: of the specification; a label stands before it
    until another is written there. None of both: a mission from before they were kept.
    """

    mission_id: str
    name: str
    phase: MissionPhase
    outcome: Outcome | None
    crafts: Mapping[str, Phase]
    flying: bool
    drafted_at_us: int
    started_at_us: int | None
    ended_at_us: int | None
    mission_time_s: float | None
    emitters: int
    bearings: int
    rejected_sweeps: int
    last_seq: int
    counted: Mapping[str, int] | None = field(default_factory=dict[str, int])
    spec_name: str | None = None
    entry: LibraryEntry = field(default_factory=LibraryEntry)

    @property
    def unfinished(self) -> bool:
        """It was started, and either is not over or has a craft that is not down."""
        return self.started_at_us is not None and (self.ended_at_us is None or self.flying)


def to_columns(digest: MissionDigest) -> dict[str, Any]:
    """As the missions table keeps it."""
    columns = asdict(digest)
    entry = columns.pop("entry")
    return columns | entry


def from_columns(columns: Mapping[str, Any]) -> MissionDigest:
    """The other way round."""
    own = {name: value for name, value in columns.items() if name not in _ENTRY}
    return MissionDigest(**own, entry=LibraryEntry(**{name: columns[name] for name in _ENTRY}))


_ENTRY = tuple(one.name for one in fields(LibraryEntry))


def fold(before: MissionDigest | None, recorded: Sequence[Recorded]) -> MissionDigest:
    """The digest after these events. The first event of a mission is its draft; ValueError otherwise."""
    digest = before
    for record in recorded:
        digest = _advance(digest, record)
        digest = replace(digest, entry=advance(digest.entry, record.event, to_us(record.at_utc)))
    if digest is None:
        raise ValueError("no events: there is nothing to fold")
    return digest


def _stored(name: str) -> str:
    """PostgreSQL's text holds no NUL."""
    return name.replace("\x00", "")


def _advance(digest: MissionDigest | None, record: Recorded) -> MissionDigest:
    event, at_us = record.event, to_us(record.at_utc)
    if digest is None:
        if not isinstance(event, MissionDrafted):
            raise ValueError(f"mission {record.mission_id} has no draft: its first event is {event.kind}")
        return MissionDigest(
            mission_id=record.mission_id,
            name=_stored(event.spec.name),
            phase="draft",
            outcome=None,
            crafts={},
            flying=False,
            drafted_at_us=at_us,
            started_at_us=None,
            ended_at_us=None,
            mission_time_s=None,
            emitters=len(event.spec.emitters),
            bearings=0,
            rejected_sweeps=0,
            last_seq=record.seq,
            spec_name=_stored(event.spec.name),
        )
    digest = replace(digest, last_seq=record.seq)
    match event:
        case MissionDrafted(spec=spec) | MissionEdited(spec=spec):
            return _in_phase(_specified(digest, spec), passed=False)
        case MissionLabelled(name=name):
            return replace(digest, name=_stored(name))
        case PreflightChecked(passed=passed):
            return _in_phase(digest, passed)
        case MissionStarted(craft_id=craft_id):
            first = at_us if digest.started_at_us is None else digest.started_at_us
            return _with_craft(replace(digest, started_at_us=first), craft_id, "ground", engaged=True)
        case PhaseChanged(craft_id=craft_id, after=after):
            return _with_craft(digest, craft_id, after, engaged=after != "ground")
        case BearingMeasured(emitter_id=emitter_id) | BearingIncluded(emitter_id=emitter_id, heard=True):
            return _one_more(digest, emitter_id, 1)
        case BearingExcluded(emitter_id=emitter_id, heard=True):
            return _one_more(digest, emitter_id, -1)
        case BeliefUpdated(emitter_id=emitter_id, bearings=bearings) if digest.counted is not None:
            return _counting(digest, {**digest.counted, emitter_id: bearings})  # without those of muted sources
        case SweepRejected():
            return replace(digest, rejected_sweeps=digest.rejected_sweeps + 1)
        case MissionEnded(outcome=outcome, mission_time_s=mission_time_s):
            return _in_phase(replace(digest, outcome=outcome, ended_at_us=at_us, mission_time_s=mission_time_s))
        case _:
            return digest


def _one_more(digest: MissionDigest, emitter_id: str, more: int) -> MissionDigest:
    """Or one fewer."""
    if digest.counted is None:
        return replace(digest, bearings=max(0, digest.bearings + more))
    return _counting(digest, {**digest.counted, emitter_id: max(0, digest.counted.get(emitter_id, 0) + more)})


def _counting(digest: MissionDigest, counted: Mapping[str, int]) -> MissionDigest:
    return replace(digest, counted=counted, bearings=sum(counted.values()))


def _specified(digest: MissionDigest, spec: MissionSpec) -> MissionDigest:
    """An emitter that is no longer looked for takes its bearings with it."""
    name = _stored(spec.name)
    called = digest.name if name == digest.spec_name else name
    digest = replace(digest, name=called, spec_name=name, emitters=len(spec.emitters))
    if digest.counted is None:
        return digest
    sought = {emitter.emitter_id for emitter in spec.emitters}
    return _counting(digest, {name: number for name, number in digest.counted.items() if name in sought})


def _with_craft(digest: MissionDigest, craft_id: str, phase: Phase, engaged: bool) -> MissionDigest:
    crafts = {**digest.crafts, craft_id: phase}
    if not engaged:
        del crafts[craft_id]
    return _in_phase(replace(digest, crafts=crafts, flying=bool(crafts)))


def _in_phase(digest: MissionDigest, passed: bool | None = None) -> MissionDigest:
    """passed: what preflight says from now on, None as before."""
    ready = digest.phase == "ready" if passed is None else passed
    started = digest.started_at_us is not None
    return replace(digest, phase=phase_of(digest.outcome, started, ready, digest.crafts.values()))
