"""Is what the search claims true? Whole missions in worlds whose errors know nothing of the filter's model.

Every mission has an emitter anywhere in the area and a sensor with errors of its own (planner.study.error_worlds). The
base policy chooses the places, and the mission ends when the verdict says "localized" or with its last bearing. What is
counted is counted at the claim: belief and estimate are those that the operator would act on.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass, replace
from math import isfinite
from typing import Any, Literal

import numpy as np

from planner.belief.estimate import confidence_region, estimate, mass_within
from planner.belief.grid import GridBelief, prior_belief, update
from planner.belief.joint import JointBelief, joint_prior, update_joint
from planner.belief.learning import flight_evidence, learned
from planner.belief.moving import MovingBelief
from planner.belief.source_errors import ErrorPrior
from planner.belief.verdict import stated, verdict
from planner.geometry import bounds, contains, distance_to_convex
from planner.motion import flight_time
from planner.shares import wilson
from planner.study.error_worlds import ROWS, Row
from planner.study.errors import StudyError
from planner.study.truth_planners import TruthPlanner, next_place
from planner.types import Bearing, FloatArray, InconsistentBearings, LocalizationRule, Problem

Model = Literal["joint", "independent"]
DOUBT = 0.1
"""Outlier probability of the independent model: the default of a mission."""
SOURCES = ("craft", "somebody else")
BEYOND = 3.0
"""Times the stated error."""
UNKNOWN, TOLD = "nothing", "the true errors"
"""What may be known of a sensor before, besides what flights taught."""
SMALLEST_TOLD = np.deg2rad(0.25)
FEWEST_TOLD = 1e-3


@dataclass(frozen=True, slots=True)
class Claim:
    """What came of one mission. time_s: until its end. error_m, stated_m, rms_m, in_c95, far_chance: at the claim.
    stated_m is what the claim states, rms_m the belief's root mean square distance, far_chance its own probability that
    the error is beyond three times what is stated.

    bias_off_deg, bias_sd_deg: what the belief was wrong by about the bias of the bearings, and what it stated of that
    (NaN: it knows none). found_s: of one of several emitters, until it was claimed, else until the mission's end; None
    where there is but one.
    """

    seed: int
    claimed: bool
    in_c95: bool
    error_m: float
    stated_m: float
    rms_m: float
    far_chance: float
    bearings: int
    time_s: float
    bias_off_deg: float
    bias_sd_deg: float
    found_s: float | None = None

    @property
    def beyond(self) -> bool:
        """Whether a claim was wrong by more than three times what it stated."""
        return self.claimed and self.error_m > BEYOND * self.stated_m


@dataclass(frozen=True, slots=True)
class Truth:
    """Of all missions of a row. claimed, in_c95, beyond_3x: shares in [0, 1] of the claims that could be made, one an
    emitter, the last two of those that were.

    in_c95_low, in_c95_high: Wilson's 95 % interval, wider where the tags of a mission hang together. beyond_low,
    beyond_high: the same of beyond_3x. beyond_believed: what the beliefs themselves said of it at the claims.
    beyond_seeds: the missions beyond, to look at. beyond_3rms:
    share beyond three times the root mean square that the belief gives. mean_s: s until the claim or the last bearing.
    bias_inside: share in which the bias was within two of its stated standard deviations. prior: what was known of the
    sensor before. planner: who chose the places. shared: what one tag's bearings told of the compass counted for all.
    first_s: of several emitters, mean s until the first of them was claimed, which in some rows is the most important.
    """

    row: str
    model: Model
    missions: int
    claimed: float
    in_c95: float
    in_c95_low: float
    in_c95_high: float
    beyond_3x: float
    beyond_low: float
    beyond_high: float
    beyond_believed: float
    beyond_seeds: tuple[int, ...]
    beyond_3rms: float
    mean_s: float
    bearings_mean: float
    error_mean_m: float
    stated_mean_m: float
    bias_inside: float
    prior: str = UNKNOWN
    planner: TruthPlanner = "fisher"
    shared: bool = False
    first_s: float | None = None

    def as_json(self) -> dict[str, Any]:
        """Shares and times rounded to what the missions can tell; None: no mission told."""
        return {name: _rounded(value) for name, value in asdict(self).items()}


@dataclass(frozen=True, slots=True)
class Search:
    """The task that is flown. platform: m ENU, where it starts. most_bearings: a mission ends unclaimed after these.
    planner: who chooses the places."""

    problem: Problem
    rule: LocalizationRule
    platform: tuple[float, float]
    most_bearings: int = 20
    planner: TruthPlanner = "fisher"


def missions(
    search: Search, row: Row, seeds: Sequence[int], model: Model = "joint", prior: ErrorPrior | None = None
) -> Iterator[Claim]:
    """Mission by mission, each with its own emitter and errors; the seed decides both. prior: of the joint model."""
    unknown = prior_of(search.problem, model, prior)
    for seed in seeds:
        yield _flown(search, row, seed, model, unknown)[0]


def fly(search: Search, row: Row, seed: int, model: Model = "joint", prior: ErrorPrior | None = None) -> Claim:
    """One mission."""
    return _flown(search, row, seed, model, prior_of(search.problem, model, prior))[0]


def learn(search: Search, row: Row, seeds: Sequence[int], unknown: ErrorPrior) -> ErrorPrior:
    """What flights of the row teach of its sensor, one after the other, each with what was learned before it.

    Only bearings are learned from: where the emitter was, nobody says.
    """
    found: list[FloatArray] = []
    prior, nowhere = unknown, joint_prior(search.problem)
    for seed in seeds:
        _, belief = _flown(search, row, seed, "joint", replace(nowhere, otherwise=prior))
        assert isinstance(belief, JointBelief)
        found.append(flight_evidence(belief, belief.errors[0].source))
        prior = learned(found, unknown)
    return prior


def told(row: Row) -> ErrorPrior:
    """The errors that the row's sensors are drawn from, for comparison with what was learned of them.

    StudyError for a row whose errors are not made of a bias, a scale and outliers alone.
    """
    if row.walls or row.antenna != "measured" or row.placing != "right":
        raise StudyError(f"the errors of {row.name} are no bias, scale and outliers that could be told")
    one = np.ones(1)
    return ErrorPrior(
        spread=np.array([max(row.bias_sd, SMALLEST_TOLD)]),
        spread_weight=one,
        scale=np.array([row.own_sd / row.stated_sd]),
        scale_weight=one,
        rate=np.array([max(row.outliers, FEWEST_TOLD)]),
        rate_weight=one,
    )


def _flown(search: Search, row: Row, seed: int, model: Model, unknown: GridBelief) -> tuple[Claim, GridBelief]:
    problem, rng = search.problem, np.random.default_rng([seed, ROWS_SEED])
    target = anywhere(problem, rng)
    sensor = row.sensor(target, rng)
    belief = unknown
    here, time, bearings = np.array(search.platform), 0.0, list[Bearing]()
    while True:
        choice = next_place(search.planner, problem, row, belief, bearings, (float(here[0]), float(here[1])))
        place = np.array([choice.x, choice.y])
        time += float(flight_time(problem.motion, float(np.hypot(*(place - here))), 0.0)) + problem.measurement_time
        here = place
        angle, sigma = sensor.bearing(place, len(bearings))
        source = SOURCES[sensor.taker(len(bearings)) is not sensor]
        bearings.append(bearing_of(model, place, angle, sigma, row.heading_sigma, source))
        belief = folded(unknown, belief, bearings[-1])
        said = verdict(problem, search.rule, bearings, belief)
        if said.localized or len(bearings) == search.most_bearings:
            break
    claim = claim_at(seed, said.localized, belief, problem, target, sensor.bias, len(bearings), time)
    return claim, belief


def claim_at(
    seed: int,
    claimed: bool,
    belief: GridBelief,
    problem: Problem,
    target: FloatArray,
    bias: float,
    bearings: int,
    time_s: float,
) -> Claim:
    """What the belief says, held against the truth. target: (2,) m. bias: rad, of the first source's bearings."""
    spread = stated(belief, estimate(belief, problem.estimator), problem.threshold)
    known = belief.errors if isinstance(belief, JointBelief | MovingBelief) else ()
    return Claim(
        seed=seed,
        claimed=claimed,
        in_c95=bool(distance_to_convex(target[None], confidence_region(belief))[0] <= 0.0),
        error_m=float(np.hypot(spread.x - target[0], spread.y - target[1])),
        stated_m=spread.expected_rmse,
        rms_m=float(np.sqrt(np.trace(spread.covariance))),
        far_chance=1.0 - mass_within(belief, spread.x, spread.y, BEYOND * spread.expected_rmse),
        bearings=bearings,
        time_s=time_s,
        bias_off_deg=float(np.rad2deg(known[0].bias - bias)) if known else float("nan"),
        bias_sd_deg=float(np.rad2deg(known[0].bias_sd)) if known else float("nan"),
    )


