"""One's own sessions and password; and for admins: people, invitations, machines' tokens."""

from __future__ import annotations

from datetime import UTC, datetime
from typing import Annotated

import segno
from fastapi import APIRouter, Path, Request

from backend.api.dependencies import PrincipalDep, ServicesDep
from backend.api.gate import encrypted
from backend.api.problems import PROBLEM_RESPONSES, ApiProblem
from backend.api.services import Services
from backend.auth import registry
from backend.auth.principal import Principal
from backend.reasons.access import NoPeopleHere
from backend.wire.people import (
    Invitation,
    InvitationList,
    MadeInvitation,
    MadeToken,
    NewInvitation,
    NewPassword,
    NewToken,
    OpenSession,
    Person,
    PersonChange,
    PersonList,
    SessionList,
    Token,
    TokenList,
)

RowId = Annotated[str, Path(pattern=r"^[0-9a-f]{32}$")]
router = APIRouter(prefix="/api", tags=["people"], responses=PROBLEM_RESPONSES)


def _myself(principal: Principal) -> str:
    """The account's id. Raises ApiProblem where there are none."""
    if principal.person is None:
        raise ApiProblem(409, NoPeopleHere())
    return principal.person


@router.get("/account/sessions")
async def list_sessions(services: ServicesDep, principal: PrincipalDep) -> SessionList:
    """Where one is signed in."""
    access = services.access
    return SessionList(
        sessions=[
            OpenSession(
                session_id=row.session_id,
                address=row.address,
                device=row.device,
                made_utc=_utc(row.made_at_us),
                idle_s=access.sessions.idle_s(row),
                own=row.session_id == principal.session,
            )
            for row in access.sessions.of(_myself(principal))
        ]
    )


@router.delete("/account/sessions", status_code=204)
async def sign_out_everywhere(services: ServicesDep, principal: PrincipalDep) -> None:
    """This browser too."""
    await services.access.sessions.end_all(_myself(principal))


@router.delete("/account/sessions/{session_id}", status_code=204)
async def end_session(session_id: RowId, services: ServicesDep, principal: PrincipalDep) -> None:
    """One of one's own."""
    await services.access.sessions.end(_myself(principal), session_id)


@router.put("/account/password", status_code=204)
async def change_password(asked: NewPassword, services: ServicesDep, principal: PrincipalDep) -> None:
    """Ends all other sessions of one's own."""
    address = principal.address or "unknown"
    await services.access.change_password(_myself(principal), asked.old, asked.new, address, principal.session)


@router.get("/people")
async def list_people(services: ServicesDep, principal: PrincipalDep) -> PersonList:
    """All, those who are shut out too."""
    _myself(principal)
    return PersonList(people=[_person(services, person) for person in services.access.people.by_name])


@router.put("/people/{person_id}")
async def change_person(
    person_id: RowId, asked: PersonChange, request: Request, services: ServicesDep, principal: PrincipalDep
) -> Person:
    """Role, right to manage, shut out or let in. 409: it is the last admin."""
    _myself(principal)
    changed = await services.access.change_person(person_id, asked.role, asked.admin, asked.active)
    request.state.audit.update(of=changed.name, now=asked.model_dump())
    return _person(services, changed)


@router.delete("/people/{person_id}/sessions", status_code=204)
async def sign_person_out(person_id: RowId, request: Request, services: ServicesDep, principal: PrincipalDep) -> None:
    """Everywhere."""
    _myself(principal)
    request.state.audit["of"] = services.access.people.known(person_id).name
    await services.access.sessions.end_all(person_id)


@router.get("/invitations")
async def list_invitations(services: ServicesDep, principal: PrincipalDep) -> InvitationList:
    """Those that wait to be accepted."""
    _myself(principal)
    access = services.access
    waiting = [row for row, left_s in access.invitations.waiting if left_s > 0 and access.stands(row)]
    return InvitationList(invitations=[_invitation(services, row) for row in waiting])


@router.post("/invitations", status_code=201)
async def invite(
    asked: NewInvitation, request: Request, services: ServicesDep, principal: PrincipalDep
) -> MadeInvitation:
    """A link for one person, and its QR code. The secret stands behind the #, so no server logs it."""
    by, lasts_s = _myself(principal), asked.hours * 3600.0
    secret, made = await services.access.invitations.make(asked.role, asked.admin, lasts_s, by)
    request.state.audit.update(invitation=made.invitation_id, offers=asked.model_dump())
    scheme = "https" if encrypted(request.scope) else "http"
    link = f"{scheme}://{request.headers.get('host', '')}/#/join/{secret}"
    qr = segno.make(link, error="m").svg_data_uri(border=4, light="white")
    return MadeInvitation(invitation=_invitation(services, made), link=link, qr=qr)


@router.delete("/invitations/{invitation_id}", status_code=204)
async def take_back_invitation(invitation_id: RowId, services: ServicesDep, principal: PrincipalDep) -> None:
    """Nobody can accept it any more."""
    _myself(principal)
    await services.access.invitations.take_back(invitation_id)


@router.get("/tokens")
async def list_tokens(services: ServicesDep, principal: PrincipalDep) -> TokenList:
    """Of machines, without their secrets."""
    _myself(principal)
    return TokenList(tokens=[_token(services, row) for row in services.access.machines.tokens])


@router.post("/tokens", status_code=201)
async def make_token(asked: NewToken, request: Request, services: ServicesDep, principal: PrincipalDep) -> MadeToken:
    """The secret is shown once: a payload agent or a program shows it as "Authorization: Bearer SECRET"."""
    lasts_s = None if asked.days is None else asked.days * 86_400.0
    secret, made = await services.access.machines.make(asked.name, asked.scope, lasts_s, _myself(principal))
    request.state.audit.update(token=made.token_id, scope=made.scope)
    return MadeToken(token=_token(services, made), secret=secret)


@router.delete("/tokens/{token_id}", status_code=204)
async def revoke_token(token_id: RowId, services: ServicesDep, principal: PrincipalDep) -> None:
    """At once; what is connected with it is cut off."""
    _myself(principal)
    await services.access.machines.revoke(token_id)


def _utc(at_us: int) -> datetime:
    return datetime.fromtimestamp(at_us / 1e6, UTC)


def _name_of(services: Services, person_id: str) -> str:
    found = services.access.people.get(person_id)
    return "" if found is None else found.name


def _person(services: Services, row: registry.Person) -> Person:
    return Person(
        person_id=row.person_id,
        name=row.name,
        role=row.role,
        admin=row.admin,
        active=row.active,
        sessions=len(services.access.sessions.of(row.person_id)),
    )


def _invitation(services: Services, row: registry.Invitation) -> Invitation:
    return Invitation(
        invitation_id=row.invitation_id,
        role=row.role,
        admin=row.admin,
        made_by=_name_of(services, row.made_by),
        expires_utc=_utc(row.expires_at_us),
    )


def _token(services: Services, row: registry.MachineToken) -> Token:
    return Token(
        token_id=row.token_id,
        name=row.name,
        scope=row.scope,
        made_by=_name_of(services, row.made_by),
        made_utc=_utc(row.made_at_us),
        expires_utc=None if row.expires_at_us is None else _utc(row.expires_at_us),
    )
