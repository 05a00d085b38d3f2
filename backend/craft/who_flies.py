"""What the craft machine makes of who has the vehicle, heard in flight or after a restart of the server."""

from __future__ import annotations

from typing import Literal

from backend.craft.effects import CancelTimer, CancelWork
from backend.craft.inputs import Restarted
from backend.craft.state import AUTOMATIC, HOMEWARD, ORDERED_BEFORE, failsafe_has, ours_to_order, pilot_has
from backend.craft.step import (
    CraftStep,
    alert,
    cancel_timers,
    clear_alerts,
    clear_failsafe,
    insist,
    start_console_timers,
)
from backend.events import AuthorityChanged
from backend.reasons import flight
from hardware.authority import Authority


def authority_heard(step: CraftStep, heard: Authority) -> None:
    """Somebody else flies, or the same one differently. Nothing is sent; only an operator takes control back."""
    craft, before = step.craft, step.craft.authority
    if not craft.engaged or kept_of(heard) == kept_of(before):
        return
    taken = pilot_has(heard) and not craft.taken_over
    if taken:
        step.do(CancelWork())
        cancel_timers(step)
    step.record(AuthorityChanged(craft_id=craft.craft_id, authority=heard))
    if not ours_to_order(heard):
        step.do(CancelTimer("order"))
        clear_alerts(step, "order")
    if taken:
        clear_failsafe(step)
        reason = flight.PilotFlies(heard.mode or "", heard.perhaps_failsafe)
        alert(step, "pilot", "caution", reason)
        step.go("manual", reason)
    elif heard.who == "pilot" and before.perhaps_failsafe and not heard.perhaps_failsafe:
        alert(step, "pilot", "caution", flight.PilotFlies(heard.mode or ""))
    elif failsafe_has(heard):
        again = before.who == heard.who == "failsafe" and before.given_back and not heard.given_back
        if again or not failsafe_has(before) or _named(heard) != _named(before):
            _by_failsafe(step, heard, again)


def _by_failsafe(step: CraftStep, heard: Authority, again: bool) -> None:
    """Also of what counted as a pilot's for a moment, until the autopilot named its cause. again: it had stopped."""
    silent = "link_lost" if "vehicle" in step.craft.links_down else "silence"
    reason = flight.FailsafeFlies(_named(heard) or silent)
    if step.craft.phase in AUTOMATIC | {"hold"} or (step.craft.phase == "manual" and heard.who == "failsafe"):
        step.do(CancelWork())
        clear_alerts(step, "pilot")
        if step.craft.phase == "manual" and "console" in step.craft.links_down:
            start_console_timers(step)  # the pilot that it was taken for had ended them
        before, why = step.craft.taken_from or "hold", step.craft.taken_reason
        if why is None or not (before in HOMEWARD or why == ORDERED_BEFORE):
            before, why = "hold", reason
        alert(step, "vehicle", "caution", reason)
        step.go(before, why)
    elif heard.who == "failsafe" and (again or _named(heard) is not None):
        alert(step, "vehicle", "caution", reason)


def _named(heard: Authority) -> Literal["battery", "transmitter", "position", "fence", "other"] | None:
    """What the autopilot says of a failsafe that acts on something else than silence."""
    return None if heard.cause == "silence" else heard.cause


def kept_of(authority: Authority) -> tuple[object, ...]:
    """What of it is a fact to keep: the bookkeeping of each command is not."""
    a = authority
    cause = a.cause if a.who == "failsafe" else None
    return a.who, a.taken_by, a.given_back, a.perhaps_failsafe, a.undone, a.mode, cause


def tell_failsafe(step: CraftStep, silent: Literal["link_lost", "ordered_before", "server_away"]) -> None:
    """What it does now, after a while in which that was not heard. silent: why it flies, where it names no cause."""
    heard = step.craft.authority
    stopped = heard.who == "failsafe" and heard.given_back
    flies = flight.FailsafeFlies(_named(heard) or silent)
    alert(step, "vehicle", "caution", flight.FailsafeStopped(heard.mode or "") if stopped else flies)


def restarted(step: CraftStep, given: Restarted) -> None:
    """Rule 4: back in hold with the same belief; a vehicle that a pilot flies is not touched."""
    craft, heard = step.craft, given.authority
    if not craft.engaged:
        return
    clear_alerts(step, "vehicle", "receiver", "console", "payload", "gps", "clock", "antenna")
    if given.other_antenna is not None:
        alert(step, "antenna", "caution", given.other_antenna)
    if kept_of(heard) != kept_of(craft.authority):
        step.record(AuthorityChanged(craft_id=craft.craft_id, authority=heard))
    if craft.taken_over:
        return
    if pilot_has(heard):
        reason = flight.PilotFlies(heard.mode or "", heard.perhaps_failsafe)
        alert(step, "pilot", "caution", reason)
        step.go("manual", reason)
    elif failsafe_has(heard):
        because = "ordered_before" if craft.comes_down_as_ordered else "server_away"
        if heard.who == "failsafe" or not step.on_ground:
            tell_failsafe(step, because)
        named = flight.FailsafeFlies(_named(heard) or because)
        step.go("hold", ORDERED_BEFORE if craft.comes_down_as_ordered else named)
    else:
        insist(step, "hold")
        step.go("hold", flight.BackAfterRestart())
