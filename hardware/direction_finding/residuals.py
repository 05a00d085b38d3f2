"""Residuals that repeat from place to place: what all sweeps of an antenna show, and its measured pattern does not.

Each sweep's binned power minus the pattern at its bearing is put on the antenna's own angle x = bearing - heading, its
level taken out, in cells of 10 degrees. What fading, echoes and noise make differs from place to place and averages
out; what the antenna makes repeats. With sweeps k = 1..n and cells c, residuals z_kc = a_c + w_kc,

    repeats^2 = mean_c ( mean_{k != l} z_kc z_lc )                            an unbiased estimate of mean a_c^2

(one-way random effects; Searle, Casella & McCulloch 1992, ch. 3), judged against what turning each sweep's residuals by
a random angle of its own makes of it, which keeps their size and their correlation and loses what they have in common.
The same of their odd part, (z(x) - z(-x)) / 2: echoes from everywhere fill the side lobes at every place alike and so
repeat a little too, but to both sides; uneven flanks do not.

After the emitter is found the same sweeps, put on the angle from the emitter instead of from their bearings, give a
pattern that includes squint and uneven flanks: see `refined_pattern`.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hardware.direction_finding.antenna import AntennaPattern
from hardware.direction_finding.calibration import true_bearing_deg
from hardware.direction_finding.pattern_file import make_pattern
from hardware.direction_finding.sweep import BIN_DEG, BINS
from hardware.readings import Place

CELL_DEG = 10.0
CELLS = round(360.0 / CELL_DEG)
FEWEST_SWEEPS = 3
LEAST_REPEATING_DB = 1.5
"""As much repeats where echoes fill the side lobes at every place."""
LEAST_UNEVEN_DB = 0.2
"""Flanks of 0.9 and 1.1 make as much; they move a bearing by 4 degrees."""
SHUFFLES = 400
RARELY = 0.01
"""Chance that sweeps which have nothing in common repeat this much."""
NEAREST_M = 30.0
PRIOR_WEIGHT = 1.0
"""The measured pattern counts as much as this number of sweeps where the flight has few."""
_CENTRE_DEG = (np.arange(BINS) + 0.5) * BIN_DEG


@dataclass(frozen=True, slots=True)
class KeptSweep:
    """What a mission keeps of a sweep. binned_db: (180,) dB at antenna headings from true north, NaN: empty bins.

    noise_db: the receiver's floor, where it is known: bins near it show no antenna.
    """

    place: Place
    bearing_deg: float
    binned_db: NDArray[np.float64]
    noise_db: float | None = None


@dataclass(frozen=True, slots=True)
class Repeating:
    """repeats_db: root mean square of what the sweeps have in common. chance: that sweeps without it show as much.

    uneven_db, uneven_chance: the same of the odd part, to one side of the front more than to the other.
    curve_db: (36,) mean residual at 0, 10, .. 350 degrees clockwise from the antenna's front, NaN: nothing heard.
    """

    repeats_db: float
    chance: float
    uneven_db: float
    uneven_chance: float
    sweeps: int
    curve_db: NDArray[np.float64]

    @property
    def significant(self) -> bool:
        """Too much, and too regular, to be the surroundings'."""
        much = self.repeats_db > LEAST_REPEATING_DB and self.chance < RARELY
        return much or (self.uneven_db > LEAST_UNEVEN_DB and self.uneven_chance < RARELY)


def repeating(sweeps: Sequence[KeptSweep], pattern: AntennaPattern, seed: int = 1) -> Repeating | None:
    """What the sweeps deviate from the pattern by alike, whatever their places. None with fewer than three sweeps.

    The same sweeps and seed give the same answer.
    """
    if len(sweeps) < FEWEST_SWEEPS:
        return None
    table = np.array([_by_angle(s, s.bearing_deg, s.binned_db - _expected_db(s, pattern)) for s in sweeps])
    found, uneven = _common_square(table), _common_square(_odd(table))
    rng = np.random.default_rng(seed)
    exceeded = uneven_exceeded = 0
    for _ in range(SHUFFLES):
        by = rng.integers(0, CELLS, len(table))
        turned = np.array([np.roll(row, int(shift)) for row, shift in zip(table, by, strict=True)])
        exceeded += _common_square(turned) >= found
        uneven_exceeded += _common_square(_odd(turned)) >= uneven
    heard = np.isfinite(table)
    with np.errstate(invalid="ignore"):
        curve = np.where(heard, table, 0.0).sum(axis=0) / heard.sum(axis=0)
    return Repeating(
        math.sqrt(max(found, 0.0)),
        (exceeded + 1) / (SHUFFLES + 1),
        math.sqrt(max(uneven, 0.0)),
        (uneven_exceeded + 1) / (SHUFFLES + 1),
        len(sweeps),
        curve,
    )


