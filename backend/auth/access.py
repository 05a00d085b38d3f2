"""Who may enter: sign-in, sessions, invitations, tokens, the first admin.

All of it is in memory and written through: a database that is away lets everybody who is signed in go on, and an abort
waits for no query. Inside one run of the server only the monotonic clock counts: a clock that jumps, as that of a field
laptop does when it first hears a satellite, neither signs anybody out in flight nor brings a session back.
"""

from __future__ import annotations

import asyncio
import hmac
import logging
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from typing import Generic, Literal, TypeVar

from backend.auth.audit import AuditLog
from backend.auth.buckets import Buckets, neighbourhood
from backend.auth.passwords import Passwords, weakness
from backend.auth.principal import Principal
from backend.auth.records import Records
from backend.auth.registry import (
    Invitation,
    MachineToken,
    Person,
    Session,
    digest,
    key_of,
    new_code,
    new_id,
    new_secret,
    typed,
)
from backend.permissions import Role, Scope, at_least
from backend.ports import JournalUnavailable
from backend.reasons import Reason
from backend.reasons.access import (
    CodeUnusable,
    FirstAdminExists,
    LastAdmin,
    NameTaken,
    NoPeopleHere,
    TooManyTries,
    WrongNameOrPassword,
)
from backend.reasons.request import NothingThere
from planner.reason import ReasonedError

log = logging.getLogger("crossfix.access")

Mode = Literal["alone", "waiting", "people"]
"""alone: one person before their own machine, no sign-in. waiting: for the first admin. people: whoever signs in."""

IDLE_S = 12 * 3600.0
LONGEST_S = 7 * 86_400.0
SEEN_EVERY_S = 300.0
"""So often at most a session's last use is written down."""
SESSIONS_EACH = 20
"""Of one person; the one that was idle longest makes room."""
WAITING_SIGN_INS = 20
"""More at once wait for nothing: they are refused."""

Kept = TypeVar("Kept", Session, MachineToken)


class Denied(ReasonedError):
    """status: of the answer."""

    def __init__(self, status: int, reason: Reason) -> None:
        super().__init__(reason)
        self.status = status


@dataclass(slots=True, eq=False)
class Entry(Generic[Kept]):
    """What lets somebody in. seen_s, made_s: on the monotonic clock. ended: set when it lets nobody in any more."""

    row: Kept
    made_s: float
    seen_s: float
    written_s: float
    ended: asyncio.Event = field(default_factory=asyncio.Event)


@dataclass(slots=True)
class Limits:
    """How often may be tried. Of names generously: nobody shall shut an admin out by trying their name."""

    addresses: Buckets = field(default_factory=lambda: Buckets(burst=10, every_s=6.0))
    names: Buckets = field(default_factory=lambda: Buckets(burst=50, every_s=5.0))
    refused_commands: Buckets = field(default_factory=lambda: Buckets(burst=30, every_s=1.0))
    noted_refusals: Buckets = field(default_factory=lambda: Buckets(burst=100, every_s=2.0))
    """Of all refused requests that the audit log takes, so that a stranger cannot fill the disk."""


