"""SoapySDR: any radio that has a Soapy module, chosen by its device string ("driver=rtlsdr,serial=00000001").

A thin adapter. SoapySDR is a system package (python3-soapysdr), never a requirement; without it `open` says so.
"""

from __future__ import annotations

import asyncio
import time
from collections.abc import AsyncIterator
from typing import Any

import numpy as np

from hardware.iq import IqBlock, clipped_at_full_scale
from hardware.ports import ReceiverError


def _soapy() -> Any:
    try:
        import SoapySDR  # pyright: ignore[reportMissingImports]
    except ImportError as error:
        raise ReceiverError(
            "SoapySDR is not installed for this Python; install the system package python3-soapysdr (and the module of "
            "your radio) and make SoapySDR.py visible in this environment, or use an rtl_tcp:// receiver"
        ) from error
    return SoapySDR


class SoapySource:
    """IQ from one receive channel. The gain is fixed; automatic gain is switched off."""

    def __init__(self, device: str, sample_rate_hz: float = 250_000.0, gain_db: float = 30.0, channel: int = 0) -> None:
        if "driver=" not in device:
            raise ReceiverError(
                f'the device string "{device}" names no driver; write for instance "driver=rtlsdr" '
                "(a search without a driver would probe the network)"
            )
        self._device_string = device
        self._rate = sample_rate_hz
        self._gain = gain_db
        self._channel = channel
        self._device: Any = None
        self._stream: Any = None

    @property
    def sample_rate_hz(self) -> float:
        return self._rate

    @property
    def gain_db(self) -> float:
        return self._gain

    async def open(self, centre_hz: float) -> float:
        return await asyncio.to_thread(self._open, centre_hz)

    def _open(self, centre_hz: float) -> float:
        soapy = _soapy()
        try:
            self._device = soapy.Device(self._device_string)
            self._device.setSampleRate(soapy.SOAPY_SDR_RX, self._channel, self._rate)
            self._device.setFrequency(soapy.SOAPY_SDR_RX, self._channel, centre_hz)
            self._device.setGainMode(soapy.SOAPY_SDR_RX, self._channel, False)
            self._device.setGain(soapy.SOAPY_SDR_RX, self._channel, self._gain)
            self._rate = float(self._device.getSampleRate(soapy.SOAPY_SDR_RX, self._channel))
            self._stream = self._device.setupStream(soapy.SOAPY_SDR_RX, soapy.SOAPY_SDR_CF32, [self._channel])
            self._device.activateStream(self._stream)
            return float(self._device.getFrequency(soapy.SOAPY_SDR_RX, self._channel))
        except RuntimeError as error:
            raise ReceiverError(f'the radio "{self._device_string}" cannot be opened: {error}') from error

    async def set_gain(self, gain_db: float) -> None:
        if self._device is not None:
            soapy = _soapy()
            await asyncio.to_thread(self._device.setGain, soapy.SOAPY_SDR_RX, self._channel, gain_db)
        self._gain = gain_db

    async def blocks(self) -> AsyncIterator[IqBlock]:
        soapy = _soapy()
        size = max(int(self._rate / 50.0), 1024)
        while self._stream is not None:
            buffer = np.empty(size, dtype=np.complex64)
            result = await asyncio.to_thread(self._device.readStream, self._stream, [buffer], size, timeoutUs=500_000)
            if result.ret == soapy.SOAPY_SDR_TIMEOUT:
                continue
            if result.ret == soapy.SOAPY_SDR_OVERFLOW:
                yield IqBlock(time.time(), np.empty(0, np.complex64), np.empty(0, np.bool_), lost=size)
                continue
            if result.ret < 0:
                raise ReceiverError(f"the radio stopped delivering: {soapy.errToStr(result.ret)}")
            samples = buffer[: result.ret]
            yield IqBlock(time.time() - samples.size / self._rate, samples, clipped_at_full_scale(samples))

    async def close(self) -> None:
        device, stream = self._device, self._stream
        self._device = self._stream = None
        if device is not None and stream is not None:
            await asyncio.to_thread(device.deactivateStream, stream)
            await asyncio.to_thread(device.closeStream, stream)
