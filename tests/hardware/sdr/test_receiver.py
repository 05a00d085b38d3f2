"""What the receiver makes of its source's faults."""

from __future__ import annotations

from collections.abc import AsyncIterator

import numpy as np
import pytest

from hardware.iq import IqBlock
from hardware.ports import ReceiverError
from hardware.readings import Channel
from hardware.sdr.receiver import IqReceiver

RATE_HZ = 10_000.0


class LosingSource:
    """Delivers every n-th block of 1000 samples and reports the others as lost."""

    sample_rate_hz = RATE_HZ
    gain_db = 0.0

    def __init__(self, every: int) -> None:
        self.every = every

    async def open(self, centre_hz: float) -> float:
        return centre_hz

    async def blocks(self) -> AsyncIterator[IqBlock]:
        for k in range(0, 400, self.every):
            lost = 1000 * (self.every - 1)
            yield IqBlock(1.8e9 + 0.1 * k, np.full(1000, 0.1, np.complex64), np.zeros(1000, np.bool_), lost)

    async def close(self) -> None: ...


async def hear(every: int) -> tuple[int, float]:
    """(samples, percent lost at the end)"""
    receiver = IqReceiver(LosingSource(every))
    await receiver.open([Channel(868e6)])
    return len([sample async for sample in receiver.samples()]), receiver.lost_percent


async def test_a_source_that_loses_most_of_its_samples_is_a_fault() -> None:
    with pytest.raises(ReceiverError, match="lost 67 %"):
        await hear(3)


async def test_a_source_that_loses_some_goes_on_and_it_is_told() -> None:
    assert await hear(2) == (400, 50.0)
    assert await hear(1) == (800, 0.0)
