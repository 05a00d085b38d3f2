"""Several tags, one craft: every turn is heard for all of them, and the planner chooses for those still wanted.

The rows tags_4 and tags_8 of the truth study, in the field scenario with its errors. Each tag is one claim; the time is
that of the whole mission, until every tag is localized or the last bearing is taken.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from planner.belief.grid import GridBelief
from planner.belief.joint import JointBelief
from planner.belief.shared_source import with_shared_errors
from planner.belief.source_errors import ErrorPrior
from planner.belief.verdict import verdict
from planner.motion import flight_time
from planner.options import FIELD, PlannerOptions
from planner.plan import plan
from planner.policy.several import Wanted, plan_several
from planner.study.error_worlds import Row, Sensor
from planner.study.errors import StudyError
from planner.study.scenarios import Scenario, scenario
from planner.study.truth import Claim, Model, bearing_of, claim_at, folded, prior_of
from planner.study.truth_planners import places_of
from planner.types import Bearing, FloatArray, LocalizationRule

TAGS = {"tags_4": 4, "tags_8": 8, "tags_4_bias5": 4, "tags_8_bias5": 8, "tags_4_first": 4, "tags_8_first": 8}
"""Rows by name: how many tags."""
FIRST = ("tags_4_first", "tags_8_first")
"""Rows in which the first tag is more important than the others, which are alike; worlds and luck are those of the row
without."""
BIAS_SD = {"tags_4_bias5": float(np.deg2rad(5.3)), "tags_8_bias5": float(np.deg2rad(5.3))}
"""Of the compass, by row: one angle for all bearings of all tags in a mission. In the other rows it is right."""
MOST_BEARINGS = 40
OPTIONS = replace(FIELD, budget=250)
"""A quarter of a flight's work a decision; eight tags make it eight rollouts a path."""
TAGS_SEED = 15


@dataclass(slots=True)
class _Tag:
    """alone: the belief by its own bearings. belief: with what the others' tell of the compass, where that counts."""

    sensor: Sensor
    alone: GridBelief
    belief: GridBelief
    bearings: list[Bearing]
    rank: int = 0
    localized: bool = False
    claim: Claim | None = None


def tags_missions(
    row: str,
    seeds: Sequence[int],
    model: Model,
    options: PlannerOptions = OPTIONS,
    *,
    shared: bool = False,
    prior: ErrorPrior | None = None,
) -> Iterator[list[Claim]]:
    """Mission by mission: a claim a tag, those that were never claimed too, all with the mission's time. shared: what
    one tag's bearings tell of the compass counts for all, of the joint model. prior: of the joint model, None: of a
    sensor of which nothing is known."""
    if row not in TAGS:
        raise StudyError(f"there is no row {row!r}: choose one of {', '.join(TAGS)}")
    known = prior or ErrorPrior()
    for seed in seeds:
        yield fly_tags(
            scenario("field"),
            TAGS[row],
            seed,
            model,
            options,
            shared=shared,
            bias_sd=BIAS_SD.get(row, 0.0),
            prior=known,
            first=row in FIRST,
        )


def fly_tags(
    world: Scenario,
    count: int,
    seed: int,
    model: Model,
    options: PlannerOptions = OPTIONS,
    *,
    shared: bool = False,
    bias_sd: float = 0.0,
    prior: ErrorPrior | None = None,
    first: bool = False,
) -> list[Claim]:
    """One mission from the scenario's place, its first bearing taken there. bias_sd: rad, of the compass, which hears
    all tags. prior: of the joint model, as it is. first: the first tag is more important than the others."""
    problem, rng = world.problem, np.random.default_rng([seed, TAGS_SEED])
    rule = LocalizationRule(threshold=problem.threshold)
    row = Row("tags", bias_sd=bias_sd, own_sd=problem.sigma, stated_sd=problem.sigma, heading_sigma=0.0)
    one = row.sensor(world.target(seed, rng), rng)
    sensors = [one, *(replace(one, target=world.target(seed, rng)) for _ in range(count - 1))]
    unknown = prior_of(problem, model, prior)
    tags = [_Tag(sensor, unknown, unknown, [], int(first and sensor is not one)) for sensor in sensors]
    here, time, place = np.array(world.platform), 0.0, np.array(world.platform)
    for number in range(MOST_BEARINGS):
        leg = float(np.hypot(*(place - here)))
        time += problem.measurement_time + (float(flight_time(problem.motion, leg, 0.0)) if leg > 0.0 else 0.0)
        here = place
        for tag in tags:
            angle, sigma = tag.sensor.bearing(here, number)
            tag.bearings.append(bearing_of(model, here, angle, sigma, row.heading_sigma, "craft"))
            tag.alone = tag.belief = folded(unknown, tag.alone, tag.bearings[-1])
        if shared:
            _share(tags)
        for tag in tags:
            tag.localized = verdict(problem, rule, tag.bearings, tag.belief).localized
            if tag.localized and tag.claim is None:
                tag.claim = _claim(tag, world, seed, time, claimed=True)
        if all(tag.localized for tag in tags):
            break
        place = _next_place(world, [tag for tag in tags if not tag.localized], here, options)
    claims = [tag.claim or _claim(tag, world, seed, time, claimed=False) for tag in tags]
    return [replace(claim, time_s=time) for claim in claims]


def _share(tags: Sequence[_Tag]) -> None:
    joint = [tag.alone for tag in tags if isinstance(tag.alone, JointBelief)]
    if len(joint) == len(tags):
        for tag, belief in zip(tags, with_shared_errors(joint), strict=True):
            tag.belief = belief


def _next_place(world: Scenario, wanted: Sequence[_Tag], here: FloatArray, options: PlannerOptions) -> FloatArray:
    """With echoes of its own, as in flight. All hear every turn."""
    platform = (float(here[0]), float(here[1]))
    problem = replace(world.problem, turned_at=places_of(wanted[0].bearings))
    if len(wanted) == 1:
        only = wanted[0]
        chosen = plan(problem, only.belief, only.bearings, platform, options, threads=1)
    else:
        asked = [Wanted(problem, tag.belief, tag.rank) for tag in wanted]
        chosen = plan_several(asked, platform, options, threads=1)
    return np.array([chosen.x, chosen.y])


def _claim(tag: _Tag, world: Scenario, seed: int, time: float, *, claimed: bool) -> Claim:
    """time: s, of now; that of the whole mission is not known yet."""
    sensor, bearings = tag.sensor, len(tag.bearings)
    made = claim_at(seed, claimed, tag.belief, world.problem, sensor.target, sensor.bias, bearings, time_s=0.0)
    return replace(made, found_s=time)
