"""People on the wire: who is signed in, who there is, invitations, machines' tokens. No secret but the new ones."""

from __future__ import annotations

from datetime import datetime
from typing import Annotated, Literal

from pydantic import AfterValidator, Field

from backend.names import seen
from backend.permissions import Role, Scope
from backend.spec import Model

Name = Annotated[str, Field(min_length=1, max_length=40, pattern=r"^[^\x00-\x1f\x7f]*\S[^\x00-\x1f\x7f]*$")]
NewName = Annotated[Name, AfterValidator(seen)]
"""Of an account or a token: no list shows it as nothing, or as something else than it is."""
Password = Annotated[str, Field(min_length=1, max_length=200)]
Code = Annotated[str, Field(min_length=1, max_length=100)]


class SignedIn(Model):
    """Whoever the page is signed in as. has_password False: they enter through the sign-in provider only."""

    person_id: str
    name: str
    role: Role
    admin: bool
    has_password: bool


class SessionState(Model):
    """mode alone: one person before their own machine, no sign-in; waiting: for the first admin; people: sign in.

    person None: nobody is signed in. encrypted False: passwords are refused here, see NotEncrypted. provider: name of
    the sign-in provider, None where there is none.
    """

    mode: Literal["alone", "waiting", "people"]
    person: SignedIn | None
    encrypted: bool
    provider: str | None


class SignIn(Model):
    """With a password."""

    name: Name
    password: Password


class FirstAdmin(Model):
    """code: as the server printed it when it started."""

    code: Code
    name: NewName
    password: Password


class InvitationCode(Model):
    """The secret out of an invitation's link."""

    code: Code


class InvitationOffer(Model):
    """What whoever accepts becomes."""

    role: Role
    admin: bool
    expires_utc: datetime


class InvitationAnswer(Model):
    """Makes the account."""

    code: Code
    name: NewName
    password: Password


class LostPassword(Model):
    """code: as `crossfix recover` printed it. password: the new one."""

    code: Code
    password: Password


class OpenSession(Model):
    """device: what its browser says of itself. own: the one that asks."""

    session_id: str
    address: str
    device: str
    made_utc: datetime
    idle_s: float
    own: bool


class SessionList(Model):
    """The newest first."""

    sessions: list[OpenSession]


class NewPassword(Model):
    """All other sessions end with it."""

    old: Password
    new: Password


class Person(Model):
    """sessions: how many are open. active False: shut out."""

    person_id: str
    name: str
    role: Role
    admin: bool
    active: bool
    sessions: int


class PersonList(Model):
    """By name."""

    people: list[Person]


class PersonChange(Model):
    """Everything that can be changed of a person."""

    role: Role
    admin: bool
    active: bool


class NewInvitation(Model):
    """hours: how long it waits to be accepted."""

    role: Role
    admin: bool = False
    hours: Annotated[int, Field(ge=1, le=168)] = 24


class Invitation(Model):
    """One that waits."""

    invitation_id: str
    role: Role
    admin: bool
    made_by: str
    expires_utc: datetime


class MadeInvitation(Model):
    """link and its QR code (an image as a data address) are shown this once."""

    invitation: Invitation
    link: str
    qr: str


class InvitationList(Model):
    """Those that wait, the newest first."""

    invitations: list[Invitation]


class NewToken(Model):
    """days None: until it is revoked."""

    name: NewName
    scope: Scope
    days: Annotated[int, Field(ge=1, le=3650)] | None = None


class Token(Model):
    """Of a machine."""

    token_id: str
    name: str
    scope: Scope
    made_by: str
    made_utc: datetime
    expires_utc: datetime | None


class MadeToken(Model):
    """secret: shown this once."""

    token: Token
    secret: str


class TokenList(Model):
    """The newest first."""

    tokens: list[Token]
