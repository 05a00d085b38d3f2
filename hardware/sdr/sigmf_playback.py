"""SigMF recordings as an IQ source."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from pathlib import Path

from hardware.direction_finding.table_file import RecordingError
from hardware.iq import IqBlock, clipped_at_full_scale
from hardware.ports import Clock, ReceiverError
from hardware.reasons.channels import RecordedElsewhere
from hardware.sdr.sigmf_file import load_sigmf


class SigmfSource:
    """Plays one recording. With a clock, at the pace it was recorded (time stamps from the clock); without one, as
    fast as it is read (time stamps from the recording's own datetime, or seconds from 0)."""

    def __init__(self, path: Path | str, clock: Clock | None = None, block_s: float = 0.05) -> None:
        self._path = Path(path)
        self._clock = clock
        self._block_s = block_s
        self._closed = False
        try:
            recording = load_sigmf(path)
        except RecordingError as error:
            raise ReceiverError(error.reason) from error
        self._samples = recording.samples
        self._rate, self._centre = recording.sample_rate_hz, recording.centre_hz
        self._start_s = recording.start_s

    @property
    def sample_rate_hz(self) -> float:
        """As the recording states it."""
        return self._rate

    @property
    def gain_db(self) -> float:
        """0: a recording's powers are taken as they are."""
        return 0.0

    @property
    def duration_s(self) -> float:
        """By its sample count."""
        return self._samples.size / self._rate

    async def open(self, centre_hz: float) -> float:
        """The recording's own centre frequency; it cannot be tuned."""
        if abs(centre_hz - self._centre) > self._rate:
            raise ReceiverError(RecordedElsewhere(self._centre, centre_hz))
        self._closed = False
        return self._centre

    async def blocks(self) -> AsyncIterator[IqBlock]:
        """Ends with the recording, or within a block after `close`."""
        size = max(int(self._block_s * self._rate), 1)
        begin_s = self._start_s if self._clock is None else self._clock.now()
        for start in range(0, self._samples.size, size):
            if self._closed:
                return
            part = self._samples.part(start, start + size)
            at_s = begin_s + start / self._rate
            if self._clock is not None:
                await self._clock.sleep(max(at_s + part.size / self._rate - self._clock.now(), 0.0))
            else:
                await asyncio.sleep(0)
            yield IqBlock(at_s, part, clipped_at_full_scale(part))

    async def close(self) -> None:
        """Ends `blocks` at the next block; `open` allows it to be played again."""
        self._closed = True
