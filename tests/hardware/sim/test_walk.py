"""A simulated emitter that goes about."""

import math

import numpy as np
import pytest

from hardware.readings import Place
from hardware.sim.walk import Gait, Walk
from hardware.sim.world import Emitter, RadioLink, World

HOME = Place(50.6, 7.2)


@pytest.mark.parametrize("gait", ["animal", "walking", "drifting"])
def test_it_goes_at_its_pace_from_when_it_began_and_the_same_way_for_the_same_seed(gait: Gait) -> None:
    walk, again = Walk(gait, 0.4, 1000.0, 7), Walk(gait, 0.4, 1000.0, 7)
    late = walk.way(1400.0)
    assert walk.way(900.0) == (0.0, 0.0)
    assert again.way(1400.0) == late
    assert 0.0 < math.hypot(*late) <= 0.4 * 400.0
    steps = [math.dist(walk.way(1000.0 + t), walk.way(1001.0 + t)) for t in range(300)]
    assert max(steps) <= 0.4 + 1e-6
    assert max(steps) > 0.39


def test_other_seeds_go_other_ways() -> None:
    assert Walk("animal", 0.4, 0.0, 1).way(300.0) != Walk("animal", 0.4, 0.0, 2).way(300.0)


def test_the_world_hears_it_where_it_is() -> None:
    """One that drifts away grows quieter."""
    walk = Walk("drifting", 2.0, 0.0, 3)
    emitter = Emitter(HOME, walk=walk)
    assert emitter.at(0.0).place == HOME
    assert emitter.at(600.0).place != HOME
    link = RadioLink(World((emitter,), seed=1), emitter.frequency_hz)
    heading = np.zeros(1)
    near = [float(link.powers_dbm(np.array([t]), HOME, 40.0, heading)[0][0]) for t in (0.0, 1.0, 2.0)]
    far = [float(link.powers_dbm(np.array([t]), HOME, 40.0, heading)[0][0]) for t in (900.0, 901.0, 902.0)]
    assert np.median(near) > np.median(far) + 6.0
