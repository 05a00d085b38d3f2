"""How often may be tried: of sign-ins and codes by address and name, of commands by person, of lines by everybody."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field

from backend.auth.buckets import Buckets, neighbourhood
from backend.auth.keeping import Denied
from backend.auth.principal import Principal
from backend.reasons.access import TooManyTries


def too_many(wait_s: float) -> Denied:
    """Says whole seconds, never too few: whoever waits that long is let in."""
    return Denied(429, TooManyTries(float(math.ceil(wait_s))))


@dataclass(slots=True)
class Limits:
    """Of names generously: nobody shall shut an admin out by trying their name."""

    monotonic_s: Callable[[], float]
    addresses: Buckets = field(default_factory=lambda: Buckets(burst=10, every_s=6.0))
    names: Buckets = field(default_factory=lambda: Buckets(burst=50, every_s=5.0))
    refused_commands: Buckets = field(default_factory=lambda: Buckets(burst=30, every_s=1.0))
    noted_refusals: Buckets = field(default_factory=lambda: Buckets(burst=100, every_s=2.0))
    """Of all refused requests that the audit log takes, so that a stranger cannot fill the disk."""

    def take_try(self, address: str) -> None:
        """Taken before, given back after: tries that run side by side count too. Raises Denied 429."""
        now_s, key = self.monotonic_s(), neighbourhood(address)
        wait_s = self.addresses.wait_s(key, now_s)
        self.addresses.take(key, now_s)
        if wait_s > 0:
            raise too_many(wait_s)

    def give_back_try(self, address: str) -> None:
        """It was a good one."""
        self.addresses.give_back(neighbourhood(address), self.monotonic_s())

    def command_wait_s(self, principal: Principal) -> float:
        """Seconds that whoever had too many commands refused has to wait."""
        return self.refused_commands.wait_s(principal.person or principal.name, self.monotonic_s())

    def command_refused(self, principal: Principal) -> None:
        """One of theirs was."""
        self.refused_commands.take(principal.person or principal.name, self.monotonic_s())

    def notes_refusal(self) -> bool:
        """Does the audit log take another refused request now?"""
        now_s = self.monotonic_s()
        if self.noted_refusals.wait_s("all", now_s) > 0:
            return False
        self.noted_refusals.take("all", now_s)
        return True
