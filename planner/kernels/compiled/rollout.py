"""Rollouts: follow the base policy along a sample path until the emitter is localized."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from planner.belief.grid import COARSE_CELLS
from planner.compiling import SOURCES, allocating, entry, inlined, jit
from planner.kernels.compiled.estimate import below_threshold, distance_sum, geometric_median
from planner.kernels.compiled.lanes import BLOCK
from planner.kernels.compiled.policies import ellipse_action, fisher_action
from planner.kernels.compiled.program import program_action
from planner.kernels.compiled.update import measure
from planner.kernels.model import (
    DYNAMIC_PROGRAM,
    ELLIPSE,
    FULL,
    GEOMETRIC_MEDIAN,
    MAP,
    Actions,
    Outcomes,
    Paths,
    Rules,
    Start,
    Tasks,
)
from planner.kernels.reference.belief import HISTOGRAM_BINS, MEDIAN_REACH
from planner.observation import WEDGE_SIGMAS
from planner.types import FloatArray

_FIRST = 2


class Workspace(NamedTuple):
    """Scratch of one call. weight: (3, n), offset, low, high: (3, r) and hull: (3, v, 2) hold beliefs: the one that
    every rollout starts with at _FIRST, then 0 and 1 in turn.

    along, across: (n,) m, cell centres in the bearing's frame. ramp: (c,) 0, 1, 2, ... histogram: (b,). gain: (g,) of
    the places, or seconds after the program's nodes, then the costs of its choices. chain: (4 r, 2) corners. Arrays of
    cells have BLOCK cells more, because whole blocks are written and the next row overwrites the excess.
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


def _entry_point(sources: int):
    """sources: what is compiled in, as a number. numba tells cached functions apart by what they close over."""

    @entry
    def rollouts(start: Start, rules: Rules, actions: Actions, paths: Paths, tasks: Tasks, out: Outcomes) -> None:
        """Run every task and fill `out`; see reference.rollouts."""
        _ = sources
        work = _workspace(start, rules)
        _copy_start(start, work)
        for t in range(len(tasks.action)):
            _rollout(start, rules, actions, paths, tasks.action[t], tasks.path[t], work, out, t)

    return rollouts


rollouts = _entry_point(SOURCES)


@inlined
def _copy_start(start, work):
    """The belief that every rollout starts with. Element by element: slices cost seconds of compiling."""
    for v in range(len(start.hull)):
        work.hull[_FIRST, v, 0], work.hull[_FIRST, v, 1] = start.hull[v, 0], start.hull[v, 1]
    filled = 0
    for j in range(start.density.shape[0]):
        work.low[_FIRST, j], work.high[_FIRST, j], work.offset[_FIRST, j] = start.low[j], start.high[j], filled
        for i in range(start.low[j], start.high[j]):
            work.weight[_FIRST, filled] = start.density[j, i]
            filled += 1


@allocating
def _workspace(start, rules):
    ny, nx = start.density.shape
    rows = max(ny, 2 * COARSE_CELLS)
    cells = max(ny * nx, 4 * COARSE_CELLS * COARSE_CELLS) + BLOCK
    columns = max(nx, 2 * COARSE_CELLS) + BLOCK
    return Workspace(
        np.empty((3, cells)),
        np.empty(cells),
        np.empty(cells),
        np.arange(columns).astype(np.float64),
        np.empty((3, rows), np.int64),
        np.empty((3, rows), np.int64),
        np.empty((3, rows), np.int64),
        np.empty((3, len(start.hull) + 2 * rules.horizon + 2, 2)),
        np.empty(HISTOGRAM_BINS),
        np.empty(
            max(len(rules.places), rules.grid_x * rules.grid_y, 4 * rules.after.shape[2] + 1) + rules.after.shape[2]
        ),
        np.empty((4 * rows + len(start.hull) + 2 * rules.horizon + 4, 2)),
    )


