"""How the map rooms say no: what is wrong, and how to mend it."""

from __future__ import annotations


class MapRefused(ValueError):
    """A file or an area that cannot be used. The message is a sentence for the operator, `remedy` what he can do."""

    def __init__(self, detail: str, remedy: str = "") -> None:
        super().__init__(detail)
        self.remedy = remedy


class NoRoom(MapRefused):
    """The file is larger than what may be stored."""


class NotStored(LookupError):
    """There is no map or overlay with this id."""
