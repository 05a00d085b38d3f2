"""A whole rollout in readable numpy: the specification of `compiled`, and its oracle in the tests.

A rollout takes a first action, then follows the base policy until the expected RMSE of its own belief falls below the
threshold (4.11) or the horizon is reached. Each step: measure with the sample path's noise, clip the possible
positions to the bearing's wedge, crop the grid, multiply the likelihood in, take the estimate.

Where rounding could decide, both kernels leave it no say: cells are compared by the leading 44 bits of their weight
(the first of equal ones wins), of actions that are equal to 1e-9 the first wins, and edges are met 1e-9 of a
cell early. Doubling the grid is put off to the next bearing, when children and parents still have the same mass.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from planner.belief.estimate import TIE_BITS
from planner.belief.grid import COARSE_CELLS, FEWEST_CELLS, aligned_range
from planner.geometry import cells_hull, centres, clip_half_plane, distance_to_convex
from planner.kernels.model import (
    DYNAMIC_PROGRAM,
    ELLIPSE,
    FULL,
    GEOMETRIC_MEDIAN,
    LIKELIHOOD_POWER,
    MAP,
    Actions,
    Outcomes,
    Paths,
    Rules,
    Start,
    Tasks,
)
from planner.kernels.value.lookup import Frame, after_at, blended, principal_frame
from planner.observation import WEDGE_SIGMAS
from planner.types import BoolArray, FloatArray

NEARLY = 1e-9
CONFIDENCE = 0.95
HISTOGRAM_SHIFT = 48
"""Weights are counted in bins of 1/16 octave, the leading 16 bits of a double, to find the 95 % cells."""
HISTOGRAM_BINS = 512
MEDIAN_STEPS = 6
MEDIAN_REACH = 1.15
"""The geometric median is looked for where the expected RMSE about the mean is below this many times the threshold: it
brings no belief of one peak further down."""
DEEPEST_DOUBLING = 12
LIGHT = 1e-6
"""Rollouts start without the ends of rows that are lighter than this share of the heaviest cell."""


class Belief(NamedTuple):
    """weight: (ny, nx) unnormalized. doubled: the next bearing starts on half the cell size."""

    weight: FloatArray
    x0: float
    y0: float
    h: float
    hull: FloatArray
    bearings: int
    doubled: bool


class PointEstimate(NamedTuple):
    """The estimate of a belief and its spread (m, m^2)."""

    x: float
    y: float
    xx: float
    xy: float
    yy: float
    expected_rmse: float


def rollouts(start: Start, rules: Rules, actions: Actions, paths: Paths, tasks: Tasks, out: Outcomes) -> None:
    """Run every task and fill `out`."""
    for t in range(len(tasks.action)):
        a, p = tasks.action[t], tasks.path[t]
        cost, bearings, end = rollout(start, rules, actions, int(a), paths.targets[p], paths.noise[p])
        out.costs[t], out.bearings[t], out.ends[t] = cost, bearings, end


def rollout(
    start: Start, rules: Rules, actions: Actions, action: int, target: FloatArray, noise: FloatArray
) -> tuple[float, int, FloatArray]:
    """Cost (s), bearings taken, and the end (see CLOSED_FEATURES) of one sample path."""
    columns = np.arange(int(start.density.shape[1]))
    live = (columns >= start.low[:, None]) & (columns < start.high[:, None])
    weight = np.where(live, start.density, 0.0)
    belief = Belief(weight, start.x0, start.y0, start.h, start.hull, start.bearings, doubled=False)
    place, heading = actions.places[action], float(actions.headings[action])
    lattice, cost = int(actions.lattice[action]), float(actions.costs[action])
    step = 0
    while True:
        belief = measure(belief, rules, place, target, float(noise[step]))
        step += 1
        estimated = estimate(belief, rules.estimator, start.flat, rules.threshold)
        localized = estimated.expected_rmse < rules.threshold  # (4.11)
        last = step == rules.horizon
        if localized or (last and rules.policy != DYNAMIC_PROGRAM):
            break
        following, next_lattice, after = base_policy(belief, estimated, rules, place, lattice)
        flight = following - place
        distance = float(np.hypot(*flight))
        if lattice >= 0 and next_lattice >= 0 and len(rules.travel):
            distance = float(rules.travel[lattice, next_lattice])
        direction = float(np.arctan2(flight[1], flight[0])) if distance > 0 else heading
        cost += flight_time(rules, distance, direction - heading)  # (4.5)
        if last:
            cost += after  # what is cut off, by the dynamic program's value
            break
        cost += rules.measurement_time
        place, heading, lattice = following, direction, next_lattice
    left_over = rules.threshold if localized else estimated.expected_rmse
    end = [
        *place,
        estimated.x,
        estimated.y,
        estimated.xx,
        estimated.xy,
        estimated.yy,
        left_over,
        belief.bearings,
        localized,
    ]
    return cost, step, np.array(end, dtype=float)


def measure(belief: Belief, rules: Rules, place: FloatArray, target: FloatArray, noise: float) -> Belief:
    """The belief after the bearing z = atan2(y_t - y_s, x_t - x_s) + w from `place` (4.2).

    A bearing that leaves no mass (the target lay on the border of its cell) changes nothing but the count.
    """
    angle = np.arctan2(target[1] - place[1], target[0] - place[0]) + noise
    half = WEDGE_SIGMAS * rules.sigma
    to_left_of_right = np.array([-np.sin(angle - half), np.cos(angle - half)])
    to_right_of_left = np.array([np.sin(angle + half), -np.cos(angle + half)])
    hull = clip_half_plane(clip_half_plane(belief.hull, place, to_left_of_right), place, to_right_of_left)
    unchanged = belief._replace(bearings=belief.bearings + 1)
    if len(hull) == 0:
        return unchanged
    weight, x0, y0, h = _cropped(belief, hull)
    ny, nx = weight.shape
    rows, columns = np.arange(int(ny)), np.arange(int(nx))
    dy = y0 + (rows + 0.5) * h - place[1]
    low = np.zeros(ny)
    high = np.full(ny, float(nx))
    for normal in (to_left_of_right, to_right_of_left, np.array([np.cos(angle), np.sin(angle)])):
        low, high = _narrowed(low, high, normal, dy, x0 - place[0], h)
    touched = (columns >= low[:, None]) & (columns < high[:, None])
    dx = x0 + (columns + 0.5) * h - place[0]
    weight = np.where(touched, weight, 0.0) * likelihood(rules, dx[None, :], dy[:, None], angle, h)
    if not weight.sum() > 0:
        return unchanged
    return Belief(weight, x0, y0, h, hull, belief.bearings + 1, doubled=max(nx, ny) < COARSE_CELLS)


def _cropped(belief: Belief, hull: FloatArray) -> tuple[FloatArray, float, float, float]:
    """The cells that touch the hull's rectangle, doubled when that is due or they are too few: weight, x0, y0, h."""
    extent = hull.max(axis=0) - hull.min(axis=0)
    doublings = int(belief.doubled)
    while True:
        h = belief.h / 2.0**doublings
        ny, nx = belief.weight.shape[0] << doublings, belief.weight.shape[1] << doublings
        (x_min, y_min), (x_max, y_max) = hull.min(axis=0), hull.max(axis=0)
        i0, i1 = aligned_range(x_min - belief.x0, x_max - belief.x0, h, nx)
        j0, j1 = aligned_range(y_min - belief.y0, y_max - belief.y0, h, ny)
        enough = max(i1 - i0, j1 - j0) >= FEWEST_CELLS or extent.max() <= 0
        if enough or doublings >= DEEPEST_DOUBLING:
            break
        doublings += 1
    rows, columns = np.arange(j0, j1) >> doublings, np.arange(i0, i1) >> doublings
    return belief.weight[np.ix_(rows, columns)], belief.x0 + i0 * h, belief.y0 + j0 * h, h


