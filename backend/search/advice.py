"""Where somebody on foot or in a car listens next, and what that would bring. Synchronous and pure; call in a thread.

The same planner as a craft's, with another mover: it goes as slowly as it says, turns an antenna by hand, and may stand
outside the fence, which is the craft's; what may not be flown over is kept off all the same. Who hops carries a craft
along, flies it straight up at each place, turns it once and takes it down again: then the craft's antenna listens, the
climb takes time, and the place is inside the fence.

Where ways and barriers were uploaded (`ground_ways`), the places are those that a way leads to, and every way counts as
long as it is; else ways are straight lines.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from shapely import MultiPoint, Point, Polygon, unary_union
from shapely.geometry.base import BaseGeometry
from shapely.ops import nearest_points

from backend.events import BearingMeasured
from backend.reasons import Reason
from backend.search import area
from backend.search.ground_ways import LaidOut, Traced, along_roads, ground_of, on_foot, within_reach
from backend.search.localization import Localization
from backend.search.planning import in_nine_of_ten
from backend.spec import LonLat, Place
from planner.belief.estimate import estimate
from planner.belief.grid import GridBelief
from planner.belief.verdict import missing_crossing, stated
from planner.geometry import contains
from planner.options import PlannerOptions
from planner.plan import plan
from planner.types import LinearConstantMotion, Problem, Region

HAND_SIGMA_RAD = math.radians(12.0)
"""Of a hand-held antenna and a phone's compass: what a reported bearing has unless its reporter says otherwise."""
HAND_TURN_S = 45.0
"""To turn an antenna by hand and to report what was heard."""
SET_OUT_S = 5.0
AROUND_M = 100.0
"""Somebody may stand this far outside the area."""
BESIDE_ROAD_M = 300.0
"""And who keeps to roads, this far."""
CLIMB_M_S, SINK_M_S = 2.5, 1.5
"""Of a craft that is flown straight up and down by hand."""
ENTERED_M = 1.0
"""Somebody who came into the fence stands this far inside."""
COARSEST_PLACES = 24
"""Places along the longer side: a person is not sent to the metre."""
COARSEST_ON_WAYS = 12
"""The same where ways are known: between every two places the shortest one is looked for."""
OPTIONS = PlannerOptions(base_policy="fisher", budget=300)


@dataclass(frozen=True, slots=True)
class Hop:
    """Straight up to altitude_m above the ground there, one turn of turn_s, straight down."""

    altitude_m: float
    up_s: float
    turn_s: float
    down_s: float

    @property
    def time_s(self) -> float:
        """From leaving the ground to standing on it again."""
        return self.up_s + self.turn_s + self.down_s


Along = Literal["straight", "around", "roads"]
"""What a way keeps to: nothing is known of the ground; around barriers and on all ways; to roads."""


@dataclass(frozen=True, slots=True)
class Course:
    """How one gets there. points: both ends included. length_m: along them. move_s: how long it takes. places: that
    were looked at, unreached: those of them that no way leads to."""

    along: Along
    points: tuple[LonLat, ...]
    length_m: float
    move_s: float
    places: int = 0
    unreached: int = 0


@dataclass(frozen=True, slots=True)
class Advice:
    """place: where to listen next. away_m, bearing_deg: as the crow flies. course: the way there.

    error_now_m: expected error as it is stated, error_then_m: about what is left of it after one bearing from there.
    mean_s, p90_s: until localized if every advice is followed; None: not known. bearings: that the advice knows of.
    hop: what to do there with a craft, None: listen with the antenna in one's hand.
    """

    place: Place
    away_m: float
    bearing_deg: float
    course: Course
    error_now_m: float
    error_then_m: float
    mean_s: float | None
    p90_s: float | None
    reason: Reason
    bearings: int
    hop: Hop | None = None


@dataclass(frozen=True, slots=True)
class Going:
    """How somebody gets on. hops: with a craft that is flown up at each place. on_roads: in a car. traced: what is
    known of the ground, empty: nothing."""

    speed_m_s: float
    hops: bool = False
    on_roads: bool = False
    traced: tuple[Traced, ...] = ()


def advise(task: Localization, measured: Sequence[BearingMeasured], here: Place, going: Going) -> Advice:
    """For one emitter. Raises PlannerError when there is nowhere to go, MissionInputError when no way leads there."""
    start = task.frame.to_enu(here)
    bearings = task.planner_bearings(measured)
    belief = task.planning_belief(bearings)
    hop = _hop(task) if going.hops else None
    going = replace(going, traced=within_reach(going.traced, task.frame, _around(task, 0.0)))
    around = _around(task, BESIDE_ROAD_M if going.on_roads and going.traced else AROUND_M)
    if not going.traced:
        around = around.union(Point(start)).convex_hull
    problem = _for_people(task, around, going.speed_m_s, hop)
    laid: LaidOut | None = None
    entering = start
    if going.traced:
        laid = _ways(task, problem, start, going)
        problem = replace(problem, ways=laid.ways)
    elif hop is not None:
        entering = _into(problem.flight_area, start)
    problem = replace(problem, crossing=missing_crossing(problem, task.rule, bearings, belief))
    decision = plan(problem, belief, bearings, entering, OPTIONS, threads=1)
    east, north = decision.x - start[0], decision.y - start[1]
    mean = estimate(belief, problem.estimator)
    now = stated(belief, mean, task.rule.threshold).expected_rmse
    left = _error_after(problem, belief, decision.x, decision.y) / mean.expected_rmse
    return Advice(
        place=task.place(decision.x, decision.y),
        away_m=math.hypot(east, north),
        bearing_deg=math.degrees(math.atan2(east, north)) % 360.0,
        course=_course(task, here, (decision.x, decision.y), going, laid),
        error_now_m=now,
        error_then_m=now * left,
        mean_s=float(decision.times.mean()) if len(decision.times) else None,
        p90_s=in_nine_of_ten(decision.times),
        reason=decision.reason,
        bearings=len(bearings),
        hop=hop,
    )


