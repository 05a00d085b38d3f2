"""What the planner is asked to do about one emitter, from the specification: its problem, rule and first belief."""

from __future__ import annotations

import math
from dataclasses import replace

from shapely import Point, unary_union
from shapely.geometry.base import BaseGeometry

from backend import spec
from backend.search import area
from backend.search.area import EDGE_TOLERANCE_M
from backend.search.given import motion_of, prior_of
from backend.search.never_stop import legs_of
from backend.search.source_priors import priors_of
from backend.search.turn_schedule import turn_s
from backend.spec import MissionSpec
from hardware.frame import LocalFrame
from planner.belief.grid import GridBelief, prior_belief
from planner.belief.joint import joint_prior
from planner.belief.moving import Assumed, moving_prior
from planner.movement import DRIFTING_S, PURPOSEFUL_S, WALKING_S, Movement
from planner.types import LocalizationRule, Problem, SectorTurns

PERSISTENCE_S = {"animal": WALKING_S, "walking": PURPOSEFUL_S, "drifting": DRIFTING_S}
"""By the kind of movement."""

KEEP_OFF_M = 1.1 * EDGE_TOLERANCE_M
"""The planner's places and ways keep this distance from no-fly zones: a little more than safety asks."""


def problem_of(
    mission: MissionSpec, emitter: spec.EmitterSpec, frame: LocalFrame, closed: BaseGeometry | None = None
) -> Problem:
    """In ENU of `frame`. closed: where no place is looked for either. Raises MissionInputError when the areas make no
    sense there."""
    target = area.target_area(mission, frame)
    area.check_reach(target)
    fence, zones = area.fence(mission, target, frame), area.no_fly(mission, frame)
    planner, sensor, wanted = mission.planner, mission.sensor, mission.localization
    problem = Problem(
        area=area.region(target),
        sigma=math.radians(sensor.sigma_deg),
        threshold=wanted.expected_rmse_m,
        measurement_time=turn_s(mission),
        motion=motion_of(planner.motion),
        flight_area=area.region(fence),
        no_fly=area.region(unary_union([*zones, closed or Point()]).buffer(KEEP_OFF_M, join_style="mitre")),
        standoff=planner.standoff_m,
        action_spacing=planner.action_spacing_m,
        estimator=planner.estimator,
        prior=prior_of(emitter.prior, frame),
        sector_turns=_sector_turns(mission),
        legs=legs_of(mission),
    )
    if (walk := _walk(emitter.movement)) is not None:
        problem = replace(problem, threshold=walk.goal(wanted.expected_rmse_m, problem.measurement_time))
    return problem


def rule_of(mission: MissionSpec, problem: Problem) -> LocalizationRule:
    """When the emitter of this problem counts as localized."""
    sensor, wanted = mission.sensor, mission.localization
    return LocalizationRule(
        threshold=problem.threshold,
        min_places=wanted.minimum_places,
        min_place_distance=wanted.minimum_place_distance_m,
        min_crossing_angle=math.radians(wanted.minimum_crossing_angle_deg),
        ways=sensor.never_stop,
    )


def prior_belief_of(problem: Problem, sensor: spec.SensorSpec, movement: spec.MovementSpec) -> GridBelief:
    """Before any bearing. Raises PlannerError when the prior leaves no place."""
    walk = _walk(movement)
    if walk is not None:
        known, otherwise = priors_of(sensor) if sensor.bearing_errors == "joint" else ({}, None)
        return moving_prior(problem, Assumed(walk, known, otherwise))
    match sensor.bearing_errors:
        case "joint":
            known, otherwise = priors_of(sensor)
            return joint_prior(problem, known, otherwise)
        case "independent":
            return prior_belief(problem)


def _sector_turns(mission: MissionSpec) -> SectorTurns | None:
    """None: every turn is a whole one, as it always is for several emitters and for tags."""
    (emitter, *others) = mission.emitters
    if others or emitter.kind == "pulsed" or not mission.sensor.turns_in_sectors:
        return None
    return SectorTurns(math.radians(mission.sensor.turn_rate_deg_s))


def _walk(movement: spec.MovementSpec) -> Movement | None:
    """None for one that stands still."""
    if movement.kind == "still":
        return None
    return Movement(movement.speed_m_s, PERSISTENCE_S[movement.kind])
