"""The server itself and the vehicle it talks to."""

from __future__ import annotations

import time
from typing import Annotated

from fastapi import APIRouter, Query

from backend.api.dependencies import ServicesDep
from backend.api.meters import free_bytes
from backend.api.problems import PROBLEM_RESPONSES, not_found
from backend.api.suggestion import suggested_mission
from backend.craft.checklist import home_of
from backend.craft.equipment import CraftEquipment
from backend.events import FIRST_CRAFT
from backend.live.snapshot import telemetry_message
from backend.reasons.safety import NoLink
from backend.spec import Place
from backend.version import VERSION
from backend.wire.health import DatabaseHealth, Health, VehicleHealth
from backend.wire.messages import TelemetryMessage
from backend.wire.resources import Defaults, Payload, PayloadList

CraftId = Annotated[str, Query(pattern=r"^[A-Za-z0-9_-]{1,40}$")]
router = APIRouter(prefix="/api", tags=["system"], responses=PROBLEM_RESPONSES)


@router.get("/health")
async def health(services: ServicesDep) -> Health:
    """Which parts answer; never waits for one."""
    settings, report = services.settings, services.journal.report()
    vehicles = [_vehicle(craft) for craft in services.missions.equipment.crafts.values()]
    kind = "sqlite" if settings.async_database_url.startswith("sqlite") else "postgresql"
    return Health(
        state="ok" if report.state == "ok" and all(vehicle.connected for vehicle in vehicles) else "degraded",
        version=VERSION,
        uptime_s=time.monotonic() - services.began_monotonic_s,
        database=DatabaseHealth(
            state=report.state, kind=kind, reason=report.reason, spooled=report.spooled, refused=report.refused
        ),
        vehicles=vehicles,
        viewers=services.hub.viewers(),
        disk_free_bytes=free_bytes(services),
        keep_sweeps_days=settings.keep_sweeps_days,
        stocks=[stock.health() for stock in services.stocks.values()],
        bearings_udp=None if services.bearings is None else services.bearings(),
        simulated=settings.simulated,
        time_factor=settings.time_factor,
    )


def _vehicle(craft: CraftEquipment) -> VehicleHealth:
    telemetry = craft.vehicle.telemetry()
    return VehicleHealth(
        craft_id=craft.craft_id,
        connected=telemetry.connected,
        autopilot=telemetry.autopilot,
        reason=None if telemetry.connected else NoLink(),
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
    telemetry, settings = services.missions.equipment.first.vehicle.telemetry(), services.settings
    home, _ = home_of(telemetry)
    fallback = Place(lat=settings.home_lat_deg, lon=settings.home_lon_deg)
    return Defaults(spec=suggested_mission(home or fallback), home=home)


@router.get("/vehicle")
async def vehicle(services: ServicesDep, craft: CraftId = FIRST_CRAFT) -> TelemetryMessage:
    """A craft's vehicle as last heard, each value with its age."""
    equipment = services.missions.equipment.crafts.get(craft)
    if equipment is None:
        raise not_found("craft", craft)
    return telemetry_message(craft, equipment.vehicle.telemetry(), services.now())
