"""Signing in and out, the first admin, accepting an invitation, and a new password after one was lost."""

from __future__ import annotations

import ipaddress
from datetime import UTC, datetime

from fastapi import APIRouter, Request, Response

from backend.api.dependencies import ServicesDep
from backend.api.gate import FORWARDED, PLAIN_COOKIE, SECURE_COOKIE, address_of, cookie_of, encrypted
from backend.api.problems import PROBLEM_RESPONSES, ApiProblem
from backend.api.services import Services
from backend.auth.access import Visit
from backend.auth.principal import Principal
from backend.auth.sessions import LONGEST_S
from backend.reasons.access import NotEncrypted
from backend.wire.people import (
    FirstAdmin,
    InvitationAnswer,
    InvitationCode,
    InvitationOffer,
    LostPassword,
    SessionState,
    SignedIn,
    SignIn,
)

router = APIRouter(prefix="/api", tags=["entering"], responses=PROBLEM_RESPONSES)


def may_carry_secrets(request: Request, services: Services) -> bool:
    """Over https; from this machine itself; or where the settings say that the network encrypts."""
    if encrypted(request.scope) or services.settings.plain_http:
        return True
    if any(header in request.headers for header in FORWARDED):
        return False
    try:
        return ipaddress.ip_address(address_of(request.scope)).is_loopback
    except ValueError:
        return False


def require_encryption(request: Request, services: Services) -> None:
    """Raises ApiProblem 403."""
    if not may_carry_secrets(request, services):
        raise ApiProblem(403, NotEncrypted())


def visit_of(request: Request) -> Visit:
    """Where the request comes from; what the browser says of itself, printable."""
    device = "".join(letter for letter in request.headers.get("user-agent", "")[:200] if letter.isprintable())
    return Visit(address_of(request.scope), device)


def _state(request: Request, services: Services, principal: Principal | None) -> SessionState:
    access = services.access
    person = None if principal is None or principal.person is None else access.people.known(principal.person)
    return SessionState(
        mode=access.mode,
        person=None
        if person is None
        else SignedIn(
            person_id=person.person_id,
            name=person.name,
            role=person.role,
            admin=person.admin,
            has_password=bool(person.password_hash),
        ),
        encrypted=may_carry_secrets(request, services),
        provider=None if services.provider is None else services.provider.name,
    )


async def entered(request: Request, response: Response, services: Services, secret: str) -> SessionState:
    """Signed in from now on; a session that this browser had before ends."""
    access, address = services.access, address_of(request.scope)
    before = cookie_of(request.scope, request.headers)
    old = None if before is None else access.signed_in(before, address)
    found = access.signed_in(secret, address)
    assert found is not None
    request.state.audit["principal"] = found[0]
    secure = encrypted(request.scope)
    response.set_cookie(
        SECURE_COOKIE if secure else PLAIN_COOKIE,
        secret,
        max_age=int(LONGEST_S),
        path="/",
        secure=secure,
        httponly=True,
        samesite="strict",
    )
    if old is not None and old[0].person is not None:
        await access.sessions.end(old[0].person, old[1].row.session_id)
    return _state(request, services, found[0])


@router.get("/session")
async def get_session(request: Request, services: ServicesDep) -> SessionState:
    """Who is signed in here, and whether anybody has to be."""
    return _state(request, services, request.state.principal)


@router.post("/session")
async def sign_in(asked: SignIn, request: Request, response: Response, services: ServicesDep) -> SessionState:
    """A new session, in a cookie. 403: name or password is wrong; 429: too many tries."""
    require_encryption(request, services)
    account = services.access.people.named(asked.name)
    if account is not None:  # another name may be a password in the wrong field
        request.state.audit["account"] = account.name
    secret = await services.access.sign_in(asked.name, asked.password, visit_of(request))
    return await entered(request, response, services, secret)


@router.delete("/session", status_code=204)
async def sign_out(request: Request, response: Response, services: ServicesDep) -> None:
    """Of this browser."""
    principal: Principal | None = request.state.principal
    for name, secure in ((SECURE_COOKIE, True), (PLAIN_COOKIE, False)):
        response.delete_cookie(name, path="/", secure=secure, httponly=True, samesite="strict")
    if principal is not None and principal.person is not None and principal.session is not None:
        await services.access.sessions.end(principal.person, principal.session)


@router.post("/first-admin", status_code=201)
async def make_first_admin(
    asked: FirstAdmin, request: Request, response: Response, services: ServicesDep
) -> SessionState:
    """With the code that the server printed; once."""
    require_encryption(request, services)
    secret = await services.access.make_first_admin(asked.code, asked.name, asked.password, visit_of(request))
    return await entered(request, response, services, secret)


@router.post("/invitation/look")
async def look_at_invitation(asked: InvitationCode, request: Request, services: ServicesDep) -> InvitationOffer:
    """What an invitation offers; it stays unused."""
    found = services.access.look_at_invitation(asked.code, address_of(request.scope))
    expires_utc = datetime.fromtimestamp(found.expires_at_us / 1e6, UTC)
    return InvitationOffer(role=found.role, admin=found.admin, expires_utc=expires_utc)


@router.post("/invitation/accept", status_code=201)
async def accept_invitation(
    asked: InvitationAnswer, request: Request, response: Response, services: ServicesDep
) -> SessionState:
    """Makes the account and signs it in; the invitation is used up."""
    require_encryption(request, services)
    secret = await services.access.accept_invitation(asked.code, asked.name, asked.password, visit_of(request))
    return await entered(request, response, services, secret)


@router.post("/recovery")
async def recover(asked: LostPassword, request: Request, response: Response, services: ServicesDep) -> SessionState:
    """A new password, with a code that `crossfix recover` printed on the server's machine; all other sessions end."""
    require_encryption(request, services)
    secret = await services.access.recover(asked.code, asked.password, visit_of(request))
    return await entered(request, response, services, secret)
