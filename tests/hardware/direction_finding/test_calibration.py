"""Calibration flights in the simulated world, and the pre-flight check that finds what is wrong."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest
from refusals import refusing

from hardware.direction_finding.calibration import CalibrationError, calibrate, check_antenna, true_bearing_deg
from hardware.direction_finding.pattern_file import SMALL_YAGI, load_pattern
from hardware.frame import LocalFrame
from hardware.readings import Place, Sweep
from hardware.reasons.antenna import AntennaAskew, AntennaDead, EmitterTooNear, TooFewSamples
from hardware.reasons.pattern import ImplausibleGains
from hardware.reasons.sweep import Overdriven
from hardware.sim.world import Emitter, Pose, RadioLink, World
from planner.reason import Reason

EMITTER = Place(50.6, 7.2)
FRAME = LocalFrame(EMITTER)
WORLD = World((Emitter(EMITTER),), seed=3)


def flown(world: World, bearing_from_emitter_deg: float, distance_m: float = 200.0) -> Sweep:
    angle = math.radians(bearing_from_emitter_deg)
    place = FRAME.to_geo(distance_m * math.sin(angle), distance_m * math.cos(angle))
    link = RadioLink(world, world.emitters[0].frequency_hz)
    times = np.arange(0.0, 12.0, 0.05)
    heading = 30.0 * times % 360.0
    power = np.array(
        [link.power_dbm(float(t), Pose(place, 30.0, float(h)))[0] for t, h in zip(times, heading, strict=True)]
    )
    return Sweep(times, heading, power, 868.3e6, place, 100.0)


def test_flight_around_the_emitter_gives_pattern_and_offset() -> None:
    world = dataclasses.replace(WORLD, antenna_offset_deg=35.0)
    flights = [flown(world, bearing, 150.0 + bearing) for bearing in (0.0, 100.0, 220.0)]
    measured = calibrate(flights, EMITTER, "test antenna")
    reference = load_pattern(SMALL_YAGI)
    # what counts is where the pattern lies relative to the nose
    from_nose = np.arange(0.0, 360.0, 5.0)
    ours = measured.pattern.gain_at(from_nose - measured.pattern.offset_to_nose_deg)
    truth = reference.gain_at(from_nose - 35.0)
    strong = truth > -10.0
    assert np.abs((ours - truth)[strong] - np.median((ours - truth)[strong])).max() < 3.0
    assert abs(measured.pattern.offset_to_nose_deg - 35.0) < 8.0
    assert measured.sweeps == 3


def test_level_of_each_sweep_does_not_matter() -> None:
    near, far = flown(WORLD, 10.0), flown(WORLD, 10.0)
    far = dataclasses.replace(far, power_db=far.power_db - 25.0)
    same = calibrate([near, near], EMITTER, "a")
    different = calibrate([near, far], EMITTER, "a")
    assert different.pattern.gain_db == pytest.approx(same.pattern.gain_db, abs=1e-3)


@pytest.mark.parametrize(
    ("sweeps", "reason"),
    [
        ([], TooFewSamples(0, 72)),
        ([flown(WORLD, 0.0, 5.0)], EmitterTooNear),
        ([dataclasses.replace(flown(WORLD, 0.0), clipped_samples=200)], Overdriven(200, 240)),
        ([dataclasses.replace(flown(WORLD, 0.0), power_db=np.full(240, -60.0))], ImplausibleGains("x", "small", 3.0)),
    ],
)
def test_flights_that_give_no_pattern_say_why(sweeps: list[Sweep], reason: Reason | type[Reason]) -> None:
    with refusing(reason, CalibrationError):
        calibrate(sweeps, EMITTER, "x")


def test_check_passes_the_right_antenna() -> None:
    assert check_antenna(flown(WORLD, 45.0), load_pattern(SMALL_YAGI), EMITTER).ok


def test_check_finds_a_wrong_offset_and_tells_the_right_one() -> None:
    world = dataclasses.replace(WORLD, antenna_offset_deg=-40.0)
    check = check_antenna(flown(world, 45.0), load_pattern(SMALL_YAGI), EMITTER)
    assert not check.ok
    assert isinstance(check.reason, AntennaAskew)
    assert check.reason.offset_deg == pytest.approx(-40.0, abs=6.0)


def test_check_finds_a_dead_antenna() -> None:
    good = flown(WORLD, 45.0)
    dead = dataclasses.replace(good, power_db=-100.0 + np.random.default_rng(1).normal(0, 0.7, good.power_db.size))
    check = check_antenna(dead, load_pattern(SMALL_YAGI), EMITTER)
    assert not check.ok
    assert isinstance(check.reason, AntennaDead)


def test_true_bearing_is_clockwise_from_north() -> None:
    bearing, distance = true_bearing_deg(FRAME.to_geo(-100.0, 0.0), EMITTER)
    assert bearing == pytest.approx(90.0, abs=0.01)
    assert distance == pytest.approx(100.0, abs=0.1)
