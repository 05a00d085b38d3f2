"""One bearing ahead on the joint belief: from which place does the next bearing most cheaply lead to a claim?

Rollouts take the bearings to come as independent and end when the expected error is small. A joint belief may wait for
something else: that an outlier among its bearings, or the bias of its compass, can no longer have put the emitter far
away. To rollouts any bearing will do then, and they choose the nearest place, which tells nothing. Here the bearing is
drawn from the belief, place and bias together, and the belief after it is judged as the verdict will judge it
(planner.kernels.claim), so that a place on the other side of the estimate counts for what it tells of the bias:

    value(a) = t(a) + (1 - P(a)) mean t / P'(a),    P'(a) = P* + (LATER_CHANCE - P*) P(a) / P*

with P(a) the chance of a claim after the bearing from a, P* the largest, and P'(a) that of each bearing after one from
a that failed: one that might have made a claim has told something all the same, one that hardly could has told nothing.
Where hardly any bearing makes a claim, P(a) is what the bearing does towards one: of the logarithm by which the mass
too far away is still too large, the share that it takes off in the mean, and P' is the best place's P mean t / t.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from planner.belief import compiled_evidence
from planner.belief.estimate import estimate
from planner.belief.evidence import SMALLEST_SIGMA, sightings
from planner.belief.grid import GridBelief
from planner.belief.joint import JointBelief
from planner.belief.source_errors import SourceErrors
from planner.belief.verdict import FAR_ERRORS, MOST_BEYOND
from planner.kernels.claim import BiasedCells, ClaimRule, Claims, Draws, claim_chances
from planner.legs import first_time
from planner.motion import flight_time
from planner.policy.fisher import gain_beside_bias
from planner.reasons import QuickestPlace
from planner.types import Candidate, Decision, Estimate, FloatArray, Problem

PLACES_JUDGED = 48
BEARINGS_DRAWN = 32
LEAST_CHANCE = 0.2
"""Of a claim after the best place's bearing; below, more than one bearing has to be planned. Rollouts, which would end
with any of them, plan those only as long as the expected error is what is missing."""
LATER_CHANCE = 0.75
"""Of a claim after each further bearing, where the likeliest place made none: in 242 decisions of the field world 54
failed, and 1.3 more followed."""
LEAST_SHARE = 1e-3
"""Of the way to a claim that a bearing is taken to cover."""
HOPELESS = 3.0
"""Times the threshold: no bearing makes a claim of a belief whose expected error is larger than that."""
CERTAIN = 0.5
"""Of the mass that the verdict allows far away, the share that a claim foreseen here may leave: among places that would
just pass, those that are judged too well are chosen."""
NEAR_BLOCKS, FAR_BLOCKS = 20, 14
"""Blocks of cells along the side of the square about the estimate, and of the whole grid, that count as one."""
NEGLIGIBLE = 1e-6
"""Mass of a block that is left out."""
EVEN_STEPS = (0.7548776662466927, 0.5698402909980532)
"""Of a sequence that fills the unit square evenly (Roberts 2018)."""
FORECAST_TIMES = 128


@dataclass(frozen=True, slots=True)
class ClaimAhead:
    """Of the most telling places (n, 2), m. costs: (n,) s, of flying there and measuring. chance: (n,) that a claim
    follows, or the share of the way to one; chance_from: the same of any places (k, 2), by the same draws.
    all_later: the chance of all later bearings, where those of the places are shares."""

    places: FloatArray
    costs: FloatArray
    chance: FloatArray
    chance_from: Callable[[FloatArray], FloatArray]
    all_later: float | None = None

    @property
    def again(self) -> float:
        """s, of one bearing more."""
        return float(self.costs.mean())

    def later(self, chance: FloatArray) -> FloatArray:
        """Of each bearing after one that had these chances (n,) and led to no claim; P' above."""
        if self.all_later is not None:
            return np.full(np.shape(chance), self.all_later)
        most = max(float(self.chance.max()), LEAST_SHARE)
        return most + (LATER_CHANCE - most) * np.minimum(chance / most, 1.0)

    def failed(self, chance: FloatArray) -> FloatArray:
        """(n,) s, after a bearing with these chances that led to no claim: 1 / P' bearings more."""
        return self.again / self.later(chance)

    @property
    def values(self) -> FloatArray:
        """(n,) s."""
        return self.costs + (1.0 - self.chance) * self.failed(self.chance)

    @property
    def best(self) -> int:
        """Which place has the least value."""
        return int(np.argmin(self.values))

    def times(self, cost: float, chance: float, paths: int) -> FloatArray:
        """(paths,) s until a claim by way of a place with this cost (s) and chance, the same paths for every place.

        Path u in (0, 1) claims at once where u < chance; of the others each further bearing leaves 1 - P':

            t + t_again (1 + floor(ln((1 - u) / (1 - P)) / ln(1 - P'))),    mean t + (1 - P) t_again / P'
        """
        share = (0.5 + np.arange(paths)) / paths
        left = np.clip((1.0 - share) / max(1.0 - chance, 1e-9), 1e-9, 1.0)
        failing = max(1.0 - float(self.later(np.array([chance]))[0]), 1e-9)
        further = 1.0 + np.floor(np.log(left) / np.log(failing))
        return cost + self.again * np.where(share < chance, 0.0, further)

    def std_errors(self, chance: FloatArray) -> FloatArray:
        """(n,) s, of the values of places with these chances; with half a bearing more that claims and half one that
        does not (Jeffreys), so that none of 32 is not certain."""
        share = (BEARINGS_DRAWN * chance + 0.5) / (BEARINGS_DRAWN + 1.0)
        return np.asarray(self.failed(chance) * np.sqrt(share * (1.0 - share) / BEARINGS_DRAWN))


