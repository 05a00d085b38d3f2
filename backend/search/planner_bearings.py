"""Bearings that were measured, in the planner's words: place in ENU, angles in rad ccw from east, sources by name."""

from __future__ import annotations

import math

import numpy as np

from backend.events import BearingMeasured, BearingSource, CraftSource, ImportSource, PersonSource
from backend.search.silences import EAST_DEG
from hardware.direction_finding.circle import LikelihoodError, SweepLikelihood
from hardware.frame import LocalFrame, compass_to_angle
from planner.belief.joint import SMALLEST_SIGMA
from planner.types import Bearing, Peak


def planner_bearing(
    fact: BearingMeasured, frame: LocalFrame, outlier_probability: float, joint: bool, moving: bool, whole_sweeps: bool
) -> Bearing:
    """joint: what all of a source's bearings share is estimated, so that sigma is of the rest only. moving: the belief
    asks when it was taken. whole_sweeps: with the sweep's likelihood, where it was kept."""
    east, north = frame.to_enu(fact.place)
    return Bearing(
        x=east,
        y=north,
        angle=compass_to_angle(fact.bearing_deg),
        sigma=math.radians(own_sigma_deg(fact) if joint else fact.sigma_deg),
        outlier_probability=outlier_probability,
        peaks=tuple(Peak(compass_to_angle(p.bearing_deg), p.weight) for p in fact.peaks),
        source=source_name(fact.source),
        taken_at=(fact.taken_at_s or 0.0) if moving else 0.0,
        profile=_profile(fact) if whole_sweeps else (),
    )


def own_sigma_deg(fact: BearingMeasured) -> float:
    """Of what differs from bearing to bearing: the shares of heading and pattern are the same for all of a source.
    Where they leave nothing, the smallest that a belief takes a bearing to have."""
    own = fact.sigma_deg**2 - fact.heading_sigma_deg**2 - fact.pattern_sigma_deg**2
    return math.sqrt(own) if own > 0.0 else math.degrees(SMALLEST_SIGMA)


def source_name(source: BearingSource) -> str:
    """As the planner tells sources apart."""
    match source:
        case CraftSource(craft_id=name) | PersonSource(name=name) | ImportSource(recording_id=name):
            return f"{source.kind}:{name}"


def _profile(fact: BearingMeasured) -> tuple[float, ...]:
    """Natural log at the angles 0, 1, .. 359 degrees ccw from east; empty for a bearing whose sweep was not kept.

    A likelihood that cannot be unpacked is none: the bearing counts by its peak and sigma.
    """
    if fact.likelihood is None:
        return ()
    try:
        said = SweepLikelihood.unpacked(fact.likelihood).log_likelihood
    except LikelihoodError:
        return ()
    return tuple(said[(EAST_DEG - np.arange(len(said))) % len(said)].tolist())
