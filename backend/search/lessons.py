"""What a flight taught of the errors of its craft's bearings, and what the flights so far say of the next one's.

A lesson is the flight's evidence for each value that bias' spread, scale and outlier rate may have
(planner.belief.learning). It needs no truth: the bearings agree or not. Where somebody told where the emitter was, they
are judged by that. An antenna check before a known emitter tells of the bias besides.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from backend.events import AntennaChecked, BearingMeasured, CraftSource, TruthNoted
from backend.ports import Lesson, Said
from backend.search.emitter import EmitterState
from backend.search.localization import Localization
from backend.search.planner_bearings import source_name
from backend.search.source_priors import learned_errors, unknown_craft
from backend.search.state import SearchState
from backend.search.task import SearchTask
from backend.spec import LearnedErrors, MissionSpec, SensorSpec
from hardware.reasons.antenna import AntennaAgrees
from planner.belief.joint import JointBelief
from planner.belief.learning import bias_at, evidence_at, flight_evidence, learned
from planner.belief.source_errors import ErrorPrior
from planner.types import Bearing, FloatArray

CHECK_SIGMA_DEG = 3.0
"""Of an antenna check's bearing, the vehicle turned by hand before a strong emitter."""
KNOWN_M = 100.0
"""From the vehicle to the emitter of a check; only the direction counts."""
LESSONS_KEPT = 100
"""The newest: what a compass was like a hundred flights ago says little of today's."""


AS_FLOWN_DEG = 0.25
"""What is taken off bearings may differ by this from flight to flight and its evidence stays what it is: half the least
spread that is compared."""

UNSAID_ACCURACY_M = 10.0
"""Of a place whose teller said nothing of it."""
LEAST_ACCURACY_M = 1.0
ACCURACY_SIGMAS = 1.5
"""Two thirds of the places are within the stated accuracy: 1.5 standard deviations of each coordinate."""


def lesson(mission_id: str, task: SearchTask, search: SearchState, craft_id: str) -> Lesson | None:
    """Of a mission that has flown, from the emitter of which the craft took most bearings, one whose place was told
    before all others: one bias turned them all, so that two emitters are not two witnesses. One that moves teaches
    nothing. None when the craft took none of another or errors were taken to be independent.

    Heavy (some tenths of a second): call it off the event loop.
    """
    source = source_name(CraftSource(craft_id=craft_id))

    def taken(emitter_id: str) -> list[BearingMeasured]:
        return [b for b in search.emitters[emitter_id].bearings if source_name(b.source) == source]

    teaching = [name for name, each in task.emitters.items() if isinstance(each.prior, JointBelief)]
    heard = [name for name in search.emitters if name in teaching and taken(name)]
    most = max(heard, key=lambda name: (found_at(search.emitters[name]) is not None, len(taken(name))), default=None)
    if most is None:
        return None
    emitter, localized = search.emitters[most], task.emitters[most]
    if (found := found_at(emitter)) is not None:
        said = _lesson_at(mission_id, localized, taken(most), source, found)
    else:
        said = _lesson(mission_id, localized.after(emitter.unheard, emitter.legs), emitter.bearings, source)
    return None if said is None else replace(said, taken_off_deg=task.mission.sensor.bearing_offset_deg)


def found_at(emitter: EmitterState) -> TruthNoted | None:
    """Where somebody found it; None when nobody did, or it was looked for in vain."""
    return None if emitter.truth is None or emitter.truth.place is None else emitter.truth


def _lesson_at(
    mission_id: str, task: Localization, taken: Sequence[BearingMeasured], source: str, found: TruthNoted
) -> Lesson | None:
    """taken: by the source. Other sources' bearings tell nothing that the place does not."""
    belief = task.prior
    if not isinstance(belief, JointBelief) or found.place is None:
        return None
    prior, bearings = belief.priors.get(source, belief.otherwise), task.planner_bearings(taken)
    accuracy_m = UNSAID_ACCURACY_M if found.accuracy_m is None else max(found.accuracy_m, LEAST_ACCURACY_M)
    at = task.frame.to_enu(found.place), accuracy_m / ACCURACY_SIGMAS
    bias, bias_sd = bias_at(bearings, prior, *at)
    log = evidence_at(bearings, prior, *at)
    bias_deg = -math.degrees(bias), math.degrees(bias_sd)
    return replace(_said_of(mission_id, len(bearings), bias_deg, prior, log), place_known=True)


def _lesson(mission_id: str, task: Localization, measured: Sequence[BearingMeasured], source: str) -> Lesson | None:
    belief = task.belief(task.planner_bearings(measured))
    errors = belief.errors_of(source) if isinstance(belief, JointBelief) else None
    if errors is None or not isinstance(belief, JointBelief):
        return None
    bias = -math.degrees(errors.bias), math.degrees(errors.bias_sd)
    return _said_of(mission_id, errors.bearings, bias, errors.prior, flight_evidence(belief, source))


def _said_of(mission_id: str, bearings: int, bias: tuple[float, float], prior: ErrorPrior, log: FloatArray) -> Lesson:
    """bias: degrees clockwise, with its standard error. log: (t, k, e) evidence at the prior's values."""
    mass = np.exp(log)
    return Lesson(
        mission_id=mission_id,
        bearings=bearings,
        bias_deg=bias[0],
        bias_std_error_deg=bias[1],
        spread_deg=_said(np.rad2deg(prior.spread), np.log(mass @ prior.rate_weight @ prior.scale_weight)),
        scale=_said(prior.scale, np.log(np.einsum("tke,t,e->k", mass, prior.spread_weight, prior.rate_weight))),
        rate=_said(prior.rate, np.log(np.einsum("tke,t,k->e", mass, prior.spread_weight, prior.scale_weight))),
        together=tuple(round(float(one), 3) for one in log.ravel()),
    )


