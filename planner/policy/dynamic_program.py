"""The Gaussian dynamic program as a policy, and as the source of the places that rollouts compare.

argmin_a t(p, a) + G(N(mean, covariance), a), with G from the table (planner.policy.value_table).
"""

from __future__ import annotations

import numpy as np

from planner.airspace import may_fly
from planner.belief.estimate import confidence_region, estimate
from planner.belief.grid import GridBelief
from planner.geometry import distance_to_convex, distance_to_edges
from planner.kernels.value.lookup import Frame, after_at, blended, principal_frame
from planner.kernels.value.model import nodes
from planner.legs import far_enough
from planner.motion import flight_time
from planner.options import BasePolicy
from planner.policy.actions import Usable, constrained_actions, standoff_from
from planner.policy.ellipse import ellipse
from planner.policy.fisher import fisher
from planner.policy.value_table import ProgramTable, program_for
from planner.reasons import QuickestPlace
from planner.travel import straight_suffices, travel_distances, visibility_graph
from planner.types import Decision, FloatArray, Problem

SHARE_APART, LEAST_APART = 0.12, 1.0
"""Places to compare keep this share of s1, and this many m, from each other."""


def dynamic_program(
    problem: Problem, belief: GridBelief, platform: tuple[float, float], rng: np.random.Generator | None = None
) -> Decision:
    """The allowed place with the least time left; what stands in for the program while there is no table for it."""
    table = program_for(problem)
    if table is None:
        return (fisher if substitute(problem) == "fisher" else ellipse)(problem, belief, platform, rng)
    places, seconds = best_places(problem, belief, platform, table, count=2)
    gain = float(seconds[1] - seconds[0]) if len(places) > 1 else 0.0
    return Decision(float(places[0, 0]), float(places[0, 1]), QuickestPlace(float(seconds[0]), gain, len(places)))


def substitute(problem: Problem) -> BasePolicy:
    """The base policy while there is no table: Fisher's where places are a lattice, else the ellipse policy."""
    return "ellipse" if problem.action_spacing is None else "fisher"


def stands_on(problem: Problem, wanted: BasePolicy) -> tuple[BasePolicy, ProgramTable | None]:
    """The base policy that rollouts follow now, and its table: a substitute while the program has none."""
    if wanted != "dynamic_program":
        return wanted, None
    table = program_for(problem)
    return (substitute(problem), None) if table is None else (wanted, table)


def best_places(
    problem: Problem,
    belief: GridBelief,
    platform: tuple[float, float],
    table: ProgramTable,
    count: int,
    usable: Usable | None = None,
) -> tuple[FloatArray, FloatArray]:
    """At most `count` allowed places (n, 2), m, and the seconds until localized by way of them (n,), best first.

    Chosen greedily from the program's nodes and half-way between them, on all sides of the mean, so that no two are
    close to each other; where no straight flight may do, and where constraints leave none of these, from the lattice.
    usable: as in `constrained_actions`, and what is compared is chosen among these: of those near to each other about a
    refused place none might be left.
    """
    here = np.array(platform, dtype=float)
    frame = belief_frame(belief)
    after = blended(table.adapted(problem), frame.s1 / problem.threshold, frame.s1 / frame.s2)
    places = np.empty((0, 2))
    if straight_suffices(problem):
        places = _allowed(problem, belief, np.concatenate((_half_steps(frame), here[None])), usable)
    if len(places) < 2:
        places = constrained_actions(problem, belief, usable)
    places = far_enough(problem, here, places)
    if usable is not None and len(left := usable(places)) > 0:
        places = left
    seconds = _flights(problem, here, places) + after_at(after, nodes(), frame, places)
    order = np.argsort(seconds, kind="stable")
    chosen = _apart(places[order], count, max(LEAST_APART, SHARE_APART * frame.s1))
    return places[order][chosen], seconds[order][chosen]


def belief_frame(belief: GridBelief) -> Frame:
    """The principal frame about the belief's mean."""
    spread = estimate(belief, "expected_value")
    (xx, xy), (_, yy) = spread.covariance
    return principal_frame(spread.x, spread.y, float(xx), float(xy), float(yy))


def _half_steps(frame: Frame) -> FloatArray:
    own = nodes()
    half = np.sort(np.concatenate((own, 0.5 * (own[1:] + own[:-1]))))
    axis = np.concatenate((-half[:0:-1], half))
    u1, u2 = np.meshgrid(axis, axis)
    return frame.places(u1.ravel(), u2.ravel())


def _allowed(problem: Problem, belief: GridBelief, places: FloatArray, usable: Usable | None) -> FloatArray:
    places = places[may_fly(problem, places)]
    if problem.crossing is not None and len(places) > 0:
        places = places if usable is None else usable(places)
        places = places[problem.crossing.crossed_from(places)]
    if problem.action_spacing is not None and problem.flight_area is not None:  # off the fence as a lattice's are
        places = places[distance_to_edges(places, problem.flight_area) >= 0.5 * problem.action_spacing]
    standoff = standoff_from(belief, problem)
    if standoff > 0 and len(places) > 0:
        places = places[distance_to_convex(places, confidence_region(belief)) >= standoff]
    return places


def _flights(problem: Problem, here: FloatArray, places: FloatArray) -> FloatArray:
    if straight_suffices(problem):
        distances = np.hypot(*(places - here).T)
    else:
        distances = travel_distances(problem, visibility_graph(problem), here, places)
    return flight_time(problem.motion, distances, np.pi / 2)


def _apart(places: FloatArray, count: int, apart: float) -> list[int]:
    """Indices of the first `count` places (n, 2) that are at least `apart` m from all before them."""
    chosen: list[int] = []
    left, x, y = np.arange(len(places)), places[:, 0], places[:, 1]
    while len(chosen) < count and len(left):
        chosen.append(int(left[0]))
        free = (x - x[0]) ** 2 + (y - y[0]) ** 2 >= apart**2
        free[0] = False
        left, x, y = left[free], x[free], y[free]
    return chosen
