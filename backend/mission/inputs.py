"""What happens to a mission: to its search, to one of its craft, or an operator's command to either."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from backend.commands import Author, Command
from backend.craft.inputs import CraftInput, Foretold, StartFacts
from backend.reasons import Reason
from backend.search.inputs import SearchInput


@dataclass(frozen=True, slots=True)
class ToCraft:
    """A craft that the mission does not know yet is met as a newcomer."""

    craft_id: str
    given: CraftInput


@dataclass(frozen=True, slots=True)
class Context:
    """What was found out about a craft, or the search, before a command was given: see CraftOrdered, SearchOrdered."""

    objections: tuple[Reason, ...] = ()
    start: StartFacts | None = None
    on_ground: bool = False
    altitude_amsl_m: float | None = None
    foretold: Foretold | None = None


@dataclass(frozen=True, slots=True)
class Commanded:
    """An operator's command. contexts: by craft id; search: of a command to the search. fence: of the lease that it was
    given under. holder_gone: who holds the lease may no longer operate."""

    command_id: str
    author: Author
    command: Command
    contexts: Mapping[str, Context] = field(default_factory=dict[str, Context])
    search: Context = Context()
    fence: int | None = None
    holder_gone: bool = False


@dataclass(frozen=True, slots=True)
class ServerCameBack:
    """After a restart, before the craft are asked who flies them."""


Input = SearchInput | ToCraft | Commanded | ServerCameBack
