"""Whatever arrives at the live channel, the server neither stumbles nor forgets its other viewers.

CROSSFIX_FUZZ_MESSAGES=100000 makes it a long run; `record.py` says how it is kept, and which seed it takes.
"""

from __future__ import annotations

import asyncio
import json
import logging
import os
import random
import time
from collections import Counter, deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path
from urllib.parse import quote

import httpx
import pytest
import websockets

from backend.cli.running import running_server
from backend.settings import Settings
from tests.benchmarks.figures.circumstances import begin
from tests.fuzz.record import SEED, Fuzzing

MESSAGES = int(os.environ.get("CROSSFIX_FUZZ_MESSAGES", "1000"))
A_CONNECTION = 25
AT_ONCE = 4
"""Connections beside one another."""
PATIENCE_S = 60.0
TOLD_EVERY = 5000
"""Messages from one line of progress to the next."""
KNOWN_CODES = {1000, 1006, 1007, 1009, 1013, 4400, 4404}
"""Ended by us; cut off while it went on sending, so that TCP's reset overtook the reason; no UTF-8; too long a message;
too many viewers; odd address; no such mission."""

NO_UTF_8 = "\ud800"
"""Sent as a text that it cannot be."""
PARTS = ["", "0", "1", "-1", "99999999999999999999", "1e9", "\x00", "é", "../..", "nobody", "{}", "a" * 70, "%"]

LIVE = Fuzzing(
    "fuzz_live", "Fuzzing the live channel", "fuzz_messages", "messages", "live channel", sums=("connections",)
)


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
            NO_UTF_8,
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


@contextmanager
def listening() -> Iterator[Faults]:
    faults, loggers = Faults(), [logging.getLogger(name) for name in ("uvicorn.error", "asyncio")]
    for logger in loggers:
        logger.addHandler(faults)
    try:
        yield faults
    finally:
        for logger in loggers:
            logger.removeHandler(faults)


def patient(address: str) -> websockets.connect:
    """On a busy machine a handshake takes its time, and nobody is gone because a pong is late."""
    return websockets.connect(
        address, max_queue=None, open_timeout=PATIENCE_S, close_timeout=PATIENCE_S, ping_interval=None
    )


@dataclass
class Attack:
    """One connection, made again from its seed: what it asked for, what it sent, how it ended."""

    seed: str
    address: str = ""
    sent: list[str | bytes] = field(default_factory=list)
    end: int | str = "open"

    async def make(self, url: str, mission_id: str) -> None:
        chance = random.Random(self.seed)
        self.address = f"{url.replace('http', 'ws')}/api/live?{query(chance, mission_id)}"
        try:
            websocket = await patient(self.address)
            async with websocket:
                for _ in range(A_CONNECTION):
                    self.sent.append(content(chance))
                    if self.sent[-1] == NO_UTF_8:
                        await websocket.send(b"\xff\xfe", text=True)
                    else:
                        await websocket.send(self.sent[-1])
        except websockets.ConnectionClosed as closed:
            self.end = int(closed.rcvd.code) if closed.rcvd else 1006
        except (OSError, TimeoutError, websockets.WebSocketException) as failure:
            self.end = repr(failure)
        else:
            self.end = int(websocket.close_code or 0)

    def __str__(self) -> str:
        last = ", ".join(f"{len(each)} of {each[:60]!r}" for each in self.sent[-3:])
        return (
            f"seed {self.seed}: {self.address} ended with {self.end} after {len(self.sent)} messages, the last: {last}"
        )


@dataclass
class Run:
    """All attacks so far."""

    sent: int = 0
    ends: Counter[int | str] = field(default_factory=Counter)
    last: deque[Attack] = field(default_factory=lambda: deque(maxlen=3 * AT_ONCE))

    def take(self, attack: Attack) -> None:
        self.sent += max(len(attack.sent), 1)
        self.ends[attack.end] += 1
        self.last.append(attack)

    def check(self, faults: Faults) -> None:
        """Fails with what was said, and with the attacks that it may have come from."""
        odd = [str(end) for end in self.ends if end not in KNOWN_CODES]
        if odd or faults.records:
            attacks = "\n".join(map(str, self.last))
            said = "\n".join([*faults.records, *odd])
            pytest.fail(f"after {self.sent} messages:\n{said}\nthe last connections:\n{attacks}", pytrace=False)


async def until(happened: Callable[[], bool], what: str) -> None:
    began = time.monotonic()
    while not happened():
        assert time.monotonic() - began < PATIENCE_S, what
        await asyncio.sleep(0.05)


async def attacks(url: str, mission_id: str, faults: Faults, run: Run, say: Callable[[str], None]) -> None:
    began, number = time.monotonic(), 0
    async with patient(f"{url.replace('http', 'ws')}/api/live?mission={mission_id}") as witness:
        while run.sent < MESSAGES:
            made = [Attack(f"{SEED}/{number + k}") for k in range(AT_ONCE)]
            number, before = number + AT_ONCE, run.sent
            await asyncio.gather(*(attack.make(url, mission_id) for attack in made))
            for attack in made:
                run.take(attack)
            run.check(faults)
            async with asyncio.timeout(PATIENCE_S):
                while json.loads(await witness.recv())["type"] != "telemetry":
                    pass
            if before // TOLD_EVERY != run.sent // TOLD_EVERY:
                say(f"{run.sent} messages, {time.monotonic() - began:.0f} s, {dict(run.ends)}")
        async with httpx.AsyncClient(base_url=url, timeout=PATIENCE_S) as client:
            spec = (await client.get("/api/defaults")).json()["spec"]
            renamed = await client.put(f"/api/missions/{mission_id}/spec", json={**spec, "name": "still here"})
            assert renamed.status_code == 200
            async with asyncio.timeout(PATIENCE_S):
                while "still here" not in str(await witness.recv()):
                    pass


@pytest.mark.system
@pytest.mark.timeout(120 + MESSAGES)
async def test_no_message_makes_the_live_channel_stumble(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    def say(line: str) -> None:
        with capsys.disabled():
            print(f"\n{line}", end="", flush=True)

    command = f"CROSSFIX_FUZZ_MESSAGES={MESSAGES} CROSSFIX_FUZZ_SEED={SEED} pytest tests/fuzz/test_live.py"
    begun = replace(begin(__file__), command=command)
    server_settings = Settings(
        port=0, data_dir=tmp_path, time_factor=10.0, spool_reserve_bytes=2**20, live_ping_timeout_s=60
    )
    run, ended_well = Run(), False
    LIVE.begin_anew()
    try:
        async with (
            running_server(server_settings) as running,
            httpx.AsyncClient(base_url=running.url, timeout=PATIENCE_S) as client,
        ):
            spec = (await client.get("/api/defaults")).json()["spec"]
            mission_id = (await client.post("/api/missions", json=spec)).json()["mission_id"]
            with listening() as faults:
                await attacks(running.url, mission_id, faults, run, say)
                await until(lambda: running.services.hub.viewers() == 0, "viewers that left are still counted")
                assert (await client.get(f"/api/missions/{mission_id}")).json()["phase"] == "draft"
                run.check(faults)
        ended_well = True
    finally:
        say(f"{run.sent} messages in {run.ends.total()} connections, ended with {dict(run.ends)}\n")
        LIVE.keep(begun, SEED, run.sent, int(not ended_well), {"connections": run.ends.total()})
