"""Value iteration over the transitions: V = min over nodes of the flight there and what a bearing there leaves.

See reference.sweep.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from planner.compiling import SOURCES, allocating, entry, jit
from planner.kernels.value.model import NEAR, NODE_STEP, RATIO_STEP, SCALE_STEP, Transitions
from planner.types import FloatArray

CHI_95 = 2.4477468306808166
"""sqrt of the 95 % quantile of chi square, two degrees of freedom: semi-axes of the 95 % ellipse over deviations."""


@jit
def travel(distance, full, speed, constant, acceleration):
    """Seconds to fly so far; see planner.motion."""
    if not full:
        return distance / speed + constant
    if distance >= speed * speed / acceleration:
        return distance / speed + speed / acceleration + constant
    return 2.0 * np.sqrt(distance / acceleration) + constant


@jit
def node_position(u, nodes):
    """Where u >= 0 lies between the nodes: index, share of the next, and how far beyond the last."""
    beyond = max(u - nodes[-1], 0.0)
    at = np.log1p(min(u, nodes[-1]) / NEAR) / NODE_STEP
    k = min(int(at), len(nodes) - 2)
    return k, min(at - k, 1.0), beyond


def _entry_point(sources: int):
    @entry
    def iterate(
        t: Transitions, scales, ratios, nodes, unit, measurement_time, full, speed, constant, acceleration, standoff,
        sweeps, tolerance,
    ):  # fmt: skip
        """(RATIOS, NODES, NODES, SCALES) s after a bearing at the node; and the last sweep's largest change, s."""
        _ = sources
        return _iterate(
            t, scales, ratios, nodes, unit, measurement_time, full, speed, constant, acceleration, standoff, sweeps,
            tolerance,
        )  # fmt: skip

    return iterate


@allocating
def _iterate(
    t, scales, ratios, nodes, unit, measurement_time, full, speed, constant, acceleration, standoff, sweeps, tolerance
):
    nr, nn, ns = len(ratios), len(nodes), len(scales)
    value = np.zeros((nr, nn, nn, ns))
    after = np.zeros((nr, nn, nn, ns))
    clearance = np.empty((nr, nn, nn))
    for r in range(nr):
        for i in range(nn):
            for j in range(nn):
                clearance[r, i, j] = _clearance(nodes[i], nodes[j], ratios[r])
    row = np.empty(ns)
    change = np.inf
    for _ in range(sweeps):
        for r in range(nr):
            for i in range(nn):
                for j in range(nn):
                    _back_up(t, r, i, j, value, after, scales, ratios, nodes, unit, measurement_time, speed)
        change = 0.0
        for r in range(nr):
            for i in range(nn):
                for j in range(nn):
                    for k in range(ns):
                        row[k] = np.inf
                    for a in range(nn):
                        for b in range(nn):
                            far = np.sqrt((nodes[a] - nodes[i]) ** 2 + (nodes[b] - nodes[j]) ** 2)
                            for k in range(ns):
                                if clearance[r, a, b] * scales[k] * unit >= standoff or (a == nn - 1 and b == nn - 1):
                                    cost = travel(far * scales[k] * unit, full, speed, constant, acceleration)
                                    row[k] = min(row[k], cost + after[r, a, b, k])
                    for k in range(ns):
                        change = max(change, abs(row[k] - value[r, i, j, k]))
                        value[r, i, j, k] = row[k]
        if change < tolerance:
            break
    return after, value, change


@jit
def _back_up(t, r, i, j, value, after, scales, ratios, nodes, unit, measurement_time, speed):
    """after = t_m + mean over draws not yet localized of V(s1', rho', u')."""
    ns, draws = len(scales), t.shrunk.shape[3]
    total = after[r, i, j]
    for k in range(ns):
        total[k] = 0.0
    for d in range(draws):
        smallest = 1.0 / t.spread[r, i, j, d]  # not localized from s1 / threshold >= this on
        first = max(0, int(np.ceil(np.log(smallest / scales[0]) / SCALE_STEP)))
        if first >= ns:
            continue
        shift = t.shrunk[r, i, j, d] / SCALE_STEP
        whole = int(np.floor(shift))
        share = shift - whole
        at = min(max(t.ratio[r, i, j, d] / RATIO_STEP, 0.0), len(ratios) - 1.000001)
        ri = int(at)
        rf = at - ri
        i1, f1, b1 = node_position(t.u1[r, i, j, d], nodes)
        i2, f2, b2 = node_position(t.u2[r, i, j, d], nodes)
        beyond = np.sqrt(b1 * b1 + b2 * b2) * np.exp(t.shrunk[r, i, j, d]) * unit / speed
        for corner in range(8):
            a, b, c = corner & 1, (corner >> 1) & 1, corner >> 2
            w = (rf if a else 1.0 - rf) * (f1 if b else 1.0 - f1) * (f2 if c else 1.0 - f2)
            v = value[ri + a, i1 + b, i2 + c]
            for k in range(first, ns):
                low = min(max(k + whole, 0), ns - 1)
                high = min(max(k + whole + 1, 0), ns - 1)
                total[k] += w * ((1.0 - share) * v[low] + share * v[high])
        for k in range(first, ns):
            total[k] += beyond * scales[k]
    for k in range(ns):
        total[k] = measurement_time + total[k] / draws


@jit
def _clearance(u1, u2, rho):
    """Distance of (u1, u2) >= 0 to the 95 % ellipse of N(0, diag(1, 1 / rho^2)), 0 inside."""
    a, b = CHI_95, CHI_95 / rho
    if (u1 / a) ** 2 + (u2 / b) ** 2 <= 1.0:
        return 0.0
    nearest = np.inf
    for step in range(91):
        angle = 0.5 * np.pi * step / 90
        nearest = min(nearest, (a * np.cos(angle) - u1) ** 2 + (b * np.sin(angle) - u2) ** 2)
    return np.sqrt(nearest)


iterate: Callable[..., tuple[FloatArray, FloatArray, float]] = _entry_point(SOURCES)
