"""Bearings heard with another antenna than the pattern's: errors next to the stated sigma and a principal axis.

    python -m tests.benchmarks.pattern_mismatch --sweeps 200

The antenna that hears is a table of its own, the power its squared field plus noise and independent jitter, read at
evenly spaced headings; the finder is given a pattern that nobody checked on the vehicle, as a file without
pointing_sigma_deg is. "foreign" is an antenna with a wide, lumpy lobe through the pattern that ships; `--turntable`
adds one from a measured table. The principal axis is that of the readings' linear powers as vectors, without a pattern.
"""

from __future__ import annotations

import argparse
import math
import sys
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from hardware.direction_finding.antenna import AntennaPattern
from hardware.direction_finding.comparison import beam
from hardware.direction_finding.estimate import SparseDirectionFinder
from hardware.direction_finding.pattern_file import SMALL_YAGI, load_pattern, make_pattern, read_turntable
from hardware.readings import BearingReading, Place, Sweep
from tests.benchmarks.figures.circumstances import begin
from tests.benchmarks.figures.pages import markdown
from tests.benchmarks.figures.record import Cell, Column, Figure, Table
from tests.benchmarks.figures.writer import add_out, plain, wanted, write

OUTLIER_DEG = 30.0
JITTER_DB = 1.0
CASES = ((16, math.inf), (36, 20.0))
"""Slices a turn, and SNR in dB at the lobe's maximum."""
AVERAGES = 100
COLUMNS = (
    Column(name="antenna"),
    Column(name="slices"),
    Column(name="SNR, dB"),
    *(Column(name=name, decimals=1) for name in ("RMS", "principal axis' RMS", "bias", "sigma (median)")),
    *(Column(name=name, decimals=2) for name in ("(error/sigma)²", "in 2")),
    *(Column(name=name, decimals=1) for name in ("outliers, %", "rejected, %")),
)


@dataclass(frozen=True, slots=True, eq=False)
class Mismatch:
    """heard: the antenna's gain; pattern: what the finder takes it for. echoes_db: levels of coherent echoes from
    anywhere. turned_deg: how far the vehicle turned."""

    name: str
    heard: AntennaPattern
    pattern: AntennaPattern
    echoes_db: tuple[float, ...] = ()
    turned_deg: float = 360.0


def deformed(width_deg: float, squint_deg: float = 0.0, left: float = 1.0, right: float = 1.0) -> AntennaPattern:
    """A beam with a floor of 12 dB, its flanks `left` and `right` times as wide, pointing `squint_deg` clockwise."""
    angle = np.arange(360.0)
    off = (angle - squint_deg + 180.0) % 360.0 - 180.0
    width = width_deg * np.where(off < 0.0, left, right)
    return make_pattern("deformed beam", angle, -np.minimum(12.0 * (off / width) ** 2, 12.0))


def lumpy() -> AntennaPattern:
    """A wide lobe with side lobes to both sides, none alike: a small loop or whip beside an airframe."""
    angle = np.arange(0.0, 360.0, 5.0)
    off = (angle + 180.0) % 360.0 - 180.0
    lobes = ((0.0, 0.0, 34.0), (96.0, -7.5, 24.0), (-104.0, -6.5, 20.0), (-62.0, -8.0, 14.0), (176.0, -14.0, 40.0))
    power = sum(
        10.0 ** (level / 10.0) * np.exp(-0.5 * (((off - at + 180.0) % 360.0 - 180.0) / wide) ** 2)
        for at, level, wide in lobes
    )
    return make_pattern("lumpy lobe", angle, 10.0 * np.log10(power + 0.01))


