"""A whole turn at once tells what the receiver tells sample by sample."""

from __future__ import annotations

import dataclasses
import math

import numpy as np

from hardware.readings import Place
from hardware.sim.propagation import Fading
from hardware.sim.turn import turn_once
from hardware.sim.world import Emitter, FrontEnd, Pose, RadioLink, Reflector, World

HERE = Place(50.6, 7.2)
FREQUENCY_HZ = 868_300_000.0
WORLD = World(
    (Emitter(Place(50.601, 7.201), FREQUENCY_HZ),),
    reflectors=(Reflector(Place(50.5995, 7.203)),),
    fading=Fading(math.inf),
    front_end=FrontEnd(averages=10**12, jitter_db=0.0),
)


def test_one_turn_equals_its_samples_one_by_one() -> None:
    sweep = turn_once(RadioLink(WORLD, FREQUENCY_HZ), HERE, start_deg=50.0)
    link = RadioLink(WORLD, FREQUENCY_HZ)
    single = [
        link.power_dbm(float(t), Pose(HERE, 40.0, float(h)))[0]
        for t, h in zip(sweep.at_s, sweep.heading_deg, strict=True)
    ]
    assert sweep.heading_deg.size == 240
    assert np.allclose(sweep.power_db, single, atol=1e-4)


def test_reflector_adds_a_field_of_its_own() -> None:
    bare = turn_once(RadioLink(dataclasses.replace(WORLD, reflectors=()), FREQUENCY_HZ), HERE)
    echoed = turn_once(RadioLink(WORLD, FREQUENCY_HZ), HERE)
    assert np.ptp(echoed.power_db - bare.power_db) > 3.0


def test_too_strong_readings_are_counted_as_clipped() -> None:
    loud = dataclasses.replace(WORLD, front_end=FrontEnd(clip_dbm=-95.0))
    sweep = turn_once(RadioLink(loud, FREQUENCY_HZ), HERE)
    assert 0 < sweep.clipped_samples == int((sweep.power_db == -95.0).sum())