def lesson_of_check(mission_id: str, checked: AntennaChecked, sensor: SensorSpec) -> Lesson | None:
    """Of an antenna check that passed: one bearing of an emitter at a known place. None of any other.

    It tells of the bias alone: what the sweep stated of its own error is not kept, so neither scale nor outliers can be
    judged by it. Of a mission the last check counts, as one compass and one place disturb all of them alike.
    """
    agrees = checked.check.reason
    if not checked.check.ok or not isinstance(agrees, AntennaAgrees):
        return None
    off_deg = (agrees.measured_deg - agrees.true_deg + 180.0) % 360.0 - 180.0
    prior = unknown_craft(sensor.outlier_probability)
    bearing = Bearing(0.0, 0.0, math.radians(-off_deg), math.radians(CHECK_SIGMA_DEG))
    log = evidence_at([bearing], prior, (KNOWN_M, 0.0))
    of_spread = np.log(np.exp(log) @ prior.rate_weight @ prior.scale_weight)
    told = np.broadcast_to((of_spread - of_spread.max())[:, None, None], log.shape)
    said = _said_of(f"check of {mission_id}"[:64], 1, (off_deg, CHECK_SIGMA_DEG), prior, told)
    return replace(said, taken_off_deg=sensor.bearing_offset_deg)


def _said(values: FloatArray, log: FloatArray) -> tuple[Said, ...]:
    best = float(log.max())
    return tuple(Said(float(value), float(one) - best) for value, one in zip(values, log, strict=True))


def errors_now(lessons: Sequence[Lesson], sensor: SensorSpec, craft_id: str, antenna: str) -> LearnedErrors:
    """What a mission with this sensor starts from, after these flights (oldest first) of the craft and antenna."""
    unknown = unknown_craft(sensor.outlier_probability)
    newest = lessons[-LESSONS_KEPT:]
    evidence = [_evidence_for(one, sensor.bearing_offset_deg, unknown) for one in newest]
    return learned_errors(learned(evidence, unknown), len(newest), craft_id, antenna)


def bias_left(one: Lesson, offset_deg: float) -> float:
    """What the flight's bearings would have been off by together, had this been taken off them; degrees clockwise."""
    return math.remainder(one.bias_deg + one.taken_off_deg - offset_deg, 360.0)


def _evidence_for(one: Lesson, offset_deg: float, prior: ErrorPrior) -> FloatArray:
    """(t, k, e) at the prior's values, for a flight whose bearings have this taken off them, degrees clockwise.

    How far the bias strays is counted from what was taken off. Where that was something else, the bias found is
    held against the new one: N(bias; 0, spread^2 + its standard error^2), whatever scale and rate are. So an offset
    that is taken over makes the flights which suggested it tell of a smaller spread, and one that is taken back of a
    larger: neither counts twice.
    """
    log = _evidence_at(one, prior)
    if abs(math.remainder(one.taken_off_deg - offset_deg, 360.0)) <= AS_FLOWN_DEG:
        return log
    variance = np.rad2deg(prior.spread) ** 2 + one.bias_std_error_deg**2
    of_spread = -0.5 * (bias_left(one, offset_deg) ** 2 / variance + np.log(variance))
    of_others = np.log(np.einsum("tke,t->ke", np.exp(log - log.max()), prior.spread_weight))
    return of_spread[:, None, None] + of_others


def _evidence_at(one: Lesson, prior: ErrorPrior) -> FloatArray:
    """(t, k, e) at the prior's values, in between interpolated over their logarithms: other missions may have compared
    other values. An older lesson says nothing of combinations: there the three count one by one."""
    said = one.spread_deg, one.scale, one.rate
    if one.together:
        log = np.array(one.together).reshape([len(some) for some in said])
    else:
        of_spread, of_scale, of_rate = (np.array([value.log_evidence for value in some]) for some in said)
        log = of_spread[:, None, None] + of_scale[:, None] + of_rate
    for axis, (some, values) in enumerate(zip(said, (np.rad2deg(prior.spread), prior.scale, prior.rate), strict=True)):
        log = np.apply_along_axis(_between, axis, log, np.log([value.value for value in some]), np.log(values))
    return log


def _between(log: FloatArray, known: FloatArray, wanted: FloatArray) -> FloatArray:
    return np.interp(wanted, known, log)


def knowing(spec: MissionSpec, lessons: Sequence[Lesson], craft_id: str, antenna: str) -> MissionSpec:
    """The specification with what the flights taught; one with independent errors stays as it is."""
    sensor, known = spec.sensor, None
    if sensor.bearing_errors == "joint":
        known = errors_now(lessons, sensor, craft_id, antenna)
    return spec if known == sensor.learned else spec.having_learned(known)


def mean_bias(lessons: Sequence[Lesson], offset_deg: float = 0.0) -> tuple[float, float] | None:
    """Of the flights, had this been taken off their bearings, weighed by what each knew: degrees clockwise, with the
    standard deviation from flight to flight.

    None without a lesson.
    """
    if not lessons:
        return None
    weight = np.array([1.0 / max(one.bias_std_error_deg, 0.1) ** 2 for one in lessons])
    bias = np.array([bias_left(one, offset_deg) for one in lessons])
    mean = float(weight @ bias / weight.sum())
    between = float(weight @ (bias - mean) ** 2 / weight.sum())
    return mean, math.sqrt(between + 1.0 / float(weight.sum()))
