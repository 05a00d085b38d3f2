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
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager, suppress
from pathlib import Path
from urllib.parse import urlsplit

import psutil

from tests.benchmarks.figures.circumstances import begin
from tests.benchmarks.figures.writer import add_out, plain, wanted, write
from tests.benchmarks.under_attack import flight, ordered_afresh_s, quantile_ms

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


async def attack(port: int, halves: int, seconds: float) -> None:
    """Ends by itself."""
    with suppress(TimeoutError):
        async with asyncio.timeout(seconds):
            await asyncio.gather(*(hold_open(port, HEAD if n % 2 else BODY) for n in range(halves)))


@asynccontextmanager
async def stranger(port: int, halves: int) -> AsyncIterator[None]:
    """Attacks inside the block."""
    command = (sys.executable, "-m", "tests.benchmarks.half_sent", "--attack", str(port), "--halves", str(halves))
    process = await asyncio.create_subprocess_exec(*command)
    try:
        yield
    finally:
        process.kill()
        await process.wait()


async def strike(
    folder: Path, seconds: float, halves: int
) -> tuple[list[float | None], list[float | None], bool, list[float]]:
    """Orders before and during the attack, whether the websocket went on telling, and seconds of processor that the
    server took per second, before and during."""
    async with flight(folder) as (url, server, shown):

        async def orders(seconds: float) -> tuple[list[float | None], float]:
            taken: list[float | None] = []
            began, worked_s = time.monotonic(), processor_s(server.pid)
            while time.monotonic() < began + seconds:
                taken.append(await ordered_afresh_s(url, shown.mission_id))
                await asyncio.sleep(PAUSE_S)
            return taken, (processor_s(server.pid) - worked_s) / (time.monotonic() - began)

        before, usual = await orders(10.0)
        async with stranger(urlsplit(url).port or 0, halves):
            during, busy = await orders(seconds)
            heard = len(shown.messages["telemetry"])
            await orders(3.0)
            lives = len(shown.messages["telemetry"]) > heard
        return before, during, lives, [usual, busy]


def processor_s(pid: int) -> float:
    times = psutil.Process(pid).cpu_times()
    return times.user + times.system


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--attack", type=int, metavar="PORT", help="be the stranger")
    parser.add_argument("--halves", type=int, default=HALVES, help="half-sent requests at a time")
    parser.add_argument("--seconds", type=float, default=SECONDS, help="of orders during the attack")
    add_out(parser)
    given = parser.parse_args()
    _, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (hard, hard))
    if given.attack is not None:
        asyncio.run(attack(given.attack, given.halves, 600.0))
        return
    begun = begin(__file__)
    with tempfile.TemporaryDirectory(prefix="crossfix-half-sent-") as folder:
        before, during, lives, worked = asyncio.run(strike(Path(folder), given.seconds, given.halves))
    lost = sum(second is None for second in during)
    median_ms, worst_ms = quantile_ms(during, 0.5), quantile_ms(during, 1.0)
    note = f"{len(during)} orders, each on a new connection; median {median_ms:g} ms, worst {worst_ms:g} ms"
    figures = [
        wanted("half_sent", quantile_ms(during, 0.99), note=note),
        wanted("half_sent_lost", lost + (0 if lives else 1), note=f"of {len(during)} orders and an open websocket"),
        plain("the same before the attack, p99", quantile_ms(before, 0.99), "ms", note=f"{len(before)} orders"),
        *(
            plain(f"server {when} the attack, of one core", round(100.0 * share, 1), "%")
            for when, share in zip(("before", "during"), worked, strict=True)
        ),
    ]
    print(json.dumps({figure.name: figure.value for figure in figures}, indent=1))
    write(given.out, "half_sent", "1010 half-sent requests in flight", begun, figures, page="people.md")
    sys.exit(bool(lost) or not lives)


if __name__ == "__main__":
    main()
