"""Sweeps of other antennas and receivers than the simulated ones: how often the truth is where the finder says.

    python -m tests.benchmarks.foreign_sweeps --sweeps 200 --jobs 2

Power against heading as a script makes it that knows neither the simulated world nor the finder: a turn and a bit of 60
readings, half a decibel of noise, a wave that fades by 1 dB over 10 degrees, and what a row says. The finder has the
antenna's turntable table, every 10 degrees to a tenth of a decibel, checked on the vehicle to a degree.
"""

from __future__ import annotations

import argparse
import math
import sys
from collections.abc import Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hardware.direction_finding.circle import SweepLikelihood
from hardware.direction_finding.estimate import SparseDirectionFinder
from hardware.direction_finding.pattern_file import make_pattern
from hardware.readings import Place, Sweep
from tests.benchmarks.figures.circumstances import begin
from tests.benchmarks.figures.pages import markdown
from tests.benchmarks.figures.record import Column, Table
from tests.benchmarks.figures.writer import add_out, plain, write
from tests.benchmarks.pattern_mismatch import principal_axis_deg

Array = NDArray[np.float64]
ANGLES: Array = np.arange(0.0, 360.0, 1.0)
TURN_DEG = 380.0
COLUMNS = (
    Column(name="antenna"),
    Column(name="what is heard"),
    Column(name="refused, %", decimals=0),
    *(Column(name=name, decimals=0) for name in ("within two sigma, %", "beyond five sigma, %")),
    *(Column(name=name, decimals=1) for name in ("RMS, degrees", "principal axis' RMS, degrees")),
    Column(name="sigma (median), degrees", decimals=1),
    Column(name="log of the likelihood at the truth over an even one", decimals=1),
)


def _end_fire(amplitude: Sequence[float], spacing: float, lag: float) -> Array:
    """Power of elements `spacing` wavelengths apart, each fed lag * 2 pi * spacing behind the one before."""
    x = 2.0 * math.pi * spacing * (np.cos(np.radians(ANGLES)) - lag)
    return np.abs(np.sum([a * np.exp(1j * k * x) for k, a in enumerate(amplitude)], axis=0)) ** 2


def _lobe(width_deg: Array | float, depth_db: float) -> Array:
    return 10.0 ** (-0.1 * depth_db * (1.0 - np.exp(-12.0 * (_off(ANGLES) / width_deg) ** 2 / depth_db)))


def _off(angle: Array) -> Array:
    return (angle + 180.0) % 360.0 - 180.0


_COSINE = np.cos(np.radians(ANGLES))
_YAGI = _end_fire((0.75, 1.0, 0.75), 0.19, 1.7)
ANTENNAS: Mapping[str, Array] = {
    "H, two elements": (0.7 + 0.3 * _COSINE) ** 2,
    "Yagi, three": _YAGI,
    "Yagi, five": _end_fire((0.6, 1.0, 0.8, 0.7, 0.6), 0.22, 1.15),
    "log-periodic": _lobe(67.0, 20.0) * 10.0 ** (0.05 * np.cos(np.radians(5.0 * ANGLES)) * (1.0 - _COSINE)),
    "moxon": (0.5 + 0.5 * _COSINE) ** 2.3 + 0.003,
    "dipole": _COSINE**2 + 0.02,
    "shadow of a body": 10.0 ** (-1.2 * np.exp(-0.5 * (_off(ANGLES - 180.0) / 32.0) ** 2)),
    "squinting Yagi": np.roll(_YAGI, 12),
    "uneven lobe": _lobe(65.0 * np.where(_off(ANGLES) < 0.0, 0.72, 1.28), 13.0),
    "Yagi, crossed": 0.7 * _YAGI / _YAGI.max() + 0.35,
}
"""(360,) power gain, of any scale."""


@dataclass(frozen=True, slots=True)
class Heard:
    """fade_db, over_deg: of the wave. drift_db: from the turn's begin to its end. slope: of the receiver's scale.
    step_db: it rounds to. clipped_db: cut off the loudest. echo_db: a reflector's wave under the direct
    one; None: none."""

    fade_db: float = 1.0
    over_deg: float = 10.0
    drift_db: float = 0.0
    slope: float = 1.0
    step_db: float = 0.0
    clipped_db: float = 0.0
    echo_db: float | None = None
    readings: int = 60


DISTURBED: Mapping[str, Heard] = {
    "rounded to 3 dB": Heard(step_db=3.0),
    "rounded to 6 dB": Heard(step_db=6.0),
    "half a dB for one": Heard(slope=0.5),
    "clipped by 4 dB": Heard(clipped_db=4.0),
    "clipped by 8 dB": Heard(clipped_db=8.0),
    "fading, 2 dB over 30 degrees": Heard(fade_db=2.0, over_deg=30.0),
    "fading, 4 dB over 30 degrees": Heard(fade_db=4.0, over_deg=30.0),
    "fading, 4 dB over 5 degrees": Heard(fade_db=4.0, over_deg=5.0),
    "10 dB more or less by the end": Heard(drift_db=10.0),
    "an echo of -10 dB": Heard(echo_db=-10.0),
    "an echo of -6 dB": Heard(echo_db=-6.0),
    "an echo of -3 dB": Heard(echo_db=-3.0),
    "16 readings": Heard(readings=16),
}
ROWS = (
    *((antenna, "as described", Heard()) for antenna in ANTENNAS),
    *((antenna, *row) for antenna in ("Yagi, three", "H, two elements") for row in DISTURBED.items()),
)


