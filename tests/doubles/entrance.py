"""Access as the tests of people, sessions and invitations open it: over a database of its own, by clocks they set."""

from __future__ import annotations

from pathlib import Path

from argon2 import PasswordHasher

from backend.auth.access import Access, Visit
from backend.auth.audit import AuditLog
from backend.auth.passwords import Passwords
from backend.auth.records import Records
from backend.store.engine import make_engine

PASSWORD = "correct horse battery"
DAY_S = 86_400.0


class Clocks:
    """wall_s jumps as the tests want; steady_s only goes on."""

    def __init__(self) -> None:
        self.wall_s, self.steady_s = 1_700_000_000.0, 50.0

    def go(self, seconds: float) -> None:
        self.wall_s += seconds
        self.steady_s += seconds


def opened(url: str, clocks: Clocks, *, expected: bool = True, timeout_s: float = 2.0) -> Access:
    return Access(
        Records(make_engine(url, timeout_s), timeout_s),
        AuditLog(None, lambda: clocks.wall_s),
        people_expected=expected,
        payload_tokens=("a configured token of a payload",),
        passwords=Passwords(PasswordHasher(time_cost=1, memory_cost=8, parallelism=1)),
        wall_s=lambda: clocks.wall_s,
        monotonic_s=lambda: clocks.steady_s,
    )


async def with_admin(access: Access) -> str:
    """The first admin's secret."""
    return await access.make_first_admin(access.begin_first_admin() or "", "Ada", PASSWORD, Visit("10.0.0.2", "laptop"))


def who(access: Access, secret: str) -> str | None:
    found = access.signed_in(secret, "10.0.0.2")
    return None if found is None else found[0].name


def everything_in(folder: Path) -> bytes:
    return b"".join(path.read_bytes() for path in folder.glob("people.sqlite*"))


async def again(url: str, clocks: Clocks, access: Access) -> Access:
    """The server after a restart. The steady clock of another boot begins anywhere."""
    await access.close()
    clocks.steady_s = 7.0
    another = opened(url, clocks)
    await another.load()
    return another