def _narrowed(
    low: FloatArray, high: FloatArray, normal: FloatArray, dy: FloatArray, left: float, h: float
) -> tuple[FloatArray, FloatArray]:
    """Columns of each row whose centre has normal . (dx, dy) >= -h / sqrt(2), dx = left + (i + 0.5) h."""
    reach = -h / np.sqrt(2.0) - normal[1] * dy
    if normal[0] > NEARLY:
        return np.maximum(low, np.ceil((reach / normal[0] - left) / h - 0.5 - NEARLY)), high
    if normal[0] < -NEARLY:
        return low, np.minimum(high, np.floor((reach / normal[0] - left) / h - 0.5 + NEARLY) + 1.0)
    return low, np.where(reach <= NEARLY * h, high, 0.0)


def likelihood(rules: Rules, dx: FloatArray, dy: FloatArray, angle: float, h: float) -> FloatArray:
    """exp(-e^2 / (2 sigma^2)), e the angle between (dx, dy) and the bearing; its mean over a cell of side h with blur.

    Beyond 4 sigma, and for places that are not ahead of the sensor, that of the wedge's edge. The mean is
    observation.mean_likelihood's: with k = h^2 / (12 sigma^2) and r^2 at least h^2 / 6 it is
    sqrt(r^2 / (r^2 + k)) times the likelihood of sin^2 e r^2 / (r^2 + k).
    """
    along = np.cos(angle) * dx + np.sin(angle) * dy
    across = np.cos(angle) * dy - np.sin(angle) * dx
    length2 = along**2 + across**2
    sin2 = np.where(along > NEARLY * h, across**2 / np.where(length2 > 0, length2, 1.0), 1.0)
    share = np.ones_like(length2)
    if rules.blur > 0.0:
        distance2 = np.maximum(length2, h * h / 6.0)
        share = distance2 / (distance2 + rules.blur * h * h)
    series = np.polynomial.Polynomial(rules.likelihood)
    root = np.asarray(series(np.minimum(sin2 * share, rules.edge)), dtype=np.float64)
    return np.asarray(root**LIKELIHOOD_POWER * np.sqrt(share), dtype=np.float64)


