"""One bearing: clip, crop, multiply by the likelihood, take the moments. See reference.belief.measure."""

from __future__ import annotations

import numpy as np

from planner.belief.estimate import TIE_BITS
from planner.belief.grid import COARSE_CELLS, FEWEST_CELLS
from planner.compiling import inlined, jit
from planner.kernels.compiled.cells import gather, gather_all
from planner.kernels.compiled.lanes import bits
from planner.kernels.reference.belief import DEEPEST_DOUBLING, NEARLY
from planner.observation import THINNEST

_INDEX_MASK = (1 << TIE_BITS) - 1
_ALIGN = 1e-9


@inlined
def measure(
    weight, offset, low, high, hull, corners, x0, y0, h, nx, ny, doubled, rules, px, py, c, s, half_c, half_s, work, now
):
    """Clip, crop, multiply. Returns the new geometry (x0, y0, h, nx, ny, corners, doubled), the number of live cells,
    the heaviest of them, and the moments m0, ma, mb, maa, mab, mbb in the bearing's frame.
    """
    rx, ry = -(s * half_c - c * half_s), c * half_c + s * half_s
    lx, ly = s * half_c + c * half_s, -(c * half_c - s * half_s)
    target = work.hull[now]
    left = _clip_wedge(hull, corners, px, py, rx, ry, lx, ly, work.chain, target)
    if left > 0:
        x_min, y_min, x_max, y_max = target[0, 0], target[0, 1], target[0, 0], target[0, 1]
        for v in range(1, left):
            x_min, x_max = min(x_min, target[v, 0]), max(x_max, target[v, 0])
            y_min, y_max = min(y_min, target[v, 1]), max(y_max, target[v, 1])
        k = 1 if doubled else 0
        fewest = COARSE_CELLS if rules.blur > 0.0 else FEWEST_CELLS
        while True:
            cell = h / (1 << k)
            i0, i1 = _aligned_range(x_min - x0, x_max - x0, cell, nx << k)
            j0, j1 = _aligned_range(y_min - y0, y_max - y0, cell, ny << k)
            enough = max(i1 - i0, j1 - j0) >= fewest or max(x_max - x_min, y_max - y_min) <= 0.0
            if enough or k >= DEEPEST_DOUBLING:
                break
            k += 1
        cells = gather(
            weight, offset, low, high, x0, y0, cell, k, i0, i1, j0, j1, px, py, c, s, rx, ry, lx, ly, work, now
        )
        if rules.blur > 0.0:
            _weigh_resolved(
                work.weight[now], work.along, work.across, cells, rules.likelihood, rules.edge, NEARLY * cell,
                rules.blur * cell * cell, 2.0 * (THINNEST * cell) ** 2,
            )  # fmt: skip
        else:
            _weigh(work.weight[now], work.along, work.across, cells, rules.likelihood, rules.edge, NEARLY * cell)
        m0, ma, mb, maa, mab, mbb, heaviest = _moments(work.weight[now], work.along, work.across, cells)
        if m0 > 0.0:
            doubled = max(i1 - i0, j1 - j0) < COARSE_CELLS
            x0, y0 = x0 + i0 * cell, y0 + j0 * cell
            return x0, y0, cell, i1 - i0, j1 - j0, left, doubled, cells, heaviest, m0, ma, mb, maa, mab, mbb
    for v in range(corners):
        target[v, 0], target[v, 1] = hull[v, 0], hull[v, 1]
    cells = gather_all(weight, offset, low, high, x0, y0, h, ny, px, py, c, s, work, now)
    m0, ma, mb, maa, mab, mbb, heaviest = _moments(work.weight[now], work.along, work.across, cells)
    return x0, y0, h, nx, ny, corners, doubled, cells, heaviest, m0, ma, mb, maa, mab, mbb


@jit
def _clip_wedge(hull, corners, px, py, rx, ry, lx, ly, between, target):
    """Convex clipping by both sides of the wedge; returns the number of corners left."""
    m = _clip(hull, corners, px, py, rx, ry, between)
    return _clip(between, m, px, py, lx, ly, target)


@jit
def _clip(hull, corners, px, py, nx, ny, target):
    if corners == 0:
        return 0
    m = 0
    x, y = hull[corners - 1, 0], hull[corners - 1, 1]
    depth = (x - px) * nx + (y - py) * ny
    for v in range(corners):
        qx, qy = hull[v, 0], hull[v, 1]
        q_depth = (qx - px) * nx + (qy - py) * ny
        if (depth >= 0.0) != (q_depth >= 0.0):
            part = depth / (depth - q_depth)
            target[m, 0], target[m, 1] = x + part * (qx - x), y + part * (qy - y)
            m += 1
        if q_depth >= 0.0:
            target[m, 0], target[m, 1] = qx, qy
            m += 1
        x, y, depth = qx, qy, q_depth
    return m


@jit
def _aligned_range(low, high, h, n):
    first = min(max(int(np.floor(low / h + _ALIGN)), 0), n - 1)
    return first, min(max(int(np.ceil(high / h - _ALIGN)), first + 1), n)


@jit
def _weigh(weight, along, across, cells, likelihood, edge, ahead):
    """Multiply the likelihood L = p(sin^2 e)^8 in; beyond 4 sigma and less than `ahead` m ahead that of the edge."""
    p0, p1, p2, p3, p4, p5 = likelihood[0], likelihood[1], likelihood[2], likelihood[3], likelihood[4], likelihood[5]
    for i in range(cells):
        a, b = along[i], across[i]
        b2 = b * b
        sin2 = b2 / (a * a + b2)
        sin2 = sin2 if a > ahead else 1.0
        u = sin2 if sin2 < edge else edge
        u2 = u * u
        root = (p0 + u * p1) + u2 * ((p2 + u * p3) + u2 * (p4 + u * p5))
        root = root * root
        root = root * root
        weight[i] *= root * root


@jit
def _weigh_resolved(weight, along, across, cells, likelihood, edge, ahead, resolved, nearest):
    """The same as far as cells can show it, see reference.belief. resolved: m^2 from which on they do."""
    p0, p1, p2, p3, p4, p5 = likelihood[0], likelihood[1], likelihood[2], likelihood[3], likelihood[4], likelihood[5]
    for i in range(cells):
        a, b = along[i], across[i]
        b2 = b * b
        r2 = a * a + b2
        far2 = r2 if r2 > nearest else nearest
        share = far2 / resolved
        share = share if share < 1.0 else 1.0
        sin2 = b2 / r2
        sin2 = sin2 if a > ahead else 1.0
        u = sin2 * share
        u = u if u < edge else edge
        u2 = u * u
        root = (p0 + u * p1) + u2 * ((p2 + u * p3) + u2 * (p4 + u * p5))
        root = root * root
        root = root * root
        weight[i] *= root * root * np.sqrt(share)


@jit
def _moments(weight, along, across, cells):
    """Moments m0, ma, mb, maa, mab, mbb and the index of the heaviest cell, the first of equal ones."""
    m0 = ma = mb = maa = mab = mbb = 0.0
    top = np.int64(0)
    for i in range(cells):
        a, b, w = along[i], across[i], weight[i]
        wa, wb = w * a, w * b
        m0 += w
        ma += wa
        mb += wb
        maa += wa * a
        mab += wa * b
        mbb += wb * b
        key = (bits(w) & ~_INDEX_MASK) | (_INDEX_MASK - i)
        top = key if key > top else top
    return m0, ma, mb, maa, mab, mbb, _INDEX_MASK - (top & _INDEX_MASK)
