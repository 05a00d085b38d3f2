"""SigMF recordings as an IQ source, and writing them."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import sigmf
from numpy.typing import NDArray

from hardware.iq import IqBlock, clipped_at_full_scale
from hardware.ports import Clock, ReceiverError


class SigmfSource:
    """Plays one recording. With a clock, at the pace it was recorded (time stamps from the clock); without one, as
    fast as it is read (time stamps from the recording's own datetime, or seconds from 0)."""

    def __init__(self, path: Path | str, clock: Clock | None = None, block_s: float = 0.05) -> None:
        self._path = Path(path)
        self._clock = clock
        self._block_s = block_s
        self._closed = False
        try:
            recording = sigmf.fromfile(str(self._path))
            if not isinstance(recording, sigmf.SigMFFile):
                raise ReceiverError(f"{self._path}: is a collection of recordings; give one recording")
            samples = recording.read_samples()
        except (OSError, ValueError, KeyError, sigmf.error.SigMFError) as error:
            raise ReceiverError(f"{self._path}: is no readable SigMF recording ({error})") from error
        rate = recording.get_global_field(sigmf.SAMPLE_RATE_KEY)
        captures = recording.get_captures()
        centre = captures[0].get(sigmf.FREQUENCY_KEY) if captures else None
        if not rate or not rate > 0:
            raise ReceiverError(f"{self._path}: the recording states no sample rate; add {sigmf.SAMPLE_RATE_KEY}")
        if centre is None:
            raise ReceiverError(f"{self._path}: the recording states no centre frequency; add {sigmf.FREQUENCY_KEY}")
        if not np.iscomplexobj(samples):
            raise ReceiverError(f"{self._path}: holds real samples; a bearing needs complex IQ")
        self._samples: NDArray[np.complex64] = np.asarray(samples, dtype=np.complex64).ravel()
        self._rate, self._centre = float(rate), float(centre)
        stamp = captures[0].get(sigmf.DATETIME_KEY)
        self._start_s = 0.0 if stamp is None else datetime.fromisoformat(stamp).timestamp()

    @property
    def sample_rate_hz(self) -> float:
        return self._rate

    @property
    def gain_db(self) -> float:
        return 0.0

    @property
    def duration_s(self) -> float:
        return self._samples.size / self._rate

    async def open(self, centre_hz: float) -> float:
        """The recording's own centre frequency; it cannot be tuned."""
        if abs(centre_hz - self._centre) > self._rate:
            raise ReceiverError(
                f"{self._path}: was recorded at {self._centre / 1e6:.4f} MHz, not near {centre_hz / 1e6:.4f} MHz"
            )
        self._closed = False
        return self._centre

    async def set_gain(self, gain_db: float) -> None:
        raise ReceiverError("a recording's gain cannot be changed")

    async def blocks(self) -> AsyncIterator[IqBlock]:
        size = max(int(self._block_s * self._rate), 1)
        begin_s = self._start_s if self._clock is None else self._clock.now()
        for start in range(0, self._samples.size, size):
            if self._closed:
                return
            part = self._samples[start : start + size]
            at_s = begin_s + start / self._rate
            if self._clock is not None:
                await self._clock.sleep(max(at_s + part.size / self._rate - self._clock.now(), 0.0))
            else:
                await asyncio.sleep(0)
            yield IqBlock(at_s, part, clipped_at_full_scale(part))

    async def close(self) -> None:
        self._closed = True


def write_sigmf(
    path: Path | str, samples: NDArray[np.complex64], sample_rate_hz: float, centre_hz: float, start_s: float
) -> Path:
    """Write `path` (.sigmf-meta and .sigmf-data beside it); returns the meta file's path."""
    base = Path(path).with_suffix("")
    data = base.with_suffix(".sigmf-data")
    samples.astype(np.complex64).tofile(data)
    meta = sigmf.SigMFFile(
        data_file=str(data),
        global_info={
            sigmf.DATATYPE_KEY: "cf32_le",
            sigmf.SAMPLE_RATE_KEY: sample_rate_hz,
            sigmf.DESCRIPTION_KEY: "IQ recorded by crossfix",
        },
    )
    stamp = datetime.fromtimestamp(start_s, UTC).strftime("%Y-%m-%dT%H:%M:%S.%fZ")
    meta.add_capture(0, metadata={sigmf.FREQUENCY_KEY: centre_hz, sigmf.DATETIME_KEY: stamp})
    target = base.with_suffix(".sigmf-meta")
    meta.tofile(str(target))
    return target
