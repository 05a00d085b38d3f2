"""Files from outside while a mission flies (figure 20): how soon is an order answered, what does the server take?

    python -m tests.benchmarks.hostile_uploads --out docs/measurements

`crossfix serve` in a process of its own flies the simulated vehicle. Each file of tests/doubles/hostile_files.py, those
of 50 MB among them, is uploaded; meanwhile hold is ordered over and over, and each answer timed at the client. Memory
is the resident set of the server and of the process that reads files, above what both took before the file; the latter
has read a sound file of each kind then, so that its libraries are loaded. What stays in memory after the last file is
a figure of its own. Fails when a file or an order gets no answer or a file an answer of the kind 5xx.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import sys
import tempfile
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import httpx
import psutil

from tests.benchmarks.figures.circumstances import begin
from tests.benchmarks.figures.writer import add_out, plain, wanted, write
from tests.benchmarks.under_attack import flight, ordered_s, quantile_ms
from tests.doubles.hostile_files import (
    HostileFile,
    archive,
    hostile_files,
    kml,
    large_files,
    log_of_turns,
    long_line,
    point,
    recording,
    zipped,
)
from tests.system.console import Console

LARGE_BYTES = 50 * 10**6
PAUSE_S = 0.05
LOOK_S = 0.05


@dataclass
class Taken:
    """orders_s: answers to hold meanwhile. most_bytes: above what the processes took before it."""

    name: str
    status: int = 0
    answer_s: float = 0.0
    orders_s: list[float | None] = field(default_factory=list[float | None])
    most_bytes: int = 0


def resident_bytes(process: psutil.Process) -> int:
    total = 0
    for each in [process, *process.children(recursive=True)]:
        try:
            total += each.memory_info().rss
        except psutil.NoSuchProcess:
            continue
    return total


def large_overlay() -> bytes:
    point = b'{"type":"Feature","properties":{},"geometry":{"type":"Point","coordinates":[7.2,50.6]}}'
    return b'{"type":"FeatureCollection","features":[' + b",".join([point] * (LARGE_BYTES // (len(point) + 1))) + b"]}"


def sound_files() -> list[HostileFile]:
    """One for each reader."""
    placemark = kml(point("7,50"))
    area = "<Placemark><Polygon><outerBoundaryIs><LinearRing><coordinates>7,50 7.1,50 7.1,50.1 7,50</coordinates>"
    area += "</LinearRing></outerBoundaryIs></Polygon></Placemark>"
    return [
        HostileFile("a line", "/api/overlays", long_line(200_000), True),
        HostileFile("a KML", "/api/overlays", placemark, True),
        HostileFile("a KMZ", "/api/overlays", zipped(placemark), True),
        HostileFile("an area", "/api/areas", json.dumps({"text": kml(area).decode()}).encode(), True),
        HostileFile("a map", "/api/maps", archive(b"{}"), True),
        recording("a log of elsewhere", "log.csv", log_of_turns(1000)),
    ]


async def uploaded(client: httpx.AsyncClient, file: HostileFile, mission_id: str) -> int:
    headers = {"content-type": file.kind}
    return (await client.post(file.to(mission_id), content=file.content, headers=headers, timeout=180)).status_code


SENDER = """
import json, sys, time
import httpx
url, kind, path = sys.argv[1:]
content = open(path, "rb").read()
began = time.monotonic()
status = httpx.post(url, content=content, headers={"content-type": kind}, timeout=180).status_code
print(json.dumps([status, time.monotonic() - began]))
"""


async def uploaded_apart(url: str, file: HostileFile, mission_id: str, folder: Path) -> tuple[int, float]:
    """Status and seconds of an upload by another process: to send 50 MB would hold up the orders timed here."""
    path = folder / "upload"
    path.write_bytes(file.content)
    sender = await asyncio.create_subprocess_exec(
        sys.executable, "-c", SENDER, url + file.to(mission_id), file.kind, str(path), stdout=asyncio.subprocess.PIPE
    )
    said, _ = await sender.communicate()
    status, answer_s = json.loads(said)
    return status, answer_s


async def measure(shown: Console, server: psutil.Process, file: HostileFile, folder: Path) -> Taken:
    taken, usual = Taken(file.name), resident_bytes(server)

    async def remember() -> None:
        while True:
            taken.most_bytes = max(taken.most_bytes, resident_bytes(server) - usual)
            await asyncio.sleep(LOOK_S)

    async def order() -> None:
        while True:
            taken.orders_s.append(await ordered_s(shown.client, shown.mission_id))
            await asyncio.sleep(PAUSE_S)

    beside = [asyncio.create_task(remember()), asyncio.create_task(order())]
    taken.status, taken.answer_s = await uploaded_apart(shown.url, file, shown.mission_id, folder)
    await asyncio.sleep(2 * PAUSE_S)
    for task in beside:
        task.cancel()
    await asyncio.gather(*beside, return_exceptions=True)
    return taken


async def run(folder: Path) -> tuple[list[Taken], int]:
    """Of each file, and the bytes by which memory grew over all of them."""
    async with flight(folder) as (_, process, shown):
        overlay = HostileFile("an overlay of 50 MB", "/api/overlays", large_overlay(), False)
        files = [overlay, *large_files(), *hostile_files()]
        server = psutil.Process(process.pid)
        for sound in sound_files():
            if (await uploaded(shown.client, sound, shown.mission_id) < 300) != sound.accepted:
                raise RuntimeError(f"not as expected: {sound.name}")
        usual = resident_bytes(server)
        found = [await measure(shown, server, file, folder) for file in files]
        return found, resident_bytes(server) - usual


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add_out(parser)
    given = parser.parse_args()
    begun = begin(__file__)
    with tempfile.TemporaryDirectory(prefix="crossfix-uploads-") as folder:
        found, kept = asyncio.run(run(Path(folder)))
    orders = [second for taken in found for second in taken.orders_s]
    slowest = max(found, key=lambda taken: quantile_ms(taken.orders_s, 1.0) if taken.orders_s else 0.0)
    heaviest = max(found, key=lambda taken: taken.most_bytes)
    latest = max(found, key=lambda taken: taken.answer_s)
    rows: list[dict[str, Any]] = [
        {
            "file": taken.name,
            "status": taken.status,
            "answer_s": round(taken.answer_s, 2),
            "worst_order_ms": quantile_ms(taken.orders_s, 1.0) if taken.orders_s else None,
            "most_mb": round(taken.most_bytes / 1e6, 1),
        }
        for taken in found
    ]
    print(json.dumps(rows, indent=1))
    lost = orders.count(None)
    note = f"{len(orders)} orders to hold, median {quantile_ms(orders, 0.5):g} ms; worst beside: {slowest.name}"
    figures = [
        wanted("upload_abort", quantile_ms(orders, 1.0), note=note),
        wanted("upload_memory", round(heaviest.most_bytes / 1e6, 1), note=f"with its reading process; {heaviest.name}"),
        wanted("upload_answer", round(latest.answer_s, 2), note=latest.name),
        plain("memory that stays after all of them", round(kept / 1e6, 1), "MB", note=f"{len(found)} files"),
    ]
    write(given.out, "hostile_uploads", "Files from outside in flight", begun, figures, page="user-guide.md")
    sys.exit(bool(lost) or any(not 200 <= taken.status < 500 for taken in found))


if __name__ == "__main__":
    main()
