"""A recorded sweep as a receiver: its power samples again, at the pace they were heard."""

from __future__ import annotations

from collections.abc import AsyncIterator, Sequence

from hardware.channels import only_carrier
from hardware.ports import Clock, ReceiverError
from hardware.readings import Channel, HeadingSample, PowerSample, Sweep
from hardware.reasons.channels import RecordedElsewhere
from hardware.reasons.receiver import ReceiverNotOpen, RecordedSweepEmpty

SAME_FREQUENCY = 0.01
"""Share by which the asked frequency may differ from the recorded one: log files round it."""


class RecordedReceiver:
    """Plays a sweep's powers from the moment samples() is asked for. `headings()` gives the matching nose."""

    lost_percent = 0.0

    def __init__(self, sweep: Sweep, clock: Clock, duration_s: float | None = None) -> None:
        if sweep.power_db.size == 0:
            raise ReceiverError(RecordedSweepEmpty())
        self._sweep = sweep
        self._clock = clock
        span = float(sweep.at_s[-1] - sweep.at_s[0])
        wanted = span if duration_s is None else duration_s
        # recordings whose times were cut to one value (or run backwards) are spread evenly
        if span > 0 and bool((sweep.at_s[1:] >= sweep.at_s[:-1]).all()):
            self._after_s = [float(t - sweep.at_s[0]) * wanted / span for t in sweep.at_s]
        else:
            step = (wanted or 0.05 * sweep.power_db.size) / sweep.power_db.size
            self._after_s = [k * step for k in range(sweep.power_db.size)]
        self._frequency_hz = 0.0
        self._open = False

    async def open(self, channels: Sequence[Channel]) -> None:
        """Raises ReceiverError for a frequency that is not the recorded one (within 1 %); a sweep without one takes
        any."""
        recorded, wanted = self._sweep.frequency_hz, only_carrier(channels).frequency_hz
        if recorded > 0 and abs(wanted - recorded) > SAME_FREQUENCY * recorded:
            raise ReceiverError(RecordedElsewhere(recorded, wanted))
        self._frequency_hz = wanted
        self._open = True

    async def close(self) -> None:
        """Playback ends at the next sample."""
        self._open = False

    async def samples(self) -> AsyncIterator[PowerSample]:
        """See the Receiver port. Ends with the recording."""
        if not self._open:
            raise ReceiverError(ReceiverNotOpen())
        begin_s = self._clock.now()
        for after_s, power_db in zip(self._after_s, self._sweep.power_db, strict=True):
            await self._clock.sleep(max(begin_s + after_s - self._clock.now(), 0.0))
            if not self._open:
                return
            yield PowerSample(begin_s + after_s, self._frequency_hz, float(power_db), self._sweep.noise_floor_db)

    def headings(self, begin_s: float) -> list[HeadingSample]:
        """The vehicle's headings as recorded, shifted to a playback that began at `begin_s`."""
        return [
            HeadingSample(begin_s + after_s, float(heading), self._sweep.position)
            for after_s, heading in zip(self._after_s, self._sweep.heading_deg, strict=True)
        ]
