"""A mission in flight and orders that are timed, for benchmarks of what strangers do meanwhile."""

from __future__ import annotations

import asyncio
import sys
import time
import uuid
from collections.abc import AsyncIterator, Sequence
from contextlib import asynccontextmanager
from pathlib import Path
from typing import NamedTuple

import httpx

from tests.system.console import Console, console
from tests.system.processes import serving, vehicle_apart


class Flight(NamedTuple):
    """shown: the console of the mission that flies. process: the server's."""

    url: str
    process: asyncio.subprocess.Process
    shown: Console


@asynccontextmanager
async def flight(folder: Path) -> AsyncIterator[Flight]:
    """`crossfix serve` in a process of its own, and its simulated vehicle on the way to its first bearing."""
    async with (
        vehicle_apart() as vehicle,
        serving(folder, "--vehicle", vehicle.url) as (url, process),
        console(url) as shown,
    ):
        await shown.draft()
        await shown.ready(120)
        await shown.watch()
        await shown.start(60)
        await shown.until_phase("flying", 120)
        yield Flight(url, process, shown)


async def ordered_s(client: httpx.AsyncClient, mission_id: str) -> float | None:
    """Seconds until hold was answered; None when there was no answer."""
    asked = {"command_id": str(uuid.uuid4()), "command": {"kind": "hold"}}
    began = time.monotonic()
    try:
        reply = await client.post(f"/api/missions/{mission_id}/commands", json=asked)
    except httpx.HTTPError as error:
        print(f"an order was lost: {error!r}", file=sys.stderr)
        return None
    return time.monotonic() - began if reply.status_code == 200 else None


async def ordered_afresh_s(url: str, mission_id: str) -> float | None:
    """The same on a new connection."""
    async with httpx.AsyncClient(base_url=url, timeout=20.0) as client:
        return await ordered_s(client, mission_id)


def quantile_ms(seconds: Sequence[float | None], share: float) -> float:
    """Of those that were answered, by nearest rank."""
    known = sorted(second for second in seconds if second is not None)
    return round(1e3 * known[min(len(known) - 1, int(share * len(known)))], 1) if known else float("inf")
