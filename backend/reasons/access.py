"""Why somebody is not let in, or may not do what they ask."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

from planner.reason import Words


@dataclass(frozen=True, slots=True)
class SignInNeeded:
    code: Literal["sign_in_needed"] = "sign_in_needed"
    english: ClassVar[Words] = Words("Nobody is signed in here, or the session has ended.", "Sign in.")


@dataclass(frozen=True, slots=True)
class FirstAdminNeeded:
    code: Literal["first_admin_needed"] = "first_admin_needed"
    english: ClassVar[Words] = Words(
        "This server has no people yet, so it does nothing for anybody.",
        "Open its page and make the first admin with the code that the server printed when it started.",
    )


@dataclass(frozen=True, slots=True)
class FirstAdminExists:
    code: Literal["first_admin_exists"] = "first_admin_exists"
    english: ClassVar[Words] = Words(
        "The first admin has been made; the code works once.", "Sign in, or ask an admin for an invitation."
    )


@dataclass(frozen=True, slots=True)
class NoPeopleHere:
    code: Literal["no_people_here"] = "no_people_here"
    english: ClassVar[Words] = Words(
        "This server listens to this machine only and has no accounts.",
        "To let others in, start it with --users, or with --host and an address of this machine.",
    )


@dataclass(frozen=True, slots=True)
class BehindProxy:
    code: Literal["behind_proxy"] = "behind_proxy"
    english: ClassVar[Words] = Words(
        "The request came through a proxy, and this server has no accounts.",
        "Start it with --users, and name the proxy in CROSSFIX_TRUSTED_PROXIES.",
    )


@dataclass(frozen=True, slots=True)
class RoleTooLow:
    """role: of who asks; None: a machine."""

    needed: Literal["viewer", "operator", "pilot", "admin"]
    role: Literal["viewer", "operator", "pilot"] | None
    code: Literal["role_too_low"] = "role_too_low"
    english: ClassVar[Words] = Words(
        "This takes {needed?viewer=a signed-in person|operator=an operator|pilot=a pilot|admin=an admin}; "
        "{role?viewer=a viewer|operator=an operator|pilot=a pilot|none=a machine's token} may not do it.",
        "Ask an admin for another role.",
    )


@dataclass(frozen=True, slots=True)
class CallNotListed:
    code: Literal["call_not_listed"] = "call_not_listed"
    english: ClassVar[Words] = Words(
        "Nobody may make this call: it is missing from the table of permissions.", "Report it; this is a fault of ours."
    )


@dataclass(frozen=True, slots=True)
class OriginMissing:
    code: Literal["origin_missing"] = "origin_missing"
    english: ClassVar[Words] = Words(
        "A signed-in page must say where it comes from, and this request did not.",
        "Use the page that this server serves; programs use a machine's token.",
    )


@dataclass(frozen=True, slots=True)
class NotEncrypted:
    code: Literal["not_encrypted"] = "not_encrypted"
    english: ClassVar[Words] = Words(
        "The connection is not encrypted: others on the network could read the password.",
        "Open the page by https:// through the proxy. On a network that encrypts by itself, set CROSSFIX_PLAIN_HTTP.",
    )


@dataclass(frozen=True, slots=True)
class WrongNameOrPassword:
    code: Literal["wrong_name_or_password"] = "wrong_name_or_password"
    english: ClassVar[Words] = Words("Name or password is wrong.", "Try again, or ask an admin for an invitation.")


@dataclass(frozen=True, slots=True)
class NoPasswordHere:
    code: Literal["no_password_here"] = "no_password_here"
    english: ClassVar[Words] = Words(
        "This account has no password here: it signs in through the sign-in provider.", "Change the password there."
    )


@dataclass(frozen=True, slots=True)
class NoProvider:
    code: Literal["no_provider"] = "no_provider"
    english: ClassVar[Words] = Words(
        "This server has no sign-in provider.", "Sign in with a name and a password, or set CROSSFIX_OIDC_ISSUER."
    )


@dataclass(frozen=True, slots=True)
class ProviderRefused:
    """What kept somebody out who came back from the sign-in provider."""

    fault: Literal["return", "refused", "away", "answer", "clock", "email", "role", "shut_out"]
    code: Literal["provider_refused"] = "provider_refused"
    english: ClassVar[Words] = Words(
        "{fault?return=The way back from the sign-in provider was used already, took longer than ten minutes, or began "
        "in another browser|refused=The sign-in provider did not sign you in|away=The sign-in provider does not answer|"
        "answer=The answer of the sign-in provider could not be accepted|clock=The sign-in provider and this server "
        "disagree about the time|email=Your email address is not verified, or not of a domain that may enter|"
        "role=The sign-in provider gives you no role here|shut_out=An admin has shut this account out}.",
        "{fault?return=Begin again on this page.|refused=Try again, or ask whoever runs the provider.|"
        "away=Try again later, or sign in with a password.|"
        "answer=Ask whoever runs this server: its log says what was wrong.|clock=Set the clock of this server.|"
        "email=Ask whoever runs the provider or this server.|"
        "role=Ask whoever runs the provider for a group that this server knows.|shut_out=Ask an admin.}",
    )


@dataclass(frozen=True, slots=True)
class TooManyTries:
    wait_s: float
    code: Literal["too_many_tries"] = "too_many_tries"
    english: ClassVar[Words] = Words("There were too many tries.", "Try again in {wait_s}.")


@dataclass(frozen=True, slots=True)
class CodeUnusable:
    """Of the first admin, of an invitation, or after a lost password."""

    fault: Literal["unknown", "used", "expired"]
    code: Literal["code_unusable"] = "code_unusable"
    english: ClassVar[Words] = Words(
        "This code {fault?unknown=is not known|used=has been used; each works once|expired=has expired}.",
        "{fault?unknown=Look whether it was copied whole.|*=Ask for a new one.}",
    )


@dataclass(frozen=True, slots=True)
class NameTaken:
    name: str
    code: Literal["name_taken"] = "name_taken"
    english: ClassVar[Words] = Words("Somebody here is called {name} already.", "Choose another name.")


@dataclass(frozen=True, slots=True)
class PasswordWeak:
    fault: Literal["short", "simple", "name"]
    least: int
    code: Literal["password_weak"] = "password_weak"
    english: ClassVar[Words] = Words(
        "The password {fault?short=is too short|simple=uses too few different characters|name=holds the name}.",
        "Take at least {least} characters; a few words that only you put together are best.",
    )


@dataclass(frozen=True, slots=True)
class LastAdmin:
    code: Literal["last_admin"] = "last_admin"
    english: ClassVar[Words] = Words("This is the last admin.", "Make somebody else admin first.")


@dataclass(frozen=True, slots=True)
class CommandIdReused:
    """command: the kind that the id belongs to."""

    command: str
    code: Literal["command_id_reused"] = "command_id_reused"
    english: ClassVar[Words] = Words(
        'This command id belongs to another order ("{command}") already; nothing was done.',
        "Send each order with an id of its own.",
    )


@dataclass(frozen=True, slots=True)
class ControlFree:
    code: Literal["control_free"] = "control_free"
    english: ClassVar[Words] = Words("Nobody controls this search.", "Take control first.")


@dataclass(frozen=True, slots=True)
class ControlHeld:
    name: str
    code: Literal["control_held"] = "control_held"
    english: ClassVar[Words] = Words(
        "{name} controls this search.", "Ask for control; a pilot can take it at once. Hold and abort need none."
    )


@dataclass(frozen=True, slots=True)
class ControlStale:
    code: Literal["control_stale"] = "control_stale"
    english: ClassVar[Words] = Words(
        "This order was given before control changed hands; nothing was done.",
        "Look at what is so now, then order again.",
    )


@dataclass(frozen=True, slots=True)
class ControlAskedAlready:
    name: str
    code: Literal["control_asked_already"] = "control_asked_already"
    english: ClassVar[Words] = Words("{name} has asked for control already.", "Wait for the answer.")


@dataclass(frozen=True, slots=True)
class ControlNotAsked:
    code: Literal["control_not_asked"] = "control_not_asked"
    english: ClassVar[Words] = Words("Nobody asks for control.")


@dataclass(frozen=True, slots=True)
class ControlNotYours:
    code: Literal["control_not_yours"] = "control_not_yours"
    english: ClassVar[Words] = Words("You do not control this search.")


@dataclass(frozen=True, slots=True)
class ControlNeedless:
    code: Literal["control_needless"] = "control_needless"
    english: ClassVar[Words] = Words("This server has no accounts: whoever sits before it controls every search.")


AccessReason = (
    SignInNeeded
    | FirstAdminNeeded
    | FirstAdminExists
    | NoPeopleHere
    | BehindProxy
    | RoleTooLow
    | CallNotListed
    | OriginMissing
    | NotEncrypted
    | WrongNameOrPassword
    | NoPasswordHere
    | NoProvider
    | ProviderRefused
    | TooManyTries
    | CodeUnusable
    | NameTaken
    | PasswordWeak
    | LastAdmin
    | CommandIdReused
    | ControlFree
    | ControlHeld
    | ControlStale
    | ControlAskedAlready
    | ControlNotAsked
    | ControlNotYours
    | ControlNeedless
)
