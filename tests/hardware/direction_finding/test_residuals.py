"""An antenna that is not the measured one shows in what its sweeps have in common; the flight then measures it."""

from __future__ import annotations

import math

import numpy as np
import pytest

from hardware.direction_finding.antenna import AntennaPattern
from hardware.direction_finding.comparison import beam
from hardware.direction_finding.estimate import SparseDirectionFinder
from hardware.direction_finding.residuals import KeptSweep, refined_pattern, repeating
from hardware.direction_finding.sweep import bin_sweep
from hardware.frame import LocalFrame
from hardware.readings import Place
from tests.benchmarks.pattern_mismatch import Mismatch, deformed, lumpy, sweep_of

EMITTER = Place(50.6, 7.2)
FRAME = LocalFrame(EMITTER)
NOMINAL = beam(60.0)
FINDER = SparseDirectionFinder()


def flight(
    heard: AntennaPattern, count: int, seed: int, echoes_db: tuple[float, ...] = ()
) -> tuple[list[KeptSweep], np.ndarray]:
    """Sweeps from places around the emitter, and the errors of their bearings in degrees."""
    rng = np.random.default_rng(seed)
    kept: list[KeptSweep] = []
    errors: list[float] = []
    for _ in range(count):
        truth = float(rng.uniform(0.0, 360.0))
        away = float(rng.uniform(60.0, 200.0))
        place = FRAME.to_geo(-away * math.sin(math.radians(truth)), -away * math.cos(math.radians(truth)))
        sweep = sweep_of(Mismatch("", heard, NOMINAL, echoes_db), 90, math.inf, truth, rng)
        reading = FINDER.estimate(sweep, NOMINAL)
        kept.append(KeptSweep(place, reading.bearing_deg, bin_sweep(sweep.heading_deg, sweep.power_db, 0.0).power_db))
        errors.append((reading.bearing_deg - truth + 180.0) % 360.0 - 180.0)
    return kept, np.array(errors)


@pytest.mark.parametrize("heard", [deformed(60.0, left=0.75, right=1.25), lumpy()], ids=["uneven flanks", "foreign"])
def test_another_antenna_shows_after_a_few_places(heard: AntennaPattern) -> None:
    found = repeating(flight(heard, 5, 1)[0], NOMINAL)
    assert found is not None
    assert found.significant


@pytest.mark.parametrize("echoes_db", [(), (-8.0,)], ids=["clear", "an echo at every place"])
def test_the_measured_antenna_is_not_suspected(echoes_db: tuple[float, ...]) -> None:
    found = [repeating(flight(NOMINAL, 5, seed, echoes_db)[0], NOMINAL) for seed in range(6)]
    assert sum(one is not None and one.significant for one in found) == 0


def test_two_places_are_too_few_to_repeat() -> None:
    kept, _ = flight(lumpy(), 2, 1)
    assert repeating(kept, NOMINAL) is None
    assert refined_pattern(kept, EMITTER, NOMINAL) is None


@pytest.mark.parametrize(
    "heard",
    [deformed(60.0, left=0.75, right=1.25), deformed(60.0, squint_deg=10.0)],
    ids=["uneven flanks", "squint of 10 degrees"],
)
def test_the_refined_pattern_takes_most_of_the_error_away(heard: AntennaPattern) -> None:
    kept, before = flight(heard, 8, 2)
    assert float(np.sqrt(np.mean(before**2))) > 4.0
    refined = refined_pattern(kept, EMITTER, NOMINAL)
    assert refined is not None
    rng = np.random.default_rng(9)
    after = []
    for truth in rng.uniform(0.0, 360.0, 10):
        reading = FINDER.estimate(sweep_of(Mismatch("", heard, refined), 90, math.inf, float(truth), rng), refined)
        after.append((reading.bearing_deg - truth + 180.0) % 360.0 - 180.0)
    assert float(np.sqrt(np.mean(np.square(after)))) < 1.9  # degrees
