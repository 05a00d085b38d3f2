"""Bearings in the simulated world (its own antenna physics, ground, fading, walls): errors next to the stated sigma.

    python -m tests.benchmarks.sensor_world --sweeps 200

The finder works with the pattern that the simulated turntable measured; the vehicle hovers at 40 m and turns at 30
degrees a second.
"""

from __future__ import annotations

import argparse
import math
import sys
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass

import numpy as np

from hardware.direction_finding.antenna import AntennaPattern
from hardware.direction_finding.comparison import Score, paired_deg, score
from hardware.direction_finding.estimate import SparseDirectionFinder
from hardware.direction_finding.least_squares import LeastSquaresDirectionFinder
from hardware.frame import LocalFrame
from hardware.readings import Place, Sweep
from hardware.sim.propagation import Fading
from hardware.sim.turn import turn_once
from hardware.sim.turntable import simulated_antenna
from hardware.sim.world import Emitter, RadioLink, Reflector, World
from tests.benchmarks.figures.circumstances import begin
from tests.benchmarks.figures.pages import markdown
from tests.benchmarks.figures.record import Cell, Column, Figure, Table
from tests.benchmarks.figures.writer import add_out, plain, wanted, write

HERE = Place(50.6, 7.2)
FREQUENCY_HZ = 868_300_000.0


@dataclass(frozen=True, slots=True)
class Situation:
    """Where the emitter is and what stands around: `reflectors` anywhere within 30 to 250 m of the vehicle."""

    name: str
    distance_m: float = 150.0
    rician_k_db: float = 9.0
    reflectors: int = 0
    loss_db: float = 6.0
    power_dbm: float = -10.0


SITUATIONS = (
    Situation("150 m, Rician K 13 dB", rician_k_db=13.0),
    Situation("150 m, K 9 dB"),
    Situation("150 m, K 5 dB", rician_k_db=5.0),
    Situation("60 m, K 9 dB (looking 33 degrees down)", 60.0),
    Situation("50 m, K 9 dB (38 degrees down)", 50.0),
    Situation("40 m, K 9 dB (44 degrees down)", 40.0),
    Situation("200 m, one reflector -6 dB", 200.0, reflectors=1),
    Situation("200 m, two reflectors -3 dB", 200.0, reflectors=2, loss_db=3.0),
    Situation("120 m, one reflector -8 dB", 120.0, reflectors=1, loss_db=8.0),
    Situation("300 m, weak (SNR 4 to 8 dB)", 300.0, power_dbm=-34.0),
    Situation("300 m, weaker (SNR 0 to 4 dB)", 300.0, power_dbm=-38.0),
)


COLUMNS = (
    Column(name="condition"),
    *(Column(name=name, decimals=2) for name in ("RMS", "minus least squares (± its standard error)", "bias")),
    *(Column(name=name, decimals=2) for name in ("sigma (median)", "error/sigma", "in 1", "in 2")),
    *(Column(name=name, decimals=1) for name in ("outliers, %", "rejected, %")),
)


def sweep_at(situation: Situation, rng: np.random.Generator) -> tuple[float, Sweep]:
    """(true bearing, sweep)."""
    frame = LocalFrame(HERE)

    def around(bearing: float, away_m: float) -> Place:
        return frame.to_geo(away_m * math.sin(bearing), away_m * math.cos(bearing))

    bearing = float(rng.uniform(0.0, 2.0 * math.pi))
    reflectors = tuple(
        Reflector(
            around(float(rng.uniform(0.0, 2.0 * math.pi)), float(rng.uniform(30.0, 250.0))),
            situation.loss_db,
            float(rng.uniform(0.0, 2.0 * math.pi)),
        )
        for _ in range(situation.reflectors)
    )
    emitter = Emitter(around(bearing, situation.distance_m), FREQUENCY_HZ, situation.power_dbm)
    seed = int(rng.integers(2**31))
    world = World((emitter,), fading=Fading(situation.rician_k_db), reflectors=reflectors, seed=seed)
    sweep = turn_once(RadioLink(world, FREQUENCY_HZ), HERE, start_deg=float(rng.uniform(0.0, 360.0)))
    return math.degrees(bearing), sweep


@dataclass(frozen=True, slots=True)
class Heard:
    """Of the sweeps at one situation. paired_deg: against least squares on the same sweeps. sigma_deg: the median."""

    score: Score
    paired_deg: tuple[float, float]
    sigma_deg: float


def heard_at(situation: Situation, sweeps: int, seed: int, pattern: AntennaPattern) -> Heard:
    rng = np.random.default_rng(seed)
    taken = [sweep_at(situation, rng) for _ in range(sweeps)]
    truths = [truth for truth, _ in taken]
    readings = [SparseDirectionFinder().estimate(sweep, pattern) for _, sweep in taken]
    plainer = [LeastSquaresDirectionFinder().estimate(sweep, pattern) for _, sweep in taken]
    sigma = float(np.median([r.sigma_deg for r in readings if r.accepted]))
    return Heard(score(readings, truths), paired_deg(readings, plainer, truths), sigma)


def row(situation: Situation, heard: Heard) -> tuple[Cell, ...]:
    """The cells under `COLUMNS`."""
    s = heard.score
    return (
        *(situation.name, s.rms_deg, heard.paired_deg, s.bias_deg, heard.sigma_deg),
        *(s.normalized_rms, s.within_one, s.within_two, s.outlier_percent, s.rejected_percent),
    )


def figures(heard: dict[Situation, Heard]) -> list[Figure]:
    """The worst situation stands for "never worse than least squares"; its standard error is doubled for 95 %."""
    worst = max(heard, key=lambda situation: heard[situation].paired_deg[0])
    difference, error = heard[worst].paired_deg
    return [
        wanted(
            "least_squares", round(difference, 2), of="simulated world", ci95=round(2.0 * error, 2), note=worst.name
        ),
        *(
            plain(f"bearing RMS, {situation.name}", round(found.score.rms_deg, 2), "deg")
            for situation, found in heard.items()
        ),
    ]


def main() -> None:
    parser = argparse.ArgumentParser(description="Bearings in the simulated world.")
    parser.add_argument("--sweeps", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=1, help="processes; each place has its own chance")
    add_out(parser)
    arguments = parser.parse_args()
    begun, pattern, heard = begin(__file__), simulated_antenna(), dict[Situation, Heard]()
    with ProcessPoolExecutor(arguments.jobs) as pool:
        waited = [
            (situation, pool.submit(heard_at, situation, arguments.sweeps, arguments.seed, pattern))
            for situation in SITUATIONS
        ]
        for situation, answer in waited:
            heard[situation] = answer.result()
            print(situation.name, file=sys.stderr, flush=True)
    table = Table(name="places", columns=COLUMNS, rows=tuple(row(*found) for found in heard.items()))
    print(markdown(table))
    title, page = "Bearings in the simulated world", "direction-finding.md#how-good-it-is"
    write(arguments.out, "sensor_world", title, begun, figures(heard), tables=[table], page=page)


if __name__ == "__main__":
    main()
