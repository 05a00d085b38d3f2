"""The Receiver port on top of any IQ source: one stream, a meter for each emitter in it."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Sequence

from hardware.channels import check_channels
from hardware.iq import IqSource
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
        self.lost_samples = 0
        """IQ samples the source reported as lost since open."""

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
        self.lost_samples = 0

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
        heard = lost = 0
        while self._meters is meters:
            try:
                async with asyncio.timeout(self._silent_after_s):
                    block = await anext(blocks)
            except StopAsyncIteration:
                return
            except TimeoutError:
                raise ReceiverError(ReceiverSilent(self._silent_after_s)) from None
            self.lost_samples += block.lost
            heard, lost = heard + block.samples.size, lost + block.lost
            if heard + lost > self._silent_after_s * self._source.sample_rate_hz:
                if lost > heard:
                    raise ReceiverError(SamplesLost(100.0 * lost / (heard + lost)))
                heard = lost = 0
            for meter in meters:
                for sample in meter.feed(block):
                    yield sample


def _setting(channel: Channel) -> ToneSetting | PulseSetting:
    """Raises SpectrumError for pulses that cannot be."""
    pulses = channel.pulses
    if channel.others:
        return every_pulse_setting(channel.rhythms)
    return ToneSetting() if pulses is None else PulseSetting(pulses.width_s, pulses.period_s, pulses.jitter_s)
