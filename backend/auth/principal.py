"""Who asks: a person who is signed in, a machine with a token, or the one person of a server without accounts."""

from __future__ import annotations

from dataclasses import dataclass

from backend.commands import Author
from backend.permissions import Need, Role, Scope, at_least
from backend.reasons.access import RoleTooLow


@dataclass(frozen=True, slots=True)
class Principal:
    """name: written into the facts as `by`. person, session: ids, None of a machine and where there are no accounts.

    role None: a machine, or the local person, who may do everything (local). address: where the request came from.
    """

    name: str
    role: Role | None = None
    admin: bool = False
    scope: Scope | None = None
    person: str | None = None
    session: str | None = None
    address: str | None = None
    local: bool = False

    @property
    def author(self) -> Author:
        """As the missions know whoever gives a command."""
        return Author(self.name, self.person, self.role, self.address)

    def refused(self, need: Need) -> RoleTooLow | None:
        """Why the call is not theirs to make, None when it is."""
        if need.anyone or self.local:
            return None
        if self.role is None:
            return None if need.scope is not None and need.scope == self.scope else _too_low(need, None)
        if need.role is None or not at_least(self.role, need.role):
            return _too_low(need, self.role)
        return RoleTooLow("admin", self.role) if need.admin and not self.admin else None


def _too_low(need: Need, role: Role | None) -> RoleTooLow:
    return RoleTooLow("admin" if need.admin or need.role is None else need.role, role)


def local_person(address: str | None) -> Principal:
    """Whoever sits before a server that listens to its own machine only and has no accounts."""
    return Principal("operator", address=address, local=True)
