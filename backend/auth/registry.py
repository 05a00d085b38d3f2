"""Who there is: people, their sessions, invitations, and machines with a token. Plain data, one class a table.

Secrets are random and long, so a plain digest keeps them; only passwords, which people choose, need argon2.
"""

from __future__ import annotations

import hashlib
import secrets
import unicodedata
from dataclasses import dataclass
from uuid import uuid4

from backend.names import without_unseen
from backend.permissions import Role, Scope

ALPHABET = "ABCDEFGHJKMNPQRSTVWXYZ23456789"
"""Of codes that people type: nothing that looks like something else."""
CODE_GROUPS, CODE_GROUP = 4, 4
"""30^16 codes: 78 bits."""


@dataclass(frozen=True, slots=True)
class Person:
    """name_key: see key_of. active False: shut out, and kept for the journal's sake. password_hash "": they have none.

    issuer, subject: who they are at the sign-in provider, None of whoever never came from there.
    """

    person_id: str
    name: str
    name_key: str
    role: Role
    admin: bool
    active: bool
    password_hash: str
    made_at_us: int
    issuer: str | None = None
    subject: str | None = None


@dataclass(frozen=True, slots=True)
class Session:
    """device: what the browser says of itself. Times: UTC microseconds."""

    session_id: str
    secret_hash: str
    person_id: str
    made_at_us: int
    seen_at_us: int
    address: str
    device: str


@dataclass(frozen=True, slots=True)
class Invitation:
    """used_by: the account that it made, None while it waits."""

    invitation_id: str
    secret_hash: str
    role: Role
    admin: bool
    made_by: str
    made_at_us: int
    expires_at_us: int
    used_by: str | None


@dataclass(frozen=True, slots=True)
class MachineToken:
    """expires_at_us None: never."""

    token_id: str
    secret_hash: str
    name: str
    scope: Scope
    made_by: str
    made_at_us: int
    expires_at_us: int | None


def new_id() -> str:
    """Of a row; no secret."""
    return uuid4().hex


def new_secret() -> str:
    """256 bits, for cookies, links and tokens."""
    return secrets.token_urlsafe(32)


def new_code() -> str:
    """For the first admin, typed from a terminal."""
    groups = ("".join(secrets.choice(ALPHABET) for _ in range(CODE_GROUP)) for _ in range(CODE_GROUPS))
    return "-".join(groups)


def typed(code: str) -> str:
    """As it was meant: without blanks, in capitals."""
    return "".join(code.split()).upper()


def digest(secret: str) -> str:
    """What is stored of a secret, and what it is found by."""
    return hashlib.sha256(secret.encode()).hexdigest()


def key_of(name: str) -> str:
    """Names that look alike are one: compatibility forms, case and blanks make no difference."""
    return " ".join(unicodedata.normalize("NFKC", name).casefold().split())


def shown_key(name: str) -> str:
    """As key_of, without the letters that are not shown: a name that differs by those alone looks the same."""
    return key_of(without_unseen(name))
