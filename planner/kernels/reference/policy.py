"""Where a rollout goes next, and the time of the way there."""

from __future__ import annotations

import numpy as np

from planner.geometry import distance_to_convex
from planner.kernels.model import DYNAMIC_PROGRAM, ELLIPSE, FULL, Rules
from planner.kernels.reference.belief import NEARLY, Belief, PointEstimate, confidence_hull
from planner.kernels.value.lookup import Frame, after_at, blended, principal_frame
from planner.types import BoolArray, FloatArray


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


def flight_time(rules: Rules, distance: float, turn: float) -> float:
    """Seconds to fly so far after turning (spec 7); see planner.motion, whose models these numbers are."""
    if rules.motion != FULL:
        return distance / rules.speed + rules.constant
    turned = abs((turn + np.pi) % (2 * np.pi) - np.pi) / rules.turn_rate
    if distance >= rules.speed**2 / rules.acceleration:
        return turned + distance / rules.speed + rules.speed / rules.acceleration + rules.constant
    return turned + 2.0 * np.sqrt(distance / rules.acceleration) + rules.constant
