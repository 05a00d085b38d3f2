"""What flights in the field world teach of a craft's bearings, before the missions of a row are flown."""

from __future__ import annotations

from backend.cli.field_missions import CRAFT_ID, FieldStudy
from backend.events import CraftSource
from backend.search.planner_bearings import source_name
from backend.search.source_priors import learned_errors, unknown_craft
from planner.belief.joint import JointBelief
from planner.belief.learning import flight_evidence, learned
from planner.belief.source_errors import ErrorPrior
from planner.study.errors import StudyError
from planner.types import FloatArray

FIRST_LESSON = 1_000_000
"""Seed of the first flight that is only learned from."""


def taught(study: FieldStudy, flights: int) -> FieldStudy:
    """The same row, flown after this many flights of its craft. Each flight starts with what those before it taught by
    their bearings alone: nobody says where the emitters were.

    Raises StudyError for a row whose bearings are taken to be independent, since those teach nothing.
    """
    if flights and study.options.errors != "joint":
        raise StudyError("only flights whose errors are estimated with the place teach anything of them")
    unknown = unknown_craft(study.spec.sensor.outlier_probability)
    found, now = list[FloatArray](), study
    for seed in range(FIRST_LESSON, FIRST_LESSON + flights):
        _, belief = now.flown(seed)
        assert isinstance(belief, JointBelief)
        found.append(flight_evidence(belief, source_name(CraftSource(craft_id=CRAFT_ID))))
        now = _knowing(study, learned(found, unknown), len(found))
    return now


def _knowing(study: FieldStudy, prior: ErrorPrior, flights: int) -> FieldStudy:
    errors = learned_errors(prior, flights, CRAFT_ID, study.options.antenna)
    spec = study.spec.model_copy(update={"sensor": study.spec.sensor.model_copy(update={"learned": errors})})
    return FieldStudy.of(study.options, spec)
