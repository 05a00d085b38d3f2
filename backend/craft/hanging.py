"""What the craft machine makes of the autopilot's own nets, which follow the search area in flight."""

from __future__ import annotations

from backend.craft.inputs import NetsNotTaken, NetsUp
from backend.craft.step import CraftStep, alert, clear_alerts
from backend.events import NetsHung


def nets_looked_at(step: CraftStep, given: NetsUp | NetsNotTaken) -> None:
    """Trouble is said once; they are given to it until it has them, and nothing is resumed before."""
    craft = step.craft
    if not craft.engaged or not craft.nets_wait:
        return
    if isinstance(given, NetsUp):
        step.record(NetsHung(craft_id=craft.craft_id))
        clear_alerts(step, "nets")
    elif all(raised.topic != "nets" or raised.reason != given.because for raised in craft.open_alerts):
        alert(step, "nets", "warning", given.because)
