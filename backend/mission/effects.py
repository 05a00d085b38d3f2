"""What a mission asks for: its search's and its craft's wishes, each addressed, and the answer to a command."""

from __future__ import annotations

from dataclasses import dataclass

from backend.craft.effects import CraftEffect
from backend.reasons import Reason
from backend.search.effects import Record, SearchElsewhere, UpdateBelief


@dataclass(frozen=True, slots=True)
class OfCraft:
    """A craft's effect, but for its facts and answers."""

    craft_id: str
    effect: CraftEffect


@dataclass(frozen=True, slots=True)
class Reply:
    """Answer the command. reason: why it was refused, None when it was accepted."""

    command_id: str
    reason: Reason | None


Effect = Record | Reply | OfCraft | UpdateBelief | SearchElsewhere
