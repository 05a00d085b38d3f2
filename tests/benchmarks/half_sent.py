"""A stranger holds 1010 half-sent requests open, and opens each again as soon as it is closed: who still gets in?

    python -m tests.benchmarks.half_sent --out docs/measurements

`crossfix serve` in a process of its own flies the simulated vehicle; the stranger is another process, and half of what
it sends stops in the head of a request, half in the body of a sign-in. Meanwhile hold is ordered over and over, each
order on a connection of its own, and timed at the client; a websocket that was open before has to stay open. Fails when
an order gets no answer or the websocket ends.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import resource
import sys
import tempfile
import time
import uuid
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager, suppress
from pathlib import Path
from urllib.parse import urlsplit

import httpx

from tests.benchmarks.figures.circumstances import begin
from tests.benchmarks.figures.writer import add_out, plain, wanted, write
from tests.system.console import console
from tests.system.processes import serving, vehicle_apart

HALVES = 1010
HEAD = b"GET /api/health HTTP/1.1\r\nhost: 127.0.0.1\r\n"
BODY = (
    b"POST /api/session HTTP/1.1\r\nhost: 127.0.0.1\r\ncontent-type: application/json\r\ncontent-length: 900\r\n\r\n{"
)
SECONDS = 40.0
PAUSE_S = 0.1


async def hold_open(port: int, sent: bytes) -> None:
    """One connection after the other, each held until the server closes it."""
    while True:
        with suppress(OSError):
            reader, writer = await asyncio.open_connection("127.0.0.1", port)
            with suppress(OSError):
                writer.write(sent)
                await reader.read()
            writer.close()
        await asyncio.sleep(0.5)


async def attack(port: int, seconds: float) -> None:
    """Ends by itself."""
    with suppress(TimeoutError):
        async with asyncio.timeout(seconds):
            await asyncio.gather(*(hold_open(port, HEAD if n % 2 else BODY) for n in range(HALVES)))


@asynccontextmanager
async def stranger(port: int) -> AsyncIterator[None]:
    """Attacks inside the block."""
    command = (sys.executable, "-m", "tests.benchmarks.half_sent", "--attack", str(port))
    process = await asyncio.create_subprocess_exec(*command)
    try:
        yield
    finally:
        process.kill()
        await process.wait()


async def ordered_s(url: str, mission_id: str) -> float | None:
    """Seconds from the first byte to the answer, on a new connection; None when there was no answer."""
    asked = {"command_id": str(uuid.uuid4()), "command": {"kind": "hold"}}
    try:
        async with httpx.AsyncClient(base_url=url, timeout=20.0) as client:
            began = time.monotonic()
            reply = await client.post(f"/api/missions/{mission_id}/commands", json=asked)
            return time.monotonic() - began if reply.status_code == 200 else None
    except httpx.HTTPError as error:
        print(f"an order was lost: {error!r}", file=sys.stderr)
        return None


async def strike(folder: Path) -> tuple[list[float | None], list[float | None], bool]:
    """Orders before and during the attack, and whether the websocket went on telling."""
    async with (
        vehicle_apart() as vehicle,
        serving(folder, "--vehicle", vehicle.url) as (url, _),
        console(url) as shown,
    ):
        await shown.draft()
        await shown.ready(120)
        await shown.watch()
        await shown.start(60)
        await shown.until_phase("flying", 120)

        async def orders(seconds: float) -> list[float | None]:
            taken: list[float | None] = []
            until = time.monotonic() + seconds
            while time.monotonic() < until:
                taken.append(await ordered_s(url, shown.mission_id))
                await asyncio.sleep(PAUSE_S)
            return taken

        before = await orders(10.0)
        async with stranger(urlsplit(url).port or 0):
            await asyncio.sleep(3.0)
            during = await orders(SECONDS)
            heard = len(shown.messages["telemetry"])
            await orders(3.0)
            lives = len(shown.messages["telemetry"]) > heard
        return before, during, lives


def ms(seconds: list[float | None], share: float) -> float:
    known = sorted(second for second in seconds if second is not None)
    return round(1e3 * known[min(len(known) - 1, int(share * len(known)))], 1) if known else float("inf")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--attack", type=int, metavar="PORT", help="be the stranger")
    add_out(parser)
    given = parser.parse_args()
    _, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (hard, hard))
    if given.attack is not None:
        asyncio.run(attack(given.attack, 600.0))
        return
    begun = begin(__file__)
    with tempfile.TemporaryDirectory(prefix="crossfix-half-sent-") as folder:
        before, during, lives = asyncio.run(strike(Path(folder)))
    lost = sum(second is None for second in during)
    note = (
        f"{len(during)} orders, each on a new connection; median {ms(during, 0.5):g} ms, worst {ms(during, 1.0):g} ms"
    )
    figures = [
        wanted("half_sent", ms(during, 0.99), note=note),
        wanted("half_sent_lost", lost + (0 if lives else 1), note=f"of {len(during)} orders and an open websocket"),
        plain("the same before the attack, p99", ms(before, 0.99), "ms", note=f"{len(before)} orders"),
    ]
    print(json.dumps({figure.name: figure.value for figure in figures}, indent=1))
    write(given.out, "half_sent", "1010 half-sent requests in flight", begun, figures, page="people.md")
    sys.exit(bool(lost) or not lives)


if __name__ == "__main__":
    main()
