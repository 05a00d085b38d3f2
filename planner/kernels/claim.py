"""How often a claim follows the next bearing from each of many places, and what it leaves of the tail: readable and
compiled.

`claim_chances_reference` is the specification in numpy, `claim_chances` its compiled twin.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from planner.compiling import entry
from planner.types import FloatArray, IntArray


class BiasedCells(NamedTuple):
    """A belief over places and, given the place, over the bias that the next bearing has in common with those before.

    x, y: (c,) m. mass: (c,), sums to 1. bias: (c,) rad, its mean. variance: (c,) rad^2, of the bias, and of the next
    bearing's own error. blur: (c,) m^2, variance of a place within the cell along each axis.
    """

    x: FloatArray
    y: FloatArray
    mass: FloatArray
    bias: FloatArray
    variance: FloatArray
    blur: FloatArray


class Draws(NamedTuple):
    """The bearings to come: (k,) the cell that each comes from, and its error in standard deviations."""

    cell: IntArray
    noise: FloatArray


class Claims(NamedTuple):
    """Of n places. chance: (n,) that the rule is met after the bearing. tail: (n,) expected logarithm of the mass that
    is still too far then, not counted below what the rule allows."""

    chance: FloatArray
    tail: FloatArray


class ClaimRule(NamedTuple):
    """threshold: m, of the expected error. far: times the threshold. beyond: the most mass that may be so far."""

    threshold: float
    far: float
    beyond: float


def claim_chances_reference(
    cells: BiasedCells, places: FloatArray, draws: Draws, rate: float, rule: ClaimRule
) -> Claims:
    """Of the places (n, 2), m: share of the draws after which the rule is met, times that of honest bearings.

    p(z | x) = (1 - rate) N(z; dir(x) + bias(x), v(x)) + rate / (2 pi),  v(x) = variance(x) + blur(x) / r^2.
    """
    found = Claims(np.empty(len(places)), np.empty(len(places)))
    for index, place in enumerate(places):
        dx, dy = cells.x - place[0], cells.y - place[1]
        towards = np.arctan2(dy, dx) + cells.bias
        variance = cells.variance + cells.blur / np.maximum(dx**2 + dy**2, np.maximum(cells.blur, 1e-6))
        z = towards[draws.cell] + np.sqrt(variance[draws.cell]) * draws.noise
        error = (z[:, None] - towards + np.pi) % (2.0 * np.pi) - np.pi
        honest = (1.0 - rate) * np.exp(-0.5 * error**2 / variance) / np.sqrt(2.0 * np.pi * variance)
        after = cells.mass * (honest + rate / (2.0 * np.pi))
        after /= after.sum(axis=1, keepdims=True)
        x, y = after @ cells.x, after @ cells.y
        off = np.hypot(cells.x - x[:, None], cells.y - y[:, None])
        expected = (after * off).sum(axis=1)
        beyond = (after * (off > rule.far * rule.threshold)).sum(axis=1)
        found.chance[index] = (1.0 - rate) * ((expected < rule.threshold) & (beyond <= rule.beyond)).mean()
        found.tail[index] = np.log(np.maximum(beyond, rule.beyond)).mean()
    return found


@entry
def claim_chances(cells: BiasedCells, places: FloatArray, draws: Draws, rate: float, rule: ClaimRule) -> Claims:
    """See claim_chances_reference."""
    count, drawn = len(cells.x), len(draws.cell)
    towards, sd, peak, after, off = np.empty((5, count))
    chance, tail = np.empty(len(places)), np.empty(len(places))
    for p in range(len(places)):
        for c in range(count):
            dx, dy = cells.x[c] - places[p, 0], cells.y[c] - places[p, 1]
            towards[c] = math.atan2(dy, dx) + cells.bias[c]
            near = max(dx * dx + dy * dy, cells.blur[c], 1e-6)
            sd[c] = math.sqrt(cells.variance[c] + cells.blur[c] / near)
            peak[c] = (1.0 - rate) / (math.sqrt(2.0 * math.pi) * sd[c])
        met, left = 0, 0.0
        for d in range(drawn):
            z = towards[draws.cell[d]] + sd[draws.cell[d]] * draws.noise[d]
            whole = x = y = 0.0
            for c in range(count):
                error = z - towards[c]
                error -= 2.0 * math.pi * math.floor(error / (2.0 * math.pi) + 0.5)
                error /= sd[c]
                after[c] = cells.mass[c] * (peak[c] * math.exp(-0.5 * error * error) + rate / (2.0 * math.pi))
                whole += after[c]
                x += after[c] * cells.x[c]
                y += after[c] * cells.y[c]
            x /= whole
            y /= whole
            expected = 0.0
            for c in range(count):
                off[c] = math.sqrt((cells.x[c] - x) ** 2 + (cells.y[c] - y) ** 2)
                expected += after[c] * off[c]
            expected /= whole
            beyond = 0.0
            for c in range(count):
                if off[c] > rule.far * rule.threshold:
                    beyond += after[c]
            met += expected < rule.threshold and beyond <= rule.beyond * whole
            left += math.log(max(beyond / whole, rule.beyond))
        chance[p] = (1.0 - rate) * met / drawn
        tail[p] = left / drawn
    return Claims(chance, tail)
