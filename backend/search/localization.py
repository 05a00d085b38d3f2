"""From facts about one emitter to the planner's words, and back.

The belief is the fold of the counted bearings in the order they were taken, so a stored mission rebuilds it bit by bit.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass, field, replace
from threading import RLock
from typing import Any

import numpy as np
from shapely.geometry.base import BaseGeometry

from backend.events import BearingMeasured, BeliefUpdated, HeardOnTheWay, LegSaid, SweepRejected
from backend.reasons import Reason
from backend.reasons.search import HeadingsAskew
from backend.search import area
from backend.search.belief_facts import errors_facts, estimate_fact
from backend.search.errors import MissionInputError
from backend.search.planner_bearings import own_sigma_deg, planner_bearing, source_name
from backend.search.problem import prior_belief_of, problem_of, rule_of
from backend.search.silences import silences_of
from backend.search.turn_schedule import turn_s
from backend.search.way_facts import stretches_of
from backend.spec import MissionSpec
from hardware.direction_finding.heading_offset import HeadingOffset, heading_offset
from hardware.frame import LocalFrame
from hardware.readings import Place
from planner.belief.grid import GridBelief, digest, update
from planner.belief.joint import JointBelief, fold_joint, heard_on_the_way, update_joint
from planner.belief.joint import unheard as silent_prior
from planner.belief.moving import MovingBelief, predicted, update_moving
from planner.belief.verdict import verdict
from planner.detection import Silence
from planner.on_the_way import Stretch
from planner.types import Bearing, InconsistentBearings, LocalizationRule, PlannerError, Problem

DOUBT = 0.05
"""Outlier probability to plan with when bearings contradict each other although the sensor was taken to be honest."""

AT_ONCE = 24
"""A joint belief folds this many bearings, and every multiple of it, in one go: a recording has hundreds."""
FOLDS_KEPT, CELLS_KEPT = 64, 4_000_000
"""Beliefs that the next bearing, and each question about a place, goes on from, and cells of all of them, of 16 bytes
each: most have some ten thousand, those of sharp bearings in a large area a quarter of a million."""


@dataclass(frozen=True, slots=True)
class Localization:
    """The task of localizing one emitter, in the planner's words. The frame's origin is the home at the start.

    beside: adds to a belief by this emitter's own bearings what others tell of their source's errors
    (backend.search.together); None: nothing. stretches: of way on which it was heard. fewer_turned_for: whether turns
    are made for fewer emitters than the mission has, and take another time than those for all. asked_at_s: when it is
    planned, UTC epoch seconds; None: right after the newest turn.
    """

    mission: MissionSpec
    emitter_id: str
    frame: LocalFrame
    problem: Problem
    prior: GridBelief
    rule: LocalizationRule
    beside: Callable[[GridBelief], GridBelief] | None = None
    stretches: tuple[Stretch, ...] = ()
    fewer_turned_for: bool = False
    asked_at_s: float | None = None
    _folds: dict[tuple[Bearing, ...], GridBelief] = field(
        default_factory=dict[tuple[Bearing, ...], GridBelief], repr=False, compare=False
    )
    _folding: AbstractContextManager[object] = field(default_factory=RLock, repr=False, compare=False)
    _after: dict[tuple[Silence, ...], Localization] = field(default_factory=lambda: {}, repr=False, compare=False)
    _heard: dict[tuple[tuple[Bearing, ...], tuple[Stretch, ...]], GridBelief] = field(
        default_factory=lambda: {}, repr=False, compare=False
    )

    @property
    def home(self) -> Place:
        """Degrees; (0, 0) of the frame."""
        return self.frame.origin

    @property
    def joint(self) -> bool:
        """Whether the errors that a source's bearings have in common are estimated with the place."""
        if isinstance(self.prior, MovingBelief):
            return self.prior.assumed.otherwise is not None
        return isinstance(self.prior, JointBelief)

    @property
    def moving(self) -> bool:
        """Whether the emitter may be elsewhere by the next bearing."""
        return isinstance(self.prior, MovingBelief)

    def after(self, unheard: Sequence[SweepRejected], legs: Sequence[HeardOnTheWay] = ()) -> Localization:
        """The same after turns that heard nothing of the emitter, known before any bearing, and legs on which it was
        heard, weighed after all of them."""
        if not isinstance(self.prior, JointBelief):
            return self
        silences = silences_of(unheard, self.frame)
        stretches = tuple(s for leg in legs for s in stretches_of(leg, self.frame, source_name(leg.source)))
        if not silences and stretches == self.stretches:
            return self
        found = self if not silences else self._after.get(silences)
        if found is None:
            found = replace(
                self, prior=silent_prior(self.prior, silences), beside=None, _folds={}, _after={}, _heard={}
            )
            self._after.clear()
            self._after[silences] = found
        return replace(found, problem=self.problem, beside=self.beside, stretches=stretches)

    def without(self, closed: BaseGeometry | None) -> Localization:
        """The same with these places (m ENU) closed to the planner, too."""
        if closed is None:
            return self
        problem = replace(self.problem, no_fly=(*self.problem.no_fly, *area.region(closed)))
        return replace(self, problem=problem)

    def turning_for(self, wanted: Sequence[str]) -> Localization:
        """The same with turns that are made for these emitters only (by id), since the others are found."""
        turn = turn_s(self.mission, wanted)
        if turn == turn_s(self.mission):
            return self
        return replace(self, problem=replace(self.problem, measurement_time=turn), fewer_turned_for=True)

    def asked(self, at_s: float) -> Localization:
        """The same for what is planned then: since the newest turn a flight, a hold or a busy machine took time."""
        return replace(self, asked_at_s=at_s)

    def planner_bearings(self, measured: Sequence[BearingMeasured]) -> tuple[Bearing, ...]:
        """Facts to the planner's bearings: place in ENU, angles in rad ccw from east."""
        outliers = self.mission.sensor.outlier_probability
        # an emitter that moves is followed by peaks and sigmas: its Kalman filters know no other densities
        whole = isinstance(self.prior, JointBelief) and self.mission.sensor.sweep_evidence == "whole"
        joint, moving = self.joint, self.moving
        return tuple(planner_bearing(fact, self.frame, outliers, joint, moving, whole) for fact in measured)

    def belief(self, bearings: Sequence[Bearing]) -> GridBelief | None:
        """None when the bearings have no common point and none may be an outlier."""
        try:
            found = self._with_legs(tuple(bearings))
        except InconsistentBearings:
            return None
        return found if self.beside is None else self.beside(found)

    def _with_legs(self, bearings: tuple[Bearing, ...]) -> GridBelief:
        """The bearings' belief, and what was heard on the way."""
        folded = self._folded(bearings)
        if not self.stretches or not isinstance(folded, JointBelief):
            return folded
        found = self._heard.get((bearings, self.stretches))
        if found is None:
            found = heard_on_the_way(folded, self.stretches)
            _make_room(self._heard)
            self._heard[bearings, self.stretches] = found
        return found

    def _folded(self, bearings: tuple[Bearing, ...]) -> GridBelief:
        """Bearing by bearing, in order, from the first or those folded at once: what was folded for fewer bearings is
        gone on from. One thread at a time: beliefs of emitters that share a source's errors ask for each other."""
        with self._folding:
            first = max(len(bearings) // AT_ONCE * AT_ONCE, 1) if isinstance(self.prior, JointBelief) else 1
            known = next((k for k in range(len(bearings), first - 1, -1) if bearings[:k] in self._folds), 0)
            found = self._folds[bearings[:known]] if known else self.prior
            for count in range(max(known + 1, first), len(bearings) + 1):
                found = self._with(found, bearings[:count])
                _make_room(self._folds)
                self._folds[bearings[:count]] = found
            return found

    def _with(self, before: GridBelief, bearings: tuple[Bearing, ...]) -> GridBelief:
        """The last of the bearings taken in. A moving emitter's belief is about the end of the newest turn."""
        match before:
            case JointBelief() if len(bearings) % AT_ONCE == 0:
                return fold_joint(before, bearings)
            case MovingBelief():
                now = max(b.taken_at for b in bearings) + 0.5 * self.problem.measurement_time
                return update_moving(before, bearings[-1], now)
            case JointBelief():
                return update_joint(before, bearings[-1])
            case _:
                return update(before, bearings[-1])

    def planning_belief(self, bearings: Sequence[Bearing]) -> GridBelief:
        """What to plan with: contradicting bearings count as possibly wrong, so that a next place tells them apart.
        Of a moving emitter: where it may be by the end of a turn from `asked_at_s` on."""
        found = self.belief(bearings)
        if isinstance(found, MovingBelief):
            waited_s = 0.0 if self.asked_at_s is None else max(self.asked_at_s - found.now, 0.0)
            return predicted(found, waited_s + self.problem.measurement_time)
        if found is not None:
            return found
        doubted = (replace(b, outlier_probability=max(b.outlier_probability, DOUBT)) for b in bearings)
        return self._with_legs(tuple(doubted))

    def belief_fact(self, measured: Sequence[BearingMeasured]) -> tuple[BeliefUpdated, GridBelief]:
        """The fact to record, and the belief to show and to plan with."""
        bearings = self.planner_bearings(measured)
        folded = self.belief(bearings)
        said = verdict(self.problem, self.rule, bearings, folded)
        offset = None if self.joint or self.moving else self.heading_offset(measured)
        doubt = offset if offset is not None and offset.significant else None
        shown = self.planning_belief(bearings) if folded is None else folded
        askew = () if doubt is None else (HeadingsAskew(doubt.offset_deg, doubt.std_error_deg),)
        not_yet: list[Reason] = [*said.reasons, *askew]
        fact = BeliefUpdated(
            emitter_id=self.emitter_id,
            bearings=len(bearings),
            estimate=None
            if folded is None or said.estimate is None
            else estimate_fact(folded, said.estimate, self.frame),
            consistent=said.consistent,
            localized=said.localized and doubt is None,
            not_yet=not_yet,
            goal_m=self.rule.threshold if self.moving else None,
            contradicting=[measured[index].bearing_id for index in said.against],
            heading_offset_deg=None if doubt is None else doubt.offset_deg,
            heading_offset_std_error_deg=None if doubt is None else doubt.std_error_deg,
            sources=errors_facts(shown, measured),
            digest=digest(shown),
            legs=[LegSaid(leg_id=leg, said=round(said, 3)) for leg, said in said.ways],
        )
        return fact, shown

    def heading_offset(self, measured: Sequence[BearingMeasured]) -> HeadingOffset | None:
        """What the bearings are off by together, judged by what their sigmas hold besides the heading's share."""
        places = np.array([self.frame.to_enu(b.place) for b in measured]).reshape(-1, 2)
        bearing = np.array([b.bearing_deg for b in measured])
        own = np.array([own_sigma_deg(b) for b in measured])
        return heading_offset(places, bearing, own, max(self.mission.sensor.outlier_probability, DOUBT))

    def corners_lon_lat(self, belief: GridBelief) -> list[tuple[float, float]]:
        """SW, SE, NE, NW of the grid's outer edge."""
        west, south, east, north = belief.bounds
        return self.frame.to_lon_lat(np.array([(west, south), (east, south), (east, north), (west, north)]))

    def place(self, x: float, y: float) -> Place:
        """(x, y) in m ENU to degrees."""
        return self.frame.to_geo(x, y)


def _make_room(kept: dict[Any, GridBelief]) -> None:
    if len(kept) >= FOLDS_KEPT or sum(belief.density.size for belief in kept.values()) >= CELLS_KEPT:
        kept.clear()


def localization(
    mission: MissionSpec, home: Place, emitter_id: str | None = None, closed: BaseGeometry | None = None
) -> Localization:
    """The task as seen from `home`. emitter_id None: the first emitter. closed: where no place is looked for either,
    m ENU; a belief does not depend on it.

    Raises MissionInputError when the specification makes no sense there.
    """
    frame = LocalFrame(home)
    emitter = mission.emitters[0] if emitter_id is None else mission.emitter(emitter_id)
    problem = problem_of(mission, emitter, frame, closed)
    try:
        prior = prior_belief_of(problem, mission.sensor, emitter.movement)
    except PlannerError as error:
        index = mission.emitters.index(emitter)
        raise MissionInputError(error.reason, f"emitters.{index}.prior") from error
    return Localization(mission, emitter.emitter_id, frame, problem, prior, rule_of(mission, problem))
