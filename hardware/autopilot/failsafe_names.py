"""By what an autopilot names a failsafe of its own: its texts, and PX4's events. Data and one small memory; pure."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

from hardware.authority import FailsafeCause

ANNOUNCED_S = 30.0
"""So long after a cause was told, or an act announced, both are of one failsafe: PX4 hovers before it acts, for 25 s at
most (COM_FAIL_ACT_T)."""
EVENTS_KEPT = 64
"""PX4 says an event again when a station that shares the link asks for it, and keeps fewer than these for that."""


@dataclass(frozen=True, slots=True)
class FailsafeText:
    """A whole text, or how it begins and `ends`. cause: None: it names none. tells: that the failsafe acts now, that it
    will in some seconds, that it acts now where that was announced, or only a cause, after which it may act."""

    begins: str
    cause: FailsafeCause | None
    tells: Literal["acts", "will_act", "acts_as_announced", "cause"] = "acts"
    ends: str | None = None

    def is_said(self, text: str) -> bool:
        """Whether `text` is this one."""
        return text == self.begins if self.ends is None else text.startswith(self.begins) and text.endswith(self.ends)


@dataclass(frozen=True, slots=True)
class FailsafeEvent:
    """One of PX4's events about a failsafe. acts: it does now, else it will in some seconds. cause: where it is always
    the same; else cause_at: the place of its number among the arguments. None: it tells of none. The number of the
    action is the fifth byte."""

    acts: bool
    cause: FailsafeCause | None = None
    cause_at: int | None = None


@dataclass(frozen=True, slots=True)
class FailsafeWords:
    """texts: the first that is said counts. events: by number, of the low three bytes of an event's id. causes: by the
    number in it. homeward_actions: numbers of the actions that end on the ground."""

    texts: tuple[FailsafeText, ...]
    events: Mapping[int, FailsafeEvent] = field(default_factory=dict[int, FailsafeEvent])
    causes: Mapping[int, FailsafeCause] = field(default_factory=dict[int, FailsafeCause])
    homeward_actions: frozenset[int] = frozenset()


class FailsafeNames:
    """Of one vehicle: what was told of the failsafe that may act next."""

    def __init__(self) -> None:
        self._cause: tuple[FailsafeCause, float] = ("other", -math.inf)
        self._announced_at_s = -math.inf
        self._heard: deque[tuple[int, int]] = deque(maxlen=EVENTS_KEPT)

    def text(self, words: FailsafeWords, text: str, at_s: float) -> FailsafeCause | None:
        """Why a failsafe acts, when `text` says that one does; text: the beginning of one, of 50 bytes at most."""
        said = next((one for one in words.texts if one.is_said(text.strip())), None)
        if said is None:
            return None
        announced = at_s - self._announced_at_s < ANNOUNCED_S
        acts = said.tells == "acts" or (said.tells == "acts_as_announced" and announced)
        return self._told(acts, said.tells == "will_act", said.cause, at_s)

    def event(self, words: FailsafeWords, fields: Mapping[str, Any], at_s: float) -> FailsafeCause | None:
        """Likewise of EVENT; one that was heard already is no news."""
        number = int(fields.get("sequence", -1)), int(fields.get("event_time_boot_ms", -1))
        if number[0] >= 0:
            if number in self._heard:
                return None
            self._heard.append(number)
        event = words.events.get(int(fields["id"]) & 0xFFFFFF)
        arguments = fields["arguments"]
        if event is None or int(arguments[4]) not in words.homeward_actions:
            return None
        told = None if event.cause_at is None else words.causes.get(int(arguments[event.cause_at]))
        return self._told(event.acts, not event.acts, event.cause or told, at_s)

    def _told(self, acts: bool, will_act: bool, cause: FailsafeCause | None, at_s: float) -> FailsafeCause | None:
        if cause is not None:
            self._cause = cause, at_s
        if will_act:
            self._announced_at_s = at_s
        if not acts:
            return None
        known, told_at_s = self._cause
        return known if at_s - told_at_s < ANNOUNCED_S else "other"
