"""What the claims of a sign-in provider make of somebody here: a name, a role, nothing unless a setting says so."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal, cast

from backend.auth.keeping import Denied
from backend.permissions import ROLES, Role
from backend.reasons.access import ProviderRefused

UNDER_WAY_S = 600.0
"""For a sign-in at the provider."""
NAME_MOST = 40
SUBJECT_MOST = 255
"""OpenID Connect Core 2: a subject has at most 255 characters."""


@dataclass(frozen=True, slots=True)
class Rules:
    """roles: value of the claim `role_claim` -> role here, or "admin". default None: who has no such value stays out.

    email_domains: when there are any, only a verified address in one of them enters.
    """

    role_claim: str | None = None
    roles: Mapping[str, Role | Literal["admin"]] | None = None
    default: Role | None = "viewer"
    email_domains: tuple[str, ...] = ()

    @property
    def gives_roles(self) -> bool:
        """Does the provider say at each sign-in what the role is? Else it stays as an admin has set it here."""
        return self.role_claim is not None and bool(self.roles)

    @property
    def gives_admin(self) -> bool:
        """Does it say who manages people, too?"""
        return self.gives_roles and "admin" in (self.roles or {}).values()


@dataclass(frozen=True, slots=True)
class Provided:
    """Somebody as the provider's signed token names them. names: to be called by, the best first."""

    issuer: str
    subject: str
    names: tuple[str, ...]
    role: Role | None
    admin: bool


def provided(issuer: str, claims: Mapping[str, Any], rules: Rules) -> Provided:
    """role None: nothing in the claims gives one, and there is no default. Raises Denied 403."""
    subject = claims.get("sub")
    if not isinstance(subject, str) or not 0 < len(subject) <= SUBJECT_MOST:
        raise Denied(403, ProviderRefused("answer"))
    email = _verified_email(claims)
    if rules.email_domains and (email is None or _domain(email) not in rules.email_domains):
        raise Denied(403, ProviderRefused("email"))
    role, admin = _role(claims, rules)
    offered = (claims.get("name"), claims.get("preferred_username"), email)
    names = tuple(name for name in map(_printable, offered) if name)
    return Provided(issuer, subject, names or ("somebody",), role, admin)


def free_name(names: tuple[str, ...], taken: frozenset[str], key: Any) -> str:
    """The first that nobody here has, else the first with a number. taken: keys of names; key: makes one."""
    for name in names:
        if key(name) not in taken:
            return name
    number = 2
    while key(name := f"{names[0][: NAME_MOST - 6].rstrip()} {number}") in taken:
        number += 1
    return name


def _role(claims: Mapping[str, Any], rules: Rules) -> tuple[Role | None, bool]:
    if not rules.gives_roles or rules.role_claim is None or rules.roles is None:
        return rules.default, False
    given = {rules.roles[value] for value in _values(claims, rules.role_claim) if value in rules.roles}
    admin = "admin" in given
    best = rules.default
    for role in ROLES:  # the highest that is given
        best = role if role in given else best
    return ("viewer" if best is None and admin else best), admin


def _values(claims: Mapping[str, Any], path: str) -> list[str]:
    """Of a claim, or of one inside another (realm_access.roles); whatever is no text is none."""
    found: Any = claims
    for part in (path,) if path in claims else path.split("."):
        found = cast("Mapping[str, Any]", found).get(part) if isinstance(found, Mapping) else None
    several = cast("list[Any]", found) if isinstance(found, list) else [found]
    return [value for value in several if isinstance(value, str)]


def _verified_email(claims: Mapping[str, Any]) -> str | None:
    """Only what the provider has verified: anybody can type an address."""
    email = claims.get("email")
    return email if isinstance(email, str) and claims.get("email_verified") is True else None


def _domain(email: str) -> str:
    return email.rpartition("@")[2].lower()


def _printable(name: Any) -> str:
    if not isinstance(name, str):
        return ""
    return " ".join("".join(letter if letter.isprintable() else " " for letter in name).split())[:NAME_MOST].rstrip()
