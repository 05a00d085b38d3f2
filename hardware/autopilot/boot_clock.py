"""The autopilot's time since boot as UTC: when a heading was true, not when its message happened to arrive."""

from __future__ import annotations

_DRIFT = 2e-3
"""How fast the offset may grow, s/s: covers any crystal, and forgets one lucky early message slowly."""
_STEP = 1.0
"""s: an offset larger than this over many messages is a step (the autopilot was suspended), not latency."""
_STEP_COUNT = 30


class BootClock:
    """utc = boot + offset, offset = the least (heard - boot) seen lately: latency only ever adds (Cristian 1989)."""

    def __init__(self) -> None:
        self._offset: float | None = None
        self._boot = 0.0
        self._late: list[float] = []
        self.reboots = 0
        """How often the time since boot went back."""

    def to_utc(self, boot_s: float, heard_at_s: float) -> float:
        """UTC of the moment `boot_s` after boot, from a message heard at `heard_at_s` (UTC); never later than that."""
        observed = heard_at_s - boot_s
        rebooted = boot_s < self._boot - _STEP
        self.reboots += rebooted
        if self._offset is None or rebooted or observed <= self._offset:
            self._offset = observed
            self._late.clear()
        else:
            excess = observed - self._offset
            self._offset += min(excess, _DRIFT * max(0.0, boot_s - self._boot))
            self._judge_step(observed, excess)
        self._boot = boot_s
        return boot_s + self._offset

    def _judge_step(self, observed: float, excess: float) -> None:
        if excess < _STEP:
            self._late.clear()
            return
        self._late.append(observed)
        if len(self._late) >= _STEP_COUNT:
            self._offset = min(self._late)
            self._late.clear()
