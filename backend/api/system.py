"""The server itself and the vehicle it talks to."""

from __future__ import annotations

import time

from fastapi import APIRouter

from backend.api.dependencies import ServicesDep
from backend.api.problems import PROBLEM_RESPONSES
from backend.api.suggestion import suggested_mission
from backend.live.snapshot import telemetry_message
from backend.spec import Place
from backend.version import VERSION
from backend.wire.messages import TelemetryMessage
from backend.wire.resources import DatabaseHealth, Defaults, Health, Payload, PayloadList, VehicleHealth

NO_VEHICLE = "No vehicle answers on the link. Check its power and the radio; the server keeps listening."

router = APIRouter(prefix="/api", tags=["system"], responses=PROBLEM_RESPONSES)


@router.get("/health")
async def health(services: ServicesDep) -> Health:
    """Which parts answer; never waits for one."""
    settings, telemetry, report = services.settings, services.missions.telemetry(), services.journal.report()
    kind = "sqlite" if settings.async_database_url.startswith("sqlite") else "postgresql"
    return Health(
        state="ok" if telemetry.connected and report.state == "ok" else "degraded",
        version=VERSION,
        uptime_s=time.monotonic() - services.began_monotonic_s,
        database=DatabaseHealth(state=report.state, kind=kind, detail=report.detail, spooled=report.spooled),
        vehicle=VehicleHealth(
            connected=telemetry.connected,
            autopilot=telemetry.autopilot,
            detail="" if telemetry.connected else NO_VEHICLE,
        ),
        viewers=services.hub.viewers(),
        simulated=settings.simulated,
        time_factor=settings.time_factor,
    )


@router.get("/payloads")
async def list_payloads(services: ServicesDep) -> PayloadList:
    """Every payload that was heard since the server's start, the connected ones first."""
    hub = services.payload
    if hub is None:
        return PayloadList(expected=False, payloads=[])
    known = sorted(hub.agents.values(), key=lambda agent: (not agent.connected, agent.agent))
    now_s = hub.now()
    return PayloadList(
        expected=True,
        payloads=[
            Payload(
                name=agent.agent,
                connected=agent.connected,
                age_s=max(now_s - agent.heard_at_s, 0.0),
                software=agent.software,
                receiver=agent.receiver,
                receiver_ok=agent.receiver_ok,
                temperature_c=agent.temperature_c,
                clock_offset_s=agent.clock_offset_s,
                round_trip_s=agent.round_trip_s,
                clipped_percent=agent.clipped_percent,
                waiting=agent.waiting,
                lost=agent.lost,
                received=agent.received,
            )
            for agent in known
        ],
    )


@router.get("/defaults")
async def defaults(services: ServicesDep) -> Defaults:
    """A specification to start from, its area around the vehicle's home."""
    telemetry, settings = services.missions.telemetry(), services.settings
    known = telemetry.home or telemetry.position
    home = Place(lat=known.lat_deg, lon=known.lon_deg) if known else None
    fallback = Place(lat=settings.home_lat_deg, lon=settings.home_lon_deg)
    return Defaults(spec=suggested_mission(home or fallback), home=home)


@router.get("/vehicle")
async def vehicle(services: ServicesDep) -> TelemetryMessage:
    """The vehicle as last heard, each value with its age."""
    return telemetry_message(services.missions.telemetry(), services.now())
