"""Links that go and come: the vehicle, its GPS, the receiver, the consoles."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from backend.craft import inputs
from backend.events import Link
from backend.reasons import Reason
from backend.reasons.flight import NoConsole, PlaceUnknown, VehicleLinkLost
from hardware.readings import Telemetry


@dataclass(slots=True)
class LinkWatch:
    """vehicle_since_s: when the vehicle was heard again after its link had been lost."""

    vehicle_since_s: float = -math.inf
    _down_since_s: dict[Link, float] = field(default_factory=dict[Link, float])
    _console_seen: bool = False

    def look(
        self, telemetry: Telemetry, now_s: float, trouble: Reason | None, consoles: int | None
    ) -> list[inputs.CraftInput]:
        """Each change once. trouble: of the receiver, None when it is well. consoles: None when nobody counts them."""
        heard = telemetry.heard_at_s
        silence = VehicleLinkLost(None if heard is None else now_s - heard)
        found: list[inputs.CraftInput] = []
        found += self._change("vehicle", None if telemetry.connected else silence, now_s, heard)
        found += self.look_at_gps(telemetry, now_s)
        found += self._change("receiver", trouble, now_s)
        self._console_seen |= bool(consoles)
        if consoles is not None and self._console_seen:
            found += self._change("console", None if consoles else NoConsole("hold"), now_s)
        return found

    def look_at_gps(self, telemetry: Telemetry, now_s: float) -> list[inputs.CraftInput]:
        """Alone: of a craft whose link nothing would be done about."""
        if not telemetry.connected:
            return []
        lost = telemetry.position_lost_since_s is not None
        return self._change("gps", PlaceUnknown() if lost else None, now_s)

    def _change(
        self, link: Link, trouble: Reason | None, now_s: float, heard_at_s: float | None = None
    ) -> list[inputs.CraftInput]:
        """trouble None: it is up. heard_at_s: over it last, where that is known: a loss is noticed later."""
        if trouble is not None and link not in self._down_since_s:
            self._down_since_s[link] = now_s if heard_at_s is None else heard_at_s
            return [inputs.LinkDown(link, trouble)]
        if trouble is None and link in self._down_since_s:
            if link == "vehicle":
                self.vehicle_since_s = now_s
            return [inputs.LinkUp(link, now_s - self._down_since_s.pop(link))]
        return []