def estimate(belief: Belief, estimator: int, flat: bool, threshold: float) -> PointEstimate:
    """Point estimate, covariance about it (3.34), expected RMSE (3.58).

    GEOMETRIC_MEDIAN: the mean, but the median where that is what brings the expected RMSE below the threshold.
    """
    rows, columns = np.nonzero(belief.weight)
    weight = belief.weight[rows, columns]
    mass = weight / weight.sum()
    x = centres(belief.x0, belief.h, belief.weight.shape[1])[columns]
    y = centres(belief.y0, belief.h, belief.weight.shape[0])[rows]
    px, py = float(mass @ x), float(mass @ y)
    if estimator == MAP and not (flat and belief.bearings <= 1):
        best = int(np.argmax(weight.view(np.int64) >> TIE_BITS))
        px, py = float(x[best]), float(y[best])
    found = _about(mass, x, y, px, py)
    if estimator == GEOMETRIC_MEDIAN and threshold <= found.expected_rmse < MEDIAN_REACH * threshold:
        median = _about(mass, x, y, *_median(mass, x, y, px, py, 1e-3 * belief.h))
        return median if median.expected_rmse < threshold else found
    return found


def _about(mass: FloatArray, x: FloatArray, y: FloatArray, px: float, py: float) -> PointEstimate:
    dx, dy = x - px, y - py
    expected_rmse = float(mass @ np.sqrt(dx**2 + dy**2))
    return PointEstimate(px, py, float(mass @ dx**2), float(mass @ (dx * dy)), float(mass @ dy**2), expected_rmse)


def _median(
    mass: FloatArray, x: FloatArray, y: FloatArray, px: float, py: float, tolerance: float
) -> tuple[float, float]:
    for _ in range(MEDIAN_STEPS):
        pull = mass / np.maximum(np.sqrt((x - px) ** 2 + (y - py) ** 2), tolerance)
        px, py = float(pull @ x / pull.sum()), float(pull @ y / pull.sum())
    return px, py


def base_policy(
    belief: Belief, estimated: PointEstimate, rules: Rules, place: FloatArray, lattice: int
) -> tuple[FloatArray, int, float]:
    """The next place (2,), its index in the fixed lattice (-1: none), and the seconds that remain from there on, its
    bearing's included, where the policy knows them.
    """
    if rules.policy == ELLIPSE:
        return ellipse_action(estimated, place, rules.ratios, rules.distances), -1, 0.0
    if rules.policy == DYNAMIC_PROGRAM:
        return program_action(belief, estimated, rules, place, lattice)
    places = rules.places if len(rules.places) else grid_places(belief, rules)
    following, index = fisher_action(belief, estimated, rules, places)
    return following, index, 0.0


