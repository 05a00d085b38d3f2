"""Bytes a minute that a viewer is sent, normal and lite beside each other on one flight: one JSON object.

    python -m tests.benchmarks.page_bytes --minutes 3 --speedup 1

By kind of message, kilobytes (1000 bytes) of the websocket's content a minute of wall time. Both viewers must have got
the same events.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import tempfile
import time
from collections import Counter
from pathlib import Path
from typing import Any
from uuid import uuid4

import httpx
import websockets

from tests.benchmarks.figures.circumstances import begin
from tests.benchmarks.figures.record import Column, Figure, Table
from tests.benchmarks.figures.writer import add_out, plain, write
from tests.browser.conftest import serving
from tests.browser.served import Server


def start(server: Server) -> str:
    mission_id, base = server.draft(expected_rmse_m=0.1, maximum_bearings=200), server.url.rstrip("/")
    while not httpx.post(f"{base}/api/missions/{mission_id}/preflight", timeout=30).json()["passed"]:
        time.sleep(0.5)
    command(server, mission_id, "start")
    return mission_id


def command(server: Server, mission_id: str, kind: str) -> None:
    body = {"command_id": str(uuid4()), "command": {"kind": kind}}
    httpx.post(f"{server.url.rstrip('/')}/api/missions/{mission_id}/commands", json=body, timeout=30).raise_for_status()


async def watch(server: Server, mission_id: str, lite: bool, seconds: float) -> tuple[Counter[str], list[int]]:
    """Bytes by kind, and the numbers of the events."""
    counted: Counter[str] = Counter()
    events: list[int] = []
    address = server.url.replace("http", "ws").rstrip("/") + f"/api/live?mission={mission_id}&lite={int(lite)}"
    async with websockets.connect(address, max_size=None, compression=None) as socket:
        try:
            async with asyncio.timeout(seconds):
                async for content in socket:
                    if isinstance(content, bytes):
                        counted["belief"] += len(content)
                        continue
                    message = json.loads(content)
                    kind = message["type"]
                    if kind == "event":
                        events.append(message["recorded"]["seq"])
                        kind = f"event {message['recorded']['event']['kind']}"
                    counted[kind] += len(content.encode())
        except TimeoutError:
            pass
    return counted, events


async def both(server: Server, mission_id: str, seconds: float) -> dict[str, Any]:
    (normal, events), (lite, thin) = await asyncio.gather(
        watch(server, mission_id, False, seconds), watch(server, mission_id, True, seconds)
    )
    shared = min(len(events), len(thin))
    assert events[:shared] == thin[:shared] == list(range(1, shared + 1)), "a viewer missed an event"

    def told(counted: Counter[str]) -> dict[str, float]:
        a_minute = {kind: round(60 * n / seconds / 1000, 1) for kind, n in counted.most_common()}
        return {"all": round(sum(a_minute.values()), 1), **a_minute}

    return {"kilobytes_a_minute": {"normal": told(normal), "lite": told(lite)}, "events": [len(events), len(thin)]}


def figures(found: dict[str, Any]) -> list[Figure]:
    sent = found["kilobytes_a_minute"]
    return [plain(f"sent to a viewer, {kind}", sent[kind]["all"], "kB/min") for kind in ("normal", "lite")]


def by_kind(found: dict[str, Any]) -> Table:
    sent = found["kilobytes_a_minute"]
    rows = tuple((kind, value, sent["lite"].get(kind, 0.0)) for kind, value in sent["normal"].items())
    columns = tuple(Column(name=name) for name in ("message", "normal, kB/min", "lite, kB/min"))
    return Table(name="kinds", columns=columns, rows=rows)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--minutes", type=float, default=3.0)
    parser.add_argument("--speedup", type=float, default=1.0)
    add_out(parser)
    arguments = parser.parse_args()
    begun = begin(__file__)
    with tempfile.TemporaryDirectory() as folder, serving(Path(folder), arguments.speedup) as server:
        mission_id = start(server)
        found = asyncio.run(both(server, mission_id, 60 * arguments.minutes))
        print(json.dumps(found))
        command(server, mission_id, "abort")
    title, page = "What a viewer is sent", "page-speed.md#what-a-viewer-is-sent"
    write(arguments.out, "page_bytes", title, begun, figures(found), tables=[by_kind(found)], page=page)


if __name__ == "__main__":
    main()