def mismatches(turntable: Path | None = None) -> tuple[Mismatch, ...]:
    nominal, yagi = beam(60.0), load_pattern(SMALL_YAGI)
    rows = (
        Mismatch("right pattern", nominal, nominal),
        Mismatch("beam 20 % wider", deformed(72.0), nominal),
        Mismatch("beam 20 % narrower", deformed(48.0), nominal),
        Mismatch("squint 10 degrees", deformed(60.0, squint_deg=10.0), nominal),
        Mismatch("flanks 0.75 and 1.25", deformed(60.0, left=0.75, right=1.25), nominal),
        Mismatch("foreign, lumpy lobe", lumpy(), yagi),
        Mismatch("three echoes -6 dB", nominal, nominal, (-6.0, -6.0, -6.0)),
        Mismatch("right pattern, turned 270 degrees", nominal, nominal, turned_deg=270.0),
        Mismatch("foreign, lumpy lobe, turned 270 degrees", lumpy(), yagi, (), 270.0),
    )
    if turntable is None:
        return rows
    measured = read_turntable(turntable)
    return (*rows, Mismatch("foreign, from a turntable", measured, yagi))


def sweep_of(mismatch: Mismatch, slices: int, snr_db: float, bearing_deg: float, rng: np.random.Generator) -> Sweep:
    """One sweep of `slices` a full turn. snr_db: at the lobe's maximum, inf: no receiver noise."""
    count = round(slices * mismatch.turned_deg / 360.0)
    heading = (rng.uniform(0.0, 360.0) + np.arange(count) * 360.0 / slices) % 360.0
    top = float(mismatch.heard.gain_db.max())
    field = 10.0 ** ((mismatch.heard.gain_at(bearing_deg - heading) - top) / 20.0) + 0j
    for level_db in mismatch.echoes_db:
        gain_db = mismatch.heard.gain_at(rng.uniform(0.0, 360.0) - heading) - top
        field = field + 10.0 ** ((level_db + gain_db) / 20.0) * np.exp(2j * math.pi * rng.uniform())
    power = np.abs(field) ** 2
    if math.isfinite(snr_db):
        noise = 10.0 ** (-snr_db / 10.0)
        spread = np.sqrt((2.0 * power * noise + noise**2) / AVERAGES)
        power = np.maximum(power + noise + spread * rng.normal(size=count), 0.05 * noise)
    level = 10.0 * np.log10(np.maximum(power, 1e-9)) + JITTER_DB * rng.normal(size=count)
    floor = -snr_db if math.isfinite(snr_db) else None
    at_s = np.linspace(0.0, 0.5 * (count - 1), count)
    return Sweep(at_s, heading, level, 868e6, Place(0.0, 0.0), 0.0, noise_floor_db=floor)


def principal_axis_deg(sweep: Sweep) -> float:
    """First principal component of the powers as vectors, not centred, towards their sum."""
    power = 10.0 ** ((sweep.power_db - sweep.power_db.max()) / 10.0)
    heading = np.radians(sweep.heading_deg)
    vectors = np.column_stack([power * np.sin(heading), power * np.cos(heading)])
    axis: NDArray[np.float64] = np.linalg.eigh(vectors.T @ vectors)[1][:, -1]
    east, north = axis if float(vectors.sum(axis=0) @ axis) > 0.0 else -axis
    return math.degrees(math.atan2(east, north)) % 360.0


@dataclass(frozen=True, slots=True)
class Found:
    """Of accepted sweeps; rms_deg, axis_rms_deg, bias_deg and squares without outliers (of either), the rest of all."""

    rms_deg: float
    axis_rms_deg: float
    bias_deg: float
    sigma_deg: float
    squares: float
    within_two: float
    outlier_percent: float
    rejected_percent: float


