# pyright: standard
"""One place of the compiled evidence: the table of nodes weighed by every bearing, as far as any of them reaches.

Products are taken instead of sums of logarithms, and brought back into range every few bearings.
"""

from __future__ import annotations

import numpy as np

from planner.belief.compiled_on_the_way import scratch_of, weigh_stretches
from planner.belief.compiled_rows import copied, interpolated, largest, times, total, weighed, weighed_at_once
from planner.belief.compiled_tables import RESCALED_EVERY, STEPS
from planner.compiling import allocating, inlined, jit


@jit
def _rescaled(table, low, high, apart, shares):
    """Each row times its rate's share, then all over the largest entry; returns its logarithm."""
    top = 0.0
    for r in range(table.shape[0]):
        share = shares[r % len(shares)]
        apart[r] *= share
        times(table[r, low:high], share)
        top = max(top, apart[r], largest(table[r, low:high]))
    for r in range(table.shape[0]):
        apart[r] /= top
        times(table[r, low:high], 1.0 / top)
    return np.log(top)


@jit
def _past(x, y, seen, i, j, first, spacing):
    """By how many nodes peak j of bearing i lies past the first one, for the emitter at (x, y)."""
    error = seen.angle[j] - np.arctan2(y - seen.y[i], x - seen.x[i])
    error -= 2.0 * np.pi * np.floor(error / (2.0 * np.pi) + 0.5)
    return (error - first) / spacing


@jit
def _last(seen, i):
    """One past the last of bearing i's peaks that count: a profile was tabulated about the first and holds them all."""
    return seen.first[i] + 1 if seen.whole[i] >= 0 else seen.first[i + 1]


@inlined
def reached(x, y, known, past):
    """First and past-last node that any bearing reaches, for the emitter at (x, y); past (p,) of each peak is set."""
    seen, count = known.seen, len(known.bias)
    low, high = count, 0
    for i in range(len(seen.x)):
        reach = 0
        for k in range(known.reach.shape[1]):
            reach = max(reach, known.reach[i, k])
        for j in range(seen.first[i], _last(seen, i)):
            past[j] = _past(x, y, seen, i, j, known.bias[0], known.spacing)
            node = int(np.floor(past[j]))
            if node + reach + 2 > 0 and node - reach < count:
                low, high = min(low, max(0, node - reach)), max(high, min(count, node + reach + 2))
    if len(known.on_way.x) > 0:
        return 0, count
    return (low, high) if low < high else (0, 0)


@inlined
def _one_peak(known, i, past, share, table):
    count, rates = table.shape[1], known.odds.shape[2]
    node = int(np.floor(past))
    fine = (past - node) * STEPS
    f = int(fine)
    above = share * (fine - f)
    for k in range(known.odds.shape[1]):
        reach = known.reach[i, k]
        left, right = max(0, node - reach), min(count, node + reach + 2)
        if left >= right:
            continue
        start, stop = left - node + reach, right - node + reach
        lower = known.table[known.table_of[i], k, f, start:stop]
        upper = known.table[known.table_of[i], k, f + 1, start:stop]
        for e in range(rates):
            odds = known.odds[i, k, e]
            weighed_at_once(table[k * rates + e, left:right], lower, upper, odds * (share - above), odds * above)


@inlined
def _several_peaks(known, i, past, table, density):
    seen, count, rates = known.seen, table.shape[1], known.odds.shape[2]
    begin, end = seen.first[i], seen.first[i + 1]
    low, high = past[begin], past[begin]
    for j in range(begin + 1, end):
        low, high = min(low, past[j]), max(high, past[j])
    for k in range(known.odds.shape[1]):
        reach = known.reach[i, k]
        least, most = max(0, int(np.floor(low)) - reach), min(count, int(np.floor(high)) + reach + 2)
        if least >= most:
            continue
        density[least:most] = 0.0
        for j in range(begin, end):
            node = int(np.floor(past[j]))
            fine = (past[j] - node) * STEPS
            f = int(fine)
            above = seen.weight[j] * (fine - f)
            left, right = max(0, node - reach), min(count, node + reach + 2)
            if left < right:
                start, stop = left - node + reach, right - node + reach
                lower = known.table[known.table_of[i], k, f, start:stop]
                upper = known.table[known.table_of[i], k, f + 1, start:stop]
                interpolated(density[left:right], lower, upper, seen.weight[j] - above, above)
        for e in range(rates):
            weighed(table[k * rates + e, least:most], density[least:most], known.odds[i, k, e])


@inlined
def of_cell(x, y, known, past, low, high, apart, table, density, way):
    """Weighs nodes low to high of table (k e, b) by all bearings and stretches, for the emitter at (x, y), as far as
    `reached` finds: all others have their prior times apart (k e,). Returns the logarithm taken out of both.

    A bearing's factor is taken relative to an outlier's, 1 + odds p(error), so that nodes beyond its reach keep theirs.
    """
    seen, log = known.seen, known.outliers
    apart[:] = 1.0
    for r in range(table.shape[0]):
        copied(table[r, low:high], known.prior[r, low:high])
    for i in range(len(seen.x)):
        first = seen.first[i]
        if _last(seen, i) - first == 1:
            _one_peak(known, i, past[first], 1.0 if seen.whole[i] >= 0 else seen.weight[first], table)
        else:
            _several_peaks(known, i, past, table, density)
        if i % RESCALED_EVERY == RESCALED_EVERY - 1:
            log += _rescaled(table, low, high, apart, known.shares[0])
    rates = len(known.rate)
    for r in range(table.shape[0]):
        share = known.shares[1, r % rates]
        apart[r] *= share
        times(table[r, low:high], share)
    if len(known.on_way.x) > 0:
        apart[:] = 0.0
        log += weigh_stretches(x, y, known.on_way, known.bias, known.spacing, known.rate, way, table)
    return log


@inlined
def whole_of(known, low, high, apart, table):
    """The sum over all nodes."""
    whole = 0.0
    for r in range(table.shape[0]):
        within_reach = known.before[r, high] - known.before[r, low]
        whole += apart[r] * (known.before[r, known.before.shape[1] - 1] - within_reach) + total(table[r, low:high])
    return whole


@allocating
def scratch(known):
    """past, apart, table, density and way as `of_cell` takes them."""
    return (
        np.empty(len(known.seen.angle)),
        np.empty(len(known.prior)),
        np.empty_like(known.prior),
        np.empty(len(known.bias)),
        scratch_of(len(known.bias), known.spacing, len(known.scale), len(known.rate)),
    )
