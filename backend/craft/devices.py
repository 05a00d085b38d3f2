"""What the craft machine makes of a device that works, and does not do it well."""

from __future__ import annotations

from backend.craft.inputs import ClockAgrees, ClockOdd, ReceiverKeepsUp, ReceiverLoses
from backend.craft.step import CraftStep, alert, clear_alerts, hold


def clock_seen(step: CraftStep, given: ClockOdd | ClockAgrees) -> None:
    """No turn goes on while its headings cannot be dated."""
    if isinstance(given, ClockAgrees):
        clear_alerts(step, "clock")
    elif step.craft.engaged:
        alert(step, "clock", "warning", given.because)
        if step.craft.phase == "measuring":
            hold(step, given.because)


def losses_seen(step: CraftStep, given: ReceiverLoses | ReceiverKeepsUp) -> None:
    """A turn of which samples are missing goes on: it has fewer readings. Worse trouble of the receiver stays said."""
    if not step.craft.engaged or "receiver" in step.craft.links_down:
        return
    if isinstance(given, ReceiverKeepsUp):
        clear_alerts(step, "receiver")
    else:
        alert(step, "receiver", "caution", given.because)
