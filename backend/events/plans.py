"""Which place comes next, and what else could have been chosen."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from backend.events.fact import Fact, Known
from backend.reasons import Reason
from backend.spec import Id, Place


class CandidateFact(Fact):
    """One candidate next place. `dropped_in_round` None: survived. `std_error_s` None: a single rollout has none."""

    lat: float
    lon: float
    value_s: float
    std_error_s: Known
    rollouts: int
    dropped_in_round: int | None


class ForecastFact(Fact):
    """Of one emitter: mean time until it is localized if it were flown for by itself from the chosen place on; it takes
    no less."""

    emitter_id: Id
    expected_time_s: Known


class SetBackFact(Fact):
    """An emitter that would come first and was taken like the last, so that the others need not wait: because."""

    emitter_id: Id
    reason: Reason


class PlanChosen(Fact):
    """The next measurement place.

    `emitter_id`: the emitter it is to tell most of, None of an operator's and of one for several emitters; then a
    candidate's `value_s` is the mean of their times, and `expected_time_s` that of the last if each were flown for by
    itself from there on: it takes no less. `place_number` counts places from 1. `expected_time_s`: mean time until
    localized by way of this place; `time_90_s`: not exceeded by nine of ten searches (None when not sampled).
    `altitude_amsl_m`: at which it would be flown to from where the craft was, None before terrain counted.
    `forecasts`: of a plan for several emitters, one each. `first`: those that came first in it, empty when all were
    alike. `set_back`: those that would have, and did not."""

    kind: Literal["plan_chosen"] = "plan_chosen"
    craft_id: Id
    emitter_id: Id | None = None
    place_number: int
    place: Place
    source: Literal["planner", "operator"]
    reason: Reason
    expected_time_s: Known
    time_90_s: Known
    candidates: list[CandidateFact]
    rollouts: int
    plan_ms: float
    by: str | None = None
    altitude_amsl_m: Known = None
    forecasts: list[ForecastFact] = Field(default_factory=list[ForecastFact])
    first: list[Id] = Field(default_factory=list[Id])
    set_back: list[SetBackFact] = Field(default_factory=list[SetBackFact])


class PlanVetoed(Fact):
    """The operator refused the proposed place; the planner chooses again without it."""

    kind: Literal["plan_vetoed"] = "plan_vetoed"
    craft_id: Id
    place: Place
    by: str
