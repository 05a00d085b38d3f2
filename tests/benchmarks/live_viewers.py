"""The viewers of `live_load`: some read everything and measure how late it is, some never read again."""

from __future__ import annotations

import asyncio
import base64
import json
import os
import socket
import sys
import time
from datetime import datetime

import websockets


def stalled_viewer(port: int, mission_id: str) -> socket.socket:
    """Shakes hands and never reads again."""
    client = socket.socket()
    client.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 2048)
    client.connect(("127.0.0.1", port))
    key = base64.b64encode(os.urandom(16)).decode()
    head = f"GET /api/live?mission={mission_id} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nUpgrade: websocket\r\n"
    client.sendall(
        f"{head}Connection: Upgrade\r\nSec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n\r\n".encode()
    )
    return client


class Tally:
    """Delays in ms of telemetry messages, and what each viewer got."""

    def __init__(self) -> None:
        self.delays_ms: list[float] = []
        self.dropped = 0
        self.gaps = 0
        self.messages = 0
        self.bytes = 0


async def view(port: int, mission_id: str, tally: Tally, lite: bool = False) -> None:
    last_seq = 0
    url = f"ws://127.0.0.1:{port}/api/live?mission={mission_id}&lite={int(lite)}"
    async with websockets.connect(url, compression=None, max_queue=None) as websocket:
        async for content in websocket:
            now = time.time()
            tally.messages += 1
            tally.bytes += len(content)
            if isinstance(content, bytes):
                continue
            if content.startswith('{"type":"telemetry"'):
                message = json.loads(content)
                tally.delays_ms.append(1e3 * (now - datetime.fromisoformat(message["at_utc"]).timestamp()))
                tally.dropped = max(tally.dropped, message["dropped"])
            elif content.startswith('{"type":"event"'):
                seq = json.loads(content)["recorded"]["seq"]
                tally.gaps += seq != last_seq + 1
                last_seq = seq


async def viewers_only(port: int, viewers: int, stalled: int) -> None:
    """Reads mission ids, one a line; all viewers go over to the new one, then a line says so."""
    tasks: list[asyncio.Task[None]] = []
    sockets: list[socket.socket] = []
    while mission_id := (await asyncio.to_thread(sys.stdin.readline)).strip():
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)
        for client in sockets:
            client.close()
        sockets = [await asyncio.to_thread(stalled_viewer, port, mission_id) for _ in range(stalled)]
        tallies = [Tally() for _ in range(viewers)]
        tasks = [asyncio.create_task(view(port, mission_id, tally)) for tally in tallies]
        while not all(tally.messages for tally in tallies):  # noqa: ASYNC110 (tasks of this process join)
            await asyncio.sleep(0.02)
        print("joined", flush=True)
    for task in tasks:
        task.cancel()
    await asyncio.gather(*tasks, return_exceptions=True)
