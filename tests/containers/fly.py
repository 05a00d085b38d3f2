"""Fly one mission on a new server that is running: `python -m tests.containers.fly https://localhost CODE`.

CODE is what the server printed for its first admin. Prints what the server says of itself, the phases with their times,
and the outcome. Fails unless PostgreSQL keeps the journal and the emitter is localized.
"""

from __future__ import annotations

import asyncio
import os
import secrets
import sys
import tempfile
import time
import uuid
from collections.abc import Callable
from contextlib import suppress
from typing import Any

import httpx

READY_S = 240.0
"""The first start waits for the database, and compiles the planner."""
FLIGHT_S = 900.0
FIRST_FENCE = 1
"""Of the control lease of a new search, once somebody has taken it."""


async def until_healthy(client: httpx.AsyncClient) -> None:
    """It answers, whoever asks. Raises TimeoutError."""
    async with asyncio.timeout(READY_S):
        while True:
            with suppress(httpx.HTTPError):
                if (await client.get("/health")).status_code == 200:
                    return
            await asyncio.sleep(1.0)


async def vehicle_ready(client: httpx.AsyncClient) -> dict[str, Any]:
    """What the server says about itself once its vehicle is there. Raises TimeoutError."""
    async with asyncio.timeout(READY_S):
        while True:
            health = answered(await client.get("/api/health"))
            if all(vehicle["connected"] for vehicle in health["vehicles"]):
                return health
            await asyncio.sleep(1.0)


def answered(reply: httpx.Response) -> Any:
    """Its JSON. Raises RuntimeError for a refusal, with what it says."""
    if reply.is_error:
        raise RuntimeError(f"{reply.request.method} {reply.request.url.path}: {reply.status_code} {reply.text[:500]}")
    return reply.json()


class Flight:
    """One mission, ordered by whoever is signed in."""

    def __init__(self, client: httpx.AsyncClient, mission_id: str) -> None:
        self._client = client
        self.path = f"/api/missions/{mission_id}"

    async def order(self, kind: str, fence: int | None = None) -> None:
        """Raises RuntimeError when it is refused."""
        asked = {"command_id": str(uuid.uuid4()), "command": {"kind": kind}, "fence": fence}
        reply = answered(await self._client.post(f"{self.path}/commands", json=asked))
        if not reply["accepted"]:
            raise RuntimeError(f"{kind}: {reply}")

    async def preflight(self) -> None:
        """Waits until all checks pass. Raises TimeoutError."""
        async with asyncio.timeout(READY_S):
            while True:
                if answered(await self._client.post(f"{self.path}/preflight"))["passed"]:
                    return
                await asyncio.sleep(1.0)

    async def facts(self) -> list[dict[str, Any]]:
        """All so far."""
        found: list[dict[str, Any]] = []
        while True:
            after = found[-1]["seq"] if found else 0
            page = answered(await self._client.get(f"{self.path}/events", params={"after": after}))
            found += page["events"]
            if not page["more"]:
                return found


async def trust(url: str, plain: str) -> None:
    """From now on this process trusts the proxy's own authority, as a phone does that has taken its certificate."""
    async with httpx.AsyncClient(timeout=5.0) as client, asyncio.timeout(READY_S):
        while True:
            with suppress(httpx.HTTPError):
                reply = await client.get(f"{plain}/authority.crt")
                if reply.status_code == 200:
                    break
            with suppress(httpx.HTTPError):  # the authority is made when somebody comes
                async with httpx.AsyncClient(verify=False, timeout=5.0) as anyone:
                    await anyone.get(url)
            await asyncio.sleep(1.0)
    with tempfile.NamedTemporaryFile(prefix="authority-", suffix=".crt", delete=False) as file:
        file.write(reply.content)
    os.environ["SSL_CERT_FILE"] = file.name


async def main(url: str, code: str, plain: str) -> int:
    begun = time.monotonic()

    def say(text: object) -> None:
        print(f"{time.monotonic() - begun:6.1f} s  {text}", flush=True)

    if url.startswith("https:"):
        await trust(url, plain)
        say("TLS: the authority's certificate is taken")
    async with httpx.AsyncClient(base_url=url, timeout=60.0, headers={"origin": url}) as client:
        await until_healthy(client)
        account = {"code": code, "name": "ada", "password": secrets.token_urlsafe(24)}
        answered(await client.post("/api/first-admin", json=account))
        health = await vehicle_ready(client)
        say(f"signed in; the server: {health}")
        spec = answered(await client.get("/api/defaults"))["spec"]
        flight = Flight(client, answered(await client.post("/api/missions", json=spec))["mission_id"])
        await flight.preflight()
        await flight.order("take_control")
        await flight.order("start", FIRST_FENCE)
        outcome = await watched(flight, say)
    say(f"outcome: {outcome}")
    return 0 if health["database"]["kind"] == "postgresql" and outcome == "localized" else 1


async def watched(flight: Flight, say: Callable[[object], None]) -> str:
    """Until the mission has ended; its outcome. Raises TimeoutError."""
    seen = 0
    async with asyncio.timeout(FLIGHT_S):
        while True:
            facts = [record["event"] for record in await flight.facts()]
            bearings = sum(fact["kind"] == "bearing_measured" for fact in facts)
            for fact in facts[seen:]:
                if fact["kind"] == "phase_changed":
                    say(f"{fact['after']}, bearings: {bearings}")
                if fact["kind"] == "mission_ended":
                    return fact["outcome"]
            seen = len(facts)
            await asyncio.sleep(1.0)


if __name__ == "__main__":
    sys.exit(asyncio.run(main(sys.argv[1], sys.argv[2], sys.argv[3] if len(sys.argv) > 3 else "http://localhost")))