def claim_ahead(
    problem: Problem,
    belief: GridBelief,
    platform: FloatArray,
    allowed: Callable[[], FloatArray],
    costs_of: Callable[[FloatArray], FloatArray],
) -> ClaimAhead | None:
    """None where more than one bearing has to be planned, and for a belief that is not of the next source alone.

    platform: (2,) m. allowed: the places (n, 2), m. costs_of: (k,) s of some of them, infinite without a way; asked for
    those alone that tell most a second of straight flight. The problem's sigma is that of the bearings to come, the
    bias in it by as much as it is still open.
    """
    if not isinstance(belief, JointBelief) or len(belief.errors) != 1:
        return None
    (errors,) = belief.errors
    if problem.next_source not in (None, errors.source):
        return None
    now = estimate(belief, problem.estimator)
    if now.expected_rmse > HOPELESS * problem.threshold:
        return None
    places = allowed()
    gains = gain_beside_bias(now, places, errors, problem.sigma, nearest=belief.h)
    straight = flight_time(problem.motion, np.hypot(*(places - platform).T), np.pi / 2) + first_time(problem)
    judged = np.ascontiguousarray(places[np.argsort(-gains / straight, kind="stable")[:PLACES_JUDGED]])
    costs = costs_of(judged)
    judged, costs = judged[np.isfinite(costs)], costs[np.isfinite(costs)]
    if len(judged) == 0:
        return None
    cells = biased_cells(problem, belief, now, errors)
    rule = ClaimRule(problem.threshold, FAR_ERRORS, CERTAIN * MOST_BEYOND)
    draws = drawn(cells.mass, BEARINGS_DRAWN)

    def claims_from(some: FloatArray) -> Claims:
        return claim_chances(cells, np.ascontiguousarray(some), draws, errors.outlier_rate, rule)

    claims = claims_from(judged)
    if claims.chance.max() >= LEAST_CHANCE:
        return ClaimAhead(judged, costs, claims.chance, lambda some: claims_from(some).chance)
    missing = _tail(cells, now, rule)
    if now.expected_rmse >= problem.threshold or missing <= 0.0:
        return None

    def share_of(tail: FloatArray) -> FloatArray:
        """Of what is missing, in logarithms."""
        return np.clip((missing + np.log(rule.beyond) - tail) / missing, LEAST_SHARE, 1.0)

    share = share_of(claims.tail)
    later = float(costs.mean() * (share / costs).max())
    return ClaimAhead(judged, costs, share, lambda some: share_of(claims_from(some).tail), min(later, 1.0))