ROWS_SEED = 14
"""Keeps these missions' chance apart from that of other studies with the same seeds."""


def truth_of(row: str, model: Model, claims: Sequence[Claim], prior: str = UNKNOWN) -> Truth:
    """Sums up the missions of a row; shares of claims are NaN when there is none."""
    claimed = [c for c in claims if c.claimed]
    nothing = float("nan")
    inside = sum(c.in_c95 for c in claimed)
    low, high = _interval(claimed, [c.in_c95 for c in claimed])
    beyond = [c.seed for c in claimed if c.beyond]
    beyond_low, beyond_high = _interval(claimed, [c.beyond for c in claimed])
    known = [c for c in claims if np.isfinite(c.bias_off_deg)]
    return Truth(
        row=row,
        model=model,
        missions=len({c.seed for c in claims}),
        claimed=len(claimed) / len(claims),
        in_c95=inside / len(claimed) if claimed else nothing,
        in_c95_low=low,
        in_c95_high=high,
        beyond_3x=len(beyond) / len(claimed) if claimed else nothing,
        beyond_low=beyond_low,
        beyond_high=beyond_high,
        beyond_believed=float(np.mean([c.far_chance for c in claimed])) if claimed else nothing,
        beyond_seeds=tuple(beyond),
        beyond_3rms=float(np.mean([c.error_m > BEYOND * c.rms_m for c in claimed])) if claimed else nothing,
        mean_s=float(np.mean([c.time_s for c in claims])),
        bearings_mean=float(np.mean([c.bearings for c in claims])),
        error_mean_m=float(np.mean([c.error_m for c in claimed])) if claimed else nothing,
        stated_mean_m=float(np.mean([c.stated_m for c in claimed])) if claimed else nothing,
        bias_inside=float(np.mean([abs(c.bias_off_deg) <= 2.0 * c.bias_sd_deg for c in known])) if known else nothing,
        prior=prior,
        first_s=_first_s(claims),
    )


