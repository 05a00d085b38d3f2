"""Headings against the truth, behind a slow radio and by a clock that is two percent off.

The simulated autopilot and the link to it step in one time, which is not wall time. A process of its own answers the
question where the nose is with its last step: on a busy machine that was some time before it was asked.
"""

from __future__ import annotations

import asyncio
import math

import numpy as np
import pytest
from simulated_air import simulated
from stepped_loop import run_stepped

from hardware.clock import ScaledClock
from hardware.sim.autopilot.ardupilot import ArduCopter
from hardware.sim.autopilot.firmware import Conditions, Firmware
from hardware.sim.autopilot.geodesy import HomeFrame
from hardware.sim.autopilot.px4 import Px4

DELAY_S, CLOCK_RATE, TURN_DEG_S = 0.15, 0.98, 30.0
WITHIN_DEG = 1.0
"""The delay alone would turn them by 4.5 degrees, and the rate, unlearned, by 9 after a quarter of a minute."""
LEARNT_S = 20.0


async def errors_deg(flavour: type[Firmware]) -> list[float]:
    """Reported minus true, at each heading of a turn."""
    home = HomeFrame(47.4, 8.5, 488.0)
    firmware = flavour(Conditions(home, heading_sigma=0.0))  # pyright: ignore[reportCallIssue]
    clock = ScaledClock()
    true: list[tuple[float, float]] = []

    def seen(flown: Firmware) -> None:
        true.append((clock.now(), flown.copter.heading))

    async with simulated(firmware, clock, seen, DELAY_S, CLOCK_RATE) as vehicle:
        await vehicle.take_off(15.0)
        await clock.sleep(LEARNT_S)
        began_s = clock.now()
        await vehicle.turn(TURN_DEG_S)
        ended_s = clock.now()
        await asyncio.sleep(1.0)
        reported = [sample for sample in vehicle.headings(began_s) if sample.at_s < ended_s]
    noses = np.interp([sample.at_s for sample in reported], *np.array(true).T)
    return [math.remainder(sample.heading_deg - nose, 360.0) for sample, nose in zip(reported, noses, strict=True)]


@pytest.mark.parametrize("flavour", [Px4, ArduCopter])
def test_a_heading_is_the_one_of_its_time_behind_a_slow_radio_and_a_clock_two_percent_off(
    flavour: type[Firmware],
) -> None:
    errors = run_stepped(errors_deg(flavour))
    assert len(errors) > 200
    assert max(map(abs, errors)) <= WITHIN_DEG, (min(errors), max(errors))
