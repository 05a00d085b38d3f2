"""What the craft machine makes of the autopilot's own nets, which follow the search area in flight."""

from __future__ import annotations

from backend.craft.inputs import NetsNotTaken, NetsUp
from backend.craft.step import CraftStep, alert, clear_alerts
from backend.events import NetsHung
from backend.reasons.safety import NoWayHome, OutsideFence

MOVED_M = 5.0
"""A vehicle that hovers stays within this."""


def nets_looked_at(step: CraftStep, given: NetsUp | NetsNotTaken) -> None:
    """Trouble is said once; they are given to it until it has them, and nothing is resumed before."""
    craft = step.craft
    if not craft.engaged or not craft.nets_wait:
        return
    if isinstance(given, NetsUp):
        step.record(NetsHung(craft_id=craft.craft_id))
        clear_alerts(step, "nets")
    elif not any(raised.topic == "nets" and _same(raised.reason, given.because) for raised in craft.open_alerts):
        alert(step, "nets", "warning", given.because)


def _same(said: object, because: object) -> bool:
    """Two reasons, also where a vehicle that hovers is a little further in or out."""
    if isinstance(said, OutsideFence) and isinstance(because, OutsideFence):
        return said.what == because.what and abs(because.beyond_m - said.beyond_m) < MOVED_M
    if isinstance(said, NoWayHome) and isinstance(because, NoWayHome):
        return abs(because.distance_m - said.distance_m) < MOVED_M
    return said == because
