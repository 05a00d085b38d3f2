"""The field of the studies: paired by seed, shadowed as it says, and wrong in the ways that a field is."""

import math
from dataclasses import replace

import numpy as np
import pytest

from backend.simulation.field_world import (
    FREQUENCY_HZ,
    HEIGHT_M,
    LATE_S,
    SHADOW_DB,
    SHADOW_M,
    Shadow,
    Way,
    antenna_pattern,
    drawn_field,
)
from hardware.direction_finding.estimate import SparseDirectionFinder
from hardware.frame import LocalFrame
from hardware.readings import Place
from hardware.sim.world import Pose, RadioLink

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


def test_compass_and_antenna_change_nothing_else():
    drawn = drawn_field(3, FRAME, AREA, 4.0)
    off = drawn_field(3, FRAME, AREA, 4.0, compass_deg=8.0)
    wide = drawn_field(3, FRAME, AREA, 4.0, compass_deg=0.0, antenna="wide")
    assert [abs(field.world.heading_error_deg) for field in (off, wide)] == [8.0, 0.0]
    assert off.world.heading_error_deg * drawn.world.heading_error_deg > 0.0
    assert drawn.truth == off.truth == wide.truth
    assert drawn.world.reflectors == off.world.reflectors == wide.world.reflectors
    sides = {drawn_field(seed, FRAME, AREA, 4.0, compass_deg=8.0).world.heading_error_deg for seed in range(20)}
    assert sides == {-8.0, 8.0}


@pytest.mark.parametrize(("antenna", "beam_deg"), [("yagi", 68.0), ("wide", 86.0)])
def test_an_antenna_is_flown_with_its_own_pattern(antenna, beam_deg):
    field, pattern = drawn_field(3, FRAME, AREA, 4.0, compass_deg=0.0, antenna=antenna), antenna_pattern(antenna)
    above = pattern.relative_bearing_deg[pattern.gain_db > pattern.gain_db.max() - 3.0]
    assert len(above) * 360.0 / len(pattern.gain_db) == pytest.approx(beam_deg, abs=8.0)
    x, y = field.truth
    reading = SparseDirectionFinder().estimate(field.sweep(x - 120.0, y, 0, 30.0), pattern)
    assert abs(math.remainder(reading.bearing_deg - 90.0, 360.0)) < 12.0


def test_what_is_told_in_flight_is_late_and_what_is_heard_leans():
    field = drawn_field(3, FRAME, AREA, 0.0)
    steps = np.arange(20.0)
    upright, leaning = (np.zeros((20, 2)), np.tile([0.3, 0.0], (20, 1)))
    heard, told = field.along(Way(steps, steps, 5.0 * steps, upright), 10.0, 0)
    assert [one.at_s for one in told] == pytest.approx([one.at_s + LATE_S for one in heard])
    other, _ = field.along(Way(steps, steps, 5.0 * steps, leaning), 10.0, 0)
    assert max(abs(a.power_db - b.power_db) for a, b in zip(heard, other, strict=True)) > 0.2


def test_along_a_way_is_heard_what_a_receiver_hears_point_by_point():
    """As `RadioLink` has it of one pose after the other, each in the world as it is shadowed there."""
    field = drawn_field(3, FRAME, AREA, 4.0, compass_deg=8.0)
    steps = np.arange(20.0)
    lean = np.outer(np.where(steps < 5, 0.0, 0.2), [0.6, 0.8])
    heard, _ = field.along(Way(10.0 * steps, 3.0 * steps, 7.0 * steps, lean), 10.0, 4)
    seed = int(np.random.default_rng([field.seed, 4, 4]).integers(2**31))
    link = RadioLink(replace(field.world, seed=seed), FREQUENCY_HZ)
    for k, sample in enumerate(heard):
        x, y = 10.0 * k, 3.0 * k
        link.world = field.at(x, y)
        pose = Pose(FRAME.to_geo(x, y), HEIGHT_M, 7.0 * k, (float(lean[k, 0]), float(lean[k, 1])))
        assert link.power_dbm(k / 10.0, pose) == (pytest.approx(sample.power_db, abs=1e-9), sample.clipped)


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
