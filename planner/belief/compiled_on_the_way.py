# pyright: standard
"""The fast twin of planner.on_the_way: what stretches of way say of one cell, for all biases of a source at once.

The nodes of the bias are equally spaced, so the readings' directions in the antenna's table go on by the same step from
node to node: tables in just these steps hold side by side what the nodes ask for. Bearings may ask for nodes far closer
than a beam of tens of degrees does: a stretch, never sharper than a bearing, is weighed at every few of them, and its
logarithm is linear between. With sigma 7 degrees and nodes 2 degrees apart that is good to 2^2 / (8 7^2), a hundredth
a stretch; what the stretches of a mission add up to is in docs/truth.md.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from planner.belief.compiled_rows import mixed, summed
from planner.compiling import jit
from planner.on_the_way import DIRECTIONS, FREEDOM, NEAR_M, Heard, variance_of
from planner.types import FloatArray

PHASES = 8
"""Steps of the tables from node to node: directions are good to half of one, an eighth of a degree."""
FINE_ENOUGH = np.deg2rad(2.0)
RESCALED_EVERY = 16
"""Stretches: none multiplies by less than the rate of outliers, or by more than a bearing's peak."""
LEAST_LOG = -200.0
"""Of a root, so that none is 0, by which the next would be divided."""
SUMS = 4
"""Of weights, weighted residuals, their squares, and logarithms of variances."""


@jit
def stride_of(spacing):
    """How many nodes of the bias lie in one step at which stretches are weighed."""
    return max(1, int(FINE_ENOUGH / spacing))


@jit
def coarse_nodes(count, spacing):
    """How many of these steps hold `count` nodes, and one beyond."""
    return (count - 1) // stride_of(spacing) + 2


class OnTheWay(NamedTuple):
    """heard: the stretches. fine: rad, from one direction of the table to the next. table: (k, PHASES, 4, m) 1 / v,
    G / v, G^2 / v and log v of each stretch, [:, p, :, i] in the direction of PHASES i + p such steps, once around and
    on as far as the bias reaches."""

    heard: Heard
    fine: float
    table: FloatArray


def on_the_way(known: Heard, count: int, spacing: float) -> OnTheWay:
    """For `count` nodes of the bias, `spacing` rad apart."""
    fine = stride_of(spacing) * spacing / PHASES
    columns = int(2.0 * np.pi / fine / PHASES) + 2 + coarse_nodes(count, spacing)
    turns = np.arange(PHASES * columns) * fine / (2.0 * np.pi)
    table = np.empty((len(known.worth), PHASES, 4, columns))
    for k, tabulated in enumerate(known.gain):
        gain = np.interp(turns, np.arange(DIRECTIONS) / DIRECTIONS, tabulated, period=1.0)
        variance = variance_of(gain)
        for j, told in enumerate((1.0 / variance, gain / variance, gain**2 / variance, np.log(variance))):
            table[k, :, j] = told.reshape(columns, PHASES).T
    return OnTheWay(known, fine, table)


@jit
def _near(x, y, heard, k):
    for i in range(heard.first[k], heard.first[k + 1]):
        if (x - heard.x[i]) ** 2 + (y - heard.y[i]) ** 2 < NEAR_M * NEAR_M:
            return True
    return False


@jit
def _summed(x, y, way, k, bias, sums):
    """sums (SUMS, n) of the readings of stretch k at the coarse nodes, for the emitter at (x, y)."""
    sums[:] = 0.0
    heard, count = way.heard, sums.shape[1]
    offset = heard.power[heard.first[k]]
    for i in range(heard.first[k], heard.first[k + 1]):
        off_x, off_y = x - heard.x[i], y - heard.y[i]
        rest = heard.power[i] - offset + 10.0 * np.log10(off_x * off_x + off_y * off_y)
        turns = (np.arctan2(off_y, off_x) - heard.front[i] + bias[0]) / (2.0 * np.pi)
        step = int((turns - np.floor(turns)) * (2.0 * np.pi) / way.fine + 0.5)
        at, told = step // PHASES, way.table[k, step % PHASES]
        here = told[:, at : at + count]
        summed(here[0], here[1], here[2], here[3], rest, sums)


@jit
def _rescaled(table):
    """Divides by the largest of the table, and returns its logarithm."""
    top = 0.0
    for r in range(table.shape[0]):
        for b in range(table.shape[1]):
            top = max(top, table[r, b])
    if top <= 0.0:
        return 0.0
    for r in range(table.shape[0]):
        for b in range(table.shape[1]):
            table[r, b] /= top
    return np.log(top)


@jit
def _between(root, stride, ratio):
    """ratio (b,) at every node, its logarithm linear between the coarse ones, where `root` is its stride-th root."""
    for n in range(len(root) - 1):
        step, found = root[n + 1] / root[n], root[n] ** stride
        for b in range(n * stride, min((n + 1) * stride, len(ratio))):
            ratio[b] = found
            found *= step


@jit
def weigh_stretches(x, y, way, bias, spacing, scale, rate, sums, ratio, table):
    """Multiplies (1 - e) f / c + e of every stretch into table (k e, b), for the emitter at (x, y), but for a factor
    whose logarithm is returned: hundreds of stretches leave the range of numbers. sums: (SUMS, n) scratch, n of
    `coarse_nodes`. ratio: (b,) scratch."""
    heard, rates, stride, weighed, log = way.heard, len(rate), stride_of(spacing), 0, 0.0
    for k in range(len(heard.worth)):
        if _near(x, y, heard, k):
            continue
        _summed(x, y, way, k, bias, sums)
        worth, readings = heard.worth[k], heard.first[k + 1] - heard.first[k] - 1
        for n in range(sums.shape[1]):
            whole = sums[0, n]
            square = max(sums[2, n] - sums[1, n] * sums[1, n] / whole, 0.0)
            sums[0, n] = worth * square / (readings * FREEDOM)
            sums[1, n] = 0.5 * worth / readings * (sums[3, n] + np.log(whole))
        for s in range(len(scale)):
            for n in range(sums.shape[1]):
                fit = np.log(1.0 + sums[0, n] / (scale[s] * scale[s]))
                of_ratio = -0.5 * (FREEDOM + worth) * fit - sums[1, n] - heard.log_mean[k, s]
                sums[2, n] = np.exp(max(of_ratio / stride, LEAST_LOG))
            _between(sums[2], stride, ratio)
            for e in range(rates):
                mixed(table[s * rates + e], ratio, 1.0 - rate[e], rate[e])
        weighed += 1
        if weighed % RESCALED_EVERY == 0:
            log += _rescaled(table)
    return log
