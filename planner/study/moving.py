"""Is what the search claims of an emitter that moves true? The rows moving_0.1, moving_0.2 and moving_0.4.

Half of the missions look for a walker, half for a drifter (planner.study.walkers) of the named speed in m/s; the search
knows which, and the speed. The claim is about the moment at which it is made, half a measurement after the middle of
the turn that led to it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np

from planner.belief.moving import Assumed, MovingBelief, moving_prior, predicted, update_moving
from planner.belief.source_errors import ErrorPrior
from planner.belief.verdict import verdict
from planner.motion import flight_time
from planner.movement import DRIFTING_S, WALKING_S, Movement
from planner.policy.fisher import fisher
from planner.study.error_worlds import ROWS, Row
from planner.study.truth import Claim, Model, Search, anywhere, bearing_of, claim_at
from planner.study.walkers import Kind, walker
from planner.types import Bearing

SPEEDS: Mapping[str, float] = {"moving_0.1": 0.1, "moving_0.2": 0.2, "moving_0.4": 0.4}
"""m/s, by row."""
ERRORS: Mapping[Model, str] = {"independent": "independent", "joint": "bias5"}
"""The sensor's errors: those that the believed model is about."""
MOVING_SEED = 151
KINDS: tuple[Kind, ...] = ("walker", "drifter")
PERSISTENCE_S: Mapping[Kind, float] = {"walker": WALKING_S, "drifter": DRIFTING_S}
"""What the search assumes."""


def moving_missions(
    search: Search, row: str, seeds: Sequence[int], model: Model, prior: ErrorPrior | None = None
) -> Iterator[Claim]:
    """Mission by mission; the seed decides where the emitter is, how it moves and the errors."""
    for seed in seeds:
        yield fly_after(search, SPEEDS[row], seed, model, prior, ROWS.named(ERRORS[model]))


def fly_after(search: Search, speed: float, seed: int, model: Model, prior: ErrorPrior | None, errors: Row) -> Claim:
    """One mission. prior: of the joint model, None: of a sensor of which nothing is known."""
    problem, rng = search.problem, np.random.default_rng([seed, MOVING_SEED])
    kind = KINDS[seed % 2]
    emitter = walker(kind, anywhere(problem, rng), speed, rng)
    sensor = errors.sensor(emitter.at(0.0), rng)
    otherwise = (prior or ErrorPrior()) if model == "joint" else None
    movement = Movement(speed, PERSISTENCE_S[kind])
    problem = replace(problem, threshold=movement.goal(problem.threshold, problem.measurement_time))
    rule = replace(search.rule, threshold=problem.threshold)
    belief: MovingBelief = moving_prior(problem, Assumed(movement, otherwise=otherwise))
    here, time, bearings = np.array(search.platform), 0.0, list[Bearing]()
    while True:
        foreseen = predicted(belief, problem.measurement_time)
        choice = fisher(problem, foreseen, (float(here[0]), float(here[1])))
        place = np.array([choice.x, choice.y])
        middle = time + float(flight_time(problem.motion, float(np.hypot(*(place - here))), 0.0))
        middle += 0.5 * problem.measurement_time
        time, here = middle + 0.5 * problem.measurement_time, place
        sensor.target = emitter.at(middle)
        angle, sigma = sensor.bearing(place, len(bearings))
        bearings.append(bearing_of(model, place, angle, sigma, errors.heading_sigma, "craft", middle))
        belief = update_moving(belief, bearings[-1], time)
        said = verdict(problem, rule, bearings, belief)
        if said.localized or len(bearings) == search.most_bearings:
            break
    return claim_at(seed, said.localized, belief, problem, emitter.at(time), sensor.bias, len(bearings), time)
