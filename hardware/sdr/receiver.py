"""The Receiver port on top of any IQ source: one stream, a meter for each emitter in it."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Sequence
from dataclasses import dataclass

from hardware.channels import check_channels
from hardware.iq import IqBlock, IqSource
from hardware.ports import ReceiverError
from hardware.readings import Channel, PowerSample
from hardware.reasons.channels import BandTooNarrow, OutsideBand
from hardware.reasons.receiver import ReceiverNotOpen, ReceiverSilent, SamplesLost
from hardware.sdr.every_pulse import EveryPulseMeter, every_pulse_setting
from hardware.sdr.pulses import PulseMeter, PulseSetting
from hardware.sdr.spectrum import SpectrumError, ToneMeter, ToneSetting, outside_band
from hardware.sdr.tuning import Reach, centre_hz


class IqReceiver:
    """Measures the power of carriers and of tags' pulses in one IQ stream, all those inside its band at once.

    `silent_after_s`: samples() raises ReceiverError when the source delivers nothing for this long, or loses more than
    half of the samples of such a period.
    """

    def __init__(self, source: IqSource, silent_after_s: float = 5.0) -> None:
        self._source = source
        self._silent_after_s = silent_after_s
        self._meters: list[ToneMeter | PulseMeter] = []
        self._before = self._now = _Samples()

    @property
    def lost_percent(self) -> float:
        """Of the IQ samples of the last one or two periods of `silent_after_s`, or since it was opened."""
        return (self._before + self._now).lost_percent

    async def open(self, channels: Sequence[Channel]) -> None:
        """See the Receiver port. The centre frequency is chosen so that every channel lies in the sampled band."""
        check_channels(channels)
        try:
            settings = [_setting(channel) for channel in channels]
        except SpectrumError as error:
            raise ReceiverError(error.reason) from error
        wanted = [Reach(c.frequency_hz, s.reach_hz) for c, s in zip(channels, settings, strict=True)]
        centre = centre_hz(wanted, self._source.sample_rate_hz)
        if isinstance(centre, BandTooNarrow):
            raise ReceiverError(centre)
        tuned = await self._source.open(centre)
        try:
            self._meters = self._meters_at(tuned, channels, wanted, settings)
        except ReceiverError:
            await self._source.close()
            raise
        self._before = self._now = _Samples()

    def _meters_at(
        self,
        tuned_hz: float,
        channels: Sequence[Channel],
        wanted: Sequence[Reach],
        settings: Sequence[ToneSetting | PulseSetting],
    ) -> list[ToneMeter | PulseMeter]:
        """A recording keeps its own centre, and a radio may take a sample rate near the one it was asked for."""
        rate, gain = self._source.sample_rate_hz, self._source.gain_db
        outside = [r.frequency_hz for r in wanted if outside_band(r.frequency_hz, r.reach_hz, tuned_hz, rate)]
        if outside:
            raise ReceiverError(OutsideBand(rate, tuned_hz, tuple(outside)))
        try:
            return [
                EveryPulseMeter.of(channel.rhythms, channel.frequency_hz, tuned_hz, rate, gain)
                if channel.others
                else PulseMeter(channel.frequency_hz, tuned_hz, rate, gain, setting)
                if isinstance(setting, PulseSetting)
                else ToneMeter(channel.frequency_hz, tuned_hz, rate, gain, setting)
                for channel, setting in zip(channels, settings, strict=True)
            ]
        except SpectrumError as error:
            raise ReceiverError(error.reason) from error

    def _count(self, block: IqBlock) -> None:
        """Raises ReceiverError after a period of which more than half was lost."""
        self._now += _Samples(block.samples.size, block.lost)
        if self._now.heard + self._now.lost > self._silent_after_s * self._source.sample_rate_hz:
            self._before, self._now = self._now, _Samples()
            if self._before.lost > self._before.heard:
                raise ReceiverError(SamplesLost(self._before.lost_percent))

    async def close(self) -> None:
        """Closes the source too."""
        self._meters = []
        await self._source.close()

    async def samples(self) -> AsyncIterator[PowerSample]:
        """See the Receiver port."""
        meters = self._meters
        if not meters:
            raise ReceiverError(ReceiverNotOpen())
        blocks = aiter(self._source.blocks())
        while self._meters is meters:
            try:
                async with asyncio.timeout(self._silent_after_s):
                    block = await anext(blocks)
            except StopAsyncIteration:
                return
            except TimeoutError:
                raise ReceiverError(ReceiverSilent(self._silent_after_s)) from None
            self._count(block)
            for meter in meters:
                for sample in meter.feed(block):
                    yield sample


@dataclass(frozen=True, slots=True)
class _Samples:
    """IQ samples of some time."""

    heard: int = 0
    lost: int = 0

    def __add__(self, more: _Samples) -> _Samples:
        return _Samples(self.heard + more.heard, self.lost + more.lost)

    @property
    def lost_percent(self) -> float:
        return 100.0 * self.lost / max(self.heard + self.lost, 1)


def _setting(channel: Channel) -> ToneSetting | PulseSetting:
    """Raises SpectrumError for pulses that cannot be."""
    pulses = channel.pulses
    if channel.others:
        return every_pulse_setting(channel.rhythms)
    return ToneSetting() if pulses is None else PulseSetting(pulses.width_s, pulses.period_s, pulses.jitter_s)
