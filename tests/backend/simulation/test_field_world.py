"""The field of the studies: paired by seed, shadowed as it says, and wrong in the ways that a field is."""

import math

import numpy as np
import pytest

from backend.simulation.field_world import SHADOW_DB, SHADOW_M, Shadow, antenna_pattern, drawn_field
from hardware.direction_finding.estimate import SparseDirectionFinder
from hardware.frame import LocalFrame
from hardware.readings import Place

FRAME = LocalFrame(Place(50.6234, 7.2046))
AREA = (-156.5, 0.0, 156.5, 200.0)


def test_a_seed_has_one_world_and_its_sweeps_one_chance_each():
    first, again, other = (drawn_field(seed, FRAME, AREA, 4.0) for seed in (3, 3, 4))
    assert first.truth == again.truth != other.truth
    assert first.world == again.world
    heard = [field.sweep(20.0, 30.0, number, 30.0).power_db for field, number in ((first, 0), (again, 0), (first, 1))]
    assert (heard[0] == heard[1]).all()
    assert not (heard[0] == heard[2]).all()


def test_the_emitter_lies_in_the_area_and_the_compass_is_wrong_as_much_as_asked_for():
    fields = [drawn_field(seed, FRAME, AREA, 8.0) for seed in range(400)]
    assert all(AREA[0] < field.truth[0] < AREA[2] and AREA[1] < field.truth[1] < AREA[3] for field in fields)
    off = np.array([field.world.heading_error_deg for field in fields])
    assert off.std() == pytest.approx(8.0, rel=0.12)
    assert all(drawn_field(seed, FRAME, AREA, 0.0).world.heading_error_deg == 0.0 for seed in range(5))
    assert {len(field.world.reflectors) for field in fields} == {1, 2}


def test_shadows_have_their_spread_and_change_over_their_length():
    shadows = [Shadow.drawn(np.random.default_rng(seed)) for seed in range(600)]
    here, near, far = (np.array([shadow.db(x, 5.0) for shadow in shadows]) for x in (0.0, SHADOW_M, 6.0 * SHADOW_M))
    assert here.std() == pytest.approx(SHADOW_DB, rel=0.1)
    assert np.corrcoef(here, near)[0, 1] == pytest.approx(math.exp(-0.5), abs=0.1)
    assert abs(np.corrcoef(here, far)[0, 1]) < 0.15


def test_a_sweep_from_it_can_be_read():
    field = drawn_field(3, FRAME, AREA, 0.0)
    reading = SparseDirectionFinder().estimate(field.sweep(0.0, 100.0, 0, 30.0), antenna_pattern())
    assert math.isfinite(reading.bearing_deg)
    assert reading.snr_db is not None
    assert reading.snr_db > 10.0
