"""Who controls a search: the lease with its fencing token, asked for, given and taken.

fence: counts up with every change of hands, so that an order that was given before one is known by its number.
"""

from __future__ import annotations

from typing import Literal

from backend.events.fact import Fact
from backend.spec import Model

ControlWay = Literal["free", "again", "given", "unanswered", "gone", "pilot", "released"]
"""How control came to its new holder: nobody had it, the same person took it again, its holder gave it or did not
answer, its holder may no longer operate, a pilot took it, its holder let go of it."""


class Holder(Model):
    """person: the account's id. name: as it was then."""

    person: str
    name: str


class ControlChanged(Fact):
    """holder None: nobody controls the search now."""

    kind: Literal["control_changed"] = "control_changed"
    holder: Holder | None
    fence: int
    way: ControlWay
    by: str


class ControlAsked(Fact):
    """Unanswered for long enough, whoever asks may take it."""

    kind: Literal["control_asked"] = "control_asked"
    holder: Holder
    by: str


class ControlKept(Fact):
    """Asked for control, its holder said no."""

    kind: Literal["control_kept"] = "control_kept"
    by: str
