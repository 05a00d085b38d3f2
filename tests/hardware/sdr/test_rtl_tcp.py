"""The rtl_tcp client against a server that speaks the real protocol, on a real socket."""

from __future__ import annotations

import asyncio
import struct
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager

import numpy as np
import pytest
from refusals import refusing

from hardware.ports import ReceiverError
from hardware.readings import Channel
from hardware.reasons.radio import NotRtlTcp, RtlSdrSampleRate, RtlTcpEnded, RtlTcpUnreachable
from hardware.reasons.receiver import ReceiverSilent
from hardware.sdr.receiver import IqReceiver
from hardware.sdr.rtl_tcp import RtlTcpSource

RATE_HZ = 250_000.0


class RtlTcpServer:
    """Streams a tone 20 kHz above the centre it was last tuned to... as the frequency command says."""

    def __init__(self, emitter_hz: float, greeting: bytes = b"RTL0", stop_after: int | None = None) -> None:
        self.emitter_hz = emitter_hz
        self.greeting = greeting
        self.stop_after = stop_after
        self.commands: list[tuple[int, int]] = []
        self.port = 0

    async def serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        writer.write(struct.pack(">4sII", self.greeting, 5, 29))
        listening = asyncio.create_task(self._listen(reader))
        sent = 0
        rng = np.random.default_rng(1)
        try:
            while self.stop_after is None or sent < self.stop_after:
                await asyncio.sleep(0.005)
                centre = next((value for code, value in reversed(self.commands) if code == 0x01), None)
                if centre is None:
                    continue
                t = (sent + np.arange(2500)) / RATE_HZ
                iq = 0.25 * np.exp(2j * np.pi * (self.emitter_hz - centre) * t)
                iq = iq + 0.005 * (rng.normal(size=t.size) + 1j * rng.normal(size=t.size))
                pairs = np.column_stack([iq.real, iq.imag]) * 127.5 + 127.5
                writer.write(np.clip(np.round(pairs), 0, 255).astype(np.uint8).tobytes())
                await writer.drain()
                sent += t.size
        except (ConnectionError, OSError):
            pass
        finally:
            listening.cancel()
            writer.close()

    async def _listen(self, reader: asyncio.StreamReader) -> None:
        while True:
            code, value = struct.unpack(">BI", await reader.readexactly(5))
            self.commands.append((code, value))


@asynccontextmanager
async def running(server: RtlTcpServer) -> AsyncIterator[RtlTcpServer]:
    listening = await asyncio.start_server(server.serve, "127.0.0.1", 0)
    server.port = listening.sockets[0].getsockname()[1]
    try:
        yield server
    finally:
        listening.close()


async def test_power_of_a_tone_through_the_whole_chain() -> None:
    async with running(RtlTcpServer(433_920_000.0)) as server:
        receiver = IqReceiver(RtlTcpSource("127.0.0.1", server.port, RATE_HZ, gain_db=28.0, settle_s=0.1))
        await receiver.open([Channel(433_920_000.0)])
        heard = []
        async for sample in receiver.samples():
            heard.append(sample)
            if len(heard) == 6:
                break
        await receiver.close()
    assert [s.power_db for s in heard] == pytest.approx([20 * np.log10(0.25) - 28.0] * 6, abs=0.5)
    assert all(s.noise_floor_db is not None and s.noise_floor_db < s.power_db - 20.0 for s in heard)
    codes = dict(server.commands)
    assert codes[0x02] == 250_000
    assert codes[0x03] == 1
    assert codes[0x04] == 280
    assert codes[0x08] == 0


async def test_stream_that_ends_and_stranger_and_nobody_are_clear_errors() -> None:
    async with running(RtlTcpServer(433_920_000.0, stop_after=30_000)) as server:
        receiver = IqReceiver(RtlTcpSource("127.0.0.1", server.port, RATE_HZ))
        await receiver.open([Channel(433_920_000.0)])
        with refusing(RtlTcpEnded(f"127.0.0.1:{server.port}", broken=False), ReceiverError):
            async for _ in receiver.samples():
                pass
        await receiver.close()
    async with running(RtlTcpServer(1.0, greeting=b"HTTP")) as server:
        with refusing(NotRtlTcp, ReceiverError):
            await RtlTcpSource("127.0.0.1", server.port).open(433e6)
    with refusing(RtlTcpUnreachable, ReceiverError):
        await RtlTcpSource("127.0.0.1", server.port).open(433e6)


async def test_silent_server_is_noticed() -> None:
    async def mute(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        writer.write(struct.pack(">4sII", b"RTL0", 5, 29))
        await reader.read(-1)
        writer.close()

    listening = await asyncio.start_server(mute, "127.0.0.1", 0)
    receiver = IqReceiver(RtlTcpSource("127.0.0.1", listening.sockets[0].getsockname()[1]), silent_after_s=0.2)
    await receiver.open([Channel(433_920_000.0)])
    with refusing(ReceiverSilent(0.2), ReceiverError):
        await anext(receiver.samples())
    await receiver.close()
    listening.close()


def test_impossible_sample_rate_is_refused() -> None:
    with refusing(RtlSdrSampleRate(48_000.0), ReceiverError):
        RtlTcpSource("127.0.0.1", sample_rate_hz=48_000.0)


@pytest.mark.parametrize("greeting", [b"", b"RTL0", b"HTTP/1.1 200"])
async def test_a_refused_opening_leaves_no_connection(greeting: bytes) -> None:
    gone = asyncio.Event()

    async def stranger(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        writer.write(greeting)
        await reader.read()
        writer.close()
        gone.set()

    listening = await asyncio.start_server(stranger, "127.0.0.1", 0)
    source = RtlTcpSource("127.0.0.1", listening.sockets[0].getsockname()[1], timeout_s=0.2)
    with pytest.raises(ReceiverError):
        await source.open(433e6)
    async with asyncio.timeout(60):
        await gone.wait()
    listening.close()
