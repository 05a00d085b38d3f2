"""Who flies, given to the machine when it changes."""

from __future__ import annotations

from dataclasses import dataclass

from backend.craft import inputs
from backend.craft.who_flies import kept_of
from hardware.authority import Authority
from hardware.readings import Telemetry


@dataclass(slots=True)
class AuthorityWatch:
    """known: as given last."""

    known: Authority

    def look(self, telemetry: Telemetry) -> list[inputs.CraftInput]:
        """Each change once. The end of a failsafe counts only while the vehicle is heard."""
        before, after = self.known, telemetry.authority
        self.known = after
        if kept_of(before) == kept_of(after):
            return []
        found: list[inputs.CraftInput] = [inputs.AuthorityHeard(after)]
        stopped = before.who == after.who == "failsafe" and after.given_back and not before.given_back
        if stopped and telemetry.connected:
            found.append(inputs.FailsafeEnded(after.mode or telemetry.mode or ""))
        return found
