"""What somebody ordered, whether it was accepted, and what the vehicle made of it.

by: who, None when the mission did by itself.
"""

from __future__ import annotations

from typing import Literal

from backend.events.fact import Fact
from backend.permissions import Role
from backend.reasons import Reason
from backend.reasons.flight import OrderName, Way
from backend.spec import Id, Model


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


class LandOrdered(Fact):
    """Where the vehicle is, not at home."""

    kind: Literal["land_ordered"] = "land_ordered"
    craft_id: Id
    by: str | None
    reason: Reason | None


class AbortOrdered(Fact):
    """The search is over for this craft: it holds, then returns."""

    kind: Literal["abort_ordered"] = "abort_ordered"
    craft_id: Id
    by: str


class OrderTried(Fact):
    """The rung is commanded. rung: index in the order's ladder (backend/craft/ladder.py). because: why the rung before
    was not done, None of the first try."""

    kind: Literal["order_tried"] = "order_tried"
    craft_id: Id
    order: OrderName
    way: Way
    rung: int
    because: Reason | None = None


class OrderNotDone(Fact):
    """What was tried was refused, not heard or not seen. rung: of what is tried next; next_in_s None: when the vehicle
    is heard again."""

    kind: Literal["order_not_done"] = "order_not_done"
    craft_id: Id
    order: OrderName
    way: Way
    reason: Reason
    rung: int
    next_way: Way
    next_in_s: float | None


class OrderDone(Fact):
    """Telemetry has confirmed it. way: what the vehicle does now, where the order itself could not be done another."""

    kind: Literal["order_done"] = "order_done"
    craft_id: Id
    order: OrderName
    way: Way


class AutomaticChanged(Fact):
    """ "Accept the next location automatically" was armed or disarmed."""

    kind: Literal["automatic_changed"] = "automatic_changed"
    craft_id: Id
    automatic: bool
    by: str


class AuthorFact(Model):
    """Who gave a command, besides the name in `by`. person, role: None where there are no accounts. address: of the
    machine that sent it."""

    person: str | None
    role: Role | None
    address: str | None


class CommandAccepted(Fact):
    """What makes commands idempotent across restarts: a repeated `command_id` gets the first answer again. order: the
    digest of all that was ordered. Both are None where nobody kept them."""

    kind: Literal["command_accepted"] = "command_accepted"
    command_id: str
    command: str
    by: str
    order: str | None = None
    author: AuthorFact | None = None


class CommandRefused(Fact):
    """Nothing was done; a repeated `command_id` gets the same reason again."""

    kind: Literal["command_refused"] = "command_refused"
    command_id: str
    command: str
    by: str
    reason: Reason
    order: str | None = None
    author: AuthorFact | None = None
