"""The stated sigma is true, the bearing no worse than a least-squares fit: without echoes, with, near the noise."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

from hardware.direction_finding.comparison import Condition, beam, known_right, paired_deg, simulate
from hardware.direction_finding.estimate import SparseDirectionFinder
from hardware.direction_finding.least_squares import LeastSquaresDirectionFinder
from hardware.direction_finding.pattern_file import SMALL_YAGI, load_pattern
from hardware.frame import LocalFrame
from hardware.readings import BearingReading, Place, Sweep
from hardware.reasons.sweep import NothingAboveNoise
from hardware.sim.turn import turn_once
from hardware.sim.turntable import simulated_antenna
from hardware.sim.world import Emitter, RadioLink, Reflector, World

HERE = Place(50.6, 7.2)
FREQUENCY_HZ = 868_300_000.0
FINDER = SparseDirectionFinder()


def errors(readings: list[BearingReading], truths: list[float]) -> np.ndarray:
    return np.array([(r.bearing_deg - t + 180.0) % 360.0 - 180.0 for r, t in zip(readings, truths, strict=True)])


def rms(values: np.ndarray) -> float:
    return float(np.sqrt(np.mean(values**2)))


@pytest.mark.parametrize(
    "condition",
    [
        Condition("reference"),
        Condition("8 dB over the noise", snr_db=8.0),
        Condition("echo 6 dB down", slices=36, echo_db=-6.0),
        Condition("echo 3 dB down", slices=36, echo_db=-3.0),
    ],
    ids=lambda condition: condition.name,
)
def test_sigma_is_true_and_least_squares_no_better(condition: Condition) -> None:
    rng, pattern = np.random.default_rng(3), known_right(beam(condition.beam_deg))
    truths = [float(b) for b in rng.uniform(0.0, 360.0, 60)]
    sweeps = [simulate(condition, pattern, truth, rng) for truth in truths]
    ours = [FINDER.estimate(sweep, pattern) for sweep in sweeps]
    plain = [LeastSquaresDirectionFinder().estimate(sweep, pattern) for sweep in sweeps]
    assert 0.65 < rms(errors(ours, truths) / np.array([r.sigma_deg for r in ours])) < 1.6
    more_deg, standard_error_deg = paired_deg(ours, plain, truths)
    assert more_deg < 2.0 * standard_error_deg


def world_sweep(rng: np.random.Generator, distance_m: float, power_dbm: float, reflectors: int) -> tuple[float, Sweep]:
    frame = LocalFrame(HERE)

    def place(bearing: float, away_m: float) -> Place:
        return frame.to_geo(away_m * math.sin(bearing), away_m * math.cos(bearing))

    bearing = rng.uniform(0.0, 2.0 * math.pi)
    walls = tuple(
        Reflector(place(rng.uniform(0.0, 2.0 * math.pi), rng.uniform(30.0, 250.0)), 6.0, rng.uniform(0.0, 6.28))
        for _ in range(reflectors)
    )
    emitter = Emitter(place(bearing, distance_m), FREQUENCY_HZ, power_dbm)
    world = World((emitter,), reflectors=walls, seed=int(rng.integers(2**31)))
    return math.degrees(bearing), turn_once(RadioLink(world, FREQUENCY_HZ), HERE, start_deg=rng.uniform(0.0, 360.0))


@pytest.mark.parametrize(
    ("distance_m", "power_dbm", "reflectors"),
    [(150.0, -10.0, 0), (40.0, -10.0, 0), (200.0, -10.0, 1), (300.0, -36.0, 0)],
    ids=["clear", "looking 44 degrees down", "a reflector", "weak"],
)
def test_sigma_covers_the_error_in_the_simulated_world(distance_m: float, power_dbm: float, reflectors: int) -> None:
    rng, pattern = np.random.default_rng(8), simulated_antenna()
    taken = [world_sweep(rng, distance_m, power_dbm, reflectors) for _ in range(40)]
    readings = [(FINDER.estimate(sweep, pattern), truth) for truth, sweep in taken]
    heard = [(r, truth) for r, truth in readings if r.accepted]
    made = errors([r for r, _ in heard], [truth for _, truth in heard])
    assert len(heard) > 20
    assert rms(made / np.array([r.sigma_deg for r, _ in heard])) < 1.7


def test_hidden_echo_widens_sigma() -> None:
    condition = Condition("clear", slices=36, jitter_db=0.5)
    pattern, rng = known_right(beam(60.0)), np.random.default_rng(5)
    echoed = dataclasses.replace(condition, echo_db=-5.0)
    clear_deg = np.median(
        [FINDER.estimate(simulate(condition, pattern, 90.0, rng), pattern).sigma_deg for _ in range(25)]
    )
    echo_deg = np.median([FINDER.estimate(simulate(echoed, pattern, 90.0, rng), pattern).sigma_deg for _ in range(25)])
    assert echo_deg > 1.3 * clear_deg


def test_uncertain_heading_adds_to_sigma() -> None:
    sweep = simulate(Condition("clear"), beam(60.0), 90.0, np.random.default_rng(6))
    sure = FINDER.estimate(sweep, beam(60.0))
    unsure = SparseDirectionFinder(heading_sigma_deg=4.0).estimate(sweep, beam(60.0))
    assert unsure.sigma_deg == pytest.approx(math.hypot(sure.sigma_deg, 4.0))
    assert unsure.bearing_deg == sure.bearing_deg


def test_unsure_place_adds_to_sigma() -> None:
    sweep = simulate(Condition("clear"), beam(60.0), 90.0, np.random.default_rng(6))
    sure = FINDER.estimate(sweep, beam(60.0))
    unsure = FINDER.estimate(dataclasses.replace(sweep, drift_m=30.0), beam(60.0))
    assert unsure.sigma_deg == pytest.approx(math.hypot(sure.sigma_deg, 16.7), rel=1e-3)
    assert unsure.bearing_deg == sure.bearing_deg


def test_wave_below_the_noise_is_not_believed() -> None:
    rng = np.random.default_rng(2)
    _, sweep = world_sweep(rng, 300.0, -52.0, 0)
    reading = FINDER.estimate(sweep, load_pattern(SMALL_YAGI))
    assert not reading.accepted
    assert reading.reason == NothingAboveNoise(3.0)
