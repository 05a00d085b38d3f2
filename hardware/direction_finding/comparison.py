"""How good the direction finders are, next to the Cramer-Rao bound: 2000 simulated sweeps a condition.

`make compare-direction-finders` makes the tables of docs/direction-finding.md from it.

The sweeps here are made by the measurement model itself (pattern, receiver noise, jitter, coherent echoes), so that a
bound exists; the simulated world of hardware/sim has physics of its own and is used in the tests.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from hardware.direction_finding.antenna import AntennaPattern
from hardware.direction_finding.estimate import SparseDirectionFinder
from hardware.direction_finding.least_squares import CorrelationDirectionFinder, LeastSquaresDirectionFinder
from hardware.direction_finding.pattern_file import make_pattern
from hardware.readings import BearingReading, Place, Sweep

OUTLIER_DEG = 30.0
_AVERAGES = 100
_DB = 10.0 / math.log(10.0)


@dataclass(frozen=True, slots=True)
class Condition:
    """beam_deg: 3 dB width, floor 12 dB down. jitter_db: even noise on every reading. snr_db: at the beam's maximum
    (inf: no receiver noise). echo_db: level of a coherent echo from a random direction at a random phase."""

    name: str
    beam_deg: float = 60.0
    slices: int = 16
    jitter_db: float = 1.0
    snr_db: float = math.inf
    echo_db: float | None = None


CONDITIONS = (
    Condition("reference: 60 deg, 16 slices, 1 dB"),
    Condition("jitter 2 dB", jitter_db=2.0),
    Condition("jitter 3 dB", jitter_db=3.0),
    Condition("SNR 20 dB", snr_db=20.0),
    Condition("SNR 10 dB", snr_db=10.0),
    Condition("SNR 5 dB", snr_db=5.0),
    Condition("beam 40 deg", beam_deg=40.0),
    Condition("beam 90 deg", beam_deg=90.0),
    Condition("8 slices", slices=8),
    Condition("36 slices", slices=36),
    Condition("180 slices", slices=180),
    Condition("echo -10 dB, 36 slices", slices=36, echo_db=-10.0),
    Condition("echo -6 dB, 36 slices", slices=36, echo_db=-6.0),
    Condition("echo -3 dB, 36 slices", slices=36, echo_db=-3.0),
)


def beam(width_deg: float, floor_db: float = 12.0) -> AntennaPattern:
    """-min(12 (theta / width)^2, floor) dB: 3 dB down at half the width."""
    angle = np.linspace(0.0, 359.0, 360)
    off = (angle + 180.0) % 360.0 - 180.0
    return make_pattern(f"{width_deg:g} deg beam", angle, -np.minimum(12.0 * (off / width_deg) ** 2, floor_db))


def known_right(pattern: AntennaPattern) -> AntennaPattern:
    """The pattern of the very antenna that hears: here the bound is compared with, not what mismatch adds."""
    return replace(pattern, pointing_sigma_deg=0.0)


def deviation_db(condition: Condition, gain_db: NDArray[np.float64]) -> NDArray[np.float64]:
    """Standard deviation of a reading where the gain (relative to the maximum) is `gain_db`: jitter and noise."""
    if math.isinf(condition.snr_db):
        return np.full(gain_db.shape, condition.jitter_db)
    snr = 10.0 ** ((condition.snr_db + gain_db) / 10.0)
    # mean of n draws of |s + w|^2: variance (2 S N + N^2) / n
    noise = _DB * np.sqrt((2.0 * snr + 1.0) / _AVERAGES) / (snr + 1.0)
    return np.hypot(condition.jitter_db, noise)


def cramer_rao_deg(condition: Condition) -> float:
    """Bound on the bearing's RMS error with unknown level, averaged over bearings between two slices (echo ignored)."""
    pattern = beam(condition.beam_deg)
    heading = np.arange(condition.slices) * 360.0 / condition.slices
    variances: list[float] = []
    for bearing in np.linspace(0.0, 360.0 / condition.slices, 40, endpoint=False):
        gain = pattern.gain_at(bearing - heading)
        slope = (pattern.gain_at(bearing + 0.5 - heading) - pattern.gain_at(bearing - 0.5 - heading)) / 1.0
        share = 1.0
        if not math.isinf(condition.snr_db):
            snr = 10.0 ** ((condition.snr_db + gain) / 10.0)
            share = snr / (snr + 1.0)
        deviation = deviation_db(condition, gain)
        by_bearing, by_level = share * slope / deviation, share * np.ones(gain.size) / deviation
        free = by_bearing - by_level * (by_bearing @ by_level) / (by_level @ by_level)
        variances.append(1.0 / max(float(free @ free), 1e-12))
    return math.sqrt(float(np.mean(variances)))


