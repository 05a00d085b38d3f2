"""Companion computers are let in by their token, and what they deliver reaches the receiver."""

from __future__ import annotations

import asyncio
import json
from dataclasses import replace

import pytest
import websockets
from narrowing import known

from hardware.payload.messages import PROTOCOL
from hardware.payload.session import PayloadSession

TOKEN = "a token of sixteen letters or more"
HELLO = {"type": "hello", "protocol": PROTOCOL, "agent": "pi", "stream": "s", "software": "0", "first_seq": 1}
SAMPLE = [1.7e9, 868.3e6, -80.0, None, False, True]
SAMPLES = {"type": "samples", "first_seq": 1, "oldest_seq": 1, "clock_offset_s": None, "samples": [SAMPLE] * 3}


def connect(served: str, token: str = TOKEN):
    return websockets.connect(f"ws://{served}/api/payload", additional_headers={"Authorization": f"Bearer {token}"})


async def ask(websocket, message: dict) -> dict:
    await websocket.send(json.dumps(message))
    return json.loads(await asyncio.wait_for(websocket.recv(), 60))


async def test_samples_reach_the_receiver_once(served, services):
    subscription = services.payload.subscribe()
    async with connect(served) as websocket:
        assert (await ask(websocket, HELLO))["type"] == "welcome"
        assert await ask(websocket, SAMPLES) == {"type": "ack", "seq": 3}
        assert await ask(websocket, SAMPLES) == {"type": "ack", "seq": 3}
        assert services.payload.connected()
    got = [await asyncio.wait_for(subscription.get(), 60) for _ in range(3)]
    assert [sample.power_db for sample in got] == [-80.0] * 3
    with pytest.raises(TimeoutError):
        await asyncio.wait_for(subscription.get(), 0.05)
    async with asyncio.timeout(60):
        while services.payload.connected():  # noqa: ASYNC110 (the server's side of a closed socket has no event)
            await asyncio.sleep(0.01)


@pytest.mark.parametrize("token", ["", "another token of sixteen letters", "é" * 20])
async def test_an_unknown_token_is_refused_before_anything_is_said(served, token):
    with pytest.raises(websockets.InvalidStatus) as refused:
        await connect(served, token.encode().decode("latin-1"))
    assert refused.value.response.status_code == 401


async def test_a_server_without_tokens_takes_no_payload(served, app, services):
    app.state.services = replace(services, payload=None)
    with pytest.raises(websockets.InvalidStatus) as refused:
        await connect(served)
    assert refused.value.response.status_code == 404


@pytest.mark.parametrize("content", ["", "{}", "[" * 5000, b"\xff\x00", json.dumps(SAMPLES), "x" * 200_000])
async def test_what_is_not_understood_is_told_and_ends_the_talk(served, content):
    async with connect(served) as websocket:
        await websocket.send(content)
        said = json.loads(await asyncio.wait_for(websocket.recv(), 60))
        assert said["type"] == "refused"
        assert said["reason"]
        with pytest.raises(websockets.ConnectionClosed) as closed:
            await asyncio.wait_for(websocket.recv(), 60)
    assert known(closed.value.rcvd).code == 1008


async def test_the_console_is_told_how_a_payload_is(client, services):
    hub = services.payload
    session = PayloadSession(hub)
    hello = {
        "type": "hello",
        "protocol": PROTOCOL,
        "agent": "pi",
        "stream": "s1",
        "software": "crossfix 1",
        "first_seq": 1,
    }
    status = {
        "type": "status",
        "receiver": {"code": "payload_listening", "channels": 1},
        "receiver_ok": True,
        "temperature_c": 51.5,
        "clock_offset_s": 0.25,
        "round_trip_s": 0.04,
        "clipped_percent": 2.5,
        "waiting": 7,
        "lost": 0,
    }
    session.receive(json.dumps(hello))
    session.receive(json.dumps(status))
    told = (await client.get("/api/payloads")).json()
    assert told["expected"]
    (payload,) = told["payloads"]
    assert payload == {"name": "pi", "connected": True, "age_s": 0.0, "software": "crossfix 1", "received": 0} | {
        key: value for key, value in status.items() if key != "type"
    }
    session.close()
    assert not (await client.get("/api/payloads")).json()["payloads"][0]["connected"]
