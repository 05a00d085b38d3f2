"""What somebody ordered, and whether it was accepted. by: who, None when the mission did by itself."""

from __future__ import annotations

from typing import Literal

from backend.events.fact import Fact
from backend.reasons import Reason
from backend.spec import Id


class HoldOrdered(Fact):
    """reason: why, when the mission ordered it by itself; None for an operator's."""

    kind: Literal["hold_ordered"] = "hold_ordered"
    craft_id: Id
    by: str | None
    reason: Reason | None


class ResumeOrdered(Fact):
    """After hold, a restart or a takeover: automatic control goes on."""

    kind: Literal["resume_ordered"] = "resume_ordered"
    craft_id: Id
    by: str


class ReturnOrdered(Fact):
    """reason: why, when the mission ordered it by itself; None for an operator's."""

    kind: Literal["return_ordered"] = "return_ordered"
    craft_id: Id
    by: str | None
    reason: Reason | None


class AbortOrdered(Fact):
    """The search is over for this craft: it holds, then returns."""

    kind: Literal["abort_ordered"] = "abort_ordered"
    craft_id: Id
    by: str


class AutomaticChanged(Fact):
    """ "Accept the next location automatically" was armed or disarmed."""

    kind: Literal["automatic_changed"] = "automatic_changed"
    craft_id: Id
    automatic: bool
    by: str


class CommandAccepted(Fact):
    """What makes commands idempotent across restarts: a repeated `command_id` gets the first answer again."""

    kind: Literal["command_accepted"] = "command_accepted"
    command_id: str
    command: str
    by: str


class CommandRefused(Fact):
    """Nothing was done; a repeated `command_id` gets the same reason again."""

    kind: Literal["command_refused"] = "command_refused"
    command_id: str
    command: str
    by: str
    reason: Reason
