"""Who may enter, and how: the first admin, a password, an invitation, a sign-in provider, a code after a lost password.

The registers hold who there is and what lets them in; what changes more than one of them at a time stands here.
"""

from __future__ import annotations

import hmac
import time
from collections.abc import Callable, Iterable
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Literal

from backend.auth.audit import AuditLog
from backend.auth.invitations import Invitations
from backend.auth.keeping import Denied, Keeping
from backend.auth.limits import Limits, too_many
from backend.auth.machines import Machines
from backend.auth.passwords import Passwords, weakness
from backend.auth.people import People
from backend.auth.principal import Principal
from backend.auth.provided import Provided, Rules, free_name
from backend.auth.records import Records, RowThere
from backend.auth.recovery import take_recovery, use_up_recovery
from backend.auth.registry import Invitation, Person, Session, digest, key_of, new_code, new_id, shown_key, typed
from backend.auth.sessions import Entry, Sessions
from backend.permissions import Role
from backend.ports import JournalUnavailable
from backend.reasons.access import (
    CodeUnusable,
    FirstAdminExists,
    NameTaken,
    NoPasswordHere,
    NoPeopleHere,
    ProviderRefused,
    WrongNameOrPassword,
)

Mode = Literal["alone", "waiting", "people"]
"""alone: one person before their own machine, no sign-in. waiting: for the first admin. people: whoever signs in."""

WAITING_SIGN_INS = 20
"""More at once wait for nothing: they are refused."""


