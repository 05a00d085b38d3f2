"""What flights tell about the errors of the next: a source's prior learned from flights whose truth nobody knows.

The bearings of a flight agree or not, and so say something of tau, the standard deviation of the bias, of the scale s
and of the rate e of outliers, although the place x stays uncertain. A flight's evidence is taken for every combination
of the three, since each excuses another: bearings that scatter have a large scale, or many are outliers.

    p(bearings | tau, s, e) = sum_x p(x) sum_b p(b | tau) prod_i p(z_i | x, b, s, e)

Flights are independent, so their evidence multiplies, and a share of the flat prior is mixed in: nothing is ever
excluded, since a compass may be disturbed tomorrow. Where the emitter was known, p(x) is that place.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np

from planner.belief import compiled_evidence
from planner.belief.evidence import Sightings, sightings
from planner.belief.joint import JointBelief, by_source, places_besides
from planner.belief.source_errors import ErrorPrior, Nodes, bias_weights, nodes
from planner.types import Bearing, FloatArray

FOUND_SIGMAS = np.linspace(-2.5, 2.5, 9)
"""Where an emitter is looked for about the place at which it was found, in standard deviations of that place."""
SURPRISE = 0.02 / 3.0
"""Share of the prior that knows nothing in each of the three, whatever was learned: in one flight of fifty something is
otherwise."""


def flight_evidence(belief: JointBelief, source: str) -> FloatArray:
    """(t, k, e) log p(bearings of a flight | spread, scale, rate of this source), 0 for the best.

    belief: with all bearings of the flight; those of other sources tell of the place. The values are those of the
    prior that the belief has of the source.
    """
    x, y, log = places_besides(belief, source)
    return _evidence(belief.prior_of(source), by_source(belief.folded)[source], x, y, log)


def evidence_at(
    bearings: Sequence[Bearing], prior: ErrorPrior, place: tuple[float, float], accuracy: float = 0.0
) -> FloatArray:
    """The same of one source's bearings of an emitter that was found at `place`, m ENU, with that standard deviation in
    each coordinate, m."""
    x, y, log = _around(place, accuracy)
    return _evidence(prior, bearings, x, y, log)


def bias_at(
    bearings: Sequence[Bearing], prior: ErrorPrior, place: tuple[float, float], accuracy: float = 0.0
) -> tuple[float, float]:
    """Expected value and standard deviation, rad, of the bias that these bearings had; place as in `evidence_at`."""
    x, y, log = _around(place, accuracy)
    seen = sightings(bearings)
    grid = _nodes(prior, seen)
    weighed = compiled_evidence.evidence(x, y, seen, grid)
    log = log + weighed.log
    mass = np.exp(log - log.max())
    of_bias = mass @ weighed.bias / mass.sum()
    mean = float(of_bias @ grid.bias)
    return mean, float(np.sqrt(max(of_bias @ (grid.bias - mean) ** 2, 0.0)))


def _around(place: tuple[float, float], accuracy: float) -> tuple[FloatArray, FloatArray, FloatArray]:
    """x, y (c,) of a lattice about the place, m, and the logarithm of their probability under N(place, accuracy^2)."""
    if accuracy <= 0.0:
        return np.array([place[0]]), np.array([place[1]]), np.zeros(1)
    off_x, off_y = (off.ravel() for off in np.meshgrid(FOUND_SIGMAS, FOUND_SIGMAS))
    log = -0.5 * (off_x**2 + off_y**2)
    return place[0] + accuracy * off_x, place[1] + accuracy * off_y, log - np.log(np.exp(log).sum())


def _evidence(
    prior: ErrorPrior, bearings: Sequence[Bearing], x: FloatArray, y: FloatArray, log: FloatArray
) -> FloatArray:
    """log: (c,) of the places' probability."""
    arrays, one = sightings(bearings), np.ones(1)
    grid = _nodes(prior, arrays)
    by_spread = bias_weights(grid.bias, grid.spacing, prior.spread)
    found = np.empty((len(prior.spread), len(prior.scale), len(prior.rate)))
    for k, scale in enumerate(prior.scale):
        for e, rate in enumerate(prior.rate):
            alone = replace(grid, scale=one * scale, scale_weight=one, rate=one * rate, rate_weight=one)
            weighed = compiled_evidence.evidence(x, y, arrays, alone)
            whole = log + weighed.log
            top = float(whole.max())
            # sum_x p(x) p(bearings, b | x) / p(b), of each node b
            likelihood = (np.exp(whole - top) @ weighed.bias) / grid.bias_weight
            found[:, k, e] = top + np.log(by_spread.T @ likelihood)
    return found - found.max()


def _nodes(prior: ErrorPrior, seen: Sightings) -> Nodes:
    return nodes(prior, float(seen.sigma.min()), len(seen.x))


def learned(flights: Iterable[FloatArray], unknown: ErrorPrior) -> ErrorPrior:
    """The prior for the next flight. flights: (t, k, e) log evidence each, at the values of `unknown`, which is assumed
    of a source that never flew."""
    flat = np.einsum("t,k,e->tke", unknown.spread_weight, unknown.scale_weight, unknown.rate_weight)
    log = sum(flights, start=np.zeros(flat.shape))
    mass = flat * np.exp(log - log.max())
    mass = (1.0 - SURPRISE) * mass / mass.sum() + SURPRISE * flat
    return replace(
        unknown,
        spread_weight=mass.sum(axis=(1, 2)),
        scale_weight=mass.sum(axis=(0, 2)),
        rate_weight=mass.sum(axis=(0, 1)),
    )