@inlined
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
        x0, y0, h, nx, ny, corners, doubled, cells, heaviest, m0, ma, mb, maa, mab, mbb = measure(
            work.weight[before], work.offset[before], work.low[before], work.high[before], work.hull[before],
            corners, x0, y0, h, nx, ny, doubled, rules, px, py, c, s, half_c, half_s, work, now,
        )  # fmt: skip
        bearings += 1
        weight, along, across = work.weight[now], work.along, work.across
        ea, eb = ma / m0, mb / m0
        if rules.estimator == MAP and not (start.flat and bearings <= 1):
            ea, eb = along[heaviest], across[heaviest]
        vaa = (maa - 2.0 * ea * ma) / m0 + ea * ea  # (3.34), about the estimate, in the bearing's frame
        vab = (mab - ea * mb - eb * ma) / m0 + ea * eb
        vbb = (mbb - 2.0 * eb * mb) / m0 + eb * eb
        ex, ey = px + c * ea - s * eb, py + s * ea + c * eb
        reach = np.hypot(max(ex - x0, x0 + nx * h - ex), max(ey - y0, y0 + ny * h - ey))
        localized = below_threshold(weight, along, across, cells, ea, eb, vaa + vbb, m0, rules.threshold, reach)
        if not localized and rules.estimator == GEOMETRIC_MEDIAN:
            near = MEDIAN_REACH * rules.threshold
            if below_threshold(weight, along, across, cells, ea, eb, vaa + vbb, m0, near, reach):
                ga, gb = geometric_median(weight, along, across, cells, ea, eb, 1e-3 * h)
                localized = distance_sum(weight, along, across, 0, cells, ga, gb) < rules.threshold * m0
                if localized:
                    ea, eb = ga, gb
                    ex, ey = px + c * ea - s * eb, py + s * ea + c * eb
                    vaa = (maa - 2.0 * ea * ma) / m0 + ea * ea
                    vab = (mab - ea * mb - eb * ma) / m0 + ea * eb
                    vbb = (mbb - 2.0 * eb * mb) / m0 + eb * eb
        xx = c * c * vaa - 2.0 * c * s * vab + s * s * vbb
        xy = c * s * (vaa - vbb) + (c * c - s * s) * vab
        yy = s * s * vaa + 2.0 * c * s * vab + c * c * vbb
        step += 1
        last, after = step == rules.horizon, 0.0
        if localized or (last and rules.policy != DYNAMIC_PROGRAM):
            break
        if rules.policy == DYNAMIC_PROGRAM:
            qx, qy, following, after = program_action(
                ex, ey, xx, xy, yy, px, py, lattice, rules, work, now, cells, heaviest, m0, x0, y0, h, nx, ny
            )
        elif rules.policy == ELLIPSE:
            qx, qy, following = ellipse_action(ex, ey, xx, xy, yy, px, py, rules.ratios, rules.distances)
        else:
            qx, qy, following = fisher_action(
                ex, ey, xx, xy, yy, rules, work, now, cells, heaviest, m0, x0, y0, h, nx, ny
            )
        distance = np.sqrt((qx - px) ** 2 + (qy - py) ** 2)
        if lattice >= 0 and following >= 0 and len(rules.travel) > 0:
            distance = rules.travel[lattice, following]
        towards = heading
        if rules.motion == FULL and distance > 0.0:
            towards = np.arctan2(qy - py, qx - px)
        cost += _flight_time(rules, distance, towards - heading)  # (4.5)
        if last:
            cost += after
            break
        cost += rules.measurement_time
        px, py, heading, lattice = qx, qy, towards, following
    out.costs[t] = cost
    out.bearings[t] = step
    expected_rmse = rules.threshold
    if not localized:
        expected_rmse = distance_sum(work.weight[now], work.along, work.across, 0, cells, ea, eb) / m0
    end = out.ends[t]
    end[0], end[1], end[2], end[3], end[4], end[5], end[6] = px, py, ex, ey, xx, xy, yy
    end[7], end[8], end[9] = expected_rmse, bearings, 1.0 if localized else 0.0


@jit
def _bearing(dx, dy, noise):
    """Cosine and sine of atan2(dy, dx) + noise (4.2)."""
    distance = np.sqrt(dx * dx + dy * dy)
    east, north = (dx / distance, dy / distance) if distance > 0.0 else (1.0, 0.0)
    c, s = np.cos(noise), np.sin(noise)
    return east * c - north * s, north * c + east * s


@inlined
def _flight_time(rules, distance, turn):
    """See reference.policy.flight_time."""
    if rules.motion != FULL:
        return distance / rules.speed + rules.constant
    turned = abs((turn + np.pi) % (2.0 * np.pi) - np.pi) / rules.turn_rate
    if distance >= rules.speed * rules.speed / rules.acceleration:
        return turned + distance / rules.speed + rules.speed / rules.acceleration + rules.constant
    return turned + 2.0 * np.sqrt(distance / rules.acceleration) + rules.constant
