"""Sweeps through a part of the circle, heard with the simulator's own antenna and fading."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from hardware.direction_finding.beside_lobe import beside_lobe_sigma_deg
from hardware.direction_finding.circle import SweepLikelihood
from hardware.direction_finding.estimate import SparseDirectionFinder, unheard_sigma_deg
from hardware.direction_finding.refine import PatternCurve
from hardware.direction_finding.sweep import bin_sweep, first_part
from hardware.frame import LocalFrame
from hardware.readings import Place, Sweep
from hardware.reasons.sweep import TurnIncomplete
from hardware.sim.turn import turn_once
from hardware.sim.turntable import simulated_antenna
from hardware.sim.world import Emitter, RadioLink, Reflector, World

FRAME = LocalFrame(Place(50.0, 7.0))
FREQUENCY_HZ = 868.3e6
PATTERN = simulated_antenna()
SWEEPS = 40
SECTOR_DEG, CIRCLE_DEG = 160.0, 360.0


def heard(seed: int, start_deg: float, echoes: tuple[Reflector, ...] = ()) -> Sweep:
    """A whole turn, the emitter 120 m away in the north."""
    emitter = Emitter(FRAME.to_geo(0.0, 120.0), FREQUENCY_HZ)
    link = RadioLink(World((emitter,), reflectors=echoes, seed=seed), FREQUENCY_HZ)
    return turn_once(link, FRAME.origin, start_deg=start_deg - PATTERN.offset_to_nose_deg)


def test_the_first_part_of_a_turn_is_what_was_heard_until_then() -> None:
    whole = heard(1, 300.0)
    part = first_part(whole, SECTOR_DEG)
    binned = bin_sweep(part.heading_deg, part.power_db, PATTERN.offset_to_nose_deg)
    assert part.partial
    assert 360.0 - binned.largest_gap_deg == pytest.approx(SECTOR_DEG, abs=3.0)
    assert np.array_equal(part.power_db, whole.power_db[: part.power_db.size])


def test_a_gap_is_refused_unless_it_was_meant_and_a_sector_too_narrow_for_a_lobe_is_refused_all_the_same() -> None:
    finder, part = SparseDirectionFinder(), first_part(heard(1, 280.0), SECTOR_DEG)
    assert finder.estimate(part, PATTERN).accepted
    assert isinstance(finder.estimate(replace(part, partial=False), PATTERN).reason, TurnIncomplete)
    assert isinstance(finder.estimate(first_part(heard(1, 330.0), 60.0), PATTERN).reason, TurnIncomplete)


def test_bearings_of_sectors_lie_within_two_sigma_as_often_as_they_say() -> None:
    """The emitter anywhere in the sector but its outer 30 degrees, which are looked at further."""
    finder, rng = SparseDirectionFinder(), np.random.default_rng(7)
    inside, off = 0, list[float]()
    for seed in range(SWEEPS):
        begin_deg = -float(rng.uniform(30.0, SECTOR_DEG - 30.0))
        found = finder.estimate(first_part(heard(seed, begin_deg), SECTOR_DEG), PATTERN)
        assert found.accepted
        off.append(math.remainder(found.bearing_deg, 360.0))
        inside += abs(off[-1]) <= 2.0 * found.sigma_deg
    assert inside >= 0.9 * SWEEPS
    assert max(map(abs, off)) < 30.0


def test_echoes_from_where_nothing_was_heard_are_in_sigma() -> None:
    """They bend the lobe through the antenna's side lobes, and what the sector shows of them is too little."""
    finder, rng = SparseDirectionFinder(), np.random.default_rng(16)
    curve = PatternCurve(PATTERN)
    unheard_deg = unheard_sigma_deg(360.0 - SECTOR_DEG, curve.beam_deg)
    inside = inside_without = 0
    for seed in range(2 * SWEEPS):
        angle, away_m = math.radians(rng.uniform(100.0, 260.0)), rng.uniform(40.0, 120.0)
        place = FRAME.to_geo(away_m * math.sin(angle), away_m * math.cos(angle))
        echo = Reflector(place, loss_db=rng.uniform(0.0, 4.0), phase_rad=rng.uniform(0.0, 2.0 * math.pi))
        begin_deg = -float(rng.uniform(60.0, SECTOR_DEG - 60.0))
        part = first_part(heard(seed, begin_deg, (echo,)), SECTOR_DEG)
        found = finder.estimate(part, PATTERN)
        off = abs(math.remainder(found.bearing_deg, 360.0))
        binned = bin_sweep(part.heading_deg, part.power_db, PATTERN.offset_to_nose_deg)
        gain_db = curve.gain_db(found.bearing_deg - binned.heading_deg) - curve.peak_db
        beside_deg = beside_lobe_sigma_deg(binned, found.fitted_db, gain_db, found.bearing_deg, curve.beam_deg)
        inside += off <= 2.0 * found.sigma_deg
        inside_without += off <= 2.0 * math.sqrt(found.sigma_deg**2 - unheard_deg**2 - beside_deg**2)
    assert inside >= 0.9 * 2 * SWEEPS
    assert inside_without < 0.85 * 2 * SWEEPS  # else these echoes bend nothing


def test_the_less_of_the_circle_was_heard_the_wider_is_a_bearing_and_a_whole_turn_is_as_it_was() -> None:
    beam_deg = PatternCurve(PATTERN).beam_deg
    assert unheard_sigma_deg(22.5, beam_deg) == 0.0
    assert 0.0 < unheard_sigma_deg(100.0, beam_deg) < unheard_sigma_deg(200.0, beam_deg)
    assert unheard_sigma_deg(200.0, 2.0 * beam_deg) == pytest.approx(2.0 * unheard_sigma_deg(200.0, beam_deg))
    finder, likely = SparseDirectionFinder(), list[int]()
    for turned_deg in (SECTOR_DEG, CIRCLE_DEG):
        found = finder.estimate(first_part(heard(1, 280.0), turned_deg), PATTERN)
        assert found.likelihood is not None
        likely.append(int((SweepLikelihood.unpacked(found.likelihood).log_likelihood > -2.0).sum()))
        assert found.sigma_deg >= unheard_sigma_deg(CIRCLE_DEG - turned_deg, beam_deg)
    # within 2 nats of its peak a normal density is 4 sigma wide
    assert likely[0] >= 4.0 * unheard_sigma_deg(CIRCLE_DEG - SECTOR_DEG, beam_deg) - 1.0 > likely[1]


def test_an_emitter_behind_is_never_a_sure_bearing_within_the_sector() -> None:
    """The back lobe looks like an emitter in front, only weaker: its likelihood has to leave the other side open."""
    finder, sure = SparseDirectionFinder(), 0
    for seed in range(SWEEPS // 2):
        found = finder.estimate(first_part(heard(seed, 100.0), SECTOR_DEG), PATTERN)
        after = (found.bearing_deg - 100.0) % 360.0
        if not found.accepted or found.likelihood is None or not 30.0 <= after <= SECTOR_DEG - 30.0:
            continue
        mass = np.exp(SweepLikelihood.unpacked(found.likelihood).log_likelihood)
        unheard = (np.arange(360) - 100.0) % 360.0 > SECTOR_DEG
        own_deg = math.sqrt(max(found.sigma_deg**2 - found.pattern_sigma_deg**2, 0.0))
        sure += mass[unheard].sum() / mass.sum() < 0.1 and own_deg <= 10.0 and found.quality >= 0.8
    assert sure <= 0.05 * SWEEPS
