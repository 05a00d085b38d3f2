"""The Receiver port on the server, when the radio sits on the payload."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator

from hardware.payload.session import PayloadHub, Subscription
from hardware.ports import ReceiverError
from hardware.readings import PowerSample, Pulses


class PayloadReceiver:
    """Samples as they arrive from the payload, in the server's time; late after an outage, never lost or doubled.

    connect_within_s: how long `open` waits for a payload. gone_after_s: an outage this long ends samples() with
    ReceiverError; shorter ones are bridged by the payload's spool.
    """

    def __init__(self, hub: PayloadHub, connect_within_s: float = 10.0, gone_after_s: float = 120.0) -> None:
        self._hub = hub
        self._connect_within_s = connect_within_s
        self._gone_after_s = gone_after_s
        self._frequency_hz: float | None = None
        self._subscription: Subscription | None = None
        self._pulses: Pulses | None = None

    def expect(self, pulses: Pulses | None) -> None:
        """See HearsPulses: passed on to the payload, which listens for them."""
        self._pulses = pulses

    async def open(self, frequency_hz: float) -> None:
        """Tune the payload. Raises ReceiverError when none connects in time."""
        if not frequency_hz > 0:
            raise ReceiverError(f"cannot tune to {frequency_hz} Hz; give the emitter's frequency in hertz")
        self._hub.tune(frequency_hz, self._pulses)
        waited = 0.0
        while not self._hub.connected():
            if waited >= self._connect_within_s:
                raise ReceiverError(
                    "no payload is connected; check that its agent runs (crossfix payload), its link and its token"
                )
            await asyncio.sleep(0.05)
            waited += 0.05
        await self.close()
        self._frequency_hz = frequency_hz
        self._subscription = self._hub.subscribe()

    async def close(self) -> None:
        if self._subscription is not None:
            self._hub.unsubscribe(self._subscription)
        self._subscription = None

    async def samples(self) -> AsyncIterator[PowerSample]:
        """See the Receiver port. Samples of another frequency (from before a change) are left out."""
        subscription = self._subscription
        if subscription is None:
            raise ReceiverError("the receiver is not open: call open(frequency_hz) first")
        outage_s = 0.0
        while self._subscription is subscription:
            try:
                async with asyncio.timeout(0.25):
                    sample = await subscription.get()
            except TimeoutError:
                outage_s = 0.0 if self._hub.connected() else outage_s + 0.25
                if outage_s >= self._gone_after_s:
                    raise ReceiverError(f"no payload was connected for {self._gone_after_s:.0f} s") from None
                continue
            outage_s = 0.0
            if sample.frequency_hz == self._frequency_hz and self._subscription is subscription:
                yield sample
