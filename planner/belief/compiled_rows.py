# pyright: standard
"""Loops over a row (b,) of nodes in place: the compiler makes vector instructions of them.

They are calls of their own so that it knows of each argument that it is one row: no other array overlaps it, and no
index is negative.
"""

from __future__ import annotations

import numpy as np

from planner.compiling import in_order, jit

SMALLEST = 1e-37
"""Of a ratio: the smallest number of 32 bits, about."""
LEAST = 1e-300
"""Of what is divided by: the smallest number of 64 bits, about. Whole rows may be far below a ratio's."""


@jit
def interpolated(density, lower, upper, below, above):
    """Two rows of a table, weighed, onto the nodes that they are cut to.

    An index that might be negative would keep the loop from becoming vectors.
    """
    for b in range(len(density)):
        density[b] += below * lower[b] + above * upper[b]


@jit
def weighed(row, density, odds):
    """A row times what a bearing says at each node, relative to an outlier's density."""
    for b in range(len(density)):
        row[b] *= 1.0 + odds * density[b]


@jit
def weighed_at_once(row, lower, upper, below, above):
    """The same of one peak, its two rows of the table already times the odds."""
    for b in range(len(row)):
        row[b] *= 1.0 + (below * lower[b] + above * upper[b])


@jit
def mixed(row, ratio, share, rest):
    """A row times what a stretch says at each node, relative to an outlier's density."""
    for b in range(len(row)):
        row[b] *= share * ratio[b] + rest


@in_order
def blended(row, first, second, third, of_first, of_second, of_third):
    """Three rows of a table, weighed."""
    for b in range(len(row)):
        row[b] = of_first * first[b] + of_second * second[b] + of_third * third[b]


@in_order
def blended_more(row, first, second, third, of_first, of_second, of_third):
    """The same, added to what the row holds."""
    for b in range(len(row)):
        row[b] += of_first * first[b] + of_second * second[b] + of_third * third[b]


@in_order
def shifted(found, row, of_first, of_second, of_third):
    """Each three neighbours of a row (n + 2,), weighed, where that is not negative."""
    for n in range(len(found)):
        found[n] = max(of_first * row[n] + of_second * row[n + 1] + of_third * row[n + 2], np.float32(0.0))


@in_order
def ratios(found, row):
    """Each entry of a row (n + 1,), none of them negative, over the one before."""
    for b in range(len(found)):
        found[b] = min(max(row[b + 1] / max(row[b], LEAST), SMALLEST), 1.0 / SMALLEST)


@in_order
def rooted(row):
    """The square root of each entry."""
    for b in range(len(row)):
        row[b] = np.sqrt(row[b])


@jit
def by_twos(row, coarse, root):
    """A row (b,) times coarse (n,) at every second entry, and times the root (n - 1,) of its ratios between."""
    whole = len(row) // 2
    for n in range(whole):
        first = coarse[n]
        row[2 * n] *= first
        row[2 * n + 1] *= first * np.float64(root[n])
    if 2 * whole < len(row):
        row[2 * whole] *= coarse[whole]


@jit
def by_fours(row, coarse, root):
    """The same at every fourth, root: the fourth one."""
    whole = len(row) // 4
    for n in range(whole):
        first, step = coarse[n], np.float64(root[n])
        row[4 * n] *= first
        row[4 * n + 1] *= first * step
        row[4 * n + 2] *= first * (step * step)
        row[4 * n + 3] *= first * (step * step * step)
    for left in range(len(row) - 4 * whole):
        row[4 * whole + left] *= coarse[whole] * np.float64(root[whole]) ** left


@jit
def times_each(row, other):
    """Entry by entry of `row`."""
    for b in range(len(row)):
        row[b] *= other[b]


@jit
def summed(weight, first, second, log_variance, rest, sums):
    """To sums (4, n): of one reading, its weight, weighted residual, its square, and logarithm of its variance, where
    the residual is rest - G. first, second: of the weight times G, and times its square."""
    whole, residuals, squares, volume = sums[0], sums[1], sums[2], sums[3]
    for n in range(len(weight)):
        along = rest * weight[n]
        whole[n] += weight[n]
        residuals[n] += along - first[n]
        squares[n] += rest * (along - 2.0 * first[n]) + second[n]
        volume[n] += log_variance[n]


@jit
def copied(row, from_row):
    """Into `row`."""
    for b in range(len(row)):
        row[b] = from_row[b]


@jit
def times(row, factor):
    """Each entry of it."""
    for b in range(len(row)):
        row[b] *= factor


@jit
def largest(row):
    """Of entries that are not negative; 0 of none."""
    top = 0.0
    for b in range(len(row)):
        top = max(top, row[b])
    return top


@jit
def total(row):
    """The sum of its entries."""
    found = 0.0
    for b in range(len(row)):
        found += row[b]
    return found


@jit
def dot(row, other):
    """The sum of the products of their entries."""
    found = 0.0
    for b in range(len(row)):
        found += row[b] * other[b]
    return found


@jit
def added(found, row, apart, weight):
    """To `found`: weight times by how much `row` differs from `apart`."""
    for b in range(len(row)):
        found[b] += weight * (row[b] - apart)


@jit
def added_beside(found, row, prior, apart, weight):
    """To `found`: weight times by how much `row` differs from its prior times `apart`."""
    for b in range(len(row)):
        found[b] += weight * (row[b] - apart * prior[b])