def _ways(task: Localization, problem: Problem, start: tuple[float, float], going: Going) -> LaidOut:
    """Raises MissionInputError when there are none."""
    closed = unary_union([Polygon(ring).buffer(0.0) for ring in problem.no_fly]) if problem.no_fly else Polygon()
    ground = ground_of(going.traced, task.frame, closed)
    assert problem.flight_area is not None
    allowed = Polygon(problem.flight_area[0])
    x_min, y_min, x_max, y_max = allowed.bounds
    spacing = max(task.problem.action_spacing or 0.0, max(x_max - x_min, y_max - y_min) / COARSEST_ON_WAYS)
    if going.on_roads and ground.roads:
        return along_roads(ground, start, allowed, spacing, going.speed_m_s)
    return on_foot(ground, start, allowed, spacing)


def _course(task: Localization, here: Place, end: tuple[float, float], going: Going, laid: LaidOut | None) -> Course:
    if laid is None:
        there = task.place(*end)
        length = math.dist(task.frame.to_enu(here), end)
        return Course("straight", ((here.lon, here.lat), (there.lon, there.lat)), length, length / going.speed_m_s)
    path = laid.ways.path(*end)
    return Course(
        "roads" if laid.on_roads else "around",
        tuple(task.frame.to_lon_lat(path)),
        float(np.hypot(*np.diff(path, axis=0).T).sum()),
        float(laid.ways.to(np.array([end]))[0]) / going.speed_m_s,
        laid.places,
        laid.unreached,
    )


def _hop(task: Localization) -> Hop:
    altitude = task.mission.flight.altitude_relative_m
    return Hop(altitude, altitude / CLIMB_M_S, task.problem.measurement_time, altitude / SINK_M_S)


def _into(fence: Region | None, start: tuple[float, float]) -> tuple[float, float]:
    """Where somebody who stands outside the fence comes into it: at the nearest point of its first ring; m ENU."""
    if fence is None or contains(fence, np.array([start]))[0]:
        return start
    ground = Polygon(fence[0]).buffer(-ENTERED_M)
    nearest = nearest_points(ground, Point(start))[0]
    return (nearest.x, nearest.y)


def from_area_m(task: Localization, here: Place) -> float:
    """How far somebody stands from the area, m; 0 inside."""
    ring = MultiPoint(np.concatenate(task.problem.area)).convex_hull
    return float(ring.distance(Point(task.frame.to_enu(here))))


def _around(task: Localization, margin: float) -> BaseGeometry:
    """The area with a margin, m."""
    corners = MultiPoint(np.concatenate(task.problem.area))
    return corners.convex_hull.buffer(margin, join_style="mitre")


def _for_people(task: Localization, around: BaseGeometry, speed_m_s: float, hop: Hop | None) -> Problem:
    problem = task.problem
    x_min, y_min, x_max, y_max = around.bounds
    spacing = max(problem.action_spacing or 0.0, max(x_max - x_min, y_max - y_min) / COARSEST_PLACES)
    fence = problem.flight_area if hop is not None else None
    return replace(
        problem,
        sigma=HAND_SIGMA_RAD if hop is None else problem.sigma,
        measurement_time=HAND_TURN_S if hop is None else hop.time_s,
        motion=LinearConstantMotion(speed_m_s, SET_OUT_S),
        flight_area=fence or area.region(around.buffer(1.0)),
        action_spacing=spacing,
    )


def _error_after(problem: Problem, belief: GridBelief, x: float, y: float) -> float:
    """Mean distance after one bearing from (x, y), m: the mean over the directions that it may have.

    sum_z p(z) mu(b | z), the directions in bins of about one sigma: p(z) is the mass that lies there, and what is left
    of the belief is weighed with the bearing's likelihood.
    """
    cx, cy = np.meshgrid(*belief.centres())
    rows, columns = np.nonzero(belief.density > 1e-7 * belief.density.max())
    mass, px, py = belief.density[rows, columns], cx[rows, columns], cy[rows, columns]
    mass = mass / mass.sum()
    direction = np.arctan2(py - y, px - x)
    middle = math.atan2(float(mass @ np.sin(direction)), float(mass @ np.cos(direction)))
    off = (direction - middle + np.pi) % (2.0 * np.pi) - np.pi
    edges = np.arange(off.min(), off.max() + problem.sigma, problem.sigma)
    error = 0.0
    for low in edges:
        share = float(mass[(off >= low) & (off < low + problem.sigma)].sum())
        if share <= 0.0:
            continue
        left = mass * np.exp(-0.5 * ((off - low - 0.5 * problem.sigma) / problem.sigma) ** 2)
        left /= left.sum()
        error += share * float(left @ np.hypot(px - left @ px, py - left @ py))
    return error
