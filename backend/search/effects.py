"""What the search machine asks for. The mission carries it out in order; the machine itself touches nothing."""

from __future__ import annotations

from dataclasses import dataclass

from backend.events import Event
from backend.reasons import Reason


@dataclass(frozen=True, slots=True)
class Record:
    """Append this fact to the journal, then show it."""

    event: Event


@dataclass(frozen=True, slots=True)
class Refuse:
    """The order is not carried out, and why."""

    reason: Reason


@dataclass(frozen=True, slots=True)
class UpdateBelief:
    """Fold all counted bearings of this emitter into its belief."""

    emitter_id: str


@dataclass(frozen=True, slots=True)
class SearchElsewhere:
    """From now on in the area that was just changed."""


SearchEffect = Record | Refuse | UpdateBelief | SearchElsewhere