def _tail(cells: BiasedCells, now: Estimate, rule: ClaimRule) -> float:
    """Logarithm of the mass that is too far from the estimate over what the rule allows."""
    off = np.hypot(cells.x - now.x, cells.y - now.y)
    beyond = float(cells.mass[off > rule.far * rule.threshold].sum())
    return float(np.log(max(beyond, np.finfo(float).tiny) / rule.beyond))


def choice(ahead: ClaimAhead) -> Decision:
    """The place with the least value; what the candidates are said to take is comparable with its times."""
    values, best = ahead.values, ahead.best
    times = ahead.times(float(ahead.costs[best]), float(ahead.chance[best]), FORECAST_TIMES)
    expected = values - values[best] + times.mean()
    candidates = tuple(
        Candidate(float(x), float(y), float(value), float(error), BEARINGS_DRAWN, None)
        for (x, y), value, error in zip(ahead.places, expected, ahead.std_errors(ahead.chance), strict=True)
    )
    gain = float(np.partition(values, 1)[1] - values[best]) if len(values) > 1 else 0.0
    return Decision(
        float(ahead.places[best, 0]),
        float(ahead.places[best, 1]),
        QuickestPlace(float(times.mean()), gain, len(values)),
        candidates,
        times,
        rollouts=BEARINGS_DRAWN * len(values),
    )


def biased_cells(problem: Problem, belief: JointBelief, now: Estimate, errors: SourceErrors) -> BiasedCells:
    """The belief in fewer cells, fine about the estimate."""
    rows, columns = np.nonzero(belief.density)
    mass = belief.density[rows, columns]
    x, y = (along[index] for along, index in zip(belief.centres(), (columns, rows), strict=True))
    reach = FAR_ERRORS * max(now.expected_rmse, problem.threshold)
    near = np.maximum(np.abs(x - now.x), np.abs(y - now.y)) <= reach
    fine, coarse = 2.0 * reach / NEAR_BLOCKS, max(belief.nx, belief.ny) * belief.h / FAR_BLOCKS
    side = np.maximum(belief.h, np.where(near, fine, coarse))
    column, row = (np.floor(off / side).astype(np.int64) for off in (x - belief.x0, y - belief.y0))
    _, block = np.unique((row << 32) | (column << 1) | near, return_inverse=True)
    whole = np.bincount(block, mass)
    middle_x, middle_y = np.bincount(block, mass * x) / whole, np.bincount(block, mass * y) / whole
    within = mass * ((x - middle_x[block]) ** 2 + (y - middle_y[block]) ** 2)
    blur = 0.5 * np.bincount(block, within) / whole + belief.h**2 / 12.0
    kept = whole > NEGLIGIBLE
    middle_x, middle_y, whole = middle_x[kept], middle_y[kept], whole[kept] / whole[kept].sum()
    grid = errors.nodes
    stretches = belief.stretches_of(errors.source)
    weighed = compiled_evidence.evidence(middle_x, middle_y, sightings(belief.folded), grid, stretches)
    bias = weighed.bias @ grid.bias
    own = max(problem.sigma**2 - errors.bias_sd**2, SMALLEST_SIGMA**2)
    variance = own + np.maximum(weighed.bias @ grid.bias**2 - bias**2, 0.0)
    return BiasedCells(middle_x, middle_y, whole, bias, variance, blur[kept])


def drawn(mass: FloatArray, count: int) -> Draws:
    """Cells by their mass (c,), the heavy ones evenly, and errors that are normal; the same for all places."""
    number = np.arange(count, dtype=np.float64) + 0.5
    share, chance = ((number * step) % 1.0 for step in EVEN_STEPS)
    order = np.argsort(mass, kind="stable")
    at = np.searchsorted(np.cumsum(mass[order]), share).clip(max=len(order) - 1)
    return Draws(order[at], _normal_quantile(chance))


def _normal_quantile(share: FloatArray) -> FloatArray:
    """Of the standard normal distribution, good to 5e-4 (Abramowitz and Stegun 26.2.23)."""
    t = np.sqrt(-2.0 * np.log(np.minimum(share, 1.0 - share)))
    above = 2.515517 + t * (0.802853 + 0.010328 * t)
    below = 1.0 + t * (1.432788 + t * (0.189269 + 0.001308 * t))
    return np.sign(share - 0.5) * (t - above / below)
