"""What Prometheus reads, parsed by its own reader."""

from __future__ import annotations

import asyncio
from uuid import uuid4

from prometheus_client.parser import text_string_to_metric_families

from backend.api.meters import Meters
from hardware.readings import Telemetry


async def figures(client) -> dict[tuple[str, tuple[tuple[str, str], ...]], float]:
    reply = await client.get("/metrics")
    assert reply.status_code == 200
    families = text_string_to_metric_families(reply.text)
    return {(s.name, tuple(sorted(s.labels.items()))): s.value for family in families for s in family.samples}


async def test_the_state_is_read_when_it_is_asked_for(client, vehicle):
    now = await figures(client)
    assert now["crossfix_vehicle_connected", (("craft", "craft-1"),)] == 1
    assert now["crossfix_database_state", (("state", "ok"),)] == 1
    assert now["crossfix_spooled_entries", ()] == 0
    assert now["crossfix_disk_free_bytes", ()] > 0
    vehicle.heard_last = Telemetry(connected=False, at_s=0.0)
    assert (await figures(client))["crossfix_vehicle_connected", (("craft", "craft-1"),)] == 0


async def test_requests_are_counted_by_route_and_never_by_address(client):
    for number in range(3):
        await client.get(f"/api/missions/unknown-{number}")
    await client.get("/some/page")
    await client.request("A" * 40, "/api/health")
    now = await figures(client)
    missions = (("method", "GET"), ("route", "/api/missions/{mission_id}"), ("status", "404"))
    assert now["crossfix_http_requests_total", missions] == 3
    assert now["crossfix_http_request_seconds_count", (("route", "/api/missions/{mission_id}"),)] == 3
    assert not [labels for _, labels in now if "unknown" in str(labels) or "A" * 11 in str(labels)]


async def test_commands_are_counted_by_kind_and_answer(client):
    spec = (await client.get("/api/defaults")).json()["spec"]
    mission = (await client.post("/api/missions", json=spec)).json()["mission_id"]
    body = {"command_id": str(uuid4()), "command": {"kind": "hold"}}
    assert not (await client.post(f"/api/missions/{mission}/commands", json=body)).json()["accepted"]
    now = await figures(client)
    assert now["crossfix_commands_total", (("accepted", "false"), ("command", "hold"))] == 1


async def test_a_loop_that_is_held_up_is_seen(monkeypatch):
    import time

    monkeypatch.setattr("backend.api.meters.LOOK_S", 0.01)
    meters = Meters()
    async with meters.watched_loop():
        await asyncio.sleep(0.03)
        time.sleep(0.3)  # noqa: ASYNC251 (what must not happen)
        await asyncio.sleep(0.03)
    worst = [line for line in meters.page().decode().splitlines() if 'lag_seconds_bucket{le="0.25"}' in line]
    total = [line for line in meters.page().decode().splitlines() if "lag_seconds_count" in line]
    assert float(worst[0].split()[-1]) < float(total[0].split()[-1])
