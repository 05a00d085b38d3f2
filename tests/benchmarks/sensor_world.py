"""Bearings in the simulated world (its own antenna physics, ground, fading, walls): errors next to the stated sigma.

    python -m tests.benchmarks.sensor_world --sweeps 200

The finder works with the pattern that the simulated turntable measured; the vehicle hovers at 40 m and turns at 30
degrees a second.
"""

from __future__ import annotations

import argparse
import math
from dataclasses import dataclass

import numpy as np

from hardware.direction_finding.comparison import paired_deg, score
from hardware.direction_finding.estimate import SparseDirectionFinder
from hardware.direction_finding.least_squares import LeastSquaresDirectionFinder
from hardware.direction_finding.pattern_file import SMALL_YAGI, load_pattern
from hardware.frame import LocalFrame
from hardware.readings import GeoPoint, Sweep
from hardware.sim.propagation import Fading
from hardware.sim.turn import turn_once
from hardware.sim.world import Emitter, RadioLink, Reflector, World

HERE = GeoPoint(50.6, 7.2)
FREQUENCY_HZ = 868_300_000.0


@dataclass(frozen=True, slots=True)
class Place:
    """Where the emitter is and what stands around: `reflectors` anywhere within 30 to 250 m of the vehicle."""

    name: str
    distance_m: float = 150.0
    rician_k_db: float = 9.0
    reflectors: int = 0
    loss_db: float = 6.0
    power_dbm: float = -10.0


PLACES = (
    Place("150 m, Rician K 13 dB", rician_k_db=13.0),
    Place("150 m, K 9 dB"),
    Place("150 m, K 5 dB", rician_k_db=5.0),
    Place("60 m, K 9 dB (looking 33 degrees down)", 60.0),
    Place("50 m, K 9 dB (38 degrees down)", 50.0),
    Place("40 m, K 9 dB (44 degrees down)", 40.0),
    Place("200 m, one reflector -6 dB", 200.0, reflectors=1),
    Place("200 m, two reflectors -3 dB", 200.0, reflectors=2, loss_db=3.0),
    Place("120 m, one reflector -8 dB", 120.0, reflectors=1, loss_db=8.0),
    Place("300 m, weak (SNR 4 to 8 dB)", 300.0, power_dbm=-34.0),
    Place("300 m, weaker (SNR 0 to 4 dB)", 300.0, power_dbm=-38.0),
)


COLUMNS = (
    *("condition", "RMS", "minus least squares' on the same sweeps", "bias", "sigma (median)"),
    *("error/sigma", "in 1", "in 2", "outliers", "rejected"),
)


def sweep_at(place: Place, rng: np.random.Generator) -> tuple[float, Sweep]:
    """(true bearing, sweep)."""
    frame = LocalFrame(HERE)

    def around(bearing: float, away_m: float) -> GeoPoint:
        return frame.to_geo(away_m * math.sin(bearing), away_m * math.cos(bearing))

    bearing = float(rng.uniform(0.0, 2.0 * math.pi))
    reflectors = tuple(
        Reflector(
            around(float(rng.uniform(0.0, 2.0 * math.pi)), float(rng.uniform(30.0, 250.0))),
            place.loss_db,
            float(rng.uniform(0.0, 2.0 * math.pi)),
        )
        for _ in range(place.reflectors)
    )
    emitter = Emitter(around(bearing, place.distance_m), FREQUENCY_HZ, place.power_dbm)
    seed = int(rng.integers(2**31))
    world = World((emitter,), fading=Fading(place.rician_k_db), reflectors=reflectors, seed=seed)
    sweep = turn_once(RadioLink(world, FREQUENCY_HZ), HERE, start_deg=float(rng.uniform(0.0, 360.0)))
    return math.degrees(bearing), sweep


def main() -> None:
    parser = argparse.ArgumentParser(description="Bearings in the simulated world.")
    parser.add_argument("--sweeps", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    pattern = load_pattern(SMALL_YAGI)
    finder, plain = SparseDirectionFinder(), LeastSquaresDirectionFinder()
    print(f"| {' | '.join(COLUMNS)} |")
    print("|---" * len(COLUMNS) + "|")
    for place in PLACES:
        rng = np.random.default_rng(arguments.seed)
        taken = [sweep_at(place, rng) for _ in range(arguments.sweeps)]
        truths = [truth for truth, _ in taken]
        readings = [finder.estimate(sweep, pattern) for _, sweep in taken]
        s = score(readings, truths)
        more, error = paired_deg(readings, [plain.estimate(sweep, pattern) for _, sweep in taken], truths)
        sigma = np.median([r.sigma_deg for r in readings if r.accepted])
        print(
            f"| {place.name} | {s.rms_deg:.2f} | {more:+.2f} ± {error:.2f} | {s.bias_deg:+.2f} | {sigma:.2f} | "
            f"{s.normalized_rms:.2f} | {s.within_one:.2f} | {s.within_two:.2f} | {s.outlier_percent:.1f} % | "
            f"{s.rejected_percent:.1f} % |",
            flush=True,
        )


if __name__ == "__main__":
    main()