def simulate(condition: Condition, pattern: AntennaPattern, bearing_deg: float, rng: np.random.Generator) -> Sweep:
    """One sweep of readings at evenly spaced headings from a random first one."""
    heading = (rng.uniform(0.0, 360.0) + np.arange(condition.slices) * 360.0 / condition.slices) % 360.0
    amplitude = 10.0 ** (pattern.gain_at(bearing_deg - heading) / 20.0) + 0j
    if condition.echo_db is not None:
        echo = 10.0 ** (pattern.gain_at(rng.uniform(0.0, 360.0) - heading) / 20.0)
        amplitude = amplitude + 10.0 ** (condition.echo_db / 20.0) * echo * np.exp(2j * math.pi * rng.uniform())
    power = np.maximum(np.abs(amplitude) ** 2, 1e-9)
    noise_db = None
    if not math.isinf(condition.snr_db):
        noise = 10.0 ** (-condition.snr_db / 10.0)
        spread = np.sqrt((2.0 * power * noise + noise**2) / _AVERAGES)
        power = np.maximum(power + noise + spread * rng.normal(size=power.size), 0.05 * noise)
        noise_db = -condition.snr_db
    level = 10.0 * np.log10(power) + condition.jitter_db * rng.normal(size=power.size)
    times = np.arange(condition.slices) * 12.0 / condition.slices
    return Sweep(times, heading, level, 868e6, Place(0.0, 0.0), 0.0, noise_floor_db=noise_db)


@dataclass(frozen=True, slots=True)
class Score:
    """Of the accepted sweeps: rms and bias without outliers (> 30 deg), outliers and rejected in percent, and of
    error / stated sigma the RMS and the share within one and two."""

    rms_deg: float
    bias_deg: float
    outlier_percent: float
    rejected_percent: float
    normalized_rms: float
    within_one: float
    within_two: float


def score(readings: list[BearingReading], truths: list[float]) -> Score:
    """truths: degrees, one a reading. NaN where every accepted reading is an outlier, or none is accepted."""
    pairs = [(r, t) for r, t in zip(readings, truths, strict=True) if r.accepted]
    error = np.array([(r.bearing_deg - t + 180.0) % 360.0 - 180.0 for r, t in pairs])
    sigma = np.array([r.sigma_deg for r, _ in pairs])
    good = np.abs(error) <= OUTLIER_DEG
    inside, normalized = error[good], error[good] / sigma[good]
    if inside.size == 0:
        return Score(math.nan, math.nan, math.nan, 100.0, math.nan, math.nan, math.nan)
    return Score(
        float(np.sqrt(np.mean(inside**2))),
        float(inside.mean()),
        100.0 * float(np.mean(~good)),
        100.0 * (1.0 - len(pairs) / len(readings)),
        float(np.sqrt(np.mean(normalized**2))),
        float(np.mean(np.abs(normalized) < 1.0)),
        float(np.mean(np.abs(normalized) < 2.0)),
    )


FINDERS = {
    "sparse": SparseDirectionFinder,
    "least squares": LeastSquaresDirectionFinder,
    "correlation": CorrelationDirectionFinder,
}


def paired_deg(
    readings: list[BearingReading], others: list[BearingReading], truths: list[float]
) -> tuple[float, float]:
    """(RMS of `readings` minus that of `others`, its standard error) over the sweeps that both accept without outlier.

    The errors are those of the same sweeps: with D_i = e_i^2 - o_i^2, the difference is mean D / (RMS e + RMS o).
    """
    both = [(r, o, t) for r, o, t in zip(readings, others, truths, strict=True) if r.accepted and o.accepted]
    error = np.array([[(x.bearing_deg - t + 180.0) % 360.0 - 180.0 for x in (r, o)] for r, o, t in both])
    square = error[(np.abs(error) <= OUTLIER_DEG).all(axis=1)] ** 2
    scale = float(np.sqrt(square.mean(axis=0)).sum())
    difference = (square[:, 0] - square[:, 1]) / scale
    return float(difference.mean()), float(difference.std(ddof=1) / math.sqrt(len(difference)))


@dataclass(frozen=True, slots=True)
class Compared:
    """paired: `paired_deg` against least squares on the same sweeps."""

    score: Score
    paired: tuple[float, float]


def compare(condition: Condition, sweeps: int, seed: int) -> dict[str, Compared]:
    """The same sweeps through every finder."""
    rng = np.random.default_rng(seed)
    pattern = known_right(beam(condition.beam_deg))
    truths = [float(b) for b in rng.uniform(0.0, 360.0, sweeps)]
    made = [simulate(condition, pattern, truth, rng) for truth in truths]
    readings = {
        name: [finder.estimate(sweep, pattern) for sweep in made]
        for name, finder in ((name, make()) for name, make in FINDERS.items())
    }
    plain = readings["least squares"]
    return {name: Compared(score(ours, truths), paired_deg(ours, plain, truths)) for name, ours in readings.items()}


def reliability(sweeps: int, seed: int) -> list[tuple[float, float, int]]:
    """(mean stated sigma, RMS error, sweeps) in ten classes of stated sigma, over all conditions, echoes included."""
    rng = np.random.default_rng(seed)
    pairs: list[tuple[float, float]] = []
    finder = SparseDirectionFinder()
    for condition in CONDITIONS:
        pattern = known_right(beam(condition.beam_deg))
        for truth in rng.uniform(0.0, 360.0, sweeps):
            reading = finder.estimate(simulate(condition, pattern, float(truth), rng), pattern)
            error = (reading.bearing_deg - truth + 180.0) % 360.0 - 180.0
            if reading.accepted and abs(error) <= OUTLIER_DEG:
                pairs.append((reading.sigma_deg, error))
    table = np.array(sorted(pairs))
    return [
        (float(part[:, 0].mean()), float(np.sqrt(np.mean(part[:, 1] ** 2))), len(part))
        for part in np.array_split(table, 10)
    ]
