"""A signed-in person's way to a server behind its proxy, and one mission that they fly there."""

from __future__ import annotations

import asyncio
import os
import tempfile
import uuid
from collections.abc import Callable
from contextlib import suppress
from typing import Any

import httpx

Fact = dict[str, Any]

READY_S = 240.0
"""The first start waits for the database, and compiles the planner."""
FLIGHT_S = 900.0


async def until_healthy(client: httpx.AsyncClient) -> None:
    """It answers, whoever asks. Raises TimeoutError."""
    async with asyncio.timeout(READY_S):
        while True:
            with suppress(httpx.HTTPError):
                if (await client.get("/health")).status_code == 200:
                    return
            await asyncio.sleep(0.5)


async def vehicle_ready(client: httpx.AsyncClient) -> dict[str, Any]:
    """What the server says about itself once its vehicle is there. Raises TimeoutError."""
    async with asyncio.timeout(READY_S):
        while True:
            with suppress(httpx.TransportError, Away):
                health = answered(await client.get("/api/health"))
                if all(vehicle["connected"] for vehicle in health["vehicles"]):
                    return health
            await asyncio.sleep(1.0)


class Away(Exception):
    """The proxy answers, the server or its database behind it does not."""


def answered(reply: httpx.Response) -> Any:
    """Its JSON. Raises Away, or RuntimeError for a refusal with what it says."""
    if reply.is_server_error:
        raise Away
    if reply.is_error:
        raise RuntimeError(f"{reply.request.method} {reply.request.url.path}: {reply.status_code} {reply.text[:500]}")
    return reply.json()


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


class Flight:
    """One mission. Where the server does not answer (it is being killed), it is asked again."""

    def __init__(self, client: httpx.AsyncClient, mission_id: str) -> None:
        self._client = client
        self.mission_id = mission_id
        self.path = f"/api/missions/{mission_id}"

    async def order(self, kind: str) -> None:
        """Under the control lease as it stands. Raises RuntimeError when it is refused."""
        leases = [fact["fence"] for fact in await self.facts() if fact["kind"] == "control_changed"]
        fence = leases[-1] if leases else None
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

    async def facts(self) -> list[Fact]:
        """All so far."""
        found: list[Fact] = []
        while True:
            after = found[-1]["seq"] if found else 0
            page = answered(await self._client.get(f"{self.path}/events", params={"after": after}))
            found += page["events"]
            if not page["more"]:
                return [record["event"] for record in found]

    async def until(self, happened: Callable[[list[Fact]], bool]) -> list[Fact]:
        """The facts with which it had happened. Raises TimeoutError."""
        async with asyncio.timeout(FLIGHT_S):
            while True:
                with suppress(httpx.TransportError, Away):
                    if happened(facts := await self.facts()):
                        return facts
                await asyncio.sleep(0.5)


def count(facts: list[Fact], kind: str) -> int:
    return sum(fact["kind"] == kind for fact in facts)


def phase(facts: list[Fact]) -> str:
    return next(fact["after"] for fact in reversed(facts) if fact["kind"] == "phase_changed")
