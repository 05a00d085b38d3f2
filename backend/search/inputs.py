"""What happens to a search: editing, checks, bearings from anywhere, finished beliefs, an operator's wish, its end."""

from __future__ import annotations

from dataclasses import dataclass

from backend.commands import ForSearch
from backend.events import BeliefUpdated, CheckFact, Event, Outcome, ReviewFact
from backend.reasons import Reason
from backend.spec import MissionSpec


@dataclass(frozen=True, slots=True)
class Edited:
    """The whole specification, not what changed of it."""

    spec: MissionSpec
    by: str


@dataclass(frozen=True, slots=True)
class PreflightDone:
    """The whole checklist, in its order."""

    checks: tuple[CheckFact, ...]


@dataclass(frozen=True, slots=True)
class BearingsArrived:
    """Bearings that no craft of the mission took just now: of a person, or the facts of an import, in order."""

    facts: tuple[Event, ...]


@dataclass(frozen=True, slots=True)
class BeliefReady:
    """The belief about an emitter, folded from the bearings with these ids, in order."""

    bearing_ids: tuple[str, ...]
    fact: BeliefUpdated


@dataclass(frozen=True, slots=True)
class BeliefFailed:
    """The belief about an emitter, of the bearings with these ids, could not be computed."""

    bearing_ids: tuple[str, ...]
    emitter_id: str


@dataclass(frozen=True, slots=True)
class SearchOrdered:
    """An operator's command. objections: what forbids it, found beforehand (an area that cannot be searched from here).
    held: every craft of the mission hovers in hold."""

    by: str
    command: ForSearch
    objections: tuple[Reason, ...] = ()
    held: bool = True


@dataclass(frozen=True, slots=True)
class NotStored:
    """Something of this mission can never be stored; it was kept aside."""

    detail: str


@dataclass(frozen=True, slots=True)
class SearchOver:
    """Nobody searches any more. outcome None: the belief decides between localized and not."""

    because: Reason
    outcome: Outcome | None = None


@dataclass(frozen=True, slots=True)
class Reviewed:
    """Somebody told the truth of an emitter, labelled the mission, deleted or restored it."""

    fact: ReviewFact


SearchInput = (
    Edited
    | PreflightDone
    | BearingsArrived
    | BeliefReady
    | BeliefFailed
    | SearchOrdered
    | NotStored
    | SearchOver
    | Reviewed
)
