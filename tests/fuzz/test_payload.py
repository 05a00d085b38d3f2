"""Odd messages from payloads: each session ends with a reason or goes on, and no wrong sample passes.

CROSSFIX_FUZZ_MESSAGES=100000 makes it a long run (`make fuzz`). CROSSFIX_FUZZ_OUT names the folder for a record of what
was found.
"""

from __future__ import annotations

import json
import math
import os
import random
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from hardware.payload.messages import PROTOCOL
from hardware.payload.session import PayloadHub, PayloadSession
from tests.benchmarks.figures.circumstances import begin
from tests.benchmarks.figures.writer import plain, wanted, write

MESSAGES = int(os.environ.get("CROSSFIX_FUZZ_MESSAGES", "2000"))
OUT = os.environ.get("CROSSFIX_FUZZ_OUT")
HELLO = {"type": "hello", "protocol": PROTOCOL, "agent": "pi", "stream": "s", "software": "0", "first_seq": 1}
SAMPLE = [1.7e9, 8e8, -80.0, None, False, True]
SAMPLES = {"type": "samples", "first_seq": 1, "oldest_seq": 1, "clock_offset_s": None, "samples": [SAMPLE] * 3}
STATUS = {
    "type": "status",
    "receiver": {"code": "payload_listening", "channels": 1},
    "receiver_ok": True,
    "temperature_c": None,
    "clock_offset_s": None,
    "round_trip_s": None,
    "clipped_percent": 0,
    "waiting": 0,
    "lost": 0,
}
PING = {"type": "ping", "agent_s": 1.0}
ODD: list[Any] = [None, True, -1, 0, 2**70, 1e308, "", "x" * 500, [], {}, [[1]], "NaN", math.nan, math.inf, "\0"]
SPLINTERS = ["", '"', "}", "\0", "9" * 400, "[" * 900]


def mutated(message: dict[str, Any], chance: random.Random) -> str:
    message = dict(message)
    for _ in range(chance.randint(0, 2)):
        key = chance.choice([*message, "extra"])
        if chance.random() < 0.3:
            message.pop(key, None)
        else:
            message[key] = chance.choice(ODD)
    text = json.dumps(message)
    if chance.random() < 0.2:
        at = chance.randrange(len(text) + 1)
        text = text[:at] + chance.choice(SPLINTERS) + text[at + chance.randint(0, 5) :]
    return text


@pytest.mark.timeout(60 + MESSAGES // 100)
def test_no_message_of_a_payload_makes_the_server_stumble(capsys: pytest.CaptureFixture[str]) -> None:
    chance, hub = random.Random(5), PayloadHub(("a token of sixteen letters or more",))
    begun = replace(begin(__file__), command=f"CROSSFIX_FUZZ_MESSAGES={MESSAGES} pytest tests/fuzz/test_payload.py")
    heard, sent, sessions, refused = hub.subscribe(), 0, 0, 0
    while sent < MESSAGES:
        session = PayloadSession(hub)
        sessions += 1
        if chance.random() < 0.8:
            session.receive(json.dumps(HELLO))
            sent += 1
        for _ in range(chance.randint(1, 40)):
            session.receive(mutated(chance.choice([HELLO, SAMPLES, SAMPLES, STATUS, PING, PING]), chance))
            sent += 1
            if session.refused:
                refused += 1
                break
        answers = [json.loads(session.outgoing.get_nowait()) for _ in range(session.outgoing.qsize())]
        told = [answer["reason"] for answer in answers if answer["type"] == "refused"]
        assert len(told) == session.refused
        assert all(told)
        session.close()
    assert not hub.connected()
    with capsys.disabled():
        print(f"\n{sent} messages in {sessions} sessions, {refused} of them refused")
    passed = list(heard._samples)
    assert passed
    assert all(math.isfinite(s.power_db) and math.isfinite(s.at_s) and abs(s.power_db) <= 400.0 for s in passed)
    figures = [
        wanted("fuzz_messages", sent, of="payload"),
        wanted("fuzz_failures", 0, of="payload"),
        plain("sessions", sessions, ""),
        plain("sessions refused", refused, ""),
    ]
    page = "faults-in-flight.md#fuzzing"
    write(Path(OUT) if OUT else None, "fuzz_payload", "Fuzzing the payload's link", begun, figures, page=page)