def ellipse_action(
    estimated: PointEstimate, place: FloatArray, ratios: FloatArray, distances: FloatArray
) -> FloatArray:
    """r = s2 PLI(s1 / s2) from the estimate, perpendicular to the major axis, on the platform's side (4.3.2)."""
    mean, difference = 0.5 * (estimated.xx + estimated.yy), 0.5 * (estimated.xx - estimated.yy)
    spread = np.hypot(difference, estimated.xy)
    round_ = spread <= NEARLY * mean
    minor = np.pi / 2 if round_ else 0.5 * np.arctan2(estimated.xy, difference) + np.pi / 2
    s1 = np.sqrt(mean + spread)
    s2 = max(np.sqrt(max(mean - spread, 0.0)), 1e-6 * s1)
    step = s2 * extrapolated(s1 / s2, ratios, distances) * np.array([np.cos(minor), np.sin(minor)])
    side = (place[0] - estimated.x) * step[0] + (place[1] - estimated.y) * step[1]
    sign = -1.0 if side < -NEARLY * (step @ step) else 1.0
    return np.array([estimated.x, estimated.y]) + sign * step


def extrapolated(ratio: float, ratios: FloatArray, distances: FloatArray) -> float:
    """The table's distance at a ratio, linear between and past its entries."""
    k = min(max(int(np.searchsorted(ratios, ratio)) - 1, 0), len(ratios) - 2)
    slope = (distances[k + 1] - distances[k]) / (ratios[k + 1] - ratios[k])
    return float(distances[k] + slope * (ratio - ratios[k]))


def grid_places(belief: Belief, rules: Rules) -> FloatArray:
    """Centres of the X x Y cells over the tripled belief rectangle, cut with the window (4.24-4.28), west to east.

    When nothing is left the window's own rectangle is divided.
    """
    ny, nx = belief.weight.shape
    width, height = nx * belief.h, ny * belief.h
    x_min, x_max = max(belief.x0 - width, rules.window[0]), min(belief.x0 + 2 * width, rules.window[2])
    y_min, y_max = max(belief.y0 - height, rules.window[1]), min(belief.y0 + 2 * height, rules.window[3])
    if x_min >= x_max or y_min >= y_max:
        x_min, y_min, x_max, y_max = rules.window
    x = x_min + (np.arange(rules.grid_x) + 0.5) * (x_max - x_min) / rules.grid_x
    y = y_min + (np.arange(rules.grid_y) + 0.5) * (y_max - y_min) / rules.grid_y
    return np.column_stack([np.tile(x, rules.grid_y), np.repeat(y, rules.grid_x)])


def fisher_action(belief: Belief, estimated: PointEstimate, rules: Rules, places: FloatArray) -> tuple[FloatArray, int]:
    """argmax_a det(P^-1 + J(x~, a)) over the places far enough from C95 (6.2.2).

    J = g g^T / sigma^2 with g = (y, -x) / r^2 has rank one: the determinant grows with g^T P g, P^-1 is not needed.
    """
    allowed = far_enough(belief, rules, places)
    x, y = estimated.x - places[:, 0], estimated.y - places[:, 1]
    r2 = np.maximum(x**2 + y**2, belief.h**2)
    gain = (estimated.xx * y**2 - 2.0 * estimated.xy * x * y + estimated.yy * x**2) / r2**2
    candidates = np.flatnonzero(allowed)
    best = int(candidates[np.argmax(gain[candidates] >= gain[candidates].max() * (1.0 - NEARLY))])
    return places[best], best if len(rules.places) else -1


def program_action(
    belief: Belief, estimated: PointEstimate, rules: Rules, place: FloatArray, lattice: int
) -> tuple[FloatArray, int, float]:
    """argmin_a t(place, a) + G(belief, a): the Gaussian dynamic program's choice, and G, s, there.

    Over the fixed lattice where there is one; else over the program's nodes beside the platform and staying, and over
    those on all sides inside the flight window when that place lies outside.
    """
    frame = principal_frame(estimated.x, estimated.y, estimated.xx, estimated.xy, estimated.yy)
    after = blended(rules.after, frame.s1 / rules.threshold, frame.s1 / frame.s2)
    if len(rules.places):
        distances = np.hypot(*(rules.places - place).T)
        if lattice >= 0 and len(rules.travel):
            distances = rules.travel[lattice]
        left = after_at(after, rules.nodes, frame, rules.places)
        costs = np.array([flight_time(rules, float(d), 0.0) for d in distances]) + left
        candidates = np.flatnonzero(far_enough(belief, rules, rules.places))
        best = int(candidates[_first_least(costs[candidates])])
        return rules.places[best], best, float(left[best])
    places, left = _beside(frame, rules, after, place)
    best = _first_least(_flights(rules, places - place) + left)
    near, near_left = places[best], float(left[best])
    if _in_window(rules, near):
        return near, -1, near_left
    places, left = _around(frame, rules, after)
    inside = _in_window(rules, places)
    if inside.any():
        best = _first_least(np.where(inside, _flights(rules, places - place) + left, np.inf))
        return places[best], -1, float(left[best])
    return np.clip(near, rules.window[:2], rules.window[2:]), -1, near_left


