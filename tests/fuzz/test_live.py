"""Whatever arrives at the live channel, the server neither stumbles nor forgets its other viewers.

CROSSFIX_FUZZ_MESSAGES=100000 makes it a long run. CROSSFIX_FUZZ_OUT names the folder for a record of what was found.
"""

from __future__ import annotations

import asyncio
import json
import logging
import os
import random
from collections import Counter
from dataclasses import replace
from pathlib import Path
from urllib.parse import quote

import httpx
import pytest
import websockets

from backend.cli.running import running_server
from backend.settings import Settings
from tests.benchmarks.figures.circumstances import begin
from tests.benchmarks.figures.writer import plain, wanted, write

MESSAGES = int(os.environ.get("CROSSFIX_FUZZ_MESSAGES", "1000"))
OUT = os.environ.get("CROSSFIX_FUZZ_OUT")
A_CONNECTION = 25
KNOWN_CODES = {1000, 1007, 1009, 1013, 4400, 4404}
"""Ended by us, no UTF-8, too long a message, too many viewers, odd address, no such mission."""

PARTS = ["", "0", "1", "-1", "99999999999999999999", "1e9", "\x00", "é", "../..", "nobody", "{}", "a" * 70, "%"]


def query(chance: random.Random, mission_id: str) -> str:
    chosen = []
    for name in ("mission", "after", "lite", "other"):
        if chance.random() < 0.6:
            good = {"mission": mission_id, "after": "0", "lite": "1", "other": "x"}[name]
            chosen.append(f"{name}={quote(good if chance.random() < 0.6 else chance.choice(PARTS))}")
    return "&".join(chosen)


def content(chance: random.Random) -> str | bytes:
    command = {"command_id": "6f2f6c8e-7f6a-4b0a-9b9a-0c8b1c8b1c8b", "command": {"kind": "abort"}}
    return chance.choice(
        [
            "",
            json.dumps(command),
            json.dumps({"type": "telemetry", "lat": chance.random()}),
            "[" * chance.randrange(5000),
            chance.randbytes(chance.randrange(2000)),
            "\x00" * chance.randrange(100),
            chance.choice(PARTS),
            "x" * 66_000,
        ]
    )


class Faults(logging.Handler):
    """What the server logs as an error of its own; its log does not reach pytest."""

    def __init__(self) -> None:
        super().__init__(logging.ERROR)
        self.records: list[str] = []

    def emit(self, record: logging.LogRecord) -> None:
        self.records.append(self.format(record))


async def one_connection(url: str, chance: random.Random, mission_id: str, ends: Counter[int]) -> int:
    sent = 0
    address = f"{url.replace('http', 'ws')}/api/live?{query(chance, mission_id)}"
    try:
        async with websockets.connect(address, max_queue=None) as websocket:
            for _ in range(A_CONNECTION):
                await websocket.send(content(chance))
                sent += 1
    except websockets.ConnectionClosed as closed:
        ends[closed.rcvd.code if closed.rcvd else 0] += 1
    else:
        ends[1000] += 1
    return max(sent, 1)


@pytest.mark.system
@pytest.mark.timeout(120 + MESSAGES)
async def test_no_message_makes_the_live_channel_stumble(tmp_path: Path, capsys):
    chance, ends, sent, faults = random.Random(7), Counter(), 0, Faults()
    begun = replace(begin(__file__), command=f"CROSSFIX_FUZZ_MESSAGES={MESSAGES} pytest tests/fuzz/test_live.py")
    server_settings = Settings(
        port=0, data_dir=tmp_path, time_factor=10.0, spool_reserve_bytes=2**20, live_ping_timeout_s=60
    )
    async with running_server(server_settings) as running, httpx.AsyncClient(base_url=running.url) as client:
        logging.getLogger("uvicorn.error").addHandler(faults)
        spec = (await client.get("/api/defaults")).json()["spec"]
        mission_id = (await client.post("/api/missions", json=spec)).json()["mission_id"]
        async with websockets.connect(f"{running.url.replace('http', 'ws')}/api/live?mission={mission_id}") as witness:
            while sent < MESSAGES:
                sent += await one_connection(running.url, chance, mission_id, ends)
                async with asyncio.timeout(60):
                    while json.loads(await witness.recv())["type"] != "telemetry":
                        pass
            renamed = await client.put(f"/api/missions/{mission_id}/spec", json={**spec, "name": "still here"})
            assert renamed.status_code == 200
            async with asyncio.timeout(60):
                while "still here" not in str(await witness.recv()):
                    pass
        assert (await client.get(f"/api/missions/{mission_id}")).json()["phase"] == "draft"
        async with asyncio.timeout(60):
            while (await client.get("/api/health")).json()["viewers"]:  # noqa: ASYNC110 (a server elsewhere)
                await asyncio.sleep(0.05)
    with capsys.disabled():
        print(f"\n{sent} messages in {sum(ends.values())} connections, ended with {dict(ends)}")
    assert set(ends) <= KNOWN_CODES
    assert faults.records == []
    figures = [
        wanted("fuzz_messages", sent, of="live channel"),
        wanted("fuzz_failures", 0, of="live channel"),
        plain("connections", sum(ends.values()), ""),
    ]
    page = "faults-in-flight.md#fuzzing"
    write(Path(OUT) if OUT else None, "fuzz_live", "Fuzzing the live channel", begun, figures, page=page)
