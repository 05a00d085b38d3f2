"""What the endpoints need, injected: the services, and who asks."""

from __future__ import annotations

from typing import Annotated

from fastapi import Depends, Path
from starlette.requests import HTTPConnection

from backend.api.meters import Meters
from backend.api.problems import ApiProblem
from backend.api.services import Services
from backend.auth.principal import Principal
from backend.reasons.access import CallNotListed

MissionId = Annotated[str, Path(pattern=r"^[A-Za-z0-9_-]{1,64}$", description="The mission's id")]
SweepId = Annotated[str, Path(pattern=r"^[A-Za-z0-9_-]{1,64}$", description="The sweep's id")]


def services(connection: HTTPConnection) -> Services:
    """The one set of the application, made when it starts."""
    return connection.app.state.services


def current_principal(connection: HTTPConnection) -> Principal:
    """Whom the gate let in. Raises ApiProblem 403 for a call that came past it."""
    principal = connection.scope.get("state", {}).get("principal")
    if not isinstance(principal, Principal):
        raise ApiProblem(403, CallNotListed())
    return principal


def passed_the_gate(connection: HTTPConnection) -> None:
    """Of every endpoint and websocket: what the gate did not look up in the table of permissions is not served."""
    if "need" not in connection.scope.get("state", {}):
        raise ApiProblem(403, CallNotListed())


def meters(connection: HTTPConnection) -> Meters:
    """Of the application."""
    return connection.app.state.meters


MetersDep = Annotated[Meters, Depends(meters)]
ServicesDep = Annotated[Services, Depends(services)]
PrincipalDep = Annotated[Principal, Depends(current_principal)]
