"""IQ blocks and where they come from."""

from __future__ import annotations

from collections.abc import AsyncIterator
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class IqBlock:
    """Consecutive samples. at_s: UTC time of the first one. samples: (n,) complex64, 1.0 = full scale.

    clipped: (n,) the converter was at its limit for that sample. lost: samples missing before this block.
    """

    at_s: float
    samples: NDArray[np.complex64]
    clipped: NDArray[np.bool_]
    lost: int = 0


class IqSource(Protocol):
    """A tuned stream of IQ. Gain is set once, at `open`; no automatic gain: a sweep compares powers."""

    @property
    def sample_rate_hz(self) -> float:
        """Complex samples a second; the band is as wide, half of it on either side of the centre."""
        ...

    @property
    def gain_db(self) -> float:
        """The receiver's gain, taken out of the power so that a change of gain does not look like a change of power."""
        ...

    async def open(self, centre_hz: float) -> float:
        """Tune; returns the centre frequency really tuned to. Raises ReceiverError."""
        ...

    def blocks(self) -> AsyncIterator[IqBlock]:
        """Raises ReceiverError when the device is gone; ends at the end of a recording or when closed."""
        ...

    async def close(self) -> None:
        """Ends `blocks`. Harmless when closed already; `open` may follow."""
        ...


def from_unsigned_bytes(raw: bytes) -> tuple[NDArray[np.complex64], NDArray[np.bool_]]:
    """Interleaved unsigned 8-bit I and Q (RTL-SDR): 127.5 is zero. Returns samples and which of them are clipped."""
    values = np.frombuffer(raw, dtype=np.uint8).reshape(-1, 2)
    scaled = (values.astype(np.float32) - 127.5) / 127.5
    clipped = ((values == 0) | (values == 255)).any(axis=1)
    return (scaled[:, 0] + 1j * scaled[:, 1]).astype(np.complex64), clipped


def clipped_at_full_scale(samples: NDArray[np.complex64], full_scale: float = 1.0) -> NDArray[np.bool_]:
    """(n,) where I or Q reaches 99.9 % of full scale."""
    limit = 0.999 * full_scale
    return (np.abs(samples.real) >= limit) | (np.abs(samples.imag) >= limit)
