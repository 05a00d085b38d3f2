"""What is assumed of the errors of a source of bearings before a flight: nothing yet, or what its flights taught.

A specification without `sensor.learned` means the first of these priors, so that journals fold to what they were.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from backend.spec import LearnedErrors, SensorSpec
from planner.belief.joint import UNKNOWN_SOURCE
from planner.belief.source_errors import ErrorPrior, evenly_spread, fielded_spread

FEWEST_OUTLIERS = 0.01
MOST_OUTLIERS = 0.6
LEAST_OUTLIERS = 1e-9
"""Of any rate but 0: bearings that nothing explains leave the range of numbers otherwise."""
"""Rates that a joint belief allows for, whatever is specified."""

SCALES, SCALE_WEIGHTS = (0.5, 1.0, 1.45), (0.15, 0.63, 0.22)
"""Of the stated sigmas. One flight's bearings agree by luck too often to tell a sensor that is better than it says, so
this has little weight until flights have taught it."""
RATES, RATE_WEIGHTS = (0.03, 0.2, 0.5, 1.0, 2.0, 5.0), (0.066, 0.169, 0.338, 0.056, 0.311, 0.06)
"""Of the specified outlier probability; the mean is a little more than that. From two bearings nobody sees an outlier:
a claim after two takes a source whose flights taught that it has hardly any. The last is of a flight among echoes."""

RATES_BEFORE = {
    1: ((0.03, 0.2, 0.5, 1.0, 2.0), (0.07, 0.18, 0.36, 0.06, 0.33)),
    4: ((0.03, 0.2, 0.5, 2.0), (0.07, 0.18, 0.42, 0.33)),
    5: ((0.03, 0.2, 0.5, 1.0, 2.0), (0.07, 0.18, 0.36, 0.06, 0.33)),
}
"""And the weights, of sources of which nothing is known, by how many rates the learned errors of a specification
compare: journals fold to what they were. One rate is that of a sensor without outliers, then as now."""


def unknown_errors(outlier_probability: float) -> ErrorPrior:
    """Of a source of which nothing is known, with values that leave room to learn."""
    return evenly_spread(_unknown(RATES, RATE_WEIGHTS, outlier_probability))


def unknown_craft(outlier_probability: float) -> ErrorPrior:
    """Of a craft that has not flown: the same, but its compass is one of those that fly."""
    return fielded_spread(unknown_errors(outlier_probability))


def _unknown(rates: Sequence[float], weights: Sequence[float], outlier_probability: float) -> ErrorPrior:
    if outlier_probability == 0.0:
        rates, weights, outlier_probability = (0.03,), (1.0,), 0.1
    rate = np.clip(np.array(rates) * outlier_probability, LEAST_OUTLIERS, MOST_OUTLIERS)
    return replace(
        UNKNOWN_SOURCE,
        scale=np.array(SCALES),
        scale_weight=np.array(SCALE_WEIGHTS),
        rate=rate,
        rate_weight=np.array(weights),
    )


def priors_of(sensor: SensorSpec) -> tuple[dict[str, ErrorPrior], ErrorPrior]:
    """In a mission with this specification: of the sources that are known, by name, and of any other."""
    if sensor.learned is None:
        return {}, _first_prior(sensor.outlier_probability)
    before = RATES_BEFORE.get(len(sensor.learned.rate))
    others = (
        unknown_errors(sensor.outlier_probability) if before is None else _unknown(*before, sensor.outlier_probability)
    )
    return {f"craft:{sensor.learned.craft_id}": prior_in(sensor.learned)}, others


def prior_in(learned: LearnedErrors) -> ErrorPrior:
    """The planner's words for the specification's."""
    return ErrorPrior(
        spread=np.deg2rad(learned.spread_deg),
        spread_weight=_normalized(learned.spread_weight),
        scale=np.array(learned.scale),
        scale_weight=_normalized(learned.scale_weight),
        rate=np.maximum(learned.rate, LEAST_OUTLIERS),
        rate_weight=_normalized(learned.rate_weight),
    )


def learned_errors(prior: ErrorPrior, flights: int, craft_id: str, antenna: str) -> LearnedErrors:
    """And back."""
    return LearnedErrors(
        craft_id=craft_id,
        antenna=antenna,
        flights=flights,
        spread_deg=[math.degrees(value) for value in prior.spread.tolist()],
        spread_weight=prior.spread_weight.tolist(),
        scale=prior.scale.tolist(),
        scale_weight=prior.scale_weight.tolist(),
        rate=prior.rate.tolist(),
        rate_weight=prior.rate_weight.tolist(),
    )


def _normalized(weights: list[float]) -> np.ndarray:
    found = np.array(weights)
    return found / found.sum()


def _first_prior(outlier_probability: float) -> ErrorPrior:
    """Outliers are half or twice as frequent as specified."""
    if outlier_probability == 0.0:
        return replace(UNKNOWN_SOURCE, rate=np.array([FEWEST_OUTLIERS]), rate_weight=np.ones(1))
    rate = np.clip(outlier_probability * np.array([0.5, 2.0]), FEWEST_OUTLIERS, MOST_OUTLIERS)
    return replace(UNKNOWN_SOURCE, rate=rate)
