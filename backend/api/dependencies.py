"""What the endpoints need, injected: the mission service, the journal, the hub and the settings."""

from __future__ import annotations

from typing import Annotated

from fastapi import Depends, Path, Request

from backend.api.meters import Meters
from backend.api.services import Services
from backend.auth.principal import Principal, current_principal

MissionId = Annotated[str, Path(pattern=r"^[A-Za-z0-9_-]{1,64}$", description="The mission's id")]
SweepId = Annotated[str, Path(pattern=r"^[A-Za-z0-9_-]{1,64}$", description="The sweep's id")]


def services(request: Request) -> Services:
    """The one set of the application, made when it starts."""
    return request.app.state.services


def meters(request: Request) -> Meters:
    """Of the application."""
    return request.app.state.meters


MetersDep = Annotated[Meters, Depends(meters)]
ServicesDep = Annotated[Services, Depends(services)]
PrincipalDep = Annotated[Principal, Depends(current_principal)]
