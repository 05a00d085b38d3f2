"""What the endpoints need, injected: the services, and who asks."""

from __future__ import annotations

from typing import Annotated

from fastapi import Depends, Path
from starlette.requests import HTTPConnection

from backend.api.services import Services
from backend.auth.principal import Principal, local_person

MissionId = Annotated[str, Path(pattern=r"^[A-Za-z0-9_-]{1,64}$", description="The mission's id")]
SweepId = Annotated[str, Path(pattern=r"^[A-Za-z0-9_-]{1,64}$", description="The sweep's id")]


def services(connection: HTTPConnection) -> Services:
    """The one set of the application, made when it starts."""
    return connection.app.state.services


def current_principal(connection: HTTPConnection) -> Principal:
    """The caller of this request."""
    return local_person(None if connection.client is None else connection.client.host)


ServicesDep = Annotated[Services, Depends(services)]
PrincipalDep = Annotated[Principal, Depends(current_principal)]