def found(mismatch: Mismatch, slices: int, snr_db: float, sweeps: int, seed: int) -> Found:
    rng, finder = np.random.default_rng([seed, slices]), SparseDirectionFinder()
    taken: list[tuple[float, BearingReading, float]] = []
    rejected = 0
    for truth in rng.uniform(0.0, 360.0, sweeps):
        sweep = sweep_of(mismatch, slices, snr_db, float(truth), rng)
        reading = finder.estimate(sweep, mismatch.pattern)
        if reading.accepted:
            taken.append((float(truth), reading, principal_axis_deg(sweep)))
        else:
            rejected += 1
    truth = np.array([t for t, _, _ in taken])
    error = (np.array([r.bearing_deg for _, r, _ in taken]) - truth + 180.0) % 360.0 - 180.0
    axis = (np.array([a for _, _, a in taken]) - truth + 180.0) % 360.0 - 180.0
    sigma = np.array([r.sigma_deg for _, r, _ in taken])
    near, axis_near = np.abs(error) <= OUTLIER_DEG, np.abs(axis) <= OUTLIER_DEG
    return Found(
        float(np.sqrt(np.mean(error[near] ** 2))),
        float(np.sqrt(np.mean(axis[axis_near] ** 2))),
        float(error[near].mean()),
        float(np.median(sigma)),
        float(np.mean((error[near] / sigma[near]) ** 2)),
        float(np.mean(np.abs(error) < 2.0 * sigma)),
        100.0 * float(np.mean(~near)),
        100.0 * rejected / sweeps,
    )


def row(mismatch: Mismatch, slices: int, snr_db: float, f: Found) -> tuple[Cell, ...]:
    """The cells under `COLUMNS`."""
    return (
        *(mismatch.name, slices, "none" if math.isinf(snr_db) else f"{snr_db:g}"),
        *(f.rms_deg, f.axis_rms_deg, f.bias_deg, f.sigma_deg, f.squares, f.within_two),
        *(f.outlier_percent, f.rejected_percent),
    )


def figures(rows: dict[tuple[Mismatch, int, float], Found]) -> list[Figure]:
    """The worst row stands for "every pattern"; how far the RMS exceeds the principal axis', where it does."""

    def named(key: tuple[Mismatch, int, float]) -> str:
        mismatch, slices, snr_db = key
        return f"{mismatch.name}, {slices} slices" + ("" if math.isinf(snr_db) else f", SNR {snr_db:g} dB")

    covered = min(rows, key=lambda key: rows[key].within_two)
    whole = {key: f for key, f in rows.items() if key[0].turned_deg >= 360.0}
    worse = max(whole, key=lambda key: whole[key].rms_deg - whole[key].axis_rms_deg)
    return [
        wanted("mismatch_sigma", round(100.0 * rows[covered].within_two, 1), note=named(covered)),
        wanted("mismatch_axis", round(whole[worse].rms_deg - whole[worse].axis_rms_deg, 2), note=named(worse)),
        *(plain(f"bearing RMS, {named(key)}", round(f.rms_deg, 2), "deg") for key, f in rows.items()),
    ]


def main() -> None:
    parser = argparse.ArgumentParser(description="Bearings with a pattern that is not the antenna's.")
    parser.add_argument("--sweeps", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--turntable", type=Path, help="measured table (angle_deg, gain_db) of another foreign antenna")
    parser.add_argument("--jobs", type=int, default=1, help="processes; the rows have their own chance")
    add_out(parser)
    arguments = parser.parse_args()
    begun, rows = begin(__file__), dict[tuple[Mismatch, int, float], Found]()
    kinds = mismatches(arguments.turntable)
    with ProcessPoolExecutor(arguments.jobs) as pool:
        waited = [
            (mismatch, case, pool.submit(found, mismatch, *case, arguments.sweeps, arguments.seed))
            for mismatch in kinds
            for case in CASES
        ]
        for mismatch, case, answer in waited:
            rows[mismatch, *case] = answer.result()
            print(mismatch.name, *case, file=sys.stderr, flush=True)
    table = Table(name="patterns", columns=COLUMNS, rows=tuple(row(*key, f) for key, f in rows.items()))
    print(markdown(table))
    title, page = "Bearings with the wrong pattern", "direction-finding.md#the-pattern-may-be-wrong"
    write(arguments.out, "pattern_mismatch", title, begun, figures(rows), tables=[table], page=page)


if __name__ == "__main__":
    main()
