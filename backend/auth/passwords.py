"""Passwords: what is good enough, and argon2id, which takes its time and memory off the event loop."""

from __future__ import annotations

import asyncio

from argon2 import PasswordHasher
from argon2.exceptions import InvalidHashError, VerificationError

from backend.auth.registry import key_of
from backend.reasons.access import PasswordWeak

LEAST = 10
MOST = 200
DIFFERENT = 5
NAME_LEAST = 4
"""Shorter names are in many good passwords."""
AT_ONCE = 2
"""64 MiB each (RFC 9106, second recommended option): a crowd at the door must not take the memory of a flight."""


def weakness(password: str, name: str) -> PasswordWeak | None:
    """Why a password is refused, None when it is good enough."""
    if len(password) < LEAST:
        return PasswordWeak("short", LEAST)
    if len(set(password)) < DIFFERENT:
        return PasswordWeak("simple", LEAST)
    holds_name = len(name) >= NAME_LEAST and key_of(name) in key_of(password)
    return PasswordWeak("name", LEAST) if holds_name else None


class Passwords:
    """Hashes and checks in threads, few at a time."""

    def __init__(self, hasher: PasswordHasher | None = None) -> None:
        """hasher: None for the library's own choice of costs."""
        self._hasher = hasher or PasswordHasher()
        self._turn = asyncio.Semaphore(AT_ONCE)
        self._nobodys: str | None = None

    async def hashed(self, password: str) -> str:
        """With its salt and costs."""
        async with self._turn:
            return await asyncio.to_thread(self._hasher.hash, password)

    async def fits(self, password: str, stored: str | None) -> bool:
        """stored None or "": there is no such person, or no password of theirs, which takes as long to find out."""
        if self._nobodys is None:
            self._nobodys = await self.hashed("nobody has this password")
        async with self._turn:
            fits = await asyncio.to_thread(self._verify, password, stored or self._nobodys)
        return fits and bool(stored)

    def _verify(self, password: str, stored: str) -> bool:
        try:
            return self._hasher.verify(stored, password)
        except (VerificationError, InvalidHashError):
            return False
