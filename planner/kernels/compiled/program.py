"""The Gaussian dynamic program's choice inside a rollout. See reference.policy.program_action."""

from __future__ import annotations

import numpy as np

from planner.compiling import inlined, jit
from planner.kernels.compiled.confidence import clear, confidence_hull
from planner.kernels.compiled.policies import affordable_standoff
from planner.kernels.model import FULL
from planner.kernels.reference.belief import NEARLY
from planner.kernels.value.lookup import ROUND
from planner.kernels.value.model import NEAR, NODE_STEP, RATIO_STEP, SCALE_STEP, SMALLEST_SCALE


@inlined
def program_action(ex, ey, xx, xy, yy, px, py, lattice, rules, work, now, cells, heaviest, m0, x0, y0, h, nx, ny):
    """x, y, index in the lattice, and the seconds that remain from there on, its bearing's included."""
    mean, difference = 0.5 * (xx + yy), 0.5 * (xx - yy)
    spread = np.hypot(difference, xy)
    c, s = 1.0, 0.0
    if spread > ROUND * mean:
        axis = 0.5 * np.arctan2(xy, difference)
        c, s = np.cos(axis), np.sin(axis)
    s1 = np.sqrt(mean + spread)
    s2 = max(np.sqrt(max(mean - spread, 0.0)), 1e-6 * s1)
    nodes, n = rules.nodes, len(rules.nodes)
    after, costs = work.gain[: n * n], work.gain[n * n :]
    _blend(rules.after, s1 / rules.threshold, s1 / s2, after)
    if len(rules.places) > 0:
        best = _best_of_lattice(
            ex, ey, c, s, s1, px, py, lattice, rules, work, now, cells, heaviest, m0, x0, y0, h, ny, after, costs
        )
        qx, qy = rules.places[best, 0], rules.places[best, 1]
        return qx, qy, best, _after_at(after, nodes, ex, ey, c, s, s1, qx, qy)
    dx, dy = px - ex, py - ey
    u1, u2 = (c * dx + s * dy) / s1, (c * dy - s * dx) / s1
    side1, side2 = 1.0 if u1 >= -NEARLY else -1.0, 1.0 if u2 >= -NEARLY else -1.0
    for i in range(n):
        far1 = side1 * nodes[i] - u1
        for j in range(n):
            far2 = side2 * nodes[j] - u2
            costs[i * n + j] = _time(rules, s1 * np.sqrt(far1 * far1 + far2 * far2)) + after[i * n + j]
    stay = _after_at(after, nodes, ex, ey, c, s, s1, px, py)
    costs[n * n] = _time(rules, 0.0) + stay
    best = _first_least(costs, n * n + 1)
    if best == n * n:
        qx, qy, left = px, py, stay
    else:
        qx, qy = _place(ex, ey, c, s, s1, side1 * nodes[best // n], side2 * nodes[best % n])
        left = after[best]
    if _inside(rules.window, qx, qy):
        return qx, qy, -1, left
    any_inside = False
    for k in range(4 * n * n):
        ax, ay = _node_around(ex, ey, c, s, s1, nodes, n, k)
        costs[k] = np.inf
        if _inside(rules.window, ax, ay):
            any_inside = True
            costs[k] = _time(rules, np.sqrt((ax - px) ** 2 + (ay - py) ** 2)) + after[k % (n * n)]
    if any_inside:
        best = _first_least(costs, 4 * n * n)
        ax, ay = _node_around(ex, ey, c, s, s1, nodes, n, best)
        return ax, ay, -1, after[best % (n * n)]
    return (
        min(max(qx, rules.window[0]), rules.window[2]),
        min(max(qy, rules.window[1]), rules.window[3]),
        -1,
        left,
    )


@inlined
def _best_of_lattice(
    ex, ey, c, s, s1, px, py, lattice, rules, work, now, cells, heaviest, m0, x0, y0, h, ny, after, costs
):
    n = len(rules.places)
    corners, needed = 0, -1.0
    if rules.standoff > 0.0:
        corners = confidence_hull(work, now, cells, heaviest, m0, x0, y0, h, ny)
        needed = affordable_standoff(rules, True, n, 0.0, 0.0, 0.0, 0.0, work.chain, corners)
    ways = lattice >= 0 and len(rules.travel) > 0
    soonest = _least(after)
    best, least = 0, np.inf
    for k in range(n):
        qx, qy = rules.places[k, 0], rules.places[k, 1]
        distance = rules.travel[lattice, k] if ways else np.sqrt((qx - px) ** 2 + (qy - py) ** 2)
        flown = _time(rules, distance)
        costs[k] = np.inf
        if flown + soonest > least * (1.0 + NEARLY):
            continue
        costs[k] = flown + _after_at(after, rules.nodes, ex, ey, c, s, s1, qx, qy)
        if costs[k] < least and (corners == 0 or clear(work.chain, corners, qx, qy, needed, np.inf)):
            best, least = k, costs[k]
    for k in range(best):
        if costs[k] <= least * (1.0 + NEARLY):
            qx, qy = rules.places[k, 0], rules.places[k, 1]
            if corners == 0 or clear(work.chain, corners, qx, qy, needed, np.inf):
                return k
    return best


@jit
def _least(costs):
    least = np.inf
    for k in range(len(costs)):
        least = min(least, costs[k])
    return least


@jit
def _first_least(costs, n):
    least = _least(costs[:n])
    for k in range(n):
        if costs[k] <= least * (1.0 + NEARLY):
            return k
    return 0


@inlined
def _time(rules, distance):
    """Without a turn: which way the vehicle looks on arrival is left out of the choice."""
    if rules.motion != FULL:
        return distance / rules.speed + rules.constant
    if distance >= rules.speed * rules.speed / rules.acceleration:
        return distance / rules.speed + rules.speed / rules.acceleration + rules.constant
    return 2.0 * np.sqrt(distance / rules.acceleration) + rules.constant


@jit
def _blend(table, scale, ratio, after):
    """See lookup.blended."""
    k, f = _between(np.log(scale / SMALLEST_SCALE) / SCALE_STEP, table.shape[0])
    r, g = _between(np.log(ratio) / RATIO_STEP, table.shape[1])
    w00, w01, w10, w11 = (1.0 - f) * (1.0 - g), (1.0 - f) * g, f * (1.0 - g), f * g
    a, b, c, d = table[k, r], table[k, r + 1], table[k + 1, r], table[k + 1, r + 1]
    for i in range(table.shape[2]):
        after[i] = w00 * a[i] + w01 * b[i] + w10 * c[i] + w11 * d[i]


@jit
def _between(at, count):
    at = min(max(at, 0.0), count - 1.0)
    k = min(int(at), count - 2)
    return k, at - k


@jit
def _after_at(after, nodes, ex, ey, c, s, s1, x, y):
    """See lookup.after_at."""
    n = len(nodes)
    dx, dy = x - ex, y - ey
    i, f = _between_nodes(abs(c * dx + s * dy) / s1, nodes)
    j, g = _between_nodes(abs(c * dy - s * dx) / s1, nodes)
    low = (1.0 - g) * after[i * n + j] + g * after[i * n + j + 1]
    high = (1.0 - g) * after[(i + 1) * n + j] + g * after[(i + 1) * n + j + 1]
    return (1.0 - f) * low + f * high


@jit
def _between_nodes(u, nodes):
    at = np.log(1.0 + min(u, nodes[-1]) / NEAR) / NODE_STEP
    k = min(int(at), len(nodes) - 2)
    return k, at - k


@jit
def _place(ex, ey, c, s, s1, u1, u2):
    a, b = s1 * u1, s1 * u2
    return ex + c * a - s * b, ey + s * a + c * b


@jit
def _node_around(ex, ey, c, s, s1, nodes, n, k):
    """Node k of those in all quadrants: (+, +), (+, -), (-, +), (-, -)."""
    quadrant, node = k // (n * n), k % (n * n)
    u1, u2 = nodes[node // n], nodes[node % n]
    return _place(ex, ey, c, s, s1, u1 if quadrant < 2 else -u1, u2 if quadrant % 2 == 0 else -u2)


@jit
def _inside(window, x, y):
    return window[0] <= x <= window[2] and window[1] <= y <= window[3]