def _first_s(claims: Sequence[Claim]) -> float | None:
    """Of each mission the first emitter's, which is the first claim with its seed; None where there is but one."""
    first = {claim.seed: claim.found_s for claim in reversed(claims)}
    times = [time for time in first.values() if time is not None]
    return float(np.mean(times)) if times else None


def _rounded(value: Any) -> Any:
    if not isinstance(value, float):
        return value
    return round(value, 4) if isfinite(value) else None


def _interval(claims: Sequence[Claim], hits: Sequence[bool]) -> tuple[float, float]:
    """Wilson's interval of the share of hits, NaN without claims.

    The claims of one mission (several tags) hang together. Those of n missions count as no more trials than give the
    share the standard error that it has between missions,
    se^2 = n / (n - 1) sum_m (hits_m - share claims_m)^2 / claims^2.
    """
    if not claims:
        return float("nan"), float("nan")
    _, mission, together = np.unique([c.seed for c in claims], return_inverse=True, return_counts=True)
    trials, count = float(len(claims)), len(together)
    share = sum(hits) / trials
    if 1 < count < trials and 0.0 < share < 1.0:
        off = np.bincount(mission, hits) - share * together
        variance = count / (count - 1) * float(off @ off) / trials**2
        trials = min(trials, share * (1.0 - share) / variance) if variance > 0.0 else trials
    return wilson(share * trials, trials)


def row_named(name: str) -> Row:
    """StudyError for a row that does not exist."""
    return ROWS.named(name)


def anywhere(problem: Problem, rng: np.random.Generator) -> FloatArray:
    """(2,) m, uniform in the area."""
    x_min, y_min, x_max, y_max = bounds(problem.area)
    while True:
        target = rng.uniform((x_min, y_min), (x_max, y_max))
        if contains(problem.area, target[None])[0]:
            return target


def prior_of(problem: Problem, model: Model, prior: ErrorPrior | None) -> GridBelief:
    """What a search begins with. prior: of the joint model, None: of a sensor of which nothing is known."""
    if model == "independent":
        return prior_belief(problem)
    return joint_prior(problem) if prior is None else joint_prior(problem, otherwise=prior)


def bearing_of(
    model: Model,
    place: FloatArray,
    angle: float,
    sigma: float,
    heading_sigma: float,
    source: str,
    taken_at: float = 0.0,
) -> Bearing:
    """The independent model takes the heading's error for each bearing's own."""
    x, y = float(place[0]), float(place[1])
    if model == "independent":
        total = float(np.hypot(sigma, heading_sigma))
        return Bearing(x, y, angle, total, outlier_probability=DOUBT, taken_at=taken_at)
    return Bearing(x, y, angle, sigma, source=source, taken_at=taken_at)


def folded(unknown: GridBelief, belief: GridBelief, bearing: Bearing) -> GridBelief:
    """The belief with a bearing; one that contradicts all others starts it over from what was unknown."""
    if isinstance(belief, JointBelief):
        return update_joint(belief, bearing)
    try:
        return update(belief, bearing)
    except InconsistentBearings:
        return unknown
