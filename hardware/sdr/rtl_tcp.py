"""rtl_tcp: an RTL-SDR on another machine, over TCP.

Protocol (librtlsdr, rtl_tcp.c): the server greets with 12 bytes: "RTL0", tuner type and number of gain steps as
big-endian 32-bit words; then it streams interleaved unsigned 8-bit I and Q. Commands: one byte, one big-endian word.
"""

from __future__ import annotations

import asyncio
import contextlib
import struct
import time
from collections.abc import AsyncIterator

from hardware.iq import IqBlock, from_unsigned_bytes
from hardware.ports import ReceiverError
from hardware.reasons.channels import FrequencyOutOfRange
from hardware.reasons.radio import NotRtlTcp, RtlSdrSampleRate, RtlTcpBusy, RtlTcpEnded, RtlTcpUnreachable
from hardware.reasons.receiver import ReceiverNotOpen
from hardware.sdr.sample_clock import SampleClock

SET_FREQUENCY, SET_SAMPLE_RATE, SET_GAIN_MODE, SET_GAIN, SET_PPM, SET_AGC = 0x01, 0x02, 0x03, 0x04, 0x05, 0x08
GREETING = struct.Struct(">4sII")
COMMAND = struct.Struct(">BI")
_RATES_HZ = ((225_001, 300_000), (900_001, 3_200_000))


class RtlTcpSource:
    """IQ from an rtl_tcp server. Manual gain; the chip's own AGC is switched off.

    settle_s: twice this is dropped from the front. The server streams before it is tuned; then it sends bursts of
    131072 samples, and only the end of a burst tells how old its samples are.
    """

    def __init__(
        self,
        host: str,
        port: int = 1234,
        sample_rate_hz: float = 250_000.0,
        gain_db: float = 28.0,
        ppm: int = 0,
        timeout_s: float = 5.0,
        settle_s: float = 0.6,
    ) -> None:
        if not any(low <= sample_rate_hz <= high for low, high in _RATES_HZ):
            raise ReceiverError(RtlSdrSampleRate(sample_rate_hz))
        self._host, self._port = host, port
        self._address = f"{host}:{port}"
        self._rate, self._gain, self._ppm = sample_rate_hz, gain_db, ppm
        self._timeout_s, self._settle_s = timeout_s, settle_s
        self._reader: asyncio.StreamReader | None = None
        self._writer: asyncio.StreamWriter | None = None

    @property
    def sample_rate_hz(self) -> float:
        """As asked for: the server never says what the chip made of it."""
        return self._rate

    @property
    def gain_db(self) -> float:
        """As asked for: the chip takes the nearest of its steps and does not say which."""
        return self._gain

    async def open(self, centre_hz: float) -> float:
        """Tunes to whole hertz. Raises ReceiverError when nobody answers or it is no rtl_tcp server."""
        if not 0 < centre_hz < 2**32:
            raise ReceiverError(FrequencyOutOfRange(centre_hz))
        await self.close()
        try:
            await self._connect()
        except ReceiverError:
            await self.close()
            raise
        await self._command(SET_SAMPLE_RATE, round(self._rate))
        await self._command(SET_PPM, self._ppm & 0xFFFFFFFF)
        await self._command(SET_AGC, 0)
        await self._command(SET_GAIN_MODE, 1)
        await self._command(SET_GAIN, round(self._gain * 10.0) & 0xFFFFFFFF)
        await self._command(SET_FREQUENCY, round(centre_hz))
        return float(round(centre_hz))

    async def _connect(self) -> None:
        try:
            async with asyncio.timeout(self._timeout_s):
                self._reader, self._writer = await asyncio.open_connection(self._host, self._port)
                greeting = await self._reader.readexactly(GREETING.size)
        except TimeoutError:
            raise ReceiverError(RtlTcpBusy(self._address, closed=False)) from None
        except asyncio.IncompleteReadError:
            raise ReceiverError(RtlTcpBusy(self._address, closed=True)) from None
        except OSError as error:
            raise ReceiverError(RtlTcpUnreachable(self._address, error.strerror or str(error))) from error
        magic, _, _ = GREETING.unpack(greeting)
        if magic != b"RTL0":
            raise ReceiverError(NotRtlTcp(self._address))

    async def _command(self, code: int, value: int) -> None:
        if self._writer is None:
            raise ReceiverError(ReceiverNotOpen())
        try:
            self._writer.write(COMMAND.pack(code, value))
            await self._writer.drain()
        except OSError as error:
            raise ReceiverError(RtlTcpEnded(self._address, broken=True)) from error

    async def blocks(self) -> AsyncIterator[IqBlock]:
        """20 ms each. Time is counted in samples and held to the wall clock (SampleClock)."""
        reader = self._reader
        if reader is None:
            raise ReceiverError(ReceiverNotOpen())
        size = 2 * int(self._rate / 50.0)
        clock = SampleClock(self._rate)
        tuned_s = time.monotonic() + self._settle_s
        received = 0
        while self._reader is reader:
            try:
                raw = await reader.readexactly(size)
            except asyncio.IncompleteReadError:
                if self._reader is not reader:
                    return
                raise ReceiverError(RtlTcpEnded(self._address, broken=False)) from None
            except OSError as error:
                raise ReceiverError(RtlTcpEnded(self._address, broken=True)) from error
            if time.monotonic() < tuned_s:
                continue
            samples, clipped = from_unsigned_bytes(raw)
            at_s = clock.arrived(received, samples.size)
            received += samples.size
            if received > self._settle_s * self._rate:
                yield IqBlock(at_s, samples, clipped)

    async def close(self) -> None:
        """Whoever iterates over `blocks` comes to an end without an error."""
        writer, self._reader, self._writer = self._writer, None, None
        if writer is not None:
            writer.close()
            with contextlib.suppress(OSError):
                await writer.wait_closed()
