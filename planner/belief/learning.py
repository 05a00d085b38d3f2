"""What flights tell about the errors of the next: a source's prior learned from flights whose truth nobody knows.

The bearings of a flight agree or not, and so say something of tau, the standard deviation of the bias, of the scale
and of the rate of outliers, although the place stays uncertain. A flight's evidence for each value is the posterior
over the prior it was given,

    p(bearings | tau) = sum_b p(b | tau) p(b | bearings) / p(b),    p(bearings | s) = p(s | bearings) / p(s),

flights are independent, so their evidence multiplies, and a share of the flat prior is mixed in: nothing is ever
excluded, since a compass may be disturbed tomorrow.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from planner.belief.source_errors import ErrorPrior, SourceErrors, bias_weights
from planner.types import FloatArray

SURPRISE = 0.02
"""Share of the prior that knows nothing, whatever was learned."""


@dataclass(frozen=True, slots=True, eq=False)
class FlightEvidence:
    """Logarithms of p(bearings of a flight | value), up to a constant each: of spread (t,), scale (k,), rate (e,)."""

    spread: FloatArray
    scale: FloatArray
    rate: FloatArray


def flight_evidence(errors: SourceErrors) -> FlightEvidence:
    """Of the flight in which the errors were estimated."""
    given, grid = errors.prior, errors.nodes
    likelihood = errors.bias_mass / grid.bias_weight
    spread = bias_weights(grid.bias, grid.spacing, given.spread).T @ likelihood
    return FlightEvidence(
        np.log(spread), np.log(errors.scale_mass / grid.scale_weight), np.log(errors.rate_mass / grid.rate_weight)
    )


def learned(flights: Iterable[FlightEvidence], unknown: ErrorPrior) -> ErrorPrior:
    """The prior for the next flight. unknown: what is assumed of a source that never flew, with the same values."""
    spread, scale, rate = (np.zeros(len(v)) for v in (unknown.spread, unknown.scale, unknown.rate))
    for one in flights:
        spread, scale, rate = spread + one.spread, scale + one.scale, rate + one.rate
    return replace(
        unknown,
        spread_weight=_posterior(unknown.spread_weight, spread),
        scale_weight=_posterior(unknown.scale_weight, scale),
        rate_weight=_posterior(unknown.rate_weight, rate),
    )


def _posterior(prior: FloatArray, log_evidence: FloatArray) -> FloatArray:
    mass = prior * np.exp(log_evidence - log_evidence.max())
    return (1.0 - SURPRISE) * mass / mass.sum() + SURPRISE * prior
