"""What the map room raises; each error says why, as a reason."""

from __future__ import annotations

from typing import Literal

from backend.reasons.maps import ArchiveReason, GeometryFault
from backend.reasons.request import NothingThere
from planner.reason import ReasonedError


class MapRefused(ReasonedError):
    """A file, or an area, cannot be used as a map, as an overlay or on one."""


class ArchiveUnusable(MapRefused):
    """A file is no map that can be shown."""

    def __init__(self, reason: ArchiveReason) -> None:
        super().__init__(reason)
        self._why: ArchiveReason = reason

    @property
    def reason(self) -> ArchiveReason:
        """Which part of the archive is wrong."""
        return self._why


class NotStored(ReasonedError, LookupError):
    """There is no map, overlay or terrain with this id."""

    def __init__(self, what: Literal["map", "overlay", "terrain"], which: str) -> None:
        super().__init__(NothingThere(what, which))


class PartUnusable(Exception):
    """One feature of a file cannot be drawn; the others can."""

    def __init__(self, fault: GeometryFault) -> None:
        super().__init__(fault)
        self.fault: GeometryFault = fault