def _flights(rules: Rules, ways: FloatArray) -> FloatArray:
    """(n,) s for straight ways (n, 2), m."""
    return np.array([flight_time(rules, float(d), 0.0) for d in np.hypot(*ways.T)])


def _in_window(rules: Rules, places: FloatArray) -> BoolArray:
    """(...,) which places (..., 2) lie inside the flight window."""
    return np.all((places >= rules.window[:2]) & (places <= rules.window[2:]), axis=-1)


def _beside(frame: Frame, rules: Rules, after: FloatArray, place: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The nodes in the platform's quadrant, then where it is: places and seconds."""
    u1, u2 = frame.seen(place)
    sides = np.array([-1.0 if u1 < -NEARLY else 1.0, -1.0 if u2 < -NEARLY else 1.0])
    a, b = np.meshgrid(rules.nodes, rules.nodes, indexing="ij")
    places = frame.places(sides[0] * a.ravel(), sides[1] * b.ravel())
    stay = after_at(after, rules.nodes, frame, place[None])
    return np.concatenate((places, place[None])), np.concatenate((after.ravel(), stay))


def _around(frame: Frame, rules: Rules, after: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The nodes in all quadrants."""
    a, b = np.meshgrid(rules.nodes, rules.nodes, indexing="ij")
    places = [frame.places(i * a.ravel(), j * b.ravel()) for i in (1.0, -1.0) for j in (1.0, -1.0)]
    return np.concatenate(places), np.tile(after.ravel(), 4)


def _first_least(costs: FloatArray) -> int:
    return int(np.argmax(costs <= costs.min() * (1.0 + NEARLY)))


def far_enough(belief: Belief, rules: Rules, places: FloatArray) -> BoolArray:
    """(n,) which places keep r_min, or what it shrinks to, from C95 (6.1)."""
    if not rules.standoff > 0:
        return np.ones(len(places), dtype=bool)
    clearance = distance_to_convex(places, confidence_hull(belief))
    return clearance >= min(rules.standoff, second_largest(clearance)) - NEARLY * rules.standoff


def second_largest(values: FloatArray) -> float:
    """The second largest of (n,) values: r_min shrinks to it when fewer than two places are left (6.1)."""
    return float(np.sort(values)[-min(2, len(values))])


def confidence_hull(belief: Belief) -> FloatArray:
    """Convex hull of the heaviest cells that hold 95 % of the mass; whole bins of equal weight (1/16 octave) enter."""
    weight = np.ascontiguousarray(belief.weight)
    bins = weight.view(np.int64) >> HISTOGRAM_SHIFT
    below_top = bins.max() - bins
    counted = below_top < HISTOGRAM_BINS
    share = np.asarray(np.bincount(below_top[counted], weights=weight[counted]), dtype=np.float64)
    last = int(np.searchsorted(np.cumsum(share), CONFIDENCE * float(weight.sum()) * (1.0 - NEARLY)))
    return cells_hull(below_top <= last, belief.x0, belief.y0, belief.h)


def flight_time(rules: Rules, distance: float, turn: float) -> float:
    """Seconds to fly so far after turning (spec 7); see planner.motion, whose models these numbers are."""
    if rules.motion != FULL:
        return distance / rules.speed + rules.constant
    turned = abs((turn + np.pi) % (2 * np.pi) - np.pi) / rules.turn_rate
    if distance >= rules.speed**2 / rules.acceleration:
        return turned + distance / rules.speed + rules.speed / rules.acceleration + rules.constant
    return turned + 2.0 * np.sqrt(distance / rules.acceleration) + rules.constant
