"""Tokens of machines: payloads, and programs that read."""

from __future__ import annotations

import hmac
from collections.abc import Iterable

from backend.auth.keeping import Denied, Keeping
from backend.auth.limits import Limits
from backend.auth.principal import Principal
from backend.auth.registry import MachineToken, digest, new_id, new_secret
from backend.auth.sessions import Entry
from backend.permissions import Scope
from backend.reasons.request import NothingThere


class Machines:
    """payload_tokens: those of the settings, which no admin made."""

    def __init__(self, keeping: Keeping, limits: Limits, payload_tokens: Iterable[str]) -> None:
        self._keeping = keeping
        self._limits = limits
        self._payload_tokens = tuple(payload_tokens)
        self._entries: dict[str, Entry[MachineToken]] = {}
        self._revoked: set[str] = set()

    def load(self, rows: Iterable[MachineToken]) -> None:
        """As the last run left them."""
        now_s, wall_us = self._keeping.monotonic_s(), self._keeping.now_us()
        for row in rows:
            made_s = now_s - max(0, wall_us - row.made_at_us) / 1e6
            self._entries[row.secret_hash] = Entry(row, made_s, made_s, made_s)

    def found(self, secret: str, address: str) -> tuple[Principal, Entry[MachineToken] | None] | None:
        """By its token; without an entry it is one of the settings. None: unknown, or it lasts no longer. Raises Denied
        429 when too many unknown ones came from there; a known one always passes, it cannot be guessed."""
        hashed = digest(secret)
        entry = self._entries.get(hashed)
        if entry is not None and self.lasts(entry):
            return Principal(entry.row.name, scope=entry.row.scope, address=address), entry
        if any(hmac.compare_digest(secret.encode(), known.encode()) for known in self._payload_tokens):
            return Principal("payload", scope="payload", address=address), None
        if entry is None and hashed not in self._revoked:  # a program that was not told guesses nothing
            self._limits.take_try(address)
        return None

    def lasts(self, entry: Entry[MachineToken]) -> bool:
        """Not revoked, not older than it was made for."""
        row, age_s = entry.row, self._keeping.monotonic_s() - entry.made_s
        expired = row.expires_at_us is not None and age_s >= (row.expires_at_us - row.made_at_us) / 1e6
        return not entry.ended.is_set() and not expired

    @property
    def tokens(self) -> list[MachineToken]:
        """The newest first, with those that could not be forgotten yet."""
        return sorted((entry.row for entry in self._entries.values()), key=lambda row: -row.made_at_us)

    async def make(self, name: str, scope: Scope, lasts_s: float | None, by: str) -> tuple[str, MachineToken]:
        """The secret, which is shown once. Raises JournalUnavailable."""
        secret, now_us = new_secret(), self._keeping.now_us()
        until_us = None if lasts_s is None else now_us + int(lasts_s * 1e6)
        token = MachineToken(new_id(), digest(secret), name, scope, by, now_us, until_us)
        await self._keeping.change(new=(token,))
        now_s = self._keeping.monotonic_s()
        self._entries[token.secret_hash] = Entry(token, now_s, now_s, now_s)
        return secret, token

    async def revoke(self, token_id: str) -> None:
        """At once. Raises Denied 404, JournalUnavailable: it lets nobody in, and is to be revoked again, since a
        restart would bring it back."""
        found = next((entry for entry in self._entries.values() if entry.row.token_id == token_id), None)
        if found is None:
            raise Denied(404, NothingThere("token", token_id))
        found.ended.set()
        self._revoked.add(found.row.secret_hash)
        await self._keeping.change(gone=(found.row,))
        self._entries.pop(found.row.secret_hash, None)
