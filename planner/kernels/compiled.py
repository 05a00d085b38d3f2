"""The fast twin of reference.py: the same rollouts with the same signature, compiled by numba, without the GIL.

What makes it fast (measured in docs/kernel.md): the grid is cropped before the likelihood is evaluated; of each row
only the columns that the widened wedge touches are gathered, into flat arrays with coordinates along and across the
bearing; one long loop then needs neither atan2 nor exp (sin^2 of the error, a polynomial, four squarings) and takes
the moments on the way; the heaviest cell is a maximum over the floats' integer view with the index in the low bits;
the expected RMSE is only summed when its bounds do not decide. Doubling the grid costs nothing: the next gather reads
each parent twice. Nothing is allocated and no reference counted inside a rollout.

One file, because numba's cache looks at the file of the compiled function only: a change in another would go unseen.
"""

# pyright: reportCallIssue=false
# An intrinsic is called without the typing context that its definition takes.
from __future__ import annotations

from typing import Any, NamedTuple

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

_FLAGS: dict[str, Any] = {"cache": True, "nogil": True, "error_model": "numpy"}
_FASTMATH = {"reassoc", "contract", "arcp", "nsz"}
_outer = njit(fastmath=_FASTMATH, **_FLAGS)
_jit = njit(fastmath=_FASTMATH, _nrt=False, **_FLAGS)
"""Counts no references to arrays: numba's atomic counters took a sixth of the time, and threads fought for them."""
_inlined = njit(fastmath=_FASTMATH, _nrt=False, forceinline=True, **_FLAGS)
"""For functions that take `rules` or `work`: these are passed by value, some hundred words a call."""
_INDEX_MASK = (1 << TIE_BITS) - 1
_BLOCK = 128
_PAD = 16
_FIRST = 2
_ALIGN = 1e-9


class _Workspace(NamedTuple):
    """Scratch of one call. weight: (3, n), offset, low, high: (3, r) and hull: (3, v, 2) hold beliefs: the one that
    every rollout starts with at _FIRST, then 0 and 1 in turn.

    along, across: (n,) m, cell centres in the bearing's frame. ramp: (c,) 0, 1, 2, ... histogram: (b,). gain: (l,) of
    the places. chain: (4 r, 2) corners. Arrays of cells have _PAD cells more, because whole blocks are written and the
    next row overwrites the excess.
    """

    weight: FloatArray
    along: FloatArray
    across: FloatArray
    ramp: FloatArray
    offset: NDArray[np.int64]
    low: NDArray[np.int64]
    high: NDArray[np.int64]
    hull: FloatArray
    histogram: FloatArray
    gain: FloatArray
    chain: FloatArray


@intrinsic
def _bits(typingctx, value):
    """The 64 bits of a float as an integer; for floats >= 0 both are ordered alike."""

    def codegen(context, builder, signature, arguments):
        return builder.bitcast(arguments[0], ir.IntType(64))

    return types.int64(types.float64), codegen


def _lanes(context, builder, array_type, array, index):
    """Pointer to _PAD neighbouring doubles of an array, as one LLVM vector."""
    data = context.make_array(array_type)(context, builder, array).data
    return builder.bitcast(builder.gep(data, [index]), ir.VectorType(ir.DoubleType(), _PAD).as_pointer())


@intrinsic
def _store_ramp(typingctx, target, index, start, step):
    """target[index + i] = start + i * step for a whole block."""

    def codegen(context, builder, signature, arguments):
        lanes = ir.VectorType(ir.DoubleType(), _PAD)
        spread = ir.Constant(ir.VectorType(ir.IntType(32), _PAD), [0] * _PAD)

        def everywhere(value):
            single = builder.insert_element(ir.Constant(lanes, ir.Undefined), value, ir.IntType(32)(0))
            return builder.shuffle_vector(single, ir.Constant(lanes, ir.Undefined), spread)

        counts = ir.Constant(lanes, [float(i) for i in range(_PAD)])
        values = builder.fadd(everywhere(arguments[2]), builder.fmul(everywhere(arguments[3]), counts))
        builder.store(values, _lanes(context, builder, signature.args[0], arguments[0], arguments[1]), align=8)
        return context.get_dummy_value()

    return types.void(target, types.int64, types.float64, types.float64), codegen


@intrinsic
def _copy_block(typingctx, target, index, source, begin):
    """target[index + i] = source[begin + i] for a whole block."""

    def codegen(context, builder, signature, arguments):
        values = builder.load(_lanes(context, builder, signature.args[2], arguments[2], arguments[3]), align=8)
        builder.store(values, _lanes(context, builder, signature.args[0], arguments[0], arguments[1]), align=8)
        return context.get_dummy_value()

    return types.void(target, types.int64, source, types.int64), codegen


