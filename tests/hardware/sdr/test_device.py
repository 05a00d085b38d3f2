"""Receivers by name, as the command line takes them."""

from __future__ import annotations

import asyncio
import struct

import pytest

from hardware.clock import WallClock
from hardware.ports import ReceiverError
from hardware.readings import Channel
from hardware.sdr.device import receiver_from
from hardware.sdr.rtl_tcp import SET_FREQUENCY


async def test_rtl_tcp_is_opened_where_its_name_says() -> None:
    tuned = asyncio.get_running_loop().create_future()

    async def greet(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        writer.write(struct.pack(">4sII", b"RTL0", 5, 29))
        orders = list(struct.iter_unpack(">BI", await reader.readexactly(6 * 5)))
        tuned.set_result(dict(orders)[SET_FREQUENCY])
        await reader.read(-1)
        writer.close()

    listening = await asyncio.start_server(greet, "127.0.0.1", 0)
    receiver = receiver_from(f"rtl_tcp://127.0.0.1:{listening.sockets[0].getsockname()[1]}", WallClock())
    await receiver.open([Channel(433_920_000.0)])
    assert await tuned == pytest.approx(433_920_000, abs=150_000)
    await receiver.close()
    listening.close()


@pytest.mark.parametrize(
    ("name", "told"),
    [
        ("rtl_tcp://", "names no host"),
        ("rtl_tcp://host:port", "not a number"),
        ("rtl_tcp:host", "not understood"),
        ("soapy:", "not understood"),
        ("soapy:serial=1", "names no driver"),
        ("radio", "not understood"),
    ],
)
def test_a_name_that_is_not_understood_says_what_to_write(name: str, told: str) -> None:
    with pytest.raises(ReceiverError, match=told):
        receiver_from(name, WallClock())
