"""The fast twin of reference.py: the same rollouts with the same signature, compiled by numba, without the GIL.

What makes it fast (measured in docs/kernel.md): the grid is cropped before the likelihood is evaluated; of each row
only the columns that the widened wedge touches are gathered, into flat arrays with coordinates along and across the
bearing; one long loop then needs neither atan2 nor exp (sin^2 of the error, a polynomial, four squarings) and takes
the moments on the way; the heaviest cell is a maximum over the floats' integer view with the index in the low bits;
the expected RMSE is only summed when its bounds do not decide. Doubling the grid costs nothing: the next gather reads
each parent twice. Nothing is allocated inside a rollout.

One file, because numba's cache looks at the file of the compiled function only: a change in another would go unseen.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from llvmlite import ir
from numba import njit, types
from numba.extending import intrinsic
from numpy.typing import NDArray

from planner.belief.estimate import TIE_BITS
from planner.belief.grid import COARSE_CELLS, FEWEST_CELLS
from planner.kernels.model import (
    ELLIPSE,
    EXPECTED_VALUE,
    FULL,
    GEOMETRIC_MEDIAN,
    Actions,
    Outcomes,
    Paths,
    Rules,
    Start,
    Tasks,
)
from planner.kernels.reference import (
    CONFIDENCE,
    DEEPEST_DOUBLING,
    HISTOGRAM_BINS,
    HISTOGRAM_SHIFT,
    MEDIAN_STEPS,
    NEARLY,
)
from planner.observation import WEDGE_SIGMAS
from planner.types import FloatArray

_jit = njit(cache=True, nogil=True, error_model="numpy", fastmath={"reassoc", "contract", "arcp", "nsz"})
_INDEX_MASK = (1 << TIE_BITS) - 1
_BLOCK = 128
_ALIGN = 1e-9


class _Workspace(NamedTuple):
    """Scratch of one call. weight: (2, n), used in turn, as are offset, low, high: (2, r) and hull: (2, v, 2).

    along, across: (n,) m, cell centres in the bearing's frame. histogram: (b,). gain, clearance: (l,) of the places.
    chain: (4 r, 2) corners of the 95 % cells' rows.
    """

    weight: FloatArray
    along: FloatArray
    across: FloatArray
    offset: NDArray[np.int64]
    low: NDArray[np.int64]
    high: NDArray[np.int64]
    hull: FloatArray
    histogram: FloatArray
    gain: FloatArray
    clearance: FloatArray
    chain: FloatArray


@intrinsic
def _bits(typingctx, value):
    """The 64 bits of a float as an integer; for floats >= 0 both are ordered alike."""

    def codegen(context, builder, signature, arguments):
        return builder.bitcast(arguments[0], ir.IntType(64))

    return types.int64(types.float64), codegen


@_jit
def rollouts(start: Start, rules: Rules, actions: Actions, paths: Paths, tasks: Tasks, out: Outcomes) -> None:
    """Run every task and fill `out`; see reference.rollouts."""
    ny, nx = start.density.shape
    rows = max(ny, 2 * COARSE_CELLS)
    cells = max(ny * nx, 4 * COARSE_CELLS * COARSE_CELLS)
    places = max(len(rules.places), rules.grid_x * rules.grid_y)
    work = _Workspace(
        np.empty((2, cells)),
        np.empty(cells),
        np.empty(cells),
        np.empty((2, rows), np.int64),
        np.empty((2, rows), np.int64),
        np.empty((2, rows), np.int64),
        np.empty((2, len(start.hull) + 2 * rules.horizon + 2, 2)),
        np.empty(HISTOGRAM_BINS),
        np.empty(places),
        np.empty(places),
        np.empty((4 * rows + 4, 2)),
    )
    offset = start.low + nx * np.arange(ny)
    density = start.density.reshape(-1)
    for t in range(len(tasks.action)):
        _rollout(start, rules, actions, paths, tasks.action[t], tasks.path[t], density, offset, work, out, t)


@_jit
def _rollout(start, rules, actions, paths, action, path, density, offset, work, out, t):
    tx, ty = paths.targets[path, 0], paths.targets[path, 1]
    px, py = actions.places[action, 0], actions.places[action, 1]
    heading, lattice, cost = actions.headings[action], actions.lattice[action], actions.costs[action]
    x0, y0, h, corners, doubled = start.x0, start.y0, start.h, len(start.hull), False
    ny, nx = start.density.shape
    now, bearings, localized = 1, start.bearings, False
    ex = ey = xx = xy = yy = 0.0
    step = 0
    while True:
        direction = np.arctan2(ty - py, tx - px) + paths.noise[path, step]
        c, s = np.cos(direction), np.sin(direction)
        before, now = now, 1 - now
        if step == 0:
            x0, y0, h, nx, ny, corners, doubled, cells, heaviest, m0, ma, mb, maa, mab, mbb = _measure(
                density, offset, start.low, start.high, start.hull, corners,
                x0, y0, h, nx, ny, doubled, rules, px, py, c, s, work, now,
            )  # fmt: skip
        else:
            x0, y0, h, nx, ny, corners, doubled, cells, heaviest, m0, ma, mb, maa, mab, mbb = _measure(
                work.weight[before], work.offset[before], work.low[before], work.high[before], work.hull[before],
                corners, x0, y0, h, nx, ny, doubled, rules, px, py, c, s, work, now,
            )  # fmt: skip
        bearings += 1
        weight, along, across = work.weight[now], work.along, work.across
        if rules.estimator == GEOMETRIC_MEDIAN:
            ea, eb = _median(weight, along, across, cells, ma / m0, mb / m0, 1e-3 * h)
        elif rules.estimator == EXPECTED_VALUE or (start.flat and bearings <= 1):
            ea, eb = ma / m0, mb / m0
        else:
            ea, eb = along[heaviest], across[heaviest]
        vaa = (maa - 2.0 * ea * ma) / m0 + ea * ea  # (3.34), about the estimate, in the bearing's frame
        vab = (mab - ea * mb - eb * ma) / m0 + ea * eb
        vbb = (mbb - 2.0 * eb * mb) / m0 + eb * eb
        localized = _localized(weight, along, across, cells, ea, eb, vaa + vbb, m0, rules.threshold, h * (nx + ny))
        ex, ey = px + c * ea - s * eb, py + s * ea + c * eb
        xx = c * c * vaa - 2.0 * c * s * vab + s * s * vbb
        xy = c * s * (vaa - vbb) + (c * c - s * s) * vab
        yy = s * s * vaa + 2.0 * c * s * vab + c * c * vbb
        step += 1
        if localized or step == rules.horizon:
            break
        if rules.policy == ELLIPSE:
            qx, qy, following = _ellipse(ex, ey, xx, xy, yy, px, py, rules.ratios, rules.distances)
        else:
            qx, qy, following = _fisher(ex, ey, xx, xy, yy, rules, work, now, cells, heaviest, m0, x0, y0, h, nx, ny)
        distance = np.hypot(qx - px, qy - py)
        if lattice >= 0 and following >= 0 and len(rules.travel) > 0:
            distance = rules.travel[lattice, following]
        towards = np.arctan2(qy - py, qx - px) if distance > 0.0 else heading
        cost += _flight_time(rules, distance, towards - heading) + rules.measurement_time  # (4.5)
        px, py, heading, lattice = qx, qy, towards, following
    out.costs[t] = cost
    out.bearings[t] = step
    expected_rmse = rules.threshold
    if not localized:
        expected_rmse = _distance_sum(work.weight[now], work.along, work.across, 0, cells, ea, eb) / m0
    end = out.ends[t]
    end[0], end[1], end[2], end[3], end[4], end[5], end[6] = px, py, ex, ey, xx, xy, yy
    end[7], end[8], end[9] = expected_rmse, bearings, 1.0 if localized else 0.0


@_jit
def _measure(weight, offset, low, high, hull, corners, x0, y0, h, nx, ny, doubled, rules, px, py, c, s, work, now):
    """Clip, crop, multiply. Returns the new geometry (x0, y0, h, nx, ny, corners, doubled), the number of live cells,
    the heaviest of them, and the moments m0, ma, mb, maa, mab, mbb in the bearing's frame.
    """
    half_c, half_s = np.cos(WEDGE_SIGMAS * rules.sigma), np.sin(WEDGE_SIGMAS * rules.sigma)
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
        while True:
            cell = h / (1 << k)
            i0, i1 = _aligned_range(x_min - x0, x_max - x0, cell, nx << k)
            j0, j1 = _aligned_range(y_min - y0, y_max - y0, cell, ny << k)
            enough = max(i1 - i0, j1 - j0) >= FEWEST_CELLS or max(x_max - x_min, y_max - y_min) <= 0.0
            if enough or k >= DEEPEST_DOUBLING:
                break
            k += 1
        cells = _gather(
            weight, offset, low, high, x0, y0, cell, k, i0, i1, j0, j1, px, py, c, s, rx, ry, lx, ly, work, now
        )
        m0, ma, mb, maa, mab, mbb, heaviest = _weigh(
            work.weight[now], work.along, work.across, cells, rules.likelihood, rules.edge
        )
        if m0 > 0.0:
            doubled = max(i1 - i0, j1 - j0) < COARSE_CELLS
            x0, y0 = x0 + i0 * cell, y0 + j0 * cell
            return x0, y0, cell, i1 - i0, j1 - j0, left, doubled, cells, heaviest, m0, ma, mb, maa, mab, mbb
    target[:corners] = hull[:corners]
    cells = _copy(weight, offset, low, high, x0, y0, h, ny, px, py, c, s, work, now)
    m0, ma, mb, maa, mab, mbb, heaviest = _moments(work.weight[now], work.along, work.across, cells)
    return x0, y0, h, nx, ny, corners, doubled, cells, heaviest, m0, ma, mb, maa, mab, mbb


@_jit
def _clip_wedge(hull, corners, px, py, rx, ry, lx, ly, between, target):
    """Convex clipping by both sides of the wedge; returns the number of corners left."""
    m = _clip(hull, corners, px, py, rx, ry, between)
    return _clip(between, m, px, py, lx, ly, target)


@_jit
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


@_jit
def _aligned_range(low, high, h, n):
    first = min(max(int(np.floor(low / h + _ALIGN)), 0), n - 1)
    return first, min(max(int(np.ceil(high / h - _ALIGN)), first + 1), n)


@_jit
def _gather(weight, offset, low, high, x0, y0, h, k, i0, i1, j0, j1, px, py, c, s, rx, ry, lx, ly, work, now):
    """Copy the live cells of rows j0..j1, columns i0..i1 that the widened wedge touches; h and the indices are those of
    the grid doubled k times. Returns how many.
    """
    target, along, across = work.weight[now], work.along, work.across
    new_offset, new_low, new_high = work.offset[now], work.low[now], work.high[now]
    left = x0 + i0 * h - px
    margin = -h / np.sqrt(2.0)
    width = i1 - i0
    step_a, step_b = c * h, -s * h
    n = 0
    for j in range(j0, j1):
        row = j >> k
        dy = y0 + j0 * h + (j - j0 + 0.5) * h - py
        a, b = _narrowed(0, width, rx, margin - ry * dy, left, h)
        a, b = _narrowed(a, b, lx, margin - ly * dy, left, h)
        a, b = _narrowed(a, b, c, margin - s * dy, left, h)
        a = max(a, (low[row] << k) - i0)
        b = min(b, (high[row] << k) - i0)
        count = max(b - a, 0)
        new_offset[j - j0], new_low[j - j0], new_high[j - j0] = n, a, a + count
        if count == 0:
            continue
        dx = left + (a + 0.5) * h
        a0, b0 = c * dx + s * dy, c * dy - s * dx
        row_a, row_b, row_w = along[n : n + count], across[n : n + count], target[n : n + count]
        for i in range(count):
            row_a[i] = a0 + step_a * i
            row_b[i] = b0 + step_b * i
        first = offset[row] - low[row]
        if k == 0:
            source = weight[first + a + i0 : first + a + i0 + count]
            for i in range(count):
                row_w[i] = source[i]
        else:
            for i in range(count):
                row_w[i] = weight[first + ((a + i + i0) >> k)]
        n += count
    return n


@_jit
def _narrowed(a, b, normal, reach, left, h):
    """Columns a..b whose centre has normal * dx >= reach, dx = left + (i + 0.5) h."""
    if normal > NEARLY:
        edge = np.ceil((reach / normal - left) / h - 0.5 - NEARLY)
        return (max(a, int(edge)), b) if edge < b else (b, b)
    if normal < -NEARLY:
        edge = np.floor((reach / normal - left) / h - 0.5 + NEARLY) + 1.0
        return (a, min(b, int(edge))) if edge > a else (a, a)
    return (a, b) if reach <= NEARLY * h else (a, a)


@_jit
def _copy(weight, offset, low, high, x0, y0, h, ny, px, py, c, s, work, now):
    """All live cells as they are, in the frame of a bearing that changed nothing. Returns how many."""
    target, along, across = work.weight[now], work.along, work.across
    n = 0
    for j in range(ny):
        dy = y0 + (j + 0.5) * h - py
        work.offset[now, j], work.low[now, j], work.high[now, j] = n, low[j], high[j]
        for i in range(low[j], high[j]):
            dx = x0 + (i + 0.5) * h - px
            along[n], across[n] = c * dx + s * dy, c * dy - s * dx
            target[n] = weight[offset[j] + i - low[j]]
            n += 1
    return n


@_jit
def _weigh(weight, along, across, cells, likelihood, edge):
    """Multiply the likelihood in; moments m0, ma, mb, maa, mab, mbb and the index of the heaviest cell."""
    p0, p1, p2, p3 = likelihood[0], likelihood[1], likelihood[2], likelihood[3]
    p4, p5, p6 = likelihood[4], likelihood[5], likelihood[6]
    m0 = ma = mb = maa = mab = mbb = 0.0
    top = np.int64(0)
    w_, a_, b_ = weight[:cells], along[:cells], across[:cells]
    for i in range(cells):
        a, b = a_[i], b_[i]
        b2 = b * b
        sin2 = b2 / (a * a + b2)
        sin2 = sin2 if a > 0.0 else 1.0
        u = sin2 if sin2 < edge else edge
        root = p0 + u * (p1 + u * (p2 + u * (p3 + u * (p4 + u * (p5 + u * p6)))))
        root = root * root
        root = root * root
        root = root * root
        w = w_[i] * (root * root)
        w_[i] = w
        wa, wb = w * a, w * b
        m0 += w
        ma += wa
        mb += wb
        maa += wa * a
        mab += wa * b
        mbb += wb * b
        key = (_bits(w) & ~_INDEX_MASK) | (_INDEX_MASK - i)
        top = key if key > top else top
    return m0, ma, mb, maa, mab, mbb, _INDEX_MASK - (top & _INDEX_MASK)


@_jit
def _moments(weight, along, across, cells):
    """As `_weigh` without a likelihood."""
    m0 = ma = mb = maa = mab = mbb = 0.0
    top = np.int64(0)
    for i in range(cells):
        a, b, w = along[i], across[i], weight[i]
        m0 += w
        ma += w * a
        mb += w * b
        maa += w * a * a
        mab += w * a * b
        mbb += w * b * b
        top = max(top, (_bits(w) & ~_INDEX_MASK) | (_INDEX_MASK - i))
    return m0, ma, mb, maa, mab, mbb, _INDEX_MASK - (top & _INDEX_MASK)


@_jit
def _median(weight, along, across, cells, ea, eb, tolerance):
    """Weiszfeld's iteration for the geometric median, from the mean."""
    for _ in range(MEDIAN_STEPS):
        pull = pull_a = pull_b = 0.0
        for i in range(cells):
            a, b = along[i], across[i]
            w = weight[i] / max(np.sqrt((a - ea) * (a - ea) + (b - eb) * (b - eb)), tolerance)
            pull += w
            pull_a += w * a
            pull_b += w * b
        ea, eb = pull_a / pull, pull_b / pull
    return ea, eb