def _expected_db(sweep: KeptSweep, pattern: AntennaPattern) -> NDArray[np.float64]:
    """By the pattern, at the heading of each bin."""
    return pattern.gain_at(np.asarray(sweep.bearing_deg - _CENTRE_DEG, dtype=np.float64))


def _odd(table: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n, 36) half the difference between a cell and its mirror image; NaN where either was not heard."""
    mirrored = table[:, (-np.arange(CELLS)) % CELLS]
    return 0.5 * (table - mirrored)


def _by_angle(sweep: KeptSweep, bearing_deg: float, value_db: NDArray[np.float64]) -> NDArray[np.float64]:
    """(36,) means of `value_db` about its own mean, at the antenna's angles; NaN where nothing was heard."""
    relative = (bearing_deg - _CENTRE_DEG) % 360.0
    good = np.isfinite(value_db)
    if sweep.noise_db is not None:
        good &= sweep.binned_db > sweep.noise_db + 3.0
    if not good.any():
        return np.full(CELLS, np.nan)
    cell = np.rint(relative[good] / CELL_DEG).astype(np.int64) % CELLS
    count = np.bincount(cell, minlength=CELLS)
    with np.errstate(invalid="ignore"):
        mean = np.bincount(cell, value_db[good] - value_db[good].mean(), CELLS) / count
    return np.where(count > 0, mean, np.nan)


def _common_square(table: NDArray[np.float64]) -> float:
    """mean over cells of the mean product of different sweeps: ((sum z)^2 - sum z^2) / (n (n - 1))."""
    heard = np.isfinite(table)
    z, count = np.where(heard, table, 0.0), heard.sum(axis=0)
    enough = count >= 2
    if not enough.any():
        return 0.0
    pairs = (count * (count - 1))[enough]
    product = (z.sum(axis=0) ** 2 - (z**2).sum(axis=0))[enough]
    return float(np.sum(product) / np.sum(pairs))


def refined_pattern(sweeps: Sequence[KeptSweep], emitter: Place, pattern: AntennaPattern) -> AntennaPattern | None:
    """The pattern that the flight's own sweeps show of an emitter whose place it found; None with too few of them.

    Gain every 10 degrees of (bearing of the emitter - antenna heading), each sweep at its own level, averaged with the
    measured pattern as if that were one more sweep. An antenna that points beside shows as a lobe beside 0, so squint
    and uneven flanks are in it; a compass that was off looks the same and is in it too. Sweeps nearer than 30 m are
    left out. pointing_sigma_deg: how far the sweeps disagree about where the lobe is, over the root of their number.
    """
    rows: list[NDArray[np.float64]] = []
    beside: list[float] = []
    for sweep in sweeps:
        bearing, distance = true_bearing_deg(sweep.place, emitter)
        if distance < NEAREST_M:
            continue
        rows.append(_by_angle(sweep, bearing, sweep.binned_db))
        beside.append((bearing - sweep.bearing_deg + 180.0) % 360.0 - 180.0)
    if len(rows) < FEWEST_SWEEPS:
        return None
    angle: NDArray[np.float64] = CELL_DEG * np.arange(CELLS, dtype=np.float64)
    known = pattern.gain_at(angle)
    table = np.array(rows)
    # each sweep's level is that at which it lies on the measured pattern, over the cells that it heard
    level = np.nanmean(table - known, axis=1)
    heard = np.isfinite(table)
    levelled = np.where(heard, table - level[:, None], 0.0)
    gain = (levelled.sum(axis=0) + PRIOR_WEIGHT * known) / (heard.sum(axis=0) + PRIOR_WEIGHT)
    spread = max(float(np.std(beside, ddof=1)) / math.sqrt(len(beside)), 1.0)
    return make_pattern(
        f"{pattern.name}, refined in flight",
        angle,
        gain - gain.max(),
        pattern.offset_to_nose_deg,
        pattern.frequency_hz,
        pattern.polarization,
        pointing_sigma_deg=min(spread, 90.0),
    )
