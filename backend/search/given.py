"""Motion and prior of a specification, as the planner takes them."""

from __future__ import annotations

import math

import numpy as np

from backend import spec
from hardware.frame import LocalFrame, compass_to_angle
from planner.types import (
    FullMotion,
    GaussianPrior,
    LinearConstantMotion,
    LinearMotion,
    Motion,
    Prior,
    RingPrior,
    UniformPrior,
)


def motion_of(motion: spec.MotionSpec) -> Motion:
    """Speeds in m/s and turn rates in rad/s."""
    match motion:
        case spec.LinearMotionSpec():
            return LinearMotion(motion.speed_m_s)
        case spec.LinearConstantMotionSpec():
            return LinearConstantMotion(motion.speed_m_s, motion.constant_s)
        case spec.FullMotionSpec():
            rate = math.radians(motion.turn_rate_deg_s)
            return FullMotion(rate, motion.acceleration_m_s2, motion.speed_m_s, motion.constant_s)


def prior_of(prior: spec.PriorSpec, frame: LocalFrame) -> Prior:
    """In metres east and north of the frame's origin."""
    match prior:
        case spec.UniformPriorSpec():
            return UniformPrior()
        case spec.GaussianPriorSpec():
            x, y = frame.to_enu(prior.centre)
            angle = compass_to_angle(prior.major_axis_deg)
            turn = np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]])
            variances = np.diag([prior.sigma_major_m**2, prior.sigma_minor_m**2])
            return GaussianPrior(x, y, turn @ variances @ turn.T)
        case spec.RingPriorSpec():
            x, y = frame.to_enu(prior.centre)
            return RingPrior(x, y, prior.inner_m, prior.outer_m)
