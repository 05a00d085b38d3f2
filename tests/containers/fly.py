"""Fly one mission on a server that is already running: `python -m tests.containers.fly https://localhost`.

Prints what the server says of itself, the phases with their times, and the outcome. Fails unless PostgreSQL keeps the
journal and the emitter is localized.
"""

from __future__ import annotations

import asyncio
import os
import sys
import tempfile
import time
from contextlib import suppress

import httpx

from tests.system.console import console

READY_S = 240.0
"""The first start waits for the database, and compiles the planner."""
FLIGHT_S = 900.0


async def server_ready(url: str) -> dict[str, object]:
    """What it says about itself once database and vehicle are there. Raises TimeoutError."""
    async with httpx.AsyncClient(base_url=url, timeout=5.0) as client, asyncio.timeout(READY_S):
        while True:
            try:
                health = (await client.get("/api/health")).json()
            except (httpx.HTTPError, ValueError):
                health = None
            if health and all(vehicle["connected"] for vehicle in health["vehicles"]):
                return health
            await asyncio.sleep(1.0)


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


async def main(url: str, plain: str) -> int:
    begun = time.monotonic()
    if url.startswith("https:"):
        await trust(url, plain)
        print(f"{time.monotonic() - begun:6.1f} s  TLS: the authority's certificate is taken", flush=True)
    health = await server_ready(url)
    print(f"{time.monotonic() - begun:6.1f} s  server ready: {health}", flush=True)
    async with console(url) as operator:
        await operator.draft()
        await operator.ready(wall_s=120.0)
        await operator.watch()
        await operator.start()
        shown = 0

        def news() -> bool:
            return len(operator.phases) > shown or bool(operator.of("mission_ended"))

        while not operator.of("mission_ended"):
            await operator.until(news, FLIGHT_S)
            for phase in operator.phases[shown:]:
                print(f"{time.monotonic() - begun:6.1f} s  {phase}, bearings: {len(operator.of('bearing_measured'))}")
            shown = len(operator.phases)
        outcome = (await operator.until_event("mission_ended"))["outcome"]
    print(f"{time.monotonic() - begun:6.1f} s  outcome: {outcome}")
    return 0 if health["database"]["kind"] == "postgresql" and outcome == "localized" else 1  # type: ignore[index]


if __name__ == "__main__":
    sys.exit(asyncio.run(main(sys.argv[1], sys.argv[2] if len(sys.argv) > 2 else "http://localhost")))
