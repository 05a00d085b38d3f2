"""What a flight taught of the errors of its craft's bearings, and what the flights so far say of the next one's.

A lesson is the flight's evidence for each value that bias' spread, scale and outlier rate may have
(planner.belief.learning). It needs no truth: the bearings agree or not.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from backend.events import BearingMeasured, CraftSource
from backend.ports import Lesson, Said
from backend.search.localization import Localization, source_name
from backend.search.source_priors import learned_errors, unknown_errors
from backend.search.state import SearchState
from backend.search.task import SearchTask
from backend.spec import LearnedErrors, MissionSpec, SensorSpec
from planner.belief.joint import JointBelief
from planner.belief.learning import FlightEvidence, flight_evidence, learned
from planner.types import FloatArray

LESSONS_KEPT = 100
"""The newest: what a compass was like a hundred flights ago says little of today's."""


def lesson(mission_id: str, task: SearchTask, search: SearchState, craft_id: str) -> Lesson | None:
    """Of a mission that has flown, from the emitter of which the craft took most bearings: one bias turned them all, so
    that two emitters are not two witnesses. None when the craft took none or errors were taken to be independent.

    Heavy (some tenths of a second): call it off the event loop.
    """
    source = source_name(CraftSource(craft_id=craft_id))

    def taken(emitter_id: str) -> list[BearingMeasured]:
        return [b for b in search.emitters[emitter_id].bearings if source_name(b.source) == source]

    most = max(search.emitters, key=lambda emitter_id: len(taken(emitter_id)), default=None)
    if most is None or not taken(most) or most not in task.emitters:
        return None
    return _lesson(mission_id, task.emitters[most], search.emitters[most].bearings, source)


def _lesson(mission_id: str, task: Localization, measured: Sequence[BearingMeasured], source: str) -> Lesson | None:
    belief = task.belief(task.planner_bearings(measured))
    errors = belief.errors_of(source) if isinstance(belief, JointBelief) else None
    if errors is None:
        return None
    found, given = flight_evidence(errors), errors.prior
    return Lesson(
        mission_id=mission_id,
        bearings=errors.bearings,
        bias_deg=-math.degrees(errors.bias),
        bias_std_error_deg=math.degrees(errors.bias_sd),
        spread_deg=_said(np.rad2deg(given.spread), found.spread),
        scale=_said(given.scale, found.scale),
        rate=_said(given.rate, found.rate),
    )


def _said(values: FloatArray, log: FloatArray) -> tuple[Said, ...]:
    best = float(log.max())
    return tuple(Said(float(value), float(one) - best) for value, one in zip(values, log, strict=True))


def errors_now(lessons: Sequence[Lesson], sensor: SensorSpec, craft_id: str, antenna: str) -> LearnedErrors:
    """What a mission with this sensor starts from, after these flights (oldest first) of the craft and antenna."""
    unknown = unknown_errors(sensor.outlier_probability)
    newest = lessons[-LESSONS_KEPT:]
    evidence = [
        FlightEvidence(
            _at(one.spread_deg, np.rad2deg(unknown.spread)), _at(one.scale, unknown.scale), _at(one.rate, unknown.rate)
        )
        for one in newest
    ]
    return learned_errors(learned(evidence, unknown), len(newest), craft_id, antenna)


def _at(said: Sequence[Said], values: FloatArray) -> FloatArray:
    """Log evidence at these values, in between interpolated over their logarithms: other missions may have compared
    other values."""
    known = np.log([one.value for one in said])
    return np.interp(np.log(values), known, np.array([one.log_evidence for one in said]))


def knowing(spec: MissionSpec, lessons: Sequence[Lesson], craft_id: str, antenna: str) -> MissionSpec:
    """The specification with what the flights taught; one with independent errors stays as it is."""
    sensor = spec.sensor
    known = errors_now(lessons, sensor, craft_id, antenna) if sensor.bearing_errors == "joint" else None
    return spec if known == sensor.learned else spec.having_learned(known)


def mean_bias(lessons: Sequence[Lesson]) -> tuple[float, float] | None:
    """Of the flights, weighed by what each knew: degrees clockwise, with the standard deviation from flight to flight.

    None without a lesson.
    """
    if not lessons:
        return None
    weight = np.array([1.0 / max(one.bias_std_error_deg, 0.1) ** 2 for one in lessons])
    bias = np.array([one.bias_deg for one in lessons])
    mean = float(weight @ bias / weight.sum())
    between = float(weight @ (bias - mean) ** 2 / weight.sum())
    return mean, math.sqrt(between + 1.0 / float(weight.sum()))
