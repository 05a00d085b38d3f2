"""Token buckets: how often something may be tried, by key. Pure: whoever asks says what time it is.

A key has `burst` tries; one comes back every `every_s`. Keys are bounded: the one that has waited longest is forgotten,
which is the one nearest to full again.
"""

from __future__ import annotations

import ipaddress
from collections import OrderedDict
from dataclasses import dataclass, field

KEYS = 10_000


@dataclass(slots=True)
class Buckets:
    """now_s: seconds of a clock that never runs backwards; a step back counts as no time."""

    burst: float
    every_s: float
    _left: OrderedDict[str, tuple[float, float]] = field(default_factory=OrderedDict[str, tuple[float, float]])

    def wait_s(self, key: str, now_s: float) -> float:
        """Seconds until there is a try again, 0 when there is one now."""
        left = self._now(key, now_s)
        return 0.0 if left >= 1.0 else (1.0 - left) * self.every_s

    def take(self, key: str, now_s: float) -> None:
        """One try less, though there may be none: who goes on trying waits longer, at most one burst more."""
        self._put(key, max(self._now(key, now_s) - 1.0, -self.burst), now_s)

    def give_back(self, key: str, now_s: float) -> None:
        """It was a good one."""
        self._put(key, min(self._now(key, now_s) + 1.0, self.burst), now_s)

    def _now(self, key: str, now_s: float) -> float:
        left, at_s = self._left.get(key, (self.burst, now_s))
        return min(self.burst, left + max(now_s - at_s, 0.0) / self.every_s)

    def _put(self, key: str, left: float, now_s: float) -> None:
        self._left[key] = (left, now_s)
        self._left.move_to_end(key)
        if len(self._left) > KEYS:
            self._left.popitem(last=False)


def neighbourhood(address: str) -> str:
    """One machine has many IPv6 addresses: its /64 counts."""
    try:
        parsed = ipaddress.ip_address(address)
    except ValueError:
        return address
    if parsed.version == 4:
        return address
    mapped = parsed.ipv4_mapped
    return str(mapped) if mapped else str(ipaddress.ip_network((parsed, 64), strict=False).network_address)
