"""The control lease of a search: who may steer it. Pure: no clock, no waiting.

Whoever holds it steers; hold, abort, return and landing never need it (backend/permissions.py). An order carries the
fence, the number of the change of hands that it was given under: one that was under way while control changed hands
and came back is refused, though the same person sent it (a fencing token: Kleppmann, "How to do distributed locking").
A pilot takes control at once. An operator asks, and may take it when the holder does not answer, or may no longer
operate. The one person of a server without accounts is bound by no lease.
"""

from __future__ import annotations

from dataclasses import dataclass

from backend.commands import (
    AskControl,
    Author,
    Command,
    ForControl,
    GiveControl,
    KeepControl,
    ReleaseControl,
    TakeControl,
)
from backend.events import ControlAsked, ControlChanged, ControlKept, ControlWay, Event, Holder
from backend.permissions import COMMANDS
from backend.reasons import Reason
from backend.reasons.access import (
    ControlAskedAlready,
    ControlFree,
    ControlHeld,
    ControlNeedless,
    ControlNotAsked,
    ControlNotYours,
    ControlStale,
)

UNANSWERED_S = 30.0
"""How long the holder has to answer, on the mission's clock."""

ControlFact = ControlChanged | ControlAsked | ControlKept


@dataclass(frozen=True, slots=True)
class Control:
    """fence: 0 until somebody took control. asked: who waits for it, since asked_at_s (UTC epoch seconds)."""

    holder: Holder | None = None
    fence: int = 0
    asked: Holder | None = None
    asked_at_s: float = 0.0

    def held_by(self, author: Author) -> bool:
        """Does this person hold it?"""
        return self.holder is not None and self.holder.person == author.person


def evolve(control: Control, event: Event, at_s: float) -> Control:
    """The lease after one fact."""
    match event:
        case ControlChanged(holder=holder, fence=fence):
            return Control(holder, fence)
        case ControlAsked(holder=asked):
            return Control(control.holder, control.fence, asked, at_s)
        case ControlKept():
            return Control(control.holder, control.fence)
        case _:
            return control


def objection(control: Control, author: Author, fence: int | None, command: Command) -> Reason | None:
    """What the lease has against an order; None when it has nothing."""
    if author.person is None or not COMMANDS[command.kind].control:
        return None
    if control.holder is None:
        return ControlFree()
    if not control.held_by(author):
        return ControlHeld(control.holder.name)
    return None if fence == control.fence else ControlStale()


def decide(
    control: Control, author: Author, command: ForControl, holder_gone: bool, at_s: float
) -> ControlFact | Reason:
    """What becomes of a command about the lease. holder_gone: its holder may no longer operate."""
    if author.person is None:
        return ControlNeedless()
    me = Holder(person=author.person, name=author.name)
    match command:
        case TakeControl():
            way = _way_to_take(control, author, holder_gone, at_s)
            if way is None:
                return ControlHeld("" if control.holder is None else control.holder.name)
            return ControlChanged(holder=me, fence=control.fence + 1, way=way, by=author.name)
        case AskControl():
            return _ask(control, me, at_s)
        case GiveControl() | KeepControl() | ReleaseControl() if not control.held_by(author):
            return ControlNotYours()
        case ReleaseControl():
            return ControlChanged(holder=None, fence=control.fence + 1, way="released", by=author.name)
        case GiveControl() | KeepControl() if control.asked is None:
            return ControlNotAsked()
        case KeepControl():
            return ControlKept(by=author.name)
        case GiveControl():
            return ControlChanged(holder=control.asked, fence=control.fence + 1, way="given", by=author.name)


def _way_to_take(control: Control, author: Author, holder_gone: bool, at_s: float) -> ControlWay | None:
    """None: not yet."""
    if control.holder is None:
        return "free"
    if control.held_by(author):
        return "again"
    if holder_gone:
        return "gone"
    if author.role == "pilot":
        return "pilot"
    asked = control.asked is not None and control.asked.person == author.person
    return "unanswered" if asked and at_s - control.asked_at_s >= UNANSWERED_S else None


def _ask(control: Control, me: Holder, at_s: float) -> ControlFact | Reason:
    """Asked again, the time begins again, so that a clock that was set back holds nobody up for ever."""
    if control.holder is None:
        return ControlFree()
    if control.holder.person == me.person:
        return ControlNotYours()
    other = control.asked is not None and control.asked.person != me.person
    if other and 0.0 <= at_s - control.asked_at_s < UNANSWERED_S:
        return ControlAskedAlready(control.asked.name if control.asked else "")
    return ControlAsked(holder=me, by=me.name)
