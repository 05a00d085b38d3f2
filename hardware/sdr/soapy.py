"""SoapySDR: any radio that has a Soapy module, chosen by its device string ("driver=rtlsdr,serial=00000001").

SoapySDR is a system package (python3-soapysdr), never a requirement; without it `open` says so.
"""

from __future__ import annotations

import asyncio
import logging
import time
from collections.abc import AsyncIterator, Callable
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from typing import Any, ParamSpec, TypeVar

import numpy as np
from numpy.typing import NDArray

from hardware.iq import IqBlock, clipped_at_full_scale
from hardware.ports import ReceiverError
from hardware.reasons.radio import NoReceiveChannel, RadioFailed, SoapyMissing, TunedElsewhere
from hardware.reasons.receiver import ReceiverMisnamed, ReceiverNotOpen
from hardware.sdr.sample_clock import SampleClock

LOG = logging.getLogger("crossfix.soapy")
DRIVER_ERRORS = (RuntimeError, ValueError, IndexError, OverflowError, SystemError)
"""What the binding makes of a driver's C++ exceptions."""
P = ParamSpec("P")
T = TypeVar("T")
FULL_SCALE = 0.993
"""The largest value of an 8-bit converter is 127/128 (of an RTL-SDR, both ways, 0.9969 and -0.9953)."""
READ_S = 0.2
"""The longest that one read waits; closing waits for it."""


def _soapy() -> Any:
    try:
        import SoapySDR  # pyright: ignore[reportMissingImports]
    except ImportError as error:
        raise ReceiverError(SoapyMissing()) from error
    return SoapySDR


class _Radio:
    """One device from open to close. Its driver's calls block, and none may run while another does (a stream must not
    be closed while it is read): one thread makes them all, in order."""

    def __init__(self, device_string: str, arguments: dict[str, str], channel: int) -> None:
        self._thread = ThreadPoolExecutor(1, "soapy")
        self._device_string, self._arguments, self._channel = device_string, arguments, channel
        self._soapy: Any = None
        self._device: Any = None
        self._stream: Any = None
        self._block = 0
        self.rate_hz = self.gain_db = self.centre_hz = 0.0

    async def call(self, work: Callable[P, T], *arguments: P.args, **named: P.kwargs) -> T:
        """Have the thread do it. Raises ReceiverError."""
        try:
            return await asyncio.get_running_loop().run_in_executor(self._thread, partial(work, *arguments, **named))
        except ReceiverError:
            raise
        except DRIVER_ERRORS as error:
            raise ReceiverError(RadioFailed(self._device_string, "call", str(error))) from error

    async def end(self) -> None:
        """After what the thread is doing now, close; the thread does so even when nobody waits for it any more."""
        closing = asyncio.get_running_loop().run_in_executor(self._thread, self.close)
        self._thread.shutdown(wait=False)
        await closing

    def open(self, centre_hz: float, rate_hz: float, gain_db: float) -> None:
        """close() is due even when it fails."""
        self._soapy = soapy = _soapy()
        receive = (soapy.SOAPY_SDR_RX, self._channel)
        self._device = device = soapy.Device(self._device_string)
        if device.getNumChannels(soapy.SOAPY_SDR_RX) <= self._channel:
            raise ReceiverError(NoReceiveChannel(self._device_string))
        device.setSampleRate(*receive, rate_hz)
        device.setFrequency(*receive, centre_hz)
        device.setGainMode(*receive, False)
        self.set_gain(gain_db)
        settings = {info.key for info in device.getSettingInfo()}
        stream_arguments = {info.key for info in device.getStreamArgsInfo(*receive)}
        for key, value in self._arguments.items():
            if key in settings:
                device.writeSetting(key, value)
        self.rate_hz = float(device.getSampleRate(*receive))
        self.centre_hz = float(device.getFrequency(*receive))
        if abs(self.centre_hz - centre_hz) > rate_hz / 2.0:
            raise ReceiverError(TunedElsewhere(self._device_string, self.centre_hz, centre_hz))
        wanted = {key: value for key, value in self._arguments.items() if key in stream_arguments}
        self._stream = device.setupStream(soapy.SOAPY_SDR_RX, soapy.SOAPY_SDR_CF32, [self._channel], wanted)
        # a burst is read whole, so that its first sample is known to be as old as it is long
        self._block = max(int(device.getStreamMTU(self._stream)), int(self.rate_hz / 50.0), 1024)
        code = device.activateStream(self._stream)
        if code:
            raise ReceiverError(RadioFailed(self._device_string, "start", soapy.errToStr(code)))

    def set_gain(self, gain_db: float) -> None:
        self._device.setGain(self._soapy.SOAPY_SDR_RX, self._channel, gain_db)
        self.gain_db = float(self._device.getGain(self._soapy.SOAPY_SDR_RX, self._channel))

    def read(self) -> NDArray[np.complex64] | None:
        """What came within READ_S, perhaps nothing; None: samples were lost. Raises ReceiverError when it is gone.

        The times that drivers give are not used: SoapyRTLSDR 0.3.3 counts two for each sample.
        """
        soapy = self._soapy
        buffer = np.empty(self._block, dtype=np.complex64)
        result = self._device.readStream(self._stream, [buffer], buffer.size, timeoutUs=int(READ_S * 1e6))
        if result.ret in (soapy.SOAPY_SDR_OVERFLOW, soapy.SOAPY_SDR_CORRUPTION):
            return None
        if result.ret == 0:
            time.sleep(0.01)  # some drivers say so, without waiting, of a device that is gone
        elif result.ret < 0 and result.ret != soapy.SOAPY_SDR_TIMEOUT:
            raise ReceiverError(RadioFailed(self._device_string, "read", soapy.errToStr(result.ret)))
        return buffer[: max(result.ret, 0)]

    def close(self) -> None:
        """Free the device, as far as the driver lets us; it can be opened again."""
        device, stream = self._device, self._stream
        self._device = self._stream = None
        steps: list[Callable[[], object]] = []
        if stream is not None:
            steps += [lambda: device.deactivateStream(stream), lambda: device.closeStream(stream)]
        if device is not None:
            steps.append(device.close)
        for step in steps:
            try:
                step()
            except DRIVER_ERRORS as error:
                LOG.warning('closing the radio "%s": %s', self._device_string, error)


