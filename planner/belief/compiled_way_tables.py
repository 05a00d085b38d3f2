# pyright: standard
"""What one stretch of way says, tabulated once over where an emitter may lie as seen from its middle.

From the middle the emitter lies at r e, e a unit vector in direction phi; reading i, d_i from the middle, sees it at
r (e - d_i / r). Let w = e / r: it says by which angles the readings' directions differ from phi, and by which factors
their distances differ from r. A bias b turns all directions alike, so that a table over w and psi = phi + b holds f / c
of planner.on_the_way for every place and every node of the bias.

It changes slowly with w: across the stretch by its parallax, along it by distances alone.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from random import Random

import numpy as np
from numpy.typing import NDArray

from planner.belief.compiled_rows import summed
from planner.belief.source_errors import EVEN_STEP, LARGEST_BIAS
from planner.compiling import SOURCES, entry
from planner.on_the_way import DIRECTIONS, FREEDOM, Stretch, heard
from planner.threads import in_parts

ACROSS, ALONG = 13, 7
"""Nodes of w to either side of the stretch, and along it."""
NEAREST = 1.0 / 36.0
"""1 / m, the largest w. Nobody is judged nearer than NEAR_M to the way, and the middle lies on it."""
TURN = round(2.0 * np.pi / EVEN_STEP)
"""Columns once around."""
PHASES = DIRECTIONS // TURN
"""Directions of the antenna's table from column to column."""
COLUMNS = TURN + int(2.0 * LARGEST_BIAS / EVEN_STEP) + 8
"""Once around, and again as far as the nodes of the bias reach."""
SUMS = 4
"""Of weights, weighted residuals, their squares, and logarithms of variances."""
LEAST_SQUARE = 1e-6
"""Of r as a reading has it, over r: an emitter may lie on a reading that is far from the middle."""
MOST_LOG = 30.0
"""Far more than readings of a craft say, and no more than the products of many stretches bear."""
KEPT = 250
"""Tables, of half a megabyte each: every belief of a mission looks up the same ones."""
THREADS = 2

Table = NDArray[np.float32]
"""(ACROSS, ALONG, s, COLUMNS) f / c for each scale, psi = EVEN_STEP * (column - 1)."""


_kept: dict[tuple[Stretch, tuple[float, ...]], Table] = {}
_chance = Random(1)


@dataclass(frozen=True, slots=True)
class Middle:
    """Of a stretch. x, y: m ENU. along: (2,) unit vector, where it is longest. reach: m, to the farthest reading."""

    x: float
    y: float
    along: tuple[float, float]
    reach: float


def middle_of(stretch: Stretch) -> Middle:
    """The readings' mean place, and the principal axis of their places."""
    x, y = np.array(stretch.x), np.array(stretch.y)
    off = np.array([x - x.mean(), y - y.mean()])
    angle = 0.5 * math.atan2(2.0 * float(off[0] @ off[1]), float(off[0] @ off[0] - off[1] @ off[1]))
    return Middle(float(x.mean()), float(y.mean()), (math.cos(angle), math.sin(angle)), float(np.hypot(*off).max()))


def table_of(stretch: Stretch, scale: tuple[float, ...]) -> Table:
    """Of a stretch that tells something; made once while KEPT suffice.

    Beyond that any of them goes, by chance: beliefs ask for all of theirs in turn, and where the one that was asked for
    longest ago goes, one too many leaves none to be found.
    """
    found = _kept.get((stretch, scale))
    if found is None:
        found = _tabulated(stretch, scale)
        if len(_kept) >= KEPT:
            _kept.pop(_chance.choice([*_kept]), None)
        _kept[stretch, scale] = found
    return found


def _tabulated(stretch: Stretch, scale: tuple[float, ...]) -> Table:
    found = np.empty((ACROSS, ALONG, len(scale), COLUMNS), dtype=np.float32)
    known, middle = heard([stretch], np.array(scale)), middle_of(stretch)
    off = np.array([known.x - middle.x, known.y - middle.y])
    around = np.arange(PHASES * (COLUMNS + TURN)) % DIRECTIONS
    weight, gain = known.weight[0, around], known.gain[0, around]
    told = np.array([weight, gain * weight, gain**2 * weight, known.log_variance[0, around]])
    by_phase = np.ascontiguousarray(told.reshape(SUMS, -1, PHASES).transpose(2, 0, 1))

    def work(part: slice) -> None:
        _tabulate(found[part], part.start, off, middle.along, known, np.array(scale), by_phase)

    in_parts(ACROSS, THREADS, work)
    return found


def _entry_point(sources: int):
    """sources: what is compiled in, as a number. numba tells cached functions apart by what they close over."""

    @entry
    def tabulate(table, first, off, along, known, scale, by_phase):
        """table: of the rows across from `first` on. off: (2, n) m, of the readings. by_phase: (PHASES, SUMS, m) 1 / v,
        G / v, G^2 / v and log v, [p, :, j] in direction PHASES j + p of the antenna's table."""
        _ = sources
        worth, readings = known.worth[0], off.shape[1] - 1
        sums = np.empty((SUMS, COLUMNS))
        for a in range(table.shape[0]):
            for b in range(ALONG):
                across_w = NEAREST * (2.0 * (first + a) / (ACROSS - 1) - 1.0)
                along_w = NEAREST * (2.0 * b / (ALONG - 1) - 1.0)
                w_x = along[0] * along_w - along[1] * across_w
                w_y = along[1] * along_w + along[0] * across_w
                length = np.sqrt(w_x * w_x + w_y * w_y)
                e_x, e_y = (w_x / length, w_y / length) if length > 0.0 else (1.0, 0.0)
                sums[:] = 0.0
                for i in range(off.shape[1]):
                    # the emitter from reading i, where phi is 0 and r is 1
                    ahead = 1.0 - length * (e_x * off[0, i] + e_y * off[1, i])
                    aside = -length * (e_x * off[1, i] - e_y * off[0, i])
                    rest = (
                        known.power[i]
                        - known.power[0]
                        + 10.0 * np.log10(max(ahead * ahead + aside * aside, LEAST_SQUARE))
                    )
                    turns = (np.arctan2(aside, ahead) - known.front[i] - EVEN_STEP) / (2.0 * np.pi)
                    step = int((turns - np.floor(turns)) * DIRECTIONS + 0.5) % DIRECTIONS
                    told = by_phase[step % PHASES, :, step // PHASES : step // PHASES + COLUMNS]
                    summed(told[0], told[1], told[2], told[3], rest, sums)
                for n in range(COLUMNS):
                    whole = sums[0, n]
                    square = max(sums[2, n] - sums[1, n] * sums[1, n] / whole, 0.0)
                    spread = worth * square / (readings * FREEDOM)
                    volume = 0.5 * worth / readings * (sums[3, n] + np.log(whole))
                    for s in range(len(scale)):
                        fit = 0.5 * (FREEDOM + worth) * np.log(1.0 + spread / (scale[s] * scale[s]))
                        table[a, b, s, n] = np.exp(min(-fit - volume - known.log_mean[0, s], MOST_LOG))

    return tabulate


_tabulate = _entry_point(SOURCES)