@intrinsic
def _copy_doubled_block(typingctx, target, index, source, begin):
    """target[index + i] = source[begin + i // 2] for a whole block."""

    def codegen(context, builder, signature, arguments):
        lanes = ir.VectorType(ir.DoubleType(), _PAD)
        values = builder.load(_lanes(context, builder, signature.args[2], arguments[2], arguments[3]), align=8)
        twice = ir.Constant(ir.VectorType(ir.IntType(32), _PAD), [i // 2 for i in range(_PAD)])
        values = builder.shuffle_vector(values, ir.Constant(lanes, ir.Undefined), twice)
        builder.store(values, _lanes(context, builder, signature.args[0], arguments[0], arguments[1]), align=8)
        return context.get_dummy_value()

    return types.void(target, types.int64, source, types.int64), codegen


@_outer
def rollouts(start: Start, rules: Rules, actions: Actions, paths: Paths, tasks: Tasks, out: Outcomes) -> None:
    """Run every task and fill `out`; see reference.rollouts."""
    work = _workspace(start, rules)
    work.hull[_FIRST, : len(start.hull)] = start.hull
    work.low[_FIRST, : len(start.low)], work.high[_FIRST, : len(start.low)] = start.low, start.high
    filled = 0
    for j in range(start.density.shape[0]):
        work.offset[_FIRST, j] = filled
        for i in range(start.low[j], start.high[j]):
            work.weight[_FIRST, filled] = start.density[j, i]
            filled += 1
    for t in range(len(tasks.action)):
        _rollout(start, rules, actions, paths, tasks.action[t], tasks.path[t], work, out, t)


@_outer
def _workspace(start, rules):
    ny, nx = start.density.shape
    rows = max(ny, 2 * COARSE_CELLS)
    cells = max(ny * nx, 4 * COARSE_CELLS * COARSE_CELLS) + _PAD
    columns = max(nx, 2 * COARSE_CELLS) + _PAD
    return _Workspace(
        np.empty((3, cells)),
        np.empty(cells),
        np.empty(cells),
        np.arange(columns).astype(np.float64),
        np.empty((3, rows), np.int64),
        np.empty((3, rows), np.int64),
        np.empty((3, rows), np.int64),
        np.empty((3, len(start.hull) + 2 * rules.horizon + 2, 2)),
        np.empty(HISTOGRAM_BINS),
        np.empty(max(len(rules.places), rules.grid_x * rules.grid_y)),
        np.empty((4 * rows + len(start.hull) + 2 * rules.horizon + 4, 2)),
    )


@_inlined
def _rollout(start, rules, actions, paths, action, path, work, out, t):
    tx, ty = paths.targets[path, 0], paths.targets[path, 1]
    px, py = actions.places[action, 0], actions.places[action, 1]
    heading, lattice, cost = actions.headings[action], actions.lattice[action], actions.costs[action]
    x0, y0, h, corners, doubled = start.x0, start.y0, start.h, len(start.hull), False
    ny, nx = start.density.shape
    now, bearings, localized, heaviest = 1, start.bearings, False, 0
    ex = ey = xx = xy = yy = 0.0
    half_c, half_s = np.cos(WEDGE_SIGMAS * rules.sigma), np.sin(WEDGE_SIGMAS * rules.sigma)
    step = 0
    while True:
        c, s = _bearing(tx - px, ty - py, paths.noise[path, step])
        before, now = _FIRST if step == 0 else now, 1 - now
        x0, y0, h, nx, ny, corners, doubled, cells, heaviest, m0, ma, mb, maa, mab, mbb = _measure(
            work.weight[before], work.offset[before], work.low[before], work.high[before], work.hull[before],
            corners, x0, y0, h, nx, ny, doubled, rules, px, py, c, s, half_c, half_s, work, now,
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
        ex, ey = px + c * ea - s * eb, py + s * ea + c * eb
        reach = np.hypot(max(ex - x0, x0 + nx * h - ex), max(ey - y0, y0 + ny * h - ey))
        localized = _localized(weight, along, across, cells, ea, eb, vaa + vbb, m0, rules.threshold, reach)
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
        distance = np.sqrt((qx - px) ** 2 + (qy - py) ** 2)
        if lattice >= 0 and following >= 0 and len(rules.travel) > 0:
            distance = rules.travel[lattice, following]
        towards = heading
        if rules.motion == FULL and distance > 0.0:
            towards = np.arctan2(qy - py, qx - px)
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
def _bearing(dx, dy, noise):
    """Cosine and sine of atan2(dy, dx) + noise (4.2)."""
    distance = np.sqrt(dx * dx + dy * dy)
    east, north = (dx / distance, dy / distance) if distance > 0.0 else (1.0, 0.0)
    c, s = np.cos(noise), np.sin(noise)
    return east * c - north * s, north * c + east * s


@_inlined
def _measure(
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
        _weigh(work.weight[now], work.along, work.across, cells, rules.likelihood, rules.edge, NEARLY * cell)
        m0, ma, mb, maa, mab, mbb, heaviest = _moments(work.weight[now], work.along, work.across, cells)
        if m0 > 0.0:
            doubled = max(i1 - i0, j1 - j0) < COARSE_CELLS
            x0, y0 = x0 + i0 * cell, y0 + j0 * cell
            return x0, y0, cell, i1 - i0, j1 - j0, left, doubled, cells, heaviest, m0, ma, mb, maa, mab, mbb
    for v in range(corners):
        target[v, 0], target[v, 1] = hull[v, 0], hull[v, 1]
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


@_inlined
def _gather(weight, offset, low, high, x0, y0, h, k, i0, i1, j0, j1, px, py, c, s, rx, ry, lx, ly, work, now):
    """Copy the live cells of rows j0..j1, columns i0..i1 that the widened wedge touches; h and the indices are those of
    the grid doubled k times. Returns how many cells there are.
    """
    target = work.weight[now]
    left, bottom = x0 + i0 * h - px, y0 + (j0 + 0.5) * h - py
    r_way, r_start, r_slope = _crossing(rx, ry, left, bottom, h)
    l_way, l_start, l_slope = _crossing(lx, ly, left, bottom, h)
    c_way, c_start, c_slope = _crossing(c, s, left, bottom, h)
    n = 0
    for j in range(j0, j1):
        row = j >> k
        up = float(j - j0)
        a, b = _narrowed(0, i1 - i0, r_way, r_start + r_slope * up)
        a, b = _narrowed(a, b, l_way, l_start + l_slope * up)
        a, b = _narrowed(a, b, c_way, c_start + c_slope * up)
        first, last, base = low[row], high[row], offset[row] - low[row]
        first, last = max(first, (a + i0) >> k), min(last, ((b + i0 - 1) >> k) + 1)
        a, b = max(a, (first << k) - i0), min(b, (last << k) - i0)
        count = max(b - a, 0)
        work.offset[now, j - j0], work.low[now, j - j0], work.high[now, j - j0] = n, a, a + count
        if count == 0:
            continue
        dx, dy = left + (a + 0.5) * h, bottom + up * h
        _place_cells(work.along, work.across, n, count, c * dx + s * dy, c * dy - s * dx, c * h, -s * h)
        _copy_cells(weight, target, base, a + i0, n, count, k)
        n += count
    return n


@_jit
def _place_cells(along, across, n, count, a0, b0, step_a, step_b):
    """Coordinates of `count` cells of one row, in whole blocks."""
    for first in range(0, count, _PAD):
        _store_ramp(along, n + first, a0 + step_a * first, step_a)
        _store_ramp(across, n + first, b0 + step_b * first, step_b)


@_jit
def _copy_cells(weight, target, base, column, n, count, k):
    """Weights of `count` cells of one row from `column` of the grid doubled k times, in whole blocks where it pays."""
    if k == 0:
        for first in range(0, count, _PAD):
            _copy_block(target, n + first, weight, base + column + first)
    elif k == 1:
        odd = column & 1
        target[n] = weight[base + (column >> 1)]
        for first in range(odd, count, _PAD):
            _copy_doubled_block(target, n + first, weight, base + ((column + first) >> 1))
    else:
        for i in range(count):
            target[n + i] = weight[base + ((column + i) >> k)]


@_jit
def _crossing(nx, ny, left, bottom, h):
    """Where a side of the widened wedge, nx dx + ny dy >= -h / sqrt(2), crosses the rows of cell centres.

    Returns the way it opens (1 east, -1 west, 0 along the rows) and the column of row 0 and its slope; for a side along
    the rows what is left of the margin, in cells.
    """
    reach = -h / np.sqrt(2.0) - ny * bottom
    if abs(nx) <= NEARLY:
        return 0, NEARLY - reach / h, ny
    return 1 if nx > 0.0 else -1, (reach / nx - left) / h - 0.5, -ny / nx


@_jit
def _narrowed(a, b, way, column):
    """The columns of a..b on the inner side of a wedge's side that crosses the row at `column`."""
    if way > 0:
        edge = np.ceil(column - NEARLY)
        return (max(a, int(edge)), b) if edge < b else (b, b)
    if way < 0:
        edge = np.floor(column + NEARLY) + 1.0
        return (a, min(b, int(edge))) if edge > a else (a, a)
    return (a, b) if column >= 0.0 else (a, a)


@_inlined
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


@_jit
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
        key = (_bits(w) & ~_INDEX_MASK) | (_INDEX_MASK - i)
        top = key if key > top else top
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


@_inlined
def _fisher(ex, ey, xx, xy, yy, rules, work, now, cells, heaviest, m0, x0, y0, h, nx, ny):
    """See reference.fisher_action. Places are held against C95 only as far as the answer needs it."""
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
        corners = _confidence_hull(work, now, cells, heaviest, m0, x0, y0, h, ny)
        needed = _affordable_standoff(rules, fixed, n, left, bottom, step_x, step_y, work.chain, corners)
    outside = _distance_to_hull(work.chain, corners, ex, ey) if corners > 0 else 0.0
    best, best_gain = 0, -np.inf
    for k in range(n):
        if gain[k] > best_gain:
            qx, qy = _place(rules, fixed, k, left, bottom, step_x, step_y)
            if corners == 0 or _clear(
                work.chain, corners, qx, qy, needed, np.sqrt((qx - ex) ** 2 + (qy - ey) ** 2) + outside
            ):
                best, best_gain = k, gain[k]
    for k in range(best):
        if gain[k] >= best_gain * (1.0 - NEARLY):
            qx, qy = _place(rules, fixed, k, left, bottom, step_x, step_y)
            if corners == 0 or _clear(work.chain, corners, qx, qy, needed, np.inf):
                best = k
                break
    qx, qy = _place(rules, fixed, best, left, bottom, step_x, step_y)
    return qx, qy, best if fixed else -1


@_jit
def _gain(x, y, xx, xy, yy, nearest):
    r2 = max(x * x + y * y, nearest * nearest)
    return (xx * y * y - 2.0 * xy * x * y + yy * x * x) / (r2 * r2)


@_inlined
def _affordable_standoff(rules, fixed, n, left, bottom, step_x, step_y, hull, corners):
    """r_min, or what it shrinks to so that two places are left (6.1)."""
    first = second = -1.0
    for k in range(n):
        qx, qy = _place(rules, fixed, k, left, bottom, step_x, step_y)
        clearance = _distance_to_hull(hull, corners, qx, qy)
        if clearance > first:
            first, second = clearance, first
        elif clearance > second:
            second = clearance
        if second >= rules.standoff:
            break
    return min(rules.standoff, second if n > 1 else first) - NEARLY * rules.standoff


@_inlined
def _action_grid(rules, x0, y0, h, nx, ny):
    """South-west corner and cell sizes of the action grid; see reference.grid_places."""
    width, height = nx * h, ny * h
    left, right = max(x0 - width, rules.window[0]), min(x0 + 2.0 * width, rules.window[2])
    bottom, top = max(y0 - height, rules.window[1]), min(y0 + 2.0 * height, rules.window[3])
    if left >= right or bottom >= top:
        left, bottom, right, top = rules.window[0], rules.window[1], rules.window[2], rules.window[3]
    return left, bottom, (right - left) / rules.grid_x, (top - bottom) / rules.grid_y


@_inlined
def _place(rules, fixed, k, left, bottom, step_x, step_y):
    if fixed:
        return rules.places[k, 0], rules.places[k, 1]
    return left + (k % rules.grid_x + 0.5) * step_x, bottom + (k // rules.grid_x + 0.5) * step_y


@_jit
def _clear(hull, corners, x, y, needed, at_most):
    """Whether (x, y) is at least `needed` m away from the hull, of which a point is at most `at_most` m away."""
    if at_most < needed:
        return False
    for v in range(corners):
        dx, dy = hull[v, 0] - x, hull[v, 1] - y
        if dx * dx + dy * dy < needed * needed and needed > 0.0:
            return False
    return _distance_to_hull(hull, corners, x, y) >= needed


@_inlined
def _confidence_hull(work, now, cells, heaviest, m0, x0, y0, h, ny):
    """Counter-clockwise hull of the 95 % cells in work.chain, see reference.confidence_hull; returns its corners."""
    weight, histogram, chain = work.weight[now], work.histogram, work.chain
    top = _bits(weight[heaviest]) >> HISTOGRAM_SHIFT
    for i in range(HISTOGRAM_BINS):
        histogram[i] = 0.0
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


@_inlined
def _flight_time(rules, distance, turn):
    """See reference.flight_time."""
    if rules.motion != FULL:
        return distance / rules.speed + rules.constant
    turned = abs((turn + np.pi) % (2.0 * np.pi) - np.pi) / rules.turn_rate
    if distance >= rules.speed * rules.speed / rules.acceleration:
        return turned + distance / rules.speed + rules.speed / rules.acceleration + rules.constant
    return turned + 2.0 * np.sqrt(distance / rules.acceleration) + rules.constant
