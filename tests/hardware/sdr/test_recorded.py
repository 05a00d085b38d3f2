"""A recorded sweep as a receiver gives back the sweep it was made from."""

from __future__ import annotations

import numpy as np
import pytest
from stepped_clock import SteppedClock

from hardware.direction_finding.sweep import assemble_sweep
from hardware.ports import ReceiverError
from hardware.readings import Channel, Place, Sweep
from hardware.sdr.recorded import RecordedReceiver


def recorded(at_s: np.ndarray) -> Sweep:
    heading = np.linspace(0.0, 350.0, at_s.size)
    return Sweep(at_s, heading, -50.0 - heading / 10.0, 148.52e6, Place(35.0, -111.0), 2100.0)


@pytest.mark.parametrize("at_s", [np.arange(30.0), np.full(30, 1.69e9), np.arange(30.0)[::-1]])
async def test_playback_with_its_headings_is_the_same_sweep(at_s: np.ndarray) -> None:
    clock = SteppedClock(5000.0)
    original = recorded(at_s)
    receiver = RecordedReceiver(original, clock, duration_s=12.0)
    await receiver.open([Channel(148.6e6)])
    begin_s = clock.now()
    heard = [sample async for sample in receiver.samples()]
    assert {sample.frequency_hz for sample in heard} == {148.6e6}
    again = assemble_sweep(heard, receiver.headings(begin_s), frequency_hz=148.52e6, altitude_amsl_m=2100.0)
    assert again.heading_deg == pytest.approx(original.heading_deg)
    assert again.power_db == pytest.approx(original.power_db)
    assert clock.now() - begin_s <= 12.0 + 1e-6


async def test_wrong_frequency_and_empty_sweep_are_refused() -> None:
    with pytest.raises(ReceiverError, match="was made at"):
        await RecordedReceiver(recorded(np.arange(30.0)), SteppedClock(5000.0)).open([Channel(868e6)])
    with pytest.raises(ReceiverError, match="no sample"):
        RecordedReceiver(recorded(np.empty(0)), SteppedClock(5000.0))
