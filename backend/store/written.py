"""A mission that was written to, as memory keeps it: all its facts, or of a large one on the ground what came since."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

from backend.events import Recorded
from backend.store.digest import MissionDigest

KEPT_WHOLE = 1_000
"""Facts of a mission on the ground. Of one with more, those of before stay in the database: reading them all takes
seconds, and the garbage collector holds the event loop up for as long as they are in memory."""


@dataclass(slots=True)
class Written:
    """digest: the summary of all its facts, None before the first. before: how many facts are in the database only.
    recorded: the facts after those."""

    digest: MissionDigest | None
    recorded: list[Recorded] = field(default_factory=list[Recorded])
    before: int = 0

    @property
    def last_seq(self) -> int:
        """0 before the first fact."""
        return self.before + len(self.recorded)

    def take(self, recorded: Iterable[Recorded], digest: MissionDigest) -> None:
        """Its next facts. digest: after them."""
        self.recorded.extend(recorded)
        self.digest = digest

    def stored_only(self, after: int, most: int | None) -> int:
        """Of the first `most` facts after number `after`, how many lie in the database only."""
        there = max(0, self.before - after)
        return there if most is None else min(there, most)

    def here(self, after: int, most: int | None) -> list[Recorded]:
        """Of the same, those in memory."""
        left = None if most is None else most - self.stored_only(after, most)
        return self.recorded[max(0, after - self.before) :][:left]


def left_in_database(digest: MissionDigest) -> bool:
    """Whether its facts stay there when the first new one is written."""
    return digest.last_seq > KEPT_WHOLE and not digest.unfinished