@dataclass(frozen=True, slots=True)
class Found:
    """off_deg, axis_off_deg: errors. sigma_deg: None where the sweep was refused. likely: log of the likelihood at the
    truth over an even one."""

    off_deg: float
    axis_off_deg: float
    sigma_deg: float | None
    likely: float


def sweep_of(antenna: str, heard: Heard, truth_deg: float, rng: np.random.Generator) -> Sweep:
    """One turn, from anywhere on."""
    turned = np.linspace(0.0, TURN_DEG, heard.readings)
    heading = rng.uniform(0.0, 360.0) + turned
    field = _field(antenna, truth_deg - heading).astype(complex)
    if heard.echo_db is not None:
        wave = 10.0 ** (heard.echo_db / 20.0) * np.exp(2j * math.pi * rng.random())
        field += wave * _field(antenna, rng.uniform(0.0, 360.0) - heading)
    power = 20.0 * np.log10(np.abs(field) + 1e-6)
    alike = np.exp(-0.5 * ((turned[:, None] - turned) / heard.over_deg) ** 2)
    power += heard.fade_db * rng.multivariate_normal(np.zeros(turned.size), alike, method="eigh")
    power += heard.drift_db * (turned / TURN_DEG - 0.5) * rng.choice([-1.0, 1.0])
    power = heard.slope * power + rng.normal(0.0, 0.5, turned.size)
    power = np.minimum(power, power.max() - heard.clipped_db)
    if heard.step_db:
        power = heard.step_db * np.round(power / heard.step_db)
    return Sweep(turned / 30.0, heading % 360.0, power - 60.0, 150e6, Place(0.0, 0.0), 0.0)


def _field(antenna: str, angle_deg: Array) -> Array:
    gain = ANTENNAS[antenna]
    return np.interp(angle_deg, ANGLES, np.sqrt(gain / gain.max()), period=360.0)


def heard_by(antenna: str, heard: Heard, sweeps: int, seed: int) -> list[Found]:
    """Each from a direction of its own."""
    table, gain = ANGLES[::10], 10.0 * np.log10(ANTENNAS[antenna] / ANTENNAS[antenna].max())[::10]
    pattern = make_pattern(antenna, table, np.round(gain, 1), pointing_sigma_deg=1.0)
    finder, rng, found = SparseDirectionFinder(), np.random.default_rng(seed), list[Found]()
    for _ in range(sweeps):
        truth = rng.uniform(0.0, 360.0)
        sweep = sweep_of(antenna, heard, truth, rng)
        reading = finder.estimate(sweep, pattern)
        likelihood = (
            SweepLikelihood.unpacked(reading.likelihood).log_likelihood if reading.likelihood else np.zeros(360)
        )
        likely = likelihood[round(truth) % 360] - float(np.log(np.mean(np.exp(likelihood))))
        off, axis_off = (math.remainder(one - truth, 360.0) for one in (reading.bearing_deg, principal_axis_deg(sweep)))
        sigma = reading.sigma_deg if reading.accepted else None
        found.append(Found(off, axis_off, sigma, likely))
    return found


Cells = tuple[str, str, float, float, float, float, float, float, float]


def row(antenna: str, what: str, found: Sequence[Found]) -> Cells:
    """The cells under `COLUMNS`: of the accepted sweeps, but for the share of the refused."""
    used = [(one, one.sigma_deg) for one in found if one.sigma_deg is not None]
    off, sigma = np.array([one.off_deg for one, _ in used]), np.array([stated for _, stated in used])
    held, far = 100.0 * float(np.mean(np.abs(off) <= 2.0 * sigma)), 100.0 * float(np.mean(np.abs(off) > 5.0 * sigma))
    own, axis = (float(np.sqrt(np.mean(np.square(one)))) for one in (off, [one.axis_off_deg for one, _ in used]))
    refused, likely = 100.0 - 100.0 * len(used) / len(found), float(np.mean([one.likely for one, _ in used]))
    return antenna, what, refused, held, far, own, axis, float(np.median(sigma)), likely


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--sweeps", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=1)
    add_out(parser)
    arguments = parser.parse_args()
    begun, rows = begin(__file__), list[Cells]()
    with ProcessPoolExecutor(arguments.jobs) as pool:
        jobs = [
            pool.submit(heard_by, a, heard, arguments.sweeps, arguments.seed + k)
            for k, (a, _, heard) in enumerate(ROWS)
        ]
        for (antenna, what, _), job in zip(ROWS, jobs, strict=True):
            rows.append(row(antenna, what, job.result()))
            print(*rows[-1], file=sys.stderr, flush=True)
    table = Table(name="sweeps", columns=COLUMNS, rows=tuple(rows))
    print(markdown(table))
    least = min((cells for cells in rows if cells[0] != "dipole"), key=lambda cells: cells[3])
    worst = max((cells for cells in rows if cells[0] != "dipole"), key=lambda cells: cells[5] - cells[6])
    figures = [
        plain("within two sigma, at least", round(least[3], 1), "%", note=", ".join(least[:2])),
        plain(
            "RMS above the principal axis', at most",
            round(worst[5] - worst[6], 1),
            "degrees",
            note=f"{worst[0]}, {worst[1]}",
        ),
    ]
    title, page = "Sweeps of other antennas and receivers", "direction-finding.md#sweeps-of-other-antennas"
    write(arguments.out, "foreign_sweeps", title, begun, figures, tables=[table], page=page)


if __name__ == "__main__":
    main()