@dataclass(frozen=True, slots=True)
class Visit:
    """Where somebody enters from. device: what the browser says of itself."""

    address: str
    device: str


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
        data_dir: Path | None = None,
        wall_s: Callable[[], float] = time.time,
        monotonic_s: Callable[[], float] = time.monotonic,
    ) -> None:
        """data_dir: where codes for lost passwords come from; None: from nowhere."""
        self._keeping = Keeping(records, wall_s, monotonic_s)
        self.audit = audit
        self.limits = Limits(monotonic_s)
        self.people = People(self._keeping)
        self.sessions = Sessions(self._keeping)
        self.invitations = Invitations(self._keeping)
        self.machines = Machines(self._keeping, self.limits, payload_tokens)
        self._people_expected = people_expected
        self._passwords = passwords or Passwords()
        self._data_dir = data_dir
        self._first_code: str | None = None
        self._signing_in = 0

    async def load(self) -> None:
        """Once, before the first request. Raises JournalUnavailable."""
        if self._keeping.records is None:
            return
        stored = await self._keeping.records.load()
        self.people.load(stored.people)
        self.sessions.load(stored.sessions)
        self.machines.load(stored.tokens)
        self.invitations.load(stored.invitations)

    async def close(self) -> None:
        """What waits is written."""
        await self.audit.close()
        await self._keeping.close()

    @property
    def mode(self) -> Mode:
        """Once there are people, there is no way back."""
        if self.people.by_name:
            return "people"
        return "waiting" if self._people_expected else "alone"

    def signed_in(self, secret: str, address: str | None) -> tuple[Principal, Entry[Session]] | None:
        """By the cookie's secret. None: nobody, or no longer."""
        entry = self.sessions.found(secret)
        person = None if entry is None else self.people.get(entry.row.person_id)
        if entry is None or person is None or not person.active:
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

    # Entering: each returns the secret of the new session, never one that was there before

    def begin_first_admin(self) -> str | None:
        """A new code for the first admin, to be printed; None when there is nobody to be made."""
        if self.mode != "waiting":
            return None
        code = new_code()
        self._first_code = digest(code)
        return code

    async def make_first_admin(self, code: str, name: str, password: str, visit: Visit) -> str:
        """Of two who try at once, one is made. Raises Denied, JournalUnavailable."""
        if self.mode == "alone":
            raise Denied(409, NoPeopleHere())
        self.limits.take_try(visit.address)
        async with self._keeping.changing:
            await self._settle()
            if self.mode == "people":
                raise Denied(409, FirstAdminExists())
            if self._first_code is None or not hmac.compare_digest(self._first_code, digest(typed(code))):
                raise Denied(403, CodeUnusable("unknown"))
            person = await self._new_person(name, password, "pilot", True)
            secret = await self._new_with_session(person, visit)
            self._first_code = None
        self.limits.give_back_try(visit.address)
        return secret

    async def sign_in(self, name: str, password: str, visit: Visit) -> str:
        """Raises Denied, JournalUnavailable."""
        if self.mode == "alone":
            raise Denied(409, NoPeopleHere())
        now_s, key = self._keeping.monotonic_s(), shown_key(name)
        wait_s = self.limits.names.wait_s(key, now_s)
        if wait_s > 0 or self._signing_in >= WAITING_SIGN_INS:
            raise too_many(max(wait_s, 1.0))
        self.limits.take_try(visit.address)
        self.limits.names.take(key, now_s)
        self._signing_in += 1
        try:
            await self._settle_apart()
            person = self.people.named(name)
            fits = await self._passwords.fits(password, None if person is None else person.password_hash)
        finally:
            self._signing_in -= 1
        async with self._keeping.changing:
            now = None if person is None else self.people.get(person.person_id)
            if not fits or now is None or not now.active or now.password_hash != (person and person.password_hash):
                raise Denied(403, WrongNameOrPassword())
            secret = await self._new_session(now, visit)
        self.limits.give_back_try(visit.address)
        self.limits.names.give_back(key, now_s)
        return secret

    def look_at_invitation(self, code: str, address: str) -> Invitation:
        """Raises Denied."""
        self.limits.take_try(address)
        invitation = self._usable(code)
        self.limits.give_back_try(address)
        return invitation

    def stands(self, invitation: Invitation) -> bool:
        """Not when whoever made it was shut out since, or no longer manages people."""
        maker = self.people.get(invitation.made_by)
        return maker is None or (maker.active and maker.admin)

    def _usable(self, code: str) -> Invitation:
        invitation = self.invitations.usable(code)
        if not self.stands(invitation):
            raise Denied(403, CodeUnusable("unknown"))
        return invitation

    async def accept_invitation(self, code: str, name: str, password: str, visit: Visit) -> str:
        """Each invitation makes one account. Raises Denied, JournalUnavailable."""
        self.limits.take_try(visit.address)
        async with self._keeping.changing:
            await self._settle()
            invitation = self._usable(code)
            person = await self._new_person(name, password, invitation.role, invitation.admin)
            self._usable(code)  # the hash took its time
            used = replace(invitation, used_by=person.person_id)
            secret = await self._new_with_session(person, visit, used)
            self.invitations.use(used)
        self.limits.give_back_try(visit.address)
        return secret

    async def enter_provided(self, found: Provided, rules: Rules, visit: Visit) -> str:
        """Whoever the sign-in provider names: known by issuer and subject, else made. Raises Denied,
        JournalUnavailable."""
        if self.mode != "people":
            raise Denied(409, NoPeopleHere())
        async with self._keeping.changing:
            await self._settle()
            before = self.people.provided(found.issuer, found.subject)
            if before is not None and not before.active:
                raise Denied(403, ProviderRefused("shut_out"))
            if found.role is None:
                if before is not None:
                    await self.sessions.end_all(before.person_id)
                raise Denied(403, ProviderRefused("role"))
            if before is None:
                return await self._new_with_session(self._new_provided(found, found.role), visit)
            role = found.role if rules.gives_roles else before.role
            admin = found.admin if rules.gives_admin else before.admin
            admin = admin or (before.admin and self.people.only_admin(before.person_id))
            now = replace(before, role=role, admin=admin)
            secret = await self._new_session(now, visit, changed=now != before)
            self.people.put(now)
        return secret

    async def recover(self, code: str, password: str, visit: Visit) -> str:
        """With a code of `crossfix recover`, once: a new password, let in again; all other sessions end. Raises Denied,
        JournalUnavailable."""
        self.limits.take_try(visit.address)
        if self._data_dir is None or self.mode != "people":
            raise Denied(403, CodeUnusable("unknown"))
        async with self._keeping.changing:
            await self._settle()
            found = take_recovery(self._data_dir, code, self._keeping.wall_s())
            before = self.people.known(found.person_id)
            hashed = await self._good_password(password, before.name)
            now = replace(before, password_hash=hashed, active=True, admin=before.admin or found.admin)
            with use_up_recovery(self._data_dir):
                await self._keeping.change(now=(now,))
            self.people.put(now)
            await self.sessions.end_all(now.person_id)
            secret = await self._new_session(now, visit)
        self.limits.give_back_try(visit.address)
        return secret

    # Of one's own, and of others

    async def change_password(self, person_id: str, old: str, new: str, address: str, session_id: str | None) -> None:
        """All sessions but the one that asks end. Raises Denied, JournalUnavailable."""
        await self._settle_apart()
        person = self.people.known(person_id)
        if not person.password_hash:
            raise Denied(409, NoPasswordHere())
        self.limits.take_try(address)
        if not await self._passwords.fits(old, person.password_hash):
            raise Denied(403, WrongNameOrPassword())
        hashed = await self._good_password(new, person.name)
        async with self._keeping.changing:
            latest = self.people.known(person_id)
            if latest.password_hash != person.password_hash:  # it was changed elsewhere meanwhile
                raise Denied(403, WrongNameOrPassword())
            now = replace(latest, password_hash=hashed)
            await self._keeping.change(now=(now,))
            self.people.put(now)
        self.limits.give_back_try(address)
        await self.sessions.end_all(person_id, but=session_id)

    async def change_person(self, person_id: str, role: Role, admin: bool, active: bool) -> Person:
        """Who is shut out is signed out at once. Raises Denied, JournalUnavailable."""
        await self._settle_apart()
        now = await self.people.change(person_id, role, admin, active)
        if not active:
            await self.sessions.end_all(person_id)
        return now

    async def _new_person(self, name: str, password: str, role: Role, admin: bool) -> Person:
        shown = " ".join(name.split())
        self.people.require_free(shown)
        hashed = await self._good_password(password, shown)
        return Person(new_id(), shown, key_of(shown), role, admin, True, hashed, self._keeping.now_us())

    def _new_provided(self, found: Provided, role: Role) -> Person:
        taken = frozenset(shown_key(person.name) for person in self.people.by_name)
        name, made_us = free_name(found.names, taken, shown_key), self._keeping.now_us()
        return Person(new_id(), name, key_of(name), role, found.admin, True, "", made_us, found.issuer, found.subject)

    async def _good_password(self, password: str, name: str) -> str:
        if (weak := weakness(password, name)) is not None:
            raise Denied(422, weak)
        return await self._passwords.hashed(password)

    async def _new_with_session(self, person: Person, visit: Visit, *used: Invitation) -> str:
        secret, session = self.sessions.made(person.person_id, visit.address, visit.device)
        try:
            await self._keeping.change(new=(person, session), now=used)
        except RowThere as error:
            raise Denied(409, NameTaken(person.name)) from error
        self.people.put(person)
        self.sessions.enter(session)
        return secret

    async def _settle(self) -> None:
        """What was not heard of in time may be stored all the same, as an account with its invitation, or a password:
        it counts from now on, and whom it shuts out or gives a new password is signed out. Raises JournalUnavailable.
        """
        if not self._keeping.in_doubt or self._keeping.records is None:
            return
        stored = await self._keeping.records.load(settled=True)
        before = [(person, self.people.get(person.person_id)) for person in stored.people]
        self.people.load(stored.people)
        self.invitations.learn(stored.invitations)
        self._keeping.in_doubt = False
        for person, known in before:
            if known is not None and (not person.active or person.password_hash != known.password_hash):
                with suppress(JournalUnavailable):  # they have ended, and the database hears of it
                    await self.sessions.end_all(person.person_id)

    async def _settle_apart(self) -> None:
        """For whoever does not hold the registers. Raises JournalUnavailable."""
        if self._keeping.in_doubt:
            async with self._keeping.changing:
                await self._settle()

    async def _new_session(self, person: Person, visit: Visit, *, changed: bool = False) -> str:
        """changed: the person is written down as well."""
        secret, session = self.sessions.made(person.person_id, visit.address, visit.device)
        crowd = self.sessions.crowd(person.person_id)
        now = (person,) if changed else ()
        await self._keeping.change(new=(session,), now=now, gone=[entry.row for entry in crowd])
        self.sessions.forget(crowd)
        self.sessions.enter(session)
        return secret
