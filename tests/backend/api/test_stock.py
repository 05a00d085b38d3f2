"""What comes from outside has room of its own: counted, bounded, and shown on the health page."""

from __future__ import annotations

import asyncio
from typing import Any

import httpx
import numpy as np

from hardware.direction_finding.pattern_file import SMALL_YAGI, load_pattern

GEOJSON = b'{"type": "Point", "coordinates": [7.1, 50.2]}'


def turn(bearing_deg: float) -> bytes:
    heading = np.arange(0.0, 360.0, 4.0)
    power = load_pattern(SMALL_YAGI).gain_at(bearing_deg - heading) - 60.0
    rows = [f"{h},{p:.2f}" for h, p in zip(heading, power, strict=True)]
    return "\n".join(["heading_deg,power_db", *rows]).encode()


async def sent(client: httpx.AsyncClient, mission_id: str, content: bytes) -> httpx.Response:
    words = {"lat": "50.6", "lon": "7.2", "at_utc": "2026-05-01T10:00:00Z"}
    files = [("files", ("turn.csv", content))]
    return await client.post(f"/api/missions/{mission_id}/recordings", files=files, data=words)


async def kept(client: httpx.AsyncClient, services: Any, what: str) -> dict[str, Any]:
    """As the health page shows it once it was counted again."""
    services.stocks[what].known, services.stocks[what]._looked_at_s = None, -1e9
    while True:
        (found,) = [each for each in (await client.get("/api/health")).json()["stocks"] if each["what"] == what]
        if found["number"] is not None:
            return found
        await asyncio.sleep(0)


async def test_recordings_are_taken_until_their_room_is_used_up(client, services) -> None:
    defaults = (await client.get("/api/defaults")).json()["spec"]
    mission_id = (await client.post("/api/missions", json=defaults)).json()["mission_id"]
    stock = services.stocks["recordings"]
    assert (await kept(client, services, "recordings"))["number"] == 0
    stock.most = 1
    assert (await sent(client, mission_id, turn(40.0))).status_code == 201
    told = await kept(client, services, "recordings")
    assert (told["number"], told["full"]) == (1, True)
    assert told["size_bytes"] > 100
    refused = await sent(client, mission_id, turn(80.0))
    assert refused.status_code == 413
    assert refused.json()["reason"] == {
        "what": "recordings", "most": 1, "most_bytes": 2 * 10**9, "code": "stock_full"
    }  # fmt: skip
    assert "CROSSFIX_RECORDINGS_MAX_SWEEPS" in refused.json()["remedy"]
    assert (await sent(client, mission_id, turn(40.0))).json()["already"], "the same again needs no room"
    stock.most, stock.most_bytes = 100, told["size_bytes"] + 100
    assert (await sent(client, mission_id, turn(80.0))).status_code == 413
    stock.most_bytes += 10**6
    assert (await sent(client, mission_id, turn(80.0))).status_code == 201


async def test_overlays_are_counted_too(client, services) -> None:
    assert (await kept(client, services, "overlays"))["number"] == 0
    assert (await client.post("/api/overlays", content=GEOJSON)).status_code == 201
    told = await kept(client, services, "overlays")
    assert (told["number"], told["most"], told["full"]) == (1, services.settings.overlays_max, False)
    assert told["size_bytes"] > len(GEOJSON)


async def test_the_limits_are_settings(app, services, settings) -> None:
    tight = settings.model_copy(update={"overlays_max": 0})
    services = type(services)(
        services.missions, services.journal, services.hub, tight, services.now, None, services.workers,
        access=services.access, finder=services.finder, pattern=services.pattern,
    )  # fmt: skip
    app.state.services = services
    transport = httpx.ASGITransport(app)
    async with httpx.AsyncClient(transport=transport, base_url="http://127.0.0.1") as client:
        reply = await client.post("/api/overlays", content=GEOJSON)
        assert (reply.status_code, reply.json()["reason"]["code"]) == (413, "stock_full")
        assert (await kept(client, services, "overlays"))["full"]
