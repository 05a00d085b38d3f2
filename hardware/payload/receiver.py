"""The Receiver port on the server, when the radio sits on the payload."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Sequence

from hardware.channels import check_channels
from hardware.payload.session import PayloadHub, Subscription
from hardware.ports import ReceiverError
from hardware.readings import Channel, PowerSample
from hardware.reasons.payload import NoPayloadConnected, PayloadAway
from hardware.reasons.receiver import ReceiverNotOpen, SamplesLost


class PayloadReceiver:
    """Samples as they arrive from the payload, in the server's time; late after an outage, never lost or doubled.

    connect_within_s: how long `open` waits for a payload. gone_after_s: an outage this long ends samples() with
    ReceiverError; shorter ones are bridged by the payload's spool.
    """

    def __init__(self, hub: PayloadHub, connect_within_s: float = 10.0, gone_after_s: float = 120.0) -> None:
        self._hub = hub
        self._connect_within_s = connect_within_s
        self._gone_after_s = gone_after_s
        self._frequencies_hz: frozenset[float] = frozenset()
        self._subscription: Subscription | None = None

    @property
    def lost_percent(self) -> float:
        """Of the payload's radio, as it last told; of several, the one that loses most."""
        told = (agent.receiver for agent in self._hub.agents.values() if agent.connected)
        return max((reason.lost_percent for reason in told if isinstance(reason, SamplesLost)), default=0.0)

    async def open(self, channels: Sequence[Channel]) -> None:
        """Tune the payload. Raises ReceiverError when none connects in time.

        What the payload's own receiver cannot hear, the payload tells in its status.
        """
        check_channels(channels)
        self._hub.tune(channels)
        waited = 0.0
        while not self._hub.connected():
            if waited >= self._connect_within_s:
                raise ReceiverError(NoPayloadConnected())
            await asyncio.sleep(0.05)
            waited += 0.05
        await self.close()
        self._frequencies_hz = frozenset(channel.frequency_hz for channel in channels)
        self._subscription = self._hub.subscribe()

    async def close(self) -> None:
        """Ends samples(); the payload itself listens on."""
        if self._subscription is not None:
            self._hub.unsubscribe(self._subscription)
        self._subscription = None

    async def samples(self) -> AsyncIterator[PowerSample]:
        """See the Receiver port. Samples of another frequency (from before a change) are left out."""
        subscription = self._subscription
        if subscription is None:
            raise ReceiverError(ReceiverNotOpen())
        outage_s = 0.0
        while self._subscription is subscription:
            try:
                async with asyncio.timeout(0.25):
                    sample = await subscription.get()
            except TimeoutError:
                outage_s = 0.0 if self._hub.connected() else outage_s + 0.25
                if outage_s >= self._gone_after_s:
                    raise ReceiverError(PayloadAway(self._gone_after_s)) from None
                continue
            outage_s = 0.0
            if sample.frequency_hz in self._frequencies_hz and self._subscription is subscription:
                yield sample
