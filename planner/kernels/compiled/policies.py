"""The base policies that a rollout follows: where to measure next."""

from __future__ import annotations

import numpy as np

from planner.compiling import inlined, jit
from planner.kernels.compiled.confidence import clear, confidence_hull, distance_to_hull
from planner.kernels.reference.belief import NEARLY


@jit
def ellipse_action(ex, ey, xx, xy, yy, px, py, ratios, distances):
    """See reference.policy.ellipse_action."""
    mean, difference = 0.5 * (xx + yy), 0.5 * (xx - yy)
    spread = np.hypot(difference, xy)
    minor = 0.5 * np.pi
    if spread > NEARLY * mean:
        minor += 0.5 * np.arctan2(xy, difference)
    s1 = np.sqrt(mean + spread)
    s2 = max(np.sqrt(max(mean - spread, 0.0)), 1e-6 * s1)
    ratio = s1 / s2
    k = min(max(np.searchsorted(ratios, ratio) - 1, 0), len(ratios) - 2)
    slope = (distances[k + 1] - distances[k]) / (ratios[k + 1] - ratios[k])
    r = s2 * (distances[k] + slope * (ratio - ratios[k]))
    dx, dy = r * np.cos(minor), r * np.sin(minor)
    if (px - ex) * dx + (py - ey) * dy < -NEARLY * (dx * dx + dy * dy):
        dx, dy = -dx, -dy
    return ex + dx, ey + dy, -1


@inlined
def fisher_action(ex, ey, xx, xy, yy, rules, work, now, cells, heaviest, m0, x0, y0, h, nx, ny):
    """See reference.policy.fisher_action. Places are held against C95 only as far as the answer needs it."""
    fixed = len(rules.places) > 0
    left, bottom, step_x, step_y = _action_grid(rules, x0, y0, h, nx, ny)
    n = len(rules.places) if fixed else rules.grid_x * rules.grid_y
    gain = work.gain
    if fixed:
        for k in range(n):
            gain[k] = _gain(ex - rules.places[k, 0], ey - rules.places[k, 1], xx, xy, yy, h)
    else:
        for row in range(rules.grid_y):
            y = ey - (bottom + (row + 0.5) * step_y)
            some = gain[row * rules.grid_x : (row + 1) * rules.grid_x]
            for column in range(rules.grid_x):
                some[column] = _gain(ex - (left + (work.ramp[column] + 0.5) * step_x), y, xx, xy, yy, h)
    corners, needed = 0, -1.0
    if rules.standoff > 0.0:
        corners = confidence_hull(work, now, cells, heaviest, m0, x0, y0, h, ny)
        needed = affordable_standoff(rules, fixed, n, left, bottom, step_x, step_y, work.chain, corners)
    outside = distance_to_hull(work.chain, corners, ex, ey) if corners > 0 else 0.0
    best, best_gain = 0, -np.inf
    for k in range(n):
        if gain[k] > best_gain:
            qx, qy = _place(rules, fixed, k, left, bottom, step_x, step_y)
            if corners == 0 or clear(
                work.chain, corners, qx, qy, needed, np.sqrt((qx - ex) ** 2 + (qy - ey) ** 2) + outside
            ):
                best, best_gain = k, gain[k]
    for k in range(best):
        if gain[k] >= best_gain * (1.0 - NEARLY):
            qx, qy = _place(rules, fixed, k, left, bottom, step_x, step_y)
            if corners == 0 or clear(work.chain, corners, qx, qy, needed, np.inf):
                best = k
                break
    qx, qy = _place(rules, fixed, best, left, bottom, step_x, step_y)
    return qx, qy, best if fixed else -1


@jit
def _gain(x, y, xx, xy, yy, nearest):
    r2 = max(x * x + y * y, nearest * nearest)
    return (xx * y * y - 2.0 * xy * x * y + yy * x * x) / (r2 * r2)


@inlined
def affordable_standoff(rules, fixed, n, left, bottom, step_x, step_y, hull, corners):
    """r_min, or what it shrinks to so that two places are left (6.1)."""
    first = second = -1.0
    for k in range(n):
        qx, qy = _place(rules, fixed, k, left, bottom, step_x, step_y)
        clearance = distance_to_hull(hull, corners, qx, qy)
        if clearance > first:
            first, second = clearance, first
        elif clearance > second:
            second = clearance
        if second >= rules.standoff:
            break
    return min(rules.standoff, second if n > 1 else first) - NEARLY * rules.standoff


@inlined
def _action_grid(rules, x0, y0, h, nx, ny):
    """South-west corner and cell sizes of the action grid; see reference.policy.grid_places."""
    width, height = nx * h, ny * h
    left, right = max(x0 - width, rules.window[0]), min(x0 + 2.0 * width, rules.window[2])
    bottom, top = max(y0 - height, rules.window[1]), min(y0 + 2.0 * height, rules.window[3])
    if left >= right or bottom >= top:
        left, bottom, right, top = rules.window[0], rules.window[1], rules.window[2], rules.window[3]
    return left, bottom, (right - left) / rules.grid_x, (top - bottom) / rules.grid_y


@inlined
def _place(rules, fixed, k, left, bottom, step_x, step_y):
    if fixed:
        return rules.places[k, 0], rules.places[k, 1]
    return left + (k % rules.grid_x + 0.5) * step_x, bottom + (k // rules.grid_x + 0.5) * step_y
