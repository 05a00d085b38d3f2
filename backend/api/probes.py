"""For machines that look after the server: does it answer, and its figures. Not part of the wire schema."""

from __future__ import annotations

from fastapi import APIRouter, Request, Response

from backend.api.dependencies import ServicesDep
from backend.api.system import health

router = APIRouter(include_in_schema=False)


@router.get("/health")
async def alive(services: ServicesDep) -> dict[str, str]:
    """200 as long as it answers, whatever is missing: a restart in flight would help nothing, and cost the flight."""
    return {"state": (await health(services)).state}


@router.get("/metrics")
async def metrics(request: Request) -> Response:
    """Prometheus' text format."""
    return Response(request.app.state.meters.page(), media_type="text/plain; version=1.0.0; charset=utf-8")