@_jit
def _localized(weight, along, across, cells, ea, eb, second_moment, m0, threshold, reach):
    """Whether the expected RMSE about (ea, eb) is below the threshold (4.11).

    E d <= sqrt(E d^2) and E d >= E d^2 / reach (no cell is farther) often decide; else the sum is taken until it does.
    """
    if second_moment < threshold * threshold * (1.0 - NEARLY):
        return True
    if second_moment >= threshold * reach:
        return False
    total, limit = 0.0, threshold * m0
    for first in range(0, cells, _BLOCK):
        total += _distance_sum(weight, along, across, first, min(first + _BLOCK, cells), ea, eb)
        if total >= limit:
            return False
    return True


@_jit
def _distance_sum(weight, along, across, first, last, ea, eb):
    total = 0.0
    w, a, b = weight[first:last], along[first:last], across[first:last]
    for i in range(last - first):
        da, db = a[i] - ea, b[i] - eb
        total += w[i] * np.sqrt(da * da + db * db)
    return total


@_jit
def _ellipse(ex, ey, xx, xy, yy, px, py, ratios, distances):
    """See reference.ellipse_action."""
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


@_jit
def _fisher(ex, ey, xx, xy, yy, rules, work, now, cells, heaviest, m0, x0, y0, h, nx, ny):
    """See reference.fisher_action. Distances to C95 are only measured for places that would win otherwise."""
    fixed = len(rules.places) > 0
    left, bottom, step_x, step_y = _action_grid(rules, x0, y0, h, nx, ny)
    n = len(rules.places) if fixed else rules.grid_x * rules.grid_y
    constrained = rules.standoff > 0.0
    corners, around = 0, 0.0
    if constrained:
        corners = _confidence_hull(work, now, cells, heaviest, m0, x0, y0, h, ny)
        for v in range(corners):
            around = max(around, np.hypot(work.chain[v, 0] - ex, work.chain[v, 1] - ey))
    gain, clearance = work.gain, work.clearance
    surely_clear = 0
    for k in range(n):
        qx, qy = _place(rules, fixed, k, left, bottom, step_x, step_y)
        x, y = ex - qx, ey - qy
        r2 = max(x * x + y * y, h * h)
        gain[k] = (xx * y * y - 2.0 * xy * x * y + yy * x * x) / (r2 * r2)
        clearance[k] = -1.0
        if np.sqrt(x * x + y * y) - around >= rules.standoff:
            surely_clear += 1
    needed = rules.standoff
    if constrained and surely_clear < 2:
        first = second = -1.0
        for k in range(n):
            qx, qy = _place(rules, fixed, k, left, bottom, step_x, step_y)
            clearance[k] = _distance_to_hull(work.chain, corners, qx, qy)
            if clearance[k] > first:
                first, second = clearance[k], first
            elif clearance[k] > second:
                second = clearance[k]
        needed = min(needed, second if n > 1 else first)
    needed -= NEARLY * rules.standoff
    best, best_gain = 0, -np.inf
    for k in range(n):
        if gain[k] > best_gain:
            qx, qy = _place(rules, fixed, k, left, bottom, step_x, step_y)
            if not constrained or _clear(work, corners, k, qx, qy) >= needed:
                best, best_gain = k, gain[k]
    for k in range(best):
        if gain[k] >= best_gain * (1.0 - NEARLY):
            qx, qy = _place(rules, fixed, k, left, bottom, step_x, step_y)
            if not constrained or _clear(work, corners, k, qx, qy) >= needed:
                best = k
                break
    qx, qy = _place(rules, fixed, best, left, bottom, step_x, step_y)
    return qx, qy, best if fixed else -1


