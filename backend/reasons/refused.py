"""The error of a machine that does not carry out an order."""

from __future__ import annotations

from planner.reason import ReasonedError


class Refused(ReasonedError):
    """Why a command is not carried out."""
