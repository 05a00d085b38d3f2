"""What the fit leaves beside the lobe widens a bearing, and nothing else does."""

from __future__ import annotations

import math

import numpy as np
import pytest

from backend.simulation.field_world import ANTENNAS, antenna_pattern
from hardware.direction_finding.antenna import AntennaPattern
from hardware.direction_finding.beside_lobe import FADING, LOBE_BEAMS, WEAK_DB, beside_lobe_sigma_deg
from hardware.direction_finding.estimate import SparseDirectionFinder
from hardware.direction_finding.pattern_file import make_pattern
from hardware.direction_finding.refine import PatternCurve
from hardware.direction_finding.sweep import BIN_DEG, BINS, bin_sweep
from hardware.frame import LocalFrame
from hardware.readings import BearingReading, Place, Sweep
from hardware.sim.turn import turn_once
from hardware.sim.turntable import simulated_antenna
from hardware.sim.world import Emitter, RadioLink, Reflector, World

BEAM_DEG = 60.0
HEADINGS = (np.arange(BINS, dtype=np.float64) + 0.5) * BIN_DEG
FITTED = 20.0 * np.log10(np.where(np.abs((HEADINGS - 90.0 + 180.0) % 360.0 - 180.0) < 45.0, 1.0, 0.3))
FRAME = LocalFrame(Place(50.0, 7.0))
FREQUENCY_HZ = 868.3e6
SWEEPS = 60


def added_deg(sweep: Sweep, pattern: AntennaPattern, found: BearingReading) -> float:
    """To the bearing's sigma."""
    curve, binned = PatternCurve(pattern), bin_sweep(sweep.heading_deg, sweep.power_db, pattern.offset_to_nose_deg)
    gain_db = curve.gain_db(found.bearing_deg - binned.heading_deg) - curve.peak_db
    return beside_lobe_sigma_deg(binned, found.fitted_db, gain_db, found.bearing_deg, curve.beam_deg)


@pytest.mark.parametrize(("amplitude", "beams"), [(0.15, 0.10), (FADING, 0.0), (0.0, 0.0)])
def test_it_is_the_amplitude_that_is_left_over_the_lobes_top(amplitude: float, beams: float) -> None:
    beside = FITTED < -1.0
    heard = 20.0 * np.log10(10.0 ** (FITTED / 20.0) + np.where(beside, amplitude, 0.5))
    binned = bin_sweep(HEADINGS, heard - 40.0, 0.0)
    assert beside_lobe_sigma_deg(binned, FITTED - 40.0, FITTED, 90.0, BEAM_DEG) == pytest.approx(
        beams * BEAM_DEG, abs=1e-9
    )


def test_a_sweep_of_the_lobe_alone_says_nothing_of_what_is_beside() -> None:
    lobe = FITTED > -1.0
    binned = bin_sweep(HEADINGS[lobe], FITTED[lobe], 0.0)
    assert beside_lobe_sigma_deg(binned, FITTED, FITTED, 90.0, BEAM_DEG) == 0.0


def test_two_echoes_at_a_wide_antenna_are_in_sigma() -> None:
    pattern, finder, rng = antenna_pattern("wide"), SparseDirectionFinder(), np.random.default_rng(5)
    inside = inside_without = 0
    for seed in range(SWEEPS):
        echoes = tuple(
            Reflector(FRAME.to_geo(*(80.0 * f(angle) for f in (math.sin, math.cos))), loss_db=7.0, phase_rad=phase)
            for angle, phase in rng.uniform((1.0, 0.0), (5.3, 2.0 * math.pi), (2, 2))
        )
        emitter = Emitter(FRAME.to_geo(0.0, 120.0), FREQUENCY_HZ)
        world = World((emitter,), reflectors=echoes, antenna=ANTENNAS["wide"], seed=seed)
        sweep = turn_once(RadioLink(world, FREQUENCY_HZ), FRAME.origin)
        found = finder.estimate(sweep, pattern)
        beside_deg = added_deg(sweep, pattern, found)
        off = abs(math.remainder(found.bearing_deg, 360.0))
        inside += off <= 2.0 * found.sigma_deg
        inside_without += off <= 2.0 * math.sqrt(found.sigma_deg**2 - beside_deg**2)
    assert inside >= 0.9 * SWEEPS
    assert inside_without < 0.8 * SWEEPS  # else these echoes bend nothing


def test_without_echoes_it_adds_little() -> None:
    pattern, added = simulated_antenna(), list[float]()
    for seed in range(20):
        emitter = Emitter(FRAME.to_geo(0.0, 120.0), FREQUENCY_HZ)
        sweep = turn_once(RadioLink(World((emitter,), seed=seed), FREQUENCY_HZ), FRAME.origin)
        found = SparseDirectionFinder().estimate(sweep, pattern)
        added.append(added_deg(sweep, pattern, found))
    assert np.median(added) < 1.0


def test_fading_in_the_other_lobe_of_a_loop_is_no_echo() -> None:
    angle, rng = np.arange(0.0, 360.0, 10.0), np.random.default_rng(1)
    both = 20.0 * np.log10(np.maximum(np.abs(np.cos(np.radians(angle))), 0.01))
    loop, added = make_pattern("loop", angle, both, 0.0, FREQUENCY_HZ, "vertical"), list[float]()
    for _ in range(20):
        power = loop.gain_at(90.0 - HEADINGS) - 60.0 + rng.standard_normal(BINS)
        sweep = Sweep(np.linspace(0.0, 18.0, BINS), HEADINGS, power, FREQUENCY_HZ, FRAME.origin, 0.0)
        added.append(added_deg(sweep, loop, SparseDirectionFinder().estimate(sweep, loop)))
    assert np.median(added) < 1.0


@pytest.mark.parametrize("antenna", ["yagi", "wide"])
def test_the_antennas_on_which_it_was_chosen_are_weak_all_the_way_beside_their_lobe(antenna: str) -> None:
    curve, off = PatternCurve(antenna_pattern(antenna)), np.arange(-180.0, 180.0, 0.5)
    gain_db = curve.gain_db(off) - curve.peak_db
    assert gain_db[np.abs(off) > LOBE_BEAMS * curve.beam_deg].max() < WEAK_DB
