"""SigMF recordings as an IQ source."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from dataclasses import replace
from pathlib import Path

from hardware.direction_finding.table_file import RecordingError
from hardware.iq import IqBlock
from hardware.ports import Clock, ReceiverError
from hardware.reasons.channels import RecordedElsewhere
from hardware.sdr.sigmf_file import load_sigmf


class SigmfSource:
    """Plays one recording, of several channels the first. With a clock, at the pace it was recorded (time stamps from
    the clock); without one, as fast as it is read (time stamps from the times its captures state, or seconds from 0).
    """

    def __init__(self, path: Path | str, clock: Clock | None = None, block_s: float = 0.05) -> None:
        self._path = Path(path)
        self._clock = clock
        self._block_s = block_s
        self._closed = False
        try:
            recording = load_sigmf(path)
        except RecordingError as error:
            raise ReceiverError(error.reason) from error
        self._recording = recording
        self._rate, self._centre = recording.sample_rate_hz, recording.centre_hz

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
        """From its first sample to its last."""
        return self._recording.duration_s

    async def open(self, centre_hz: float) -> float:
        """The recording's own centre frequency; it cannot be tuned."""
        if abs(centre_hz - self._centre) > self._rate:
            raise ReceiverError(RecordedElsewhere(self._centre, centre_hz))
        self._closed = False
        return self._centre

    async def blocks(self) -> AsyncIterator[IqBlock]:
        """Ends with the recording, or within a block after `close`."""
        late_s = 0.0 if self._clock is None else self._clock.now() - self._recording.start_s
        for block in self._recording.blocks(max(int(self._block_s * self._rate), 1)):
            if self._closed:
                return
            at_s = block.at_s + late_s
            if self._clock is not None:
                await self._clock.sleep(max(at_s + block.samples.size / self._rate - self._clock.now(), 0.0))
            else:
                await asyncio.sleep(0)
            yield replace(block, at_s=at_s)

    async def close(self) -> None:
        """Ends `blocks` at the next block; `open` allows it to be played again."""
        self._closed = True
