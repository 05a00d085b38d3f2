"""The words of the theory as data: what every belief, policy and selection takes and returns.

Frame: local east-north-up (ENU) metres. Angles: radians, counter-clockwise from east. Times: seconds.
Source: F. Hoffmann's thesis on sensor path planning for emitter localization (spec sections 1-4, 7).
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from planner.crossing import Crossing
from planner.options import FIELD, CellLikelihood, Estimator
from planner.reason import ReasonedError
from planner.reasons import ChoiceReason, NotYetReason, RefusalReason
from planner.ways import Ways

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]

Ring = FloatArray
"""(n, 2) vertices in metres ENU, not closed (the last vertex differs from the first), either orientation."""

Region = tuple[Ring, ...]
"""Rings combined by the even-odd rule: one ring is a polygon, a ring inside another is a hole, disjoint rings a set."""


class PlannerError(ReasonedError):
    """The planner refuses what it was given, or finds nowhere to go."""

    def __init__(self, reason: RefusalReason) -> None:
        super().__init__(reason)
        self._refusal: RefusalReason = reason

    @property
    def reason(self) -> RefusalReason:
        """Why the planner refuses."""
        return self._refusal


class InconsistentBearings(PlannerError):
    """The +-4 sigma wedges have no common point inside the area."""


@dataclass(frozen=True, slots=True)
class Peak:
    """Another direction that one sweep may mean. `angle` rad; `weight` relative to the main peak's weight of 1."""

    angle: float
    weight: float


@dataclass(frozen=True, slots=True)
class Bearing:
    """One bearing z = atan2(y_t - y_s, x_t - x_s) + w, w ~ N(0, sigma^2), taken at (x, y) (4.2).

    x, y: sensor position, m ENU. angle, sigma: rad. `outlier_probability` eps mixes in a uniform likelihood,
    (1 - eps) * sum_i w_i N(angle_i, sigma) + eps / (2 pi); with eps = 0 the wedge is hard at +-4 sigma. source: who
    took it; a joint belief (planner.belief.joint) gives the bearings of one source one bias, scale and outlier rate.
    taken_at: s on any clock; counts for emitters that move only. profile: natural log of what its sweep says of the
    directions 2 pi k / m, ccw from east, any offset; empty: only angle, sigma and peaks are known. A joint belief takes
    it in their place.
    """

    x: float
    y: float
    angle: float
    sigma: float
    outlier_probability: float = 0.0
    peaks: tuple[Peak, ...] = ()
    source: str = ""
    taken_at: float = 0.0
    profile: tuple[float, ...] = ()


@dataclass(frozen=True, slots=True)
class UniformPrior:
    """Uniform on the target area."""


@dataclass(frozen=True, slots=True)
class GaussianPrior:
    """N((x, y), covariance) cut to the target area. `covariance` (2, 2), m^2."""

    x: float
    y: float
    covariance: FloatArray


@dataclass(frozen=True, slots=True)
class RingPrior:
    """Uniform in area between two radii (m) around (x, y), cut to the target area: a known detection range."""

    x: float
    y: float
    inner: float
    outer: float


Prior = UniformPrior | GaussianPrior | RingPrior


@dataclass(frozen=True, slots=True)
class LinearMotion:
    """t = |d| / speed."""

    speed: float


@dataclass(frozen=True, slots=True)
class LinearConstantMotion:
    """t = |d| / speed + constant (thesis 6.4.3: 7 m/s, 11.2 s)."""

    speed: float
    constant: float


@dataclass(frozen=True, slots=True)
class FullMotion:
    """Turn, accelerate, cruise, decelerate, settle (thesis 6.4.3: 30 deg/s, 1 m/s^2, 8 m/s, 3 s)."""

    turn_rate: float = np.deg2rad(30.0)
    acceleration: float = 1.0
    speed: float = 8.0
    constant: float = 3.0


Motion = LinearMotion | LinearConstantMotion | FullMotion


@dataclass(frozen=True, slots=True)
class SectorTurns:
    """A measurement turns through the directions that are expected at its place, not through all of them.

    turn_rate: rad/s. share: of the expected directions that the sector is laid around. margin: rad on either side.
    narrowest, widest: rad; a wider one is turned as a whole circle.
    """

    turn_rate: float
    share: float = 0.9
    margin: float = np.deg2rad(45.0)
    narrowest: float = np.deg2rad(200.0)
    widest: float = np.deg2rad(270.0)

    def width(self, arc: float) -> float:
        """Radians to turn for expected directions within an arc, rad."""
        wanted = max(arc + 2.0 * self.margin, self.narrowest)
        return wanted if wanted <= self.widest else 2.0 * np.pi