class SoapySource:
    """IQ from one receive channel. The gain is fixed; automatic gain is switched off.

    `device`: SoapySDR's "key=value,..." with a driver. Keys that the driver lists as settings or stream arguments
    ("biastee", "bufflen", "chan") are handed on as such.
    """

    def __init__(self, device: str, sample_rate_hz: float = 250_000.0, gain_db: float = 30.0, channel: int = 0) -> None:
        pairs = (part.partition("=") for part in device.split(","))
        self._arguments = {key.strip(): value.strip() for key, _, value in pairs}
        if not self._arguments.get("driver"):
            raise ReceiverError(ReceiverMisnamed(device, "driver"))
        if self._arguments["driver"] == "remote" and not self._arguments.get("remote"):
            raise ReceiverError(ReceiverMisnamed(device, "server"))
        self._device_string = device
        self._wanted_rate, self._wanted_gain, self._channel = sample_rate_hz, gain_db, channel
        self._radio: _Radio | None = None

    @property
    def sample_rate_hz(self) -> float:
        """What the radio settled for; what was asked for until it is open."""
        return self._wanted_rate if self._radio is None else self._radio.rate_hz

    @property
    def gain_db(self) -> float:
        """What the radio settled for; what was asked for until it is open."""
        return self._wanted_gain if self._radio is None else self._radio.gain_db

    async def open(self, centre_hz: float) -> float:
        """Raises ReceiverError when the device is not found, in use, or refuses the settings."""
        await self.close()
        radio = _Radio(self._device_string, self._arguments, self._channel)
        try:
            await radio.call(radio.open, centre_hz, self._wanted_rate, self._wanted_gain)
        except BaseException:
            await radio.end()
            raise
        self._radio = radio
        return radio.centre_hz

    async def blocks(self) -> AsyncIterator[IqBlock]:
        """Samples that the driver lost are counted in `lost` of the next block."""
        radio = self._radio
        if radio is None:
            raise ReceiverError(ReceiverNotOpen())
        clock = SampleClock(radio.rate_hz)
        received, end_s, gap = 0, 0.0, False
        while self._radio is radio:
            try:
                samples = await radio.call(radio.read)
            except ReceiverError:
                if self._radio is not radio:
                    return
                raise
            if samples is None:
                clock.restart()
                gap = received > 0
            elif samples.size:
                at_s = clock.arrived(received, samples.size)
                lost = max(round((at_s - end_s) * radio.rate_hz), 1) if gap else 0
                yield IqBlock(at_s, samples, clipped_at_full_scale(samples, FULL_SCALE), lost)
                received, end_s, gap = received + samples.size, at_s + samples.size / radio.rate_hz, False

    async def close(self) -> None:
        """Returns when the driver has let go of the device."""
        radio, self._radio = self._radio, None
        if radio is not None:
            await radio.end()
