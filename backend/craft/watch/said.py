"""What the autopilot says, given to the machine as often as a person can read it. What is left out is counted."""

from __future__ import annotations

from dataclasses import dataclass, field

from backend.craft import inputs
from hardware.reasons.vehicle_news import AutopilotRepeats, AutopilotSaid, AutopilotSaidMore

AGAIN_S = 10.0
"""A text is repeated no sooner, and only once it was heard twice as often as was last said."""
FORGOTTEN_S = 120.0
"""A text that was not heard for this long is over; when it comes again it is new."""
MOST_TEXTS = 20
BURST, REFILL_S = 8, 5.0
"""How many new texts pass at once, and the seconds before each further one."""


@dataclass(slots=True)
class _Heard:
    said: AutopilotSaid
    last_s: float
    reported_s: float
    times: int = 1
    reported: int = 1


@dataclass(slots=True)
class SaidWatch:
    """Of one craft. Times are the clock's, seconds."""

    _heard: dict[str, _Heard] = field(default_factory=dict[str, _Heard])
    _allowance: float = BURST
    _refilled_s: float | None = None
    _left_out: int = 0

    def hear(self, said: AutopilotSaid, now_s: float) -> list[inputs.CraftInput]:
        """A new text at once; one that is known counts up."""
        known = self._heard.get(said.text)
        if known is not None:
            known.times += 1
            known.last_s = now_s
            return []
        self._refill(now_s)
        if self._allowance < 1.0:
            self._left_out += 1
            return []
        self._allowance -= 1.0
        if len(self._heard) >= MOST_TEXTS:
            del self._heard[min(self._heard, key=lambda text: self._heard[text].last_s)]
        self._heard[said.text] = _Heard(said, now_s, now_s)
        return [inputs.Said(said)]

    def look(self, now_s: float) -> list[inputs.CraftInput]:
        """What has been repeated, what is over, how much was left out."""
        found: list[inputs.CraftInput] = []
        for text, heard in list(self._heard.items()):
            if now_s - heard.last_s > FORGOTTEN_S:
                del self._heard[text]
                found.append(inputs.SaidNoMore(text))
            elif heard.times >= 2 * heard.reported and now_s - heard.reported_s >= AGAIN_S:
                heard.reported, heard.reported_s = heard.times, now_s
                found.append(inputs.Said(AutopilotRepeats(heard.said.severity, text, heard.times)))
        self._refill(now_s)
        if self._left_out and self._allowance >= 1.0:
            self._allowance -= 1.0
            found.append(inputs.Said(AutopilotSaidMore(self._left_out)))
            self._left_out = 0
        return found

    def _refill(self, now_s: float) -> None:
        passed_s = 0.0 if self._refilled_s is None else max(0.0, now_s - self._refilled_s)
        self._allowance = min(float(BURST), self._allowance + passed_s / REFILL_S)
        self._refilled_s = now_s
