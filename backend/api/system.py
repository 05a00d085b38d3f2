"""The server itself and the vehicle it talks to."""

from __future__ import annotations

from fastapi import APIRouter

from backend.api.dependencies import ServicesDep
from backend.api.problems import PROBLEM_RESPONSES
from backend.wire.messages import TelemetryMessage
from backend.wire.resources import Defaults, Health

router = APIRouter(prefix="/api", tags=["system"], responses=PROBLEM_RESPONSES)


@router.get("/health")
async def health(services: ServicesDep) -> Health:
    """Which parts answer; never waits for one."""
    raise NotImplementedError


@router.get("/defaults")
async def defaults(services: ServicesDep) -> Defaults:
    """A specification to start from, its area around the vehicle's home."""
    raise NotImplementedError


@router.get("/vehicle")
async def vehicle(services: ServicesDep) -> TelemetryMessage:
    """The vehicle as last heard, each value with its age."""
    raise NotImplementedError
