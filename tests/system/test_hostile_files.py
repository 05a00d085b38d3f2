"""Files from outside, uploaded while a mission flies: an order is answered before the file is read to its end."""

from __future__ import annotations

import asyncio

import pytest
from console import Console
from hostile_files import HostileFile, hostile_files

pytestmark = pytest.mark.system


@pytest.fixture
def speedup() -> float:
    """Slow: minutes of uploads on a busy machine must not empty the battery that holds the vehicle."""
    return 2.0


async def upload(operator: Console, file: HostileFile) -> int:
    reply = await operator.client.post(
        file.to(operator.mission_id), content=file.content, headers={"content-type": file.kind}, timeout=120
    )
    if reply.status_code >= 400:
        assert reply.json()["reason"]["code"], reply.text
    return reply.status_code


def size_of_file(file: HostileFile) -> int:
    """Of what is accepted: the largest is read longest."""
    return len(file.content) if file.accepted else 0


async def test_no_file_holds_up_an_order_or_stops_the_server(operator: Console) -> None:
    await operator.start()
    await operator.until_phase("flying")
    waiting = asyncio.create_task(upload(operator, max(hostile_files(), key=size_of_file)))
    await asyncio.sleep(0.3)  # it is being read
    held = await operator.order("hold")
    assert held["accepted"], held
    assert not waiting.done()
    await waiting

    for file in hostile_files():
        reading = asyncio.create_task(upload(operator, file))
        looks = 0
        while not reading.done():
            assert (await operator.client.get("/api/health")).status_code == 200
            looks += 1
            await asyncio.sleep(0.05)
        assert (reading.result() < 400) == file.accepted, (file.name, reading.result())
        assert reading.result() < 500, file.name
        assert looks > 0
    for listed in ("/api/maps", "/api/overlays"):
        assert (await operator.client.get(listed)).status_code == 200
    assert operator.phases[-1] == "hold"
    assert (await operator.order("abort"))["accepted"]
