"""Invitations: each makes one account, waits for a while, and can be taken back."""

from __future__ import annotations

from collections.abc import Iterable

from backend.auth.keeping import Denied, Keeping
from backend.auth.registry import Invitation, digest, new_id, new_secret
from backend.permissions import Role
from backend.reasons.access import CodeUnusable
from backend.reasons.request import NothingThere


class Invitations:
    """By the digest of their secrets, each with the time until which it waits, on the monotonic clock."""

    def __init__(self, keeping: Keeping) -> None:
        self._keeping = keeping
        self._made: dict[str, tuple[Invitation, float]] = {}

    def load(self, rows: Iterable[Invitation]) -> None:
        """As the last run left them."""
        now_s, wall_us = self._keeping.monotonic_s(), self._keeping.now_us()
        for row in rows:
            lasts_s = (row.expires_at_us - max(wall_us, row.made_at_us)) / 1e6
            self._made[row.secret_hash] = (row, now_s + lasts_s)

    def usable(self, code: str) -> Invitation:
        """Raises Denied 403: unknown, used or expired."""
        found = self._made.get(digest(code.strip()))
        if found is None:
            raise Denied(403, CodeUnusable("unknown"))
        invitation, until_s = found
        if invitation.used_by is not None:
            raise Denied(403, CodeUnusable("used"))
        if self._keeping.monotonic_s() >= until_s:
            raise Denied(403, CodeUnusable("expired"))
        return invitation

    def use(self, used: Invitation) -> None:
        """As it is now that an account was made with it."""
        self._made[used.secret_hash] = (used, self._made[used.secret_hash][1])

    def learn(self, rows: Iterable[Invitation]) -> None:
        """What the database says of those that are known."""
        for row in rows:
            if row.secret_hash in self._made:
                self.use(row)

    @property
    def waiting(self) -> list[tuple[Invitation, float]]:
        """To be used, each with the seconds it still has; the newest first."""
        now_s = self._keeping.monotonic_s()
        found = [(row, until_s - now_s) for row, until_s in self._made.values() if row.used_by is None]
        return sorted(found, key=lambda pair: -pair[0].made_at_us)

    async def make(self, role: Role, admin: bool, lasts_s: float, by: str) -> tuple[str, Invitation]:
        """The secret of its link, which is shown once. Raises JournalUnavailable."""
        secret, now_us = new_secret(), self._keeping.now_us()
        until_us = now_us + int(lasts_s * 1e6)
        invitation = Invitation(new_id(), digest(secret), role, admin, by, now_us, until_us, None)
        await self._keeping.change(new=(invitation,))
        self._made[invitation.secret_hash] = (invitation, self._keeping.monotonic_s() + lasts_s)
        return secret, invitation

    async def take_back(self, invitation_id: str) -> None:
        """Raises Denied 404, JournalUnavailable."""
        async with self._keeping.changing:
            found = next((row for row, _ in self._made.values() if row.invitation_id == invitation_id), None)
            if found is None or found.used_by is not None:
                raise Denied(404, NothingThere("invitation", invitation_id))
            await self._keeping.change(gone=(found,))
            del self._made[found.secret_hash]
