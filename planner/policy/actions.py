"""Where the platform may measure next: the action space and its constraints (4.24-4.28, 6.1).

Either the X x Y cells of the tripled belief rectangle, or a fixed lattice over the flight area (the field system).
No-fly areas, the flight area, and a minimum distance to C95 remove actions.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from planner.airspace import may_fly
from planner.belief.estimate import confidence_region
from planner.belief.grid import GridBelief
from planner.geometry import bounds, centres, distance_to_convex
from planner.reasons import NoPlaceToFly, TooManyPlaces, UnusableNumber
from planner.types import BoolArray, FloatArray, PlannerError, Problem

MOST_PLACES = 20_000
"""A finer lattice is refused: no budget could tell its places apart, and no map could show them."""
SAME_PLACE_M = 5.0
"""Nearer to a refused place than this is the same place: what stands against one stands against the other."""
OTHER_ECHOES_M = 25.0
"""Echoes and shadows are those of a place: a bearing from nearer to another one is off by the same."""

Usable = Callable[[FloatArray], FloatArray]
"""Those of the places (n, 2), m, that may be chosen."""


def action_space(problem: Problem, belief: GridBelief) -> FloatArray:
    """(n, 2) m: every place where the platform may measure, whatever its distance to C95."""
    places = (
        lattice(problem)
        if problem.action_spacing is not None or problem.ways is not None
        else belief_grid(problem, belief)
    )
    allowed = may_fly(problem, places)
    if not allowed.any():
        raise PlannerError(NoPlaceToFly())
    return places[allowed]


def constrained_actions(problem: Problem, belief: GridBelief, usable: Usable | None = None) -> FloatArray:
    """(n, 2) m: the action space without the places nearer than r_min to C95, and without those that cross too little.

    When fewer than two would be left, r_min shrinks until two are (6.1). usable: among which places that is, and the
    widest crossing is looked for, where one is asked for; None: all that have echoes of their own.
    """
    places = action_space(problem, belief)
    places = with_own_echoes(places, problem) if usable is None else usable(places)
    if problem.crossing is not None:
        places = places[problem.crossing.crossed_from(places)]
    standoff = standoff_from(belief, problem)
    if standoff <= 0 or len(places) == 0:
        return places
    clearance = distance_to_convex(places, confidence_region(belief))
    return places[clearance >= min(standoff, np.sort(clearance)[-min(2, len(clearance))])]


def standoff_from(belief: GridBelief, problem: Problem) -> float:
    """r_min, m, to keep from this belief's C95 (6.1). 0 for a flat prior without a bearing: its C95 is the whole
    searched area, and keeping away from it would mean turning outside first."""
    return 0.0 if belief.flat_prior and belief.bearings == 0 else problem.standoff


def without_refused(
    places: FloatArray, refused: Sequence[tuple[float, float]], problem: Problem, belief: GridBelief
) -> FloatArray:
    """(n, 2) m: those that lie half a spacing, and at least SAME_PLACE_M, from every refused one (m ENU).

    While no standoff is asked for, a turn in vain may have been made above the emitter: r_min from every refused one
    where any place is so far.
    """
    near = max(0.5 * (problem.action_spacing or belief.h), SAME_PLACE_M)
    away = from_nearest(places, refused)
    if standoff_from(belief, problem) < problem.standoff and (away >= max(problem.standoff, near)).any():
        near = max(problem.standoff, near)
    return places[away >= near]


def with_own_echoes(places: FloatArray, problem: Problem) -> FloatArray:
    """(n, 2) m: those at least OTHER_ECHOES_M from where a turn was made already; where none is, the farthest."""
    return places[own_echoes(places, problem)]


def own_echoes(places: FloatArray, problem: Problem) -> BoolArray:
    """(n,) which of the places (n, 2), m, `with_own_echoes` keeps; at least one."""
    away = from_nearest(places, problem.turned_at)
    return np.asarray(away >= apart_from_turns(away))


def apart_from_turns(away: FloatArray) -> float:
    """m to keep from where turns were made, of places (n,) m away from them."""
    return float(min(OTHER_ECHOES_M, away.max(initial=0.0)))


def from_nearest(places: FloatArray, others: Sequence[tuple[float, float]]) -> FloatArray:
    """(n,) m from each place (n, 2) to the nearest of the others, m; infinite where there are none."""
    away = np.full(len(places), np.inf)
    for other in others:
        away = np.minimum(away, np.hypot(*(places - np.array(other)).T))
    return away


def lattice(problem: Problem) -> FloatArray:
    """(n, 2) m: centres of as many squares of `action_spacing` as fit each way into the flight area's rectangle.

    West to east first; no place stands on the fence. Somebody on the ground has the places of their ways instead.
    """
    if problem.ways is not None:
        return problem.ways.places
    spacing = problem.action_spacing
    if spacing is None or not (np.isfinite(spacing) and spacing > 0):
        raise PlannerError(UnusableNumber("action_spacing", "positive", str(spacing)))
    x_min, y_min, x_max, y_max = bounds(problem.area if problem.flight_area is None else problem.flight_area)
    if (x_max - x_min) * (y_max - y_min) > MOST_PLACES * spacing**2:
        finest = np.ceil(np.sqrt((x_max - x_min) * (y_max - y_min) / MOST_PLACES))
        raise PlannerError(TooManyPlaces(float(spacing), MOST_PLACES, float(finest)))
    x, y = _centred(x_min, x_max, spacing), _centred(y_min, y_max, spacing)
    return _product(x, y)


def belief_grid(problem: Problem, belief: GridBelief) -> FloatArray:
    """(X Y, 2) m: cell centres of the action rectangle; west to east first."""
    nx, ny = problem.action_grid
    if nx < 1 or ny < 1:
        raise PlannerError(UnusableNumber("action_grid", "at_least_one", f"{nx} x {ny}"))
    left, bottom, right, top = action_rectangle(problem, belief)
    return _product(centres(left, (right - left) / nx, nx), centres(bottom, (top - bottom) / ny, ny))


def action_rectangle(problem: Problem, belief: GridBelief) -> tuple[float, float, float, float]:
    """(x_min, y_min, x_max, y_max), m: the belief rectangle tripled, cut with the flight area's if they meet."""
    x_min, y_min, x_max, y_max = belief.bounds
    width, height = x_max - x_min, y_max - y_min
    window = flight_window(problem)
    left, right = max(x_min - width, window[0]), min(x_max + width, window[2])
    bottom, top = max(y_min - height, window[1]), min(y_max + height, window[3])
    if left >= right or bottom >= top:
        left, bottom, right, top = window
    return float(left), float(bottom), float(right), float(top)


def flight_window(problem: Problem) -> FloatArray:
    """(x_min, y_min, x_max, y_max) of the flight area, infinite when there is none."""
    if problem.flight_area is None:
        return np.array([-np.inf, -np.inf, np.inf, np.inf])
    return np.array(bounds(problem.flight_area))


def _centred(low: float, high: float, spacing: float) -> FloatArray:
    count = max(1, int((high - low) / spacing + 1e-9))
    return centres(0.5 * (low + high - count * spacing), spacing, count)


def _product(x: FloatArray, y: FloatArray) -> FloatArray:
    return np.column_stack([np.tile(x, len(y)), np.repeat(y, len(x))])