@_jit
def _action_grid(rules, x0, y0, h, nx, ny):
    """South-west corner and cell sizes of the action grid; see reference.grid_places."""
    width, height = nx * h, ny * h
    left, right = max(x0 - width, rules.window[0]), min(x0 + 2.0 * width, rules.window[2])
    bottom, top = max(y0 - height, rules.window[1]), min(y0 + 2.0 * height, rules.window[3])
    if left >= right or bottom >= top:
        left, bottom, right, top = rules.window[0], rules.window[1], rules.window[2], rules.window[3]
    return left, bottom, (right - left) / rules.grid_x, (top - bottom) / rules.grid_y


@_jit
def _place(rules, fixed, k, left, bottom, step_x, step_y):
    if fixed:
        return rules.places[k, 0], rules.places[k, 1]
    return left + (k % rules.grid_x + 0.5) * step_x, bottom + (k // rules.grid_x + 0.5) * step_y


@_jit
def _clear(work, corners, k, qx, qy):
    if work.clearance[k] < 0.0:
        work.clearance[k] = _distance_to_hull(work.chain, corners, qx, qy)
    return work.clearance[k]


@_jit
def _confidence_hull(work, now, cells, heaviest, m0, x0, y0, h, ny):
    """Counter-clockwise hull of the 95 % cells in work.chain, see reference.confidence_hull; returns its corners."""
    weight, histogram, chain = work.weight[now], work.histogram, work.chain
    top = _bits(weight[heaviest]) >> HISTOGRAM_SHIFT
    histogram[:] = 0.0
    for i in range(cells):
        below = top - (_bits(weight[i]) >> HISTOGRAM_SHIFT)
        if below < HISTOGRAM_BINS:
            histogram[below] += weight[i]
    wanted, held, last = CONFIDENCE * m0 * (1.0 - NEARLY), 0.0, -1
    while held < wanted and last + 1 < HISTOGRAM_BINS:
        last += 1
        held += histogram[last]
    m = 0
    for j in range(ny):
        past = _heavy_from_right(weight, work.offset[now, j], work.high[now, j] - work.low[now, j], top, last)
        if past > 0:
            x = x0 + (work.low[now, j] + past) * h
            m = _pushed(chain, m, 0, x, y0 + j * h)
            m = _pushed(chain, m, 0, x, y0 + (j + 1) * h)
    base = m
    for j in range(ny - 1, -1, -1):
        first = _heavy_from_left(weight, work.offset[now, j], work.high[now, j] - work.low[now, j], top, last)
        if first >= 0:
            x = x0 + (work.low[now, j] + first) * h
            m = _pushed(chain, m, base, x, y0 + (j + 1) * h)
            m = _pushed(chain, m, base, x, y0 + j * h)
    return m


@_jit
def _heavy_from_right(weight, offset, count, top, last):
    for i in range(count, 0, -1):
        if top - (_bits(weight[offset + i - 1]) >> HISTOGRAM_SHIFT) <= last:
            return i
    return 0


@_jit
def _heavy_from_left(weight, offset, count, top, last):
    for i in range(count):
        if top - (_bits(weight[offset + i]) >> HISTOGRAM_SHIFT) <= last:
            return i
    return -1


@_jit
def _pushed(chain, m, base, x, y):
    """Add a corner to a chain that turns left, dropping those that no longer stick out; returns the new length."""
    while m - base >= 2:
        ax, ay, bx, by = chain[m - 2, 0], chain[m - 2, 1], chain[m - 1, 0], chain[m - 1, 1]
        if (bx - ax) * (y - ay) - (by - ay) * (x - ax) > 0.0:
            break
        m -= 1
    chain[m, 0], chain[m, 1] = x, y
    return m + 1


@_jit
def _distance_to_hull(hull, corners, x, y):
    """m from (x, y) to a counter-clockwise convex polygon, 0 inside."""
    inside, nearest = True, np.inf
    ax, ay = hull[corners - 1, 0], hull[corners - 1, 1]
    for v in range(corners):
        bx, by = hull[v, 0], hull[v, 1]
        ux, uy, vx, vy = bx - ax, by - ay, x - ax, y - ay
        inside = inside and ux * vy - uy * vx >= 0.0
        part = min(max((ux * vx + uy * vy) / max(ux * ux + uy * uy, 1e-300), 0.0), 1.0)
        dx, dy = vx - part * ux, vy - part * uy
        nearest = min(nearest, dx * dx + dy * dy)
        ax, ay = bx, by
    return 0.0 if inside else np.sqrt(nearest)


@_jit
def _flight_time(rules, distance, turn):
    """See reference.flight_time."""
    if rules.motion != FULL:
        return distance / rules.speed + rules.constant
    turned = abs((turn + np.pi) % (2.0 * np.pi) - np.pi) / rules.turn_rate
    if distance >= rules.speed * rules.speed / rules.acceleration:
        return turned + distance / rules.speed + rules.speed / rules.acceleration + rules.constant
    return turned + 2.0 * np.sqrt(distance / rules.acceleration) + rules.constant
