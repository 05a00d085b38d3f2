"""The simulator's IQ and the simulator's receiver tell the same power."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest
from stepped_clock import SteppedClock

from hardware.readings import Channel, Place, Pulses, Telemetry
from hardware.sdr.receiver import IqReceiver
from hardware.sim.iq import SimulatedIq
from hardware.sim.propagation import Fading
from hardware.sim.receiver import SimulatedReceiver
from hardware.sim.world import Emitter, World

FREQUENCY_HZ = 868_300_000.0
STEADY = World((Emitter(Place(50.601, 7.2), FREQUENCY_HZ),), fading=Fading(math.inf))


def pose(clock: SteppedClock) -> Telemetry:
    return Telemetry(True, clock.now(), Place(50.6, 7.2), clock.now(), 100.0, 40.0, 20.0, clock.now())


async def mean_power(receiver: IqReceiver | SimulatedReceiver, count: int = 30) -> float:
    await receiver.open([Channel(FREQUENCY_HZ)])
    heard = []
    async for sample in receiver.samples():
        heard.append(sample.power_db)
        if len(heard) == count:
            break
    await receiver.close()
    return float(np.mean(heard))


async def test_iq_and_power_agree_whatever_the_gain() -> None:
    clock = SteppedClock(1000.0)
    direct = await mean_power(SimulatedReceiver(STEADY, lambda: pose(clock), clock))
    source = SimulatedIq(STEADY, lambda: pose(clock), clock, drift_hz_s=20.0)
    assert await mean_power(IqReceiver(source)) == pytest.approx(direct, abs=0.5)
    louder = SimulatedIq(STEADY, lambda: pose(clock), clock, drift_hz_s=20.0, extra_gain_db=20.0)
    assert await mean_power(IqReceiver(louder)) == pytest.approx(direct, abs=0.5)


async def test_two_emitters_are_heard_at_once_by_frequency() -> None:
    clock = SteppedClock(1000.0)
    other = dataclasses.replace(STEADY.emitters[0], frequency_hz=FREQUENCY_HZ + 8000.0, power_dbm=-20.0)
    world = dataclasses.replace(STEADY, emitters=(STEADY.emitters[0], other))
    receiver = IqReceiver(SimulatedIq(world, lambda: pose(clock), clock))
    await receiver.open([Channel(FREQUENCY_HZ), Channel(FREQUENCY_HZ + 8000.0)])
    power: dict[float, list[float]] = {}
    async for sample in receiver.samples():
        power.setdefault(sample.frequency_hz, []).append(sample.power_db)
        if min(len(power.get(f, [])) for f in (FREQUENCY_HZ, FREQUENCY_HZ + 8000.0)) >= 10:
            break
    assert np.mean(power[FREQUENCY_HZ]) - np.mean(power[FREQUENCY_HZ + 8000.0]) == pytest.approx(10.0, abs=0.7)


async def test_pulsed_tag_is_heard_once_a_period() -> None:
    clock = SteppedClock(1000.0)
    tag = dataclasses.replace(STEADY.emitters[0], pulse_period_s=1.0, pulse_width_s=0.02)
    world = dataclasses.replace(STEADY, emitters=(tag,))
    source = SimulatedIq(world, lambda: pose(clock), clock, sample_rate_hz=12_000.0)
    receiver = IqReceiver(source)
    await receiver.open([Channel(FREQUENCY_HZ, Pulses(0.02, 1.0))])
    times = []
    async for sample in receiver.samples():
        times.append(sample.at_s)
        if len(times) == 12:
            break
    assert np.diff(times) == pytest.approx(np.ones(11), abs=0.02)
