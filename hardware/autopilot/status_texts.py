"""STATUSTEXT: what the autopilot says, its chunks of 50 bytes joined by their id. Pure; the bytes are anybody's.

The chunks of an id are numbered from 0, and the last is the first that does not fill its 50 bytes. Id 0 stands for a
text that is whole, but PX4 counts its first text after a start as 0, too: one that fills its bytes may go on. Each text
is given once: when it is whole, or with a gap when the rest of it does not come.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

from hardware.autopilot.words import sanitized

Severity = Literal["critical", "error", "warning", "information"]
CHUNK_BYTES = 50
MOST_CHUNKS = 8
MOST_WAITING = 8
WAIT_S = 1.0
"""For a missing chunk, from the last one that came."""
REMEMBERED_S = 5.0
"""A chunk of a text that has been given comes late or twice: it is nothing new."""
GAP = "…"


@dataclass(frozen=True, slots=True)
class StatusText:
    """text: one printable line, with a gap where a chunk is missing."""

    severity: Severity
    text: str


@dataclass(slots=True)
class _Coming:
    severity: Severity
    last_s: float
    chunks: dict[int, str] = field(default_factory=dict[int, str])
    final: int | None = None
    given: bool = False

    @property
    def whole(self) -> bool:
        return self.final is not None and all(seq in self.chunks for seq in range(self.final + 1))

    @property
    def text(self) -> str:
        end = (self.final if self.final is not None else max(self.chunks) + 1) + 1
        return "".join(self.chunks.get(seq, GAP) for seq in range(end))


class StatusTexts:
    """Of one component of one vehicle; another one's ids mean other texts."""

    def __init__(self) -> None:
        self._coming: dict[int, _Coming] = {}

    def take(self, severity: int, text: str, text_id: int, chunk: int, now_s: float) -> list[StatusText]:
        """severity: MAV_SEVERITY. What is complete now."""
        named = severity_of(severity)
        found = self.overdue(now_s)
        if text_id == 0 and chunk == 0:
            found += self._give(0) if 0 in self._coming else []
            self._coming.pop(0, None)
            if len(text.encode(errors="replace")) < CHUNK_BYTES:
                return found + _given(named, text)
        coming = self._coming.get(text_id)
        if coming is None:
            if len(self._coming) >= MOST_WAITING:
                found += self._give(self._oldest())
                del self._coming[self._oldest()]
            coming = self._coming[text_id] = _Coming(named, now_s)
        if coming.given or chunk in coming.chunks or chunk >= MOST_CHUNKS:
            return found
        coming.chunks[chunk], coming.last_s = text, now_s
        if chunk == MOST_CHUNKS - 1 or len(text.encode(errors="replace")) < CHUNK_BYTES:
            coming.final = chunk
        return found + (self._give(text_id) if coming.whole else [])

    def overdue(self, now_s: float) -> list[StatusText]:
        """Texts whose missing chunks are no longer waited for."""
        found: list[StatusText] = []
        for text_id, coming in list(self._coming.items()):
            if not coming.given and now_s - coming.last_s > WAIT_S:
                found += self._give(text_id)
            if now_s - coming.last_s > REMEMBERED_S or now_s < coming.last_s:
                del self._coming[text_id]
        return found

    def _oldest(self) -> int:
        return min(self._coming, key=lambda text_id: self._coming[text_id].last_s)

    def _give(self, text_id: int) -> list[StatusText]:
        coming = self._coming[text_id]
        if coming.given or not coming.chunks:
            return []
        coming.given = True
        if text_id == 0 and coming.chunks.keys() == {0}:
            coming.final = 0
        return _given(coming.severity, coming.text)


def severity_of(number: int) -> Severity:
    """number: MAV_SEVERITY; what is worse than critical counts as critical."""
    if number <= 2:
        return "critical"
    return "error" if number == 3 else "warning" if number == 4 else "information"


def _given(severity: Severity, text: str) -> list[StatusText]:
    clean = sanitized(text)
    return [StatusText(severity, clean)] if clean else []
