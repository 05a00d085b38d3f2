"""Who is signed in where, and for how long."""

from __future__ import annotations

import asyncio
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from typing import Generic, TypeVar

from backend.auth.keeping import Denied, Keeping
from backend.auth.registry import MachineToken, Session, digest, new_id, new_secret
from backend.reasons.request import NothingThere

IDLE_S = 12 * 3600.0
LONGEST_S = 7 * 86_400.0
SEEN_EVERY_S = 300.0
"""So often at most a session's last use is written down."""
SESSIONS_EACH = 20
"""Of one person; the one that was idle longest makes room."""

Kept = TypeVar("Kept", Session, MachineToken)


@dataclass(slots=True, eq=False)
class Entry(Generic[Kept]):
    """What lets somebody in. seen_s, made_s: on the monotonic clock. ended: set when it lets nobody in any more."""

    row: Kept
    made_s: float
    seen_s: float
    written_s: float
    ended: asyncio.Event = field(default_factory=asyncio.Event)


class Sessions:
    """Found by the digest of their secrets."""

    def __init__(self, keeping: Keeping) -> None:
        self._keeping = keeping
        self._entries: dict[str, Entry[Session]] = {}

    def load(self, rows: Iterable[Session]) -> None:
        """As the last run left them: a clock that was set back meanwhile lengthens none by more than its lifetime."""
        now_s, wall_us = self._keeping.monotonic_s(), self._keeping.now_us()
        for row in rows:
            seen_s = now_s - max(0, wall_us - row.seen_at_us) / 1e6
            made_s = now_s - max(0, wall_us - row.made_at_us) / 1e6
            self._entries[row.secret_hash] = Entry(row, made_s, seen_s, seen_s)

    def found(self, secret: str) -> Entry[Session] | None:
        """By the cookie's secret. None: there is none, or it lasts no longer."""
        entry = self._entries.get(digest(secret))
        return entry if entry is not None and self.lasts(entry) else None

    def lasts(self, entry: Entry[Session]) -> bool:
        """Not ended, not idle for too long, not too old."""
        now_s = self._keeping.monotonic_s()
        return not entry.ended.is_set() and now_s - entry.seen_s < IDLE_S and now_s - entry.made_s < LONGEST_S

    def seen(self, entry: Entry[Session]) -> None:
        """It was used now; that is written down now and then, in the background."""
        entry.seen_s = self._keeping.monotonic_s()
        if entry.seen_s - entry.written_s < SEEN_EVERY_S or entry.ended.is_set():
            return
        entry.written_s = entry.seen_s
        entry.row = replace(entry.row, seen_at_us=self._keeping.now_us())
        self._keeping.change_quietly(entry.row)

    def of(self, person_id: str) -> list[Session]:
        """That last, the newest first."""
        rows = [entry.row for entry in self._of(person_id) if self.lasts(entry)]
        return sorted(rows, key=lambda row: -row.made_at_us)

    def idle_s(self, session: Session) -> float:
        """Seconds since it was used last."""
        return max(0.0, self._keeping.monotonic_s() - self._entries[session.secret_hash].seen_s)

    def made(self, person_id: str, address: str, device: str) -> tuple[str, Session]:
        """A secret that was never there before, and its session; it lets in once it is entered."""
        secret, now_us = new_secret(), self._keeping.now_us()
        return secret, Session(new_id(), digest(secret), person_id, now_us, now_us, address[:64], device[:200])

    def enter(self, session: Session) -> None:
        """From now on it lets in."""
        now_s = self._keeping.monotonic_s()
        self._entries[session.secret_hash] = Entry(session, now_s, now_s, now_s)

    def crowd(self, person_id: str) -> list[Entry[Session]]:
        """Those that make room for one more."""
        return sorted(self._of(person_id), key=lambda entry: entry.seen_s)[: -SESSIONS_EACH + 1]

    async def end(self, person_id: str, session_id: str) -> None:
        """Of this person. Ended at once, whatever the database says. Raises Denied 404, JournalUnavailable."""
        found = [entry for entry in self._of(person_id) if entry.row.session_id == session_id]
        if not found:
            raise Denied(404, NothingThere("session", session_id))
        await self.end_these(found)

    async def end_all(self, person_id: str, *, but: str | None = None) -> None:
        """Signed out everywhere. but: the id of a session that goes on. Raises JournalUnavailable."""
        await self.end_these([entry for entry in self._of(person_id) if entry.row.session_id != but])

    async def end_these(self, entries: Sequence[Entry[Session]]) -> None:
        """Raises JournalUnavailable; they have ended all the same, and the database hears of it when it is back."""
        rows = [entry.row for entry in entries]
        self.forget(entries)
        await self._keeping.remove(rows)

    def forget(self, entries: Iterable[Entry[Session]]) -> None:
        """They let nobody in any more; the database hears of it from whoever calls."""
        for entry in entries:
            entry.ended.set()
            self._entries.pop(entry.row.secret_hash, None)

    def _of(self, person_id: str) -> list[Entry[Session]]:
        return [entry for entry in self._entries.values() if entry.row.person_id == person_id]