@dataclass(frozen=True, slots=True)
class Legs:
    """The craft turns at no place: what it hears on the way there counts as a bearing from there.

    least: m, of a leg; a shorter one tells nothing. sigma: rad, of the bearing that a leg is worth. pause: s, between
    two legs.
    """

    least: float
    sigma: float
    pause: float


@dataclass(frozen=True, slots=True)
class Problem:
    """One localization task, everything that does not change while it is flown.

    area: where the emitter may be. flight_area: where the platform may be (None: anywhere). no_fly: what it must not
    enter or cross. sigma: rad, the bearing noise the planner assumes. threshold: mu, m. measurement_time: t_m, s.
    standoff: r_min, m: actions nearer than this to C95 are removed (0: unconstrained).
    action_grid: X x Y cells over the tripled belief rectangle (4.24-4.28); action_spacing: a fixed lattice (m) over
    the flight area instead (the field system: 15 m). likelihood: of a cell of a hard wedge, in the localizer and in
    rollouts. sector_turns: None: a measurement takes as long everywhere. next_source: who takes the bearings to come;
    None: who took those that came. ways: of somebody on the ground, with the only places to measure at; None: straight
    flights, around what is not flown over. crossing: what the next bearing must cross, where a claim waits for that.
    legs: None: a bearing is a turn at its place. turned_at: m ENU, where bearings were taken: one from
    nearby shares their echoes.
    """

    area: Region
    sigma: float
    threshold: float
    measurement_time: float
    motion: Motion
    flight_area: Region | None = None
    no_fly: Region = ()
    standoff: float = 0.0
    action_grid: tuple[int, int] = (20, 20)
    action_spacing: float | None = None
    estimator: Estimator = FIELD.estimator
    likelihood: CellLikelihood = "centre"
    prior: Prior = field(default_factory=UniformPrior)
    sector_turns: SectorTurns | None = None
    next_source: str | None = None
    ways: Ways | None = None
    crossing: Crossing | None = None
    legs: Legs | None = None
    turned_at: tuple[tuple[float, float], ...] = ()


@dataclass(frozen=True, slots=True)
class Estimate:
    """Point estimate and spread of a belief.

    x, y: m ENU. covariance: (2, 2) m^2 about the point (3.34). expected_rmse: mu(b) = sum p |x~ - x|, m (3.58).
    entropy: nat (3.59).
    """

    x: float
    y: float
    covariance: FloatArray
    expected_rmse: float
    entropy: float


@dataclass(frozen=True, slots=True)
class Candidate:
    """One first action and what the selection learned of it.

    x, y: m ENU. value: mean time until localization, s. std_error: s. rollouts: sample paths spent on it.
    dropped_in_round: 1-based round that eliminated it, None when it survived to the end.
    """

    x: float
    y: float
    value: float
    std_error: float
    rollouts: int
    dropped_in_round: int | None


@dataclass(frozen=True, slots=True)
class Decision:
    """What a policy answers. x, y: the next measurement place, m ENU.

    reason: why this place. candidates: empty for policies that compare none.
    times: (n,) s, sampled times until localization by way of the chosen action (empty when not sampled).
    each: (E, n) s, of several emitters those of each, in the order in which they were asked for; times: of the last.
    rollouts: sample paths used.
    """

    x: float
    y: float
    reason: ChoiceReason
    candidates: tuple[Candidate, ...] = ()
    times: FloatArray = field(default_factory=lambda: np.empty(0))
    each: FloatArray = field(default_factory=lambda: np.empty((0, 0)))
    rollouts: int = 0


@dataclass(frozen=True, slots=True)
class LocalizationRule:
    """When "localized" may be said (design, mission rule 6).

    threshold: mu, m. min_places: from how many distinct places there must be bearings. min_place_distance: m between
    distinct places. min_crossing_angle: rad, the best crossing angle of two bearing lines at the estimate. ways: a leg
    on which the emitter was heard is such a place, too (planner.belief.seen_on_the_way).
    """

    threshold: float
    min_places: int = 2
    min_place_distance: float = 10.0
    min_crossing_angle: float = np.deg2rad(20.0)
    ways: bool = False


@dataclass(frozen=True, slots=True)
class Verdict:
    """localized, or the reasons why not yet.

    consistent: the wedges have a common point. estimate: what the belief says, None when the bearings are inconsistent.
    against: indices of the bearings that do not point at the estimate. ways: of legs that may count as places, by name,
    what they say of the estimate (planner.belief.seen_on_the_way).
    """

    localized: bool
    consistent: bool
    reasons: tuple[NotYetReason, ...]
    estimate: Estimate | None = None
    against: tuple[int, ...] = ()
    ways: tuple[tuple[str, float], ...] = ()
