"""All facts of a mission, passed to another process as a few long texts instead of tens of thousands of objects.

Objects would block the event loop twice: while they are pickled, and whenever the garbage collector scans them.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from backend.events import Recorded
from backend.ports import TrackPoint
from backend.store.entries import EventsEntry, decode, to_records
from backend.store.upgrade import Imports


class FactsDamaged(ValueError):
    """One of them is no fact."""


@dataclass(frozen=True, slots=True)
class HandedOver:
    """pieces: consecutive facts, each as the spool keeps it. imports: see entries.to_records."""

    pieces: tuple[bytes, ...]
    imports: Imports

    def recorded(self) -> list[Recorded]:
        """As the journal reads them. Raises FactsDamaged."""
        entries = [entry for piece in self.pieces if isinstance(entry := decode(piece), EventsEntry)]
        try:
            return [record for e in entries for record in to_records(e.mission_id, e.rows, self.imports)]
        except ValueError as error:
            raise FactsDamaged(str(error)) from error


Tracks = Mapping[str, Sequence[TrackPoint]]


def made_of(facts: HandedOver, making: Callable[[Sequence[Recorded], Tracks], str | bytes], tracks: Tracks) -> bytes:
    """What `making` makes of them and of the flown paths; a text in UTF-8. Raises FactsDamaged."""
    made = making(facts.recorded(), tracks)
    return made.encode() if isinstance(made, str) else made
