"""Who there is, and what each may do."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from backend.auth.keeping import Denied, Keeping
from backend.auth.registry import Person, key_of, shown_key
from backend.permissions import Role, at_least
from backend.reasons.access import LastAdmin, NameTaken
from backend.reasons.request import NothingThere


class People:
    """By id. Nobody is ever removed: the journal names them."""

    def __init__(self, keeping: Keeping) -> None:
        self._keeping = keeping
        self._all: dict[str, Person] = {}

    def load(self, rows: Iterable[Person]) -> None:
        """As the last run left them."""
        self._all = {person.person_id: person for person in rows}

    @property
    def by_name(self) -> list[Person]:
        """Everybody."""
        return sorted(self._all.values(), key=lambda person: person.name_key)

    def get(self, person_id: str) -> Person | None:
        """None: unknown."""
        return self._all.get(person_id)

    def known(self, person_id: str) -> Person:
        """Raises Denied 404."""
        found = self._all.get(person_id)
        if found is None:
            raise Denied(404, NothingThere("person", person_id))
        return found

    def named(self, name: str) -> Person | None:
        """Also without the letters that are not shown, which Persian and Hindi names have, where that names one person.
        None: nobody is called so."""
        found = next((person for person in self._all.values() if person.name_key == key_of(name)), None)
        if found is not None:
            return found
        alike = [person for person in self._all.values() if shown_key(person.name) == shown_key(name)]
        return alike[0] if len(alike) == 1 else None

    def provided(self, issuer: str, subject: str) -> Person | None:
        """Whoever that is at the sign-in provider. Never by name or email, which others may give themselves there."""
        return next((p for p in self._all.values() if (p.issuer, p.subject) == (issuer, subject)), None)

    def require_free(self, name: str) -> None:
        """Raises Denied 409 where somebody's name looks the same."""
        if any(shown_key(person.name) == shown_key(name) for person in self._all.values()):
            raise Denied(409, NameTaken(name))

    def operates(self, person_id: str) -> bool:
        """May this person give commands now?"""
        person = self._all.get(person_id)
        return person is not None and person.active and at_least(person.role, "operator")

    def only_admin(self, person_id: str) -> bool:
        """Nobody else could manage people."""
        return not any(p.admin and p.active for p in self._all.values() if p.person_id != person_id)

    def put(self, person: Person) -> None:
        """As they are from now on; the database has it already."""
        self._all[person.person_id] = person

    async def change(self, person_id: str, role: Role, admin: bool, active: bool) -> Person:
        """Raises Denied, JournalUnavailable."""
        async with self._keeping.changing:
            before = self.known(person_id)
            now = replace(before, role=role, admin=admin, active=active)
            if before.admin and before.active and not (admin and active) and self.only_admin(person_id):
                raise Denied(409, LastAdmin())
            await self._keeping.change(now=(now,))
            self.put(now)
        return now