class Access:
    """records None: nobody can be kept (a server on paper, for tests of other things)."""

    def __init__(
        self,
        records: Records | None,
        audit: AuditLog,
        *,
        people_expected: bool,
        payload_tokens: Iterable[str] = (),
        passwords: Passwords | None = None,
        wall_s: Callable[[], float] = time.time,
        monotonic_s: Callable[[], float] = time.monotonic,
    ) -> None:
        self._records = records
        self.audit = audit
        self.limits = Limits()
        self._people_expected = people_expected
        self._payload_tokens = tuple(payload_tokens)
        self._passwords = passwords or Passwords()
        self._wall_s = wall_s
        self._monotonic_s = monotonic_s
        self._people: dict[str, Person] = {}
        self._sessions: dict[str, Entry[Session]] = {}
        self._tokens: dict[str, Entry[MachineToken]] = {}
        self._invitations: dict[str, tuple[Invitation, float]] = {}
        self._first_code: str | None = None
        self._changing = asyncio.Lock()
        self._signing_in = 0
        self._writing: set[asyncio.Task[None]] = set()

    # State

    async def load(self) -> None:
        """Once, before the first request. Raises JournalUnavailable."""
        if self._records is None:
            return
        stored = await self._records.load()
        now_s, wall_us = self._monotonic_s(), self._now_us()

        def ago(at_us: int) -> float:
            return now_s - max(0, wall_us - at_us) / 1e6

        self._people = {person.person_id: person for person in stored.people}
        for row in stored.sessions:
            seen_s = ago(row.seen_at_us)
            self._sessions[row.secret_hash] = Entry(row, ago(row.made_at_us), seen_s, seen_s)
        for token in stored.tokens:
            made_s = ago(token.made_at_us)
            self._tokens[token.secret_hash] = Entry(token, made_s, made_s, made_s)
        for invitation in stored.invitations:
            lasts_s = (invitation.expires_at_us - max(wall_us, invitation.made_at_us)) / 1e6
            self._invitations[invitation.secret_hash] = (invitation, now_s + lasts_s)

    @property
    def mode(self) -> Mode:
        """Once there are people, there is no way back."""
        if self._people:
            return "people"
        return "waiting" if self._people_expected else "alone"

    @property
    def people(self) -> list[Person]:
        """By name."""
        return sorted(self._people.values(), key=lambda person: person.name_key)

    def person(self, person_id: str) -> Person:
        """Raises Denied 404."""
        found = self._people.get(person_id)
        if found is None:
            raise Denied(404, NothingThere("person", person_id))
        return found

    def named(self, name: str) -> Person | None:
        """None: nobody is called so."""
        return next((person for person in self._people.values() if person.name_key == key_of(name)), None)

    def operates(self, person_id: str) -> bool:
        """May this person give commands now?"""
        person = self._people.get(person_id)
        return person is not None and person.active and at_least(person.role, "operator")

    # Who asks

    def signed_in(self, secret: str, address: str | None) -> tuple[Principal, Entry[Session]] | None:
        """By the cookie's secret. None: nobody, or no longer."""
        entry = self._sessions.get(digest(secret))
        if entry is None or not self.lasts(entry):
            return None
        person = self._people.get(entry.row.person_id)
        if person is None or not person.active:
            return None
        principal = Principal(
            person.name,
            person.role,
            person.admin,
            person=person.person_id,
            session=entry.row.session_id,
            address=address,
        )
        return principal, entry

    def lasts(self, entry: Entry[Session]) -> bool:
        """Not ended, not idle for too long, not too old."""
        now_s = self._monotonic_s()
        return not entry.ended.is_set() and now_s - entry.seen_s < IDLE_S and now_s - entry.made_s < LONGEST_S

    def seen(self, entry: Entry[Session]) -> None:
        """It was used now; that is written down now and then, in the background."""
        entry.seen_s = self._monotonic_s()
        if entry.seen_s - entry.written_s < SEEN_EVERY_S or entry.ended.is_set():
            return
        entry.written_s = entry.seen_s
        entry.row = replace(entry.row, seen_at_us=self._now_us())
        task = asyncio.create_task(self._write_quietly(entry.row))
        self._writing.add(task)
        task.add_done_callback(self._writing.discard)

    def machine(self, secret: str, address: str) -> tuple[Principal, asyncio.Event] | None:
        """By its token. None: unknown. Raises Denied 429 when too many unknown ones came from there; a known one always
        passes, it cannot be guessed."""
        entry = self._tokens.get(digest(secret))
        if entry is not None and not entry.ended.is_set() and self._token_lasts(entry):
            return Principal(entry.row.name, scope=entry.row.scope, address=address), entry.ended
        if any(hmac.compare_digest(secret.encode(), known.encode()) for known in self._payload_tokens):
            return Principal("payload", scope="payload", address=address), asyncio.Event()
        self._try(address)
        return None

    def _token_lasts(self, entry: Entry[MachineToken]) -> bool:
        row = entry.row
        if row.expires_at_us is None:
            return True
        return self._monotonic_s() - entry.made_s < (row.expires_at_us - row.made_at_us) / 1e6

    # Entering

    def begin_first_admin(self) -> str | None:
        """A new code for the first admin, to be printed; None when there is nobody to be made."""
        if self.mode != "waiting":
            return None
        code = new_code()
        self._first_code = digest(code)
        return code

    async def make_first_admin(self, code: str, name: str, password: str, address: str, device: str) -> str:
        """The new session's secret. Of two who try at once, one is made. Raises Denied, JournalUnavailable."""
        if self.mode == "alone":
            raise Denied(409, NoPeopleHere())
        self._try(address)
        async with self._changing:
            if self._people:
                raise Denied(409, FirstAdminExists())
            if self._first_code is None or not hmac.compare_digest(self._first_code, digest(typed(code))):
                raise Denied(403, CodeUnusable("unknown"))
            person = await self._new_person(name, password, "pilot", True)
            secret, session = self._new_session(person, address, device)
            await self._change(new=(person, session))
            self._first_code = None
            self._people[person.person_id] = person
            self._enter(session)
        self._good_try(address)
        return secret

    async def sign_in(self, name: str, password: str, address: str, device: str) -> str:
        """The new session's secret: never one that was there before. Raises Denied, JournalUnavailable."""
        if self.mode == "alone":
            raise Denied(409, NoPeopleHere())
        now_s, key = self._monotonic_s(), key_of(name)
        person = self.named(name)
        wait_s = self.limits.names.wait_s(key, now_s)
        if wait_s > 0 or self._signing_in >= WAITING_SIGN_INS:
            raise Denied(429, TooManyTries(max(wait_s, 1.0)))
        self._try(address)
        self.limits.names.take(key, now_s)
        self._signing_in += 1
        try:
            fits = await self._passwords.fits(password, None if person is None else person.password_hash)
        finally:
            self._signing_in -= 1
        async with self._changing:
            now = None if person is None else self._people.get(person.person_id)
            if not fits or now is None or not now.active or now.password_hash != (person and person.password_hash):
                raise Denied(403, WrongNameOrPassword())
            secret, session = self._new_session(now, address, device)
            crowd = sorted(self._sessions_of(now.person_id), key=lambda entry: entry.seen_s)[: -SESSIONS_EACH + 1]
            await self._change(new=(session,), gone=[entry.row for entry in crowd])
            for entry in crowd:
                self._end(entry)
            self._enter(session)
        self._good_try(address)
        self.limits.names.give_back(key, now_s)
        return secret

    def look_at_invitation(self, code: str, address: str) -> Invitation:
        """Raises Denied."""
        self._try(address)
        invitation = self._usable(code)
        self._good_try(address)
        return invitation

    async def accept_invitation(self, code: str, name: str, password: str, address: str, device: str) -> str:
        """The new person's session. Each invitation makes one account. Raises Denied, JournalUnavailable."""
        self._try(address)
        async with self._changing:
            invitation = self._usable(code)
            person = await self._new_person(name, password, invitation.role, invitation.admin)
            self._usable(code)  # the hash took its time
            used = replace(invitation, used_by=person.person_id)
            secret, session = self._new_session(person, address, device)
            await self._change(new=(person, session), now=(used,))
            self._invitations[invitation.secret_hash] = (used, self._invitations[invitation.secret_hash][1])
            self._people[person.person_id] = person
            self._enter(session)
        self._good_try(address)
        return secret

    def _usable(self, code: str) -> Invitation:
        found = self._invitations.get(digest(code.strip()))
        if found is None:
            raise Denied(403, CodeUnusable("unknown"))
        invitation, until_s = found
        if invitation.used_by is not None:
            raise Denied(403, CodeUnusable("used"))
        if self._monotonic_s() >= until_s:
            raise Denied(403, CodeUnusable("expired"))
        return invitation

    def _try(self, address: str) -> None:
        """Taken before, given back after: tries that run side by side count too."""
        now_s, key = self._monotonic_s(), neighbourhood(address)
        wait_s = self.limits.addresses.wait_s(key, now_s)
        self.limits.addresses.take(key, now_s)
        if wait_s > 0:
            raise Denied(429, TooManyTries(wait_s))

    def _good_try(self, address: str) -> None:
        self.limits.addresses.give_back(neighbourhood(address), self._monotonic_s())

    async def _new_person(self, name: str, password: str, role: Role, admin: bool) -> Person:
        shown = " ".join(name.split())
        if any(person.name_key == key_of(shown) for person in self._people.values()):
            raise Denied(409, NameTaken(shown))
        if (weak := weakness(password, shown)) is not None:
            raise Denied(422, weak)
        hashed = await self._passwords.hashed(password)
        return Person(new_id(), shown, key_of(shown), role, admin, True, hashed, self._now_us())

    def _new_session(self, person: Person, address: str, device: str) -> tuple[str, Session]:
        secret, now_us = new_secret(), self._now_us()
        session = Session(new_id(), digest(secret), person.person_id, now_us, now_us, address[:64], device[:200])
        return secret, session

    def _enter(self, session: Session) -> None:
        now_s = self._monotonic_s()
        self._sessions[session.secret_hash] = Entry(session, now_s, now_s, now_s)

    # One's own account, and people

    def sessions_of(self, person_id: str) -> list[Session]:
        """That last, the newest first."""
        rows = [entry.row for entry in self._sessions_of(person_id) if self.lasts(entry)]
        return sorted(rows, key=lambda row: -row.made_at_us)

    def last_seen_s(self, session: Session) -> float:
        """Seconds since it was used last."""
        return max(0.0, self._monotonic_s() - self._sessions[session.secret_hash].seen_s)

    async def end_session(self, person_id: str, session_id: str) -> None:
        """Of this person. Ended at once, whatever the database says. Raises Denied 404, JournalUnavailable."""
        found = [entry for entry in self._sessions_of(person_id) if entry.row.session_id == session_id]
        if not found:
            raise Denied(404, NothingThere("session", session_id))
        await self._end_all(found)

    async def end_sessions(self, person_id: str) -> None:
        """Signed out everywhere."""
        await self._end_all(list(self._sessions_of(person_id)))

    async def change_password(self, person_id: str, old: str, new: str, address: str) -> None:
        """All sessions end. Raises Denied, JournalUnavailable."""
        self._try(address)
        person = self.person(person_id)
        if not await self._passwords.fits(old, person.password_hash):
            raise Denied(403, WrongNameOrPassword())
        if (weak := weakness(new, person.name)) is not None:
            raise Denied(422, weak)
        hashed = await self._passwords.hashed(new)
        async with self._changing:
            now = replace(self.person(person_id), password_hash=hashed)
            await self._change(now=(now,))
            self._people[person_id] = now
        self._good_try(address)
        await self.end_sessions(person_id)

    async def change_person(self, person_id: str, role: Role, admin: bool, active: bool) -> Person:
        """Who is shut out is signed out at once. Raises Denied, JournalUnavailable."""
        async with self._changing:
            before = self.person(person_id)
            now = replace(before, role=role, admin=admin, active=active)
            others = any(p.admin and p.active for p in self._people.values() if p.person_id != person_id)
            if before.admin and before.active and not (admin and active) and not others:
                raise Denied(409, LastAdmin())
            await self._change(now=(now,))
            self._people[person_id] = now
        if not active:
            await self.end_sessions(person_id)
        return now

    @property
    def invitations(self) -> list[tuple[Invitation, float]]:
        """That wait to be used, each with the seconds it still has; the newest first."""
        now_s = self._monotonic_s()
        waiting = [(row, until_s - now_s) for row, until_s in self._invitations.values() if row.used_by is None]
        return sorted(waiting, key=lambda pair: -pair[0].made_at_us)

    async def invite(self, role: Role, admin: bool, lasts_s: float, by: str) -> tuple[str, Invitation]:
        """The secret of its link, which is shown once. Raises JournalUnavailable."""
        secret, now_us = new_secret(), self._now_us()
        until_us = now_us + int(lasts_s * 1e6)
        invitation = Invitation(new_id(), digest(secret), role, admin, by, now_us, until_us, None)
        await self._change(new=(invitation,))
        self._invitations[invitation.secret_hash] = (invitation, self._monotonic_s() + lasts_s)
        return secret, invitation

    async def take_back_invitation(self, invitation_id: str) -> None:
        """Raises Denied 404, JournalUnavailable."""
        async with self._changing:
            found = next((row for row, _ in self._invitations.values() if row.invitation_id == invitation_id), None)
            if found is None or found.used_by is not None:
                raise Denied(404, NothingThere("invitation", invitation_id))
            del self._invitations[found.secret_hash]
            await self._change(gone=(found,))

    @property
    def tokens(self) -> list[MachineToken]:
        """The newest first."""
        return sorted((entry.row for entry in self._tokens.values()), key=lambda row: -row.made_at_us)

    async def make_token(self, name: str, scope: Scope, lasts_s: float | None, by: str) -> tuple[str, MachineToken]:
        """The secret, which is shown once. Raises JournalUnavailable."""
        secret, now_us = new_secret(), self._now_us()
        until_us = None if lasts_s is None else now_us + int(lasts_s * 1e6)
        token = MachineToken(new_id(), digest(secret), name, scope, by, now_us, until_us)
        await self._change(new=(token,))
        now_s = self._monotonic_s()
        self._tokens[token.secret_hash] = Entry(token, now_s, now_s, now_s)
        return secret, token

    async def revoke_token(self, token_id: str) -> None:
        """At once. Raises Denied 404, JournalUnavailable."""
        found = next((entry for entry in self._tokens.values() if entry.row.token_id == token_id), None)
        if found is None:
            raise Denied(404, NothingThere("token", token_id))
        found.ended.set()
        del self._tokens[found.row.secret_hash]
        await self._change(gone=(found.row,))

    # Commands

    def command_wait_s(self, principal: Principal) -> float:
        """Seconds that whoever had too many commands refused has to wait."""
        return self.limits.refused_commands.wait_s(principal.person or principal.name, self._monotonic_s())

    def command_refused(self, principal: Principal) -> None:
        """One of theirs was."""
        self.limits.refused_commands.take(principal.person or principal.name, self._monotonic_s())

    def notes_refusal(self) -> bool:
        """Does the audit log take another refused request now?"""
        now_s = self._monotonic_s()
        if self.limits.noted_refusals.wait_s("all", now_s) > 0:
            return False
        self.limits.noted_refusals.take("all", now_s)
        return True

    async def close(self) -> None:
        """What waits is written."""
        await asyncio.gather(*self._writing, return_exceptions=True)
        await self.audit.close()
        if self._records is not None:
            await self._records.close()

    def _sessions_of(self, person_id: str) -> Iterable[Entry[Session]]:
        return [entry for entry in self._sessions.values() if entry.row.person_id == person_id]

    def _end(self, entry: Entry[Session]) -> None:
        entry.ended.set()
        self._sessions.pop(entry.row.secret_hash, None)

    async def _end_all(self, entries: list[Entry[Session]]) -> None:
        for entry in entries:
            self._end(entry)
        await self._change(gone=[entry.row for entry in entries])

    async def _change(self, **changes: Iterable[Person | Session | Invitation | MachineToken]) -> None:
        if self._records is not None:
            await self._records.change(**{name: tuple(rows) for name, rows in changes.items()})

    async def _write_quietly(self, row: Session) -> None:
        try:
            await self._change(now=(row,))
        except JournalUnavailable as error:
            log.info("the last use of a session was not written down: %s", error)

    def _now_us(self) -> int:
        return int(self._wall_s() * 1e6)
