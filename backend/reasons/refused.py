"""The error of a machine that does not carry out an order."""

from __future__ import annotations

from backend.reasons import Reason, carried
from planner.reason import ReasonedError


class Refused(ReasonedError):
    """Why a command is not carried out."""

    @property
    def reason(self) -> Reason:
        """Of any room: the wire's union holds them all."""
        return carried(super().reason)
