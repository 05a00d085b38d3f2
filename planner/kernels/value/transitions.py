"""What one bearing makes of a Gaussian belief: the exact posterior's shape, for every node and draw.

See reference.posterior.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from planner.compiling import SOURCES, allocating, entry, jit
from planner.kernels.value.model import Transitions

REACH = 3.4
"""The belief is cut into cells as far as this many standard deviations."""
ACROSS = 68
"""Cells along the major axis; along the minor one as many a length, but at least FEWEST."""
FEWEST = 23
MEDIAN_STEPS = 4
LIGHT, BEYOND = 1e-7, 16.0
"""Cells of less weight, or with a larger exponent, count for nothing."""

ARCTAN = (
    0.0028662257, -0.0161657367, 0.0429096138, -0.0752896400, 0.1065626393, -0.1420889944, 0.1999355085, -0.3333314528,
    1.0,
)  # fmt: skip
"""Of t^17 to t in arctan t, 0 <= t <= 1, to 2e-8 rad (Abramowitz and Stegun 1964, 4.4.49)."""
HALVINGS = 5
NO_LENGTH = 1e-300
"""Stands for 0 where a cell lies at the sensor itself."""


def _entry_point(sources: int):
    @entry
    def transitions(ratios, nodes, sigma, draws, out: Transitions) -> None:
        """Fill `out` for draws (k, 3): standard normal target place (2) and bearing noise."""
        _ = sources
        for r in range(len(ratios)):
            _of_ratio(r, ratios[r], nodes, sigma, draws, out)

    return transitions


@allocating
def _of_ratio(r, rho, nodes, sigma, draws, out):
    nx, ny = ACROSS + 1, max(FEWEST, int(np.ceil(ACROSS / rho)) + 1)
    hx, hy = 2.0 * REACH / nx, 2.0 * REACH / (rho * ny)
    mass_x, mass_y = np.empty(nx), np.empty(ny)
    for i in range(nx):
        x = -REACH + (i + 0.5) * hx
        mass_x[i] = np.exp(-0.5 * x * x)
    for j in range(ny):
        y = rho * (-REACH / rho + (j + 0.5) * hy)
        mass_y[j] = np.exp(-0.5 * y * y)
    weight, xs, ys = np.empty(nx * ny), np.empty(nx * ny), np.empty(nx * ny)
    for i in range(len(nodes)):
        for j in range(len(nodes)):
            for k in range(len(draws)):
                answer = _posterior(rho, nodes[i], nodes[j], sigma, draws[k], mass_x, mass_y, hx, hy, weight, xs, ys)
                out.shrunk[r, i, j, k] = answer[0]
                out.ratio[r, i, j, k] = answer[1]
                out.u1[r, i, j, k] = answer[2]
                out.u2[r, i, j, k] = answer[3]
                out.spread[r, i, j, k] = answer[4]


@jit
def _posterior(rho, ax, ay, sigma, draw, mass_x, mass_y, hx, hy, weight, xs, ys):
    """log s1', log rho', the platform in the new frame, E |x - median|; s1 = 1, the bearing taken at (ax, ay)."""
    dx, dy = draw[0] - ax, draw[1] / rho - ay
    distance = np.sqrt(dx * dx + dy * dy)
    east, north = (dx / distance, dy / distance) if distance > 0.0 else (1.0, 0.0)
    turn_c, turn_s = np.cos(sigma * draw[2]), np.sin(sigma * draw[2])
    c, s = east * turn_c - north * turn_s, north * turn_c + east * turn_s
    n = _weigh(rho, ax, ay, c, s, sigma, mass_x, mass_y, hx, hy, weight, xs, ys)
    m0 = m1 = m2 = m11 = m12 = m22 = 0.0
    for t in range(n):
        w, x, y = weight[t], xs[t], ys[t]
        m0 += w
        m1 += w * x
        m2 += w * y
        m11 += w * x * x
        m12 += w * x * y
        m22 += w * y * y
    if not m0 > 0.0:
        return 0.0, np.log(rho), ax, ay, 1.0
    m1, m2 = m1 / m0, m2 / m0
    # the spread of a cell is its own; a belief of one cell has it alone
    xx = m11 / m0 - m1 * m1 + hx * hx / 12.0
    xy = m12 / m0 - m1 * m2
    yy = m22 / m0 - m2 * m2 + hy * hy / 12.0
    mean, difference = 0.5 * (xx + yy), 0.5 * (xx - yy)
    spread = np.sqrt(difference * difference + xy * xy)
    s1, s2 = np.sqrt(mean + spread), np.sqrt(max(mean - spread, 1e-12 * mean))
    axis = 0.5 * np.arctan2(xy, difference)
    ca, sa = np.cos(axis), np.sin(axis)
    u1 = abs(ca * (ax - m1) + sa * (ay - m2)) / s1
    u2 = abs(ca * (ay - m2) - sa * (ax - m1)) / s1
    px, py = m1, m2
    for _ in range(MEDIAN_STEPS):  # Weiszfeld
        pull = pull_x = pull_y = 0.0
        for t in range(n):
            d = np.sqrt((xs[t] - px) ** 2 + (ys[t] - py) ** 2)
            w = weight[t] / max(d, 0.1 * hy)
            pull += w
            pull_x += w * xs[t]
            pull_y += w * ys[t]
        px, py = pull_x / pull, pull_y / pull
    total = 0.0
    for t in range(n):
        total += weight[t] * np.sqrt((xs[t] - px) ** 2 + (ys[t] - py) ** 2)
    return np.log(s1), np.log(s1 / s2), u1, u2, total / m0


@jit
def _weigh(rho, ax, ay, c, s, sigma, mass_x, mass_y, hx, hy, weight, xs, ys):
    """The cells that the bearing leaves alive. Returns how many.

    The likelihood is that of a cell's mean: the width of the cell as seen from the sensor adds to the noise.
    """
    n = 0
    steep = np.tan(min(4.5 * sigma, 1.4))
    margin = 1.5 * max(hx, hy)
    south, cells = -REACH / rho, len(mass_y)
    for i in range(len(mass_x)):
        x = -REACH + (i + 0.5) * hx
        dx = x - ax
        # steep along + margin >= |across|, and along >= -margin, with along = c dx + s dy, across = c dy - s dx
        low, high = _narrowed(south - ay, -south - ay, steep * s - c, (steep * c + s) * dx + margin)
        low, high = _narrowed(low, high, steep * s + c, (steep * c - s) * dx + margin)
        low, high = _narrowed(low, high, s, c * dx + margin)
        first = max(int(np.ceil((low + ay - south) / hy - 0.5)), 0)
        count = min(int(np.floor((high + ay - south) / hy - 0.5)) + 1, cells) - first
        if count <= 0:
            continue
        column, likely = weight[n : n + count], mass_y[first : first + count]
        for t in range(count):  # in vectors: no branch, no call
            dy = south + (first + t + 0.5) * hy - ay
            r2 = max(dx * dx + dy * dy, 0.25 * (hx * hx + hy * hy) / 3.0)
            seen = (hx * hx * dy * dy + hy * hy * dx * dx) / (12.0 * r2 * r2)
            variance = sigma * sigma + seen
            error = _angle(c * dx + s * dy, abs(c * dy - s * dx))
            exponent = 0.5 * error * error / variance
            w = mass_x[i] * likely[t] * sigma / np.sqrt(variance) * _falling(min(exponent, BEYOND))
            column[t] = w if exponent <= BEYOND else 0.0
        for t in range(count):
            w = column[t]
            if w > LIGHT:
                weight[n], xs[n], ys[n] = w, x, south + (first + t + 0.5) * hy
                n += 1
    return n


@jit
def _angle(along, across):
    """rad, arctan2(across, along) for across >= 0."""
    beside, ahead = across, abs(along)
    t = min(beside, ahead) / max(max(beside, ahead), NO_LENGTH)
    q = t * t
    angle = 0.0
    for factor in ARCTAN:
        angle = angle * q + factor
    angle *= t
    angle = angle if beside <= ahead else 0.5 * np.pi - angle
    return angle if along >= 0.0 else np.pi - angle


@jit
def _falling(x):
    """exp(-x) for 0 <= x <= BEYOND to 1e-8 of itself: Taylor's series of its 32nd root, squared five times."""
    z, power = -x / 2.0**HALVINGS, 1.0
    for term in range(9, 0, -1):
        power = 1.0 + power * z / term
    for _ in range(HALVINGS):
        power *= power
    return power


@jit
def _narrowed(low, high, slope, offset):
    """The part of low..high where slope dy + offset >= 0."""
    if slope > 0.0:
        return max(low, -offset / slope), high
    if slope < 0.0:
        return low, min(high, -offset / slope)
    return (low, high) if offset >= 0.0 else (high, low)


transitions: Callable[..., None] = _entry_point(SOURCES)
