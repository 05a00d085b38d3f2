"""The Receiver port on top of any IQ source: one stream, one or several emitters by frequency."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator

from hardware.iq import IqSource
from hardware.ports import ReceiverError
from hardware.readings import PowerSample, Pulses
from hardware.sdr.pulses import PulseMeter, PulseSetting
from hardware.sdr.spectrum import SpectrumError, ToneMeter, ToneSetting

DC_OFFSET_HZ = 0.15
"""Tuned this share of the sample rate beside the emitter: cheap receivers have a spike at the centre."""


class IqReceiver:
    """Measures the power of carriers (ToneSetting) or pulsed tags (PulseSetting) in an IQ stream.

    `silent_after_s`: samples() raises ReceiverError when the source delivers nothing for so long, or loses more than
    half of what so long a time holds.
    """

    def __init__(
        self, source: IqSource, setting: ToneSetting | PulseSetting | None = None, silent_after_s: float = 5.0
    ) -> None:
        self._source = source
        self._made_for = self._setting = setting or ToneSetting()
        self._silent_after_s = silent_after_s
        self._meters: list[ToneMeter | PulseMeter] = []
        self._gain_frozen = False
        self.lost_samples = 0
        """IQ samples the source reported as lost since open."""

    def expect(self, pulses: Pulses | None) -> None:
        """See HearsPulses. Raises ReceiverError for pulses that cannot be."""
        try:
            told = None if pulses is None else PulseSetting(pulses.width_s, pulses.period_s, pulses.jitter_s)
        except SpectrumError as error:
            raise ReceiverError(str(error)) from error
        self._setting = told or self._made_for

    async def open(self, frequency_hz: float, *others_hz: float) -> None:
        """Tune so that all frequencies fit. Raises ReceiverError."""
        frequencies = [frequency_hz, *others_hz]
        if any(not f > 0 for f in frequencies):
            raise ReceiverError(f"cannot tune to {min(frequencies)} Hz; give the emitter's frequency in hertz")
        rate = self._source.sample_rate_hz
        middle = (min(frequencies) + max(frequencies)) / 2.0
        centre = await self._source.open(middle + (DC_OFFSET_HZ * rate if len(frequencies) == 1 else 0.0))
        try:
            self._meters = [self._meter(f, centre) for f in frequencies]
        except SpectrumError as error:
            await self._source.close()
            raise ReceiverError(str(error)) from error
        self.lost_samples = 0

    def _meter(self, frequency_hz: float, centre_hz: float) -> ToneMeter | PulseMeter:
        rate, gain = self._source.sample_rate_hz, self._source.gain_db
        if isinstance(self._setting, PulseSetting):
            return PulseMeter(frequency_hz, centre_hz, rate, gain, self._setting)
        return ToneMeter(frequency_hz, centre_hz, rate, gain, self._setting)

    async def close(self) -> None:
        self._meters = []
        await self._source.close()

    def freeze_gain(self) -> None:
        """From here on (a sweep begins) the gain stays as it is."""
        self._gain_frozen = True

    def thaw_gain(self) -> None:
        """The sweep is over."""
        self._gain_frozen = False

    async def set_gain(self, gain_db: float) -> None:
        """Change the gain between sweeps. Raises ReceiverError inside a sweep: powers would not compare."""
        if self._gain_frozen:
            raise ReceiverError("the gain must not change inside a sweep; set it before the sweep or after it")
        await self._source.set_gain(gain_db)
        for meter in self._meters:
            meter.gain_db = self._source.gain_db

    async def samples(self) -> AsyncIterator[PowerSample]:
        """See the Receiver port; samples of several emitters carry their own frequency."""
        if not self._meters:
            raise ReceiverError("the receiver is not open: call open(frequency_hz) first")
        blocks = aiter(self._source.blocks())
        heard = lost = 0
        while self._meters:
            try:
                async with asyncio.timeout(self._silent_after_s):
                    block = await anext(blocks)
            except StopAsyncIteration:
                return
            except TimeoutError:
                raise ReceiverError(
                    f"the receiver delivered nothing for {self._silent_after_s:.0f} s; check its cable and driver"
                ) from None
            self.lost_samples += block.lost
            heard, lost = heard + block.samples.size, lost + block.lost
            if heard + lost > self._silent_after_s * self._source.sample_rate_hz:
                if lost > heard:
                    raise ReceiverError(
                        f"the receiver lost {100.0 * lost / (heard + lost):.0f} % of its samples: is it still there? "
                        "If this computer is too slow for it, lower the sample rate"
                    )
                heard = lost = 0
            for meter in self._meters:
                for sample in meter.feed(block):
                    yield sample
