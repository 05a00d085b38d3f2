"""Sign-in by a provider: the browser is sent there, and comes back with a code.

Both are plain navigations, so a refusal leads back to the page, which says why by the fault in its address.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

from fastapi import APIRouter, Query, Request, Response
from starlette.responses import RedirectResponse

from backend.api.dependencies import ServicesDep
from backend.api.entering import entered, require_encryption, visit_of
from backend.api.gate import encrypted
from backend.api.problems import PROBLEM_RESPONSES, ApiProblem
from backend.api.services import Services
from backend.auth.keeping import Denied
from backend.auth.provided import UNDER_WAY_S
from backend.reasons.access import NoProvider, ProviderRefused

if TYPE_CHECKING:
    from backend.auth.provider import Provider

router = APIRouter(prefix="/api/provider", tags=["entering"], responses=PROBLEM_RESPONSES)

SECURE_COOKIE, PLAIN_COOKIE = "__Host-crossfix-provider", "crossfix-provider"
"""Of a sign-in under way. Lax: the way back comes from another site."""
RETURN = "/api/provider/return"
REDIRECTS: dict[int | str, dict[str, Any]] = {303: {"description": "Where the browser goes on"}}
MOST = 4096
"""Characters of what the provider sends back."""


@router.get("/begin", status_code=303, response_class=RedirectResponse, responses=REDIRECTS)
async def begin(request: Request, services: ServicesDep) -> Response:
    """To the provider."""
    provider = _provider(services)
    require_encryption(request, services)
    services.access.limits.take_try(visit_of(request).address)  # whoever comes back signed in has it back
    secure = encrypted(request.scope)
    scheme = "https" if secure else "http"
    try:
        url, browser = await provider.begin(f"{scheme}://{request.headers.get('host', '')}{RETURN}")
    except Denied as error:
        return _back(request, error)
    response = RedirectResponse(url, 303)
    response.set_cookie(
        SECURE_COOKIE if secure else PLAIN_COOKIE,
        browser,
        max_age=int(UNDER_WAY_S),
        path="/",
        secure=secure,
        httponly=True,
        samesite="lax",
    )
    return response


@router.get("/return", status_code=303, response_class=RedirectResponse, responses=REDIRECTS)
async def come_back(
    request: Request,
    services: ServicesDep,
    state: Annotated[str, Query(max_length=MOST)] = "",
    code: Annotated[str | None, Query(max_length=MOST)] = None,
    error: Annotated[str | None, Query(max_length=MOST)] = None,
    iss: Annotated[str | None, Query(max_length=MOST)] = None,
) -> Response:
    """From the provider: signed in, or back at the sign-in with the reason. Each state works once."""
    provider = _provider(services)
    require_encryption(request, services)
    visit = visit_of(request)
    services.access.limits.take_try(visit.address)
    secure = encrypted(request.scope)
    cookie = SECURE_COOKIE if secure else PLAIN_COOKIE
    sent = {"state": state, "code": code, "error": error, "iss": iss}
    try:
        found = await provider.finish(
            {name: value for name, value in sent.items() if value is not None}, request.cookies.get(cookie)
        )
        request.state.audit["provided"] = {"issuer": found.issuer, "subject": found.subject}
        secret = await services.access.enter_provided(found, provider.rules, visit)
        response = RedirectResponse("/", 303)
        state_now = await entered(request, response, services, secret)
        if state_now.person is not None:
            request.state.audit["role"] = {"role": state_now.person.role, "admin": state_now.person.admin}
        services.access.limits.give_back_try(visit.address)
        services.access.limits.give_back_try(visit.address)  # that of the way there
    except Denied as denied:
        response = _back(request, denied)
    response.delete_cookie(cookie, path="/", secure=secure, httponly=True, samesite="lax")
    return response


def _provider(services: Services) -> Provider:
    if services.provider is None:
        raise ApiProblem(409, NoProvider())
    return services.provider


def _back(request: Request, denied: Denied) -> Response:
    """To the page, which knows the words. What is no fault of this kind is answered as everywhere else."""
    reason = denied.reason
    if not isinstance(reason, ProviderRefused):
        raise denied
    request.state.audit.update(status=denied.status, reason=f"{reason.code}: {reason.fault}")
    return RedirectResponse(f"/#/sign-in/{reason.fault}", 303)
