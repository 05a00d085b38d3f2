"""What every receiver asks of the channels it is to hear, whatever it can hear itself."""

from __future__ import annotations

from collections.abc import Sequence

from hardware.ports import ReceiverError
from hardware.readings import Channel
from hardware.reasons.channels import CarriersOnly, FrequencyOutOfRange, FrequencyTwice, NoChannel, OneChannelOnly


def check_channels(channels: Sequence[Channel]) -> None:
    """At least one, at frequencies above zero that differ. Raises ReceiverError."""
    if not channels:
        raise ReceiverError(NoChannel())
    known: set[float] = set()
    for channel in channels:
        if not channel.frequency_hz > 0:
            raise ReceiverError(FrequencyOutOfRange(channel.frequency_hz))
        if channel.frequency_hz in known:
            raise ReceiverError(FrequencyTwice(channel.frequency_hz))
        known.add(channel.frequency_hz)


def only_carrier(channels: Sequence[Channel]) -> Channel:
    """The one channel of a receiver that measures the power of one carrier. Raises ReceiverError."""
    check_channels(channels)
    if len(channels) > 1:
        raise ReceiverError(OneChannelOnly(len(channels)))
    (channel,) = channels
    if channel.pulses is not None:
        raise ReceiverError(CarriersOnly(channel.frequency_hz))
    return channel
