"""A turn only as far as needed: which sector to turn through, and after each look whether to stop or to go on.

Pure: no clock, no vehicle. A turn is planned from the directions expected at its place (`planned_turn`), turned
clockwise from the sector's beginning, and looked at after its end (`look`). A look goes on when no bearing came of it,
when the bearing lies near an edge, when the sweep is hardly like the antenna's pattern, or when a direction not yet
heard remains likely:

    P(elsewhere) = sum_{b not heard} q(b) L(b) / sum_b q(b) L(b)

q: expected directions (planner.directions, a tenth of them anywhere), L: the sweep's likelihood. It never turns back:
what lies before the sector's beginning is reached by the whole circle.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from backend.events import BearingMeasured, TurnFact
from backend.events.bearings import WHOLE_DEG
from backend.reasons.turning import (
    BearingUncertain,
    ElsewherePossible,
    GoOnReason,
    MaximumAtEdge,
    MaximumSeen,
    NothingFoundYet,
    QualityPoor,
    SectorExpected,
    StopReason,
    WholeCircleSeen,
    WholeTurn,
)
from backend.search.localization import Localization
from backend.search.planning import foreseen
from backend.spec import MissionSpec
from hardware.direction_finding.circle import SweepLikelihood
from hardware.readings import BearingReading
from planner.belief.grid import GridBelief
from planner.directions import DIRECTIONS, SURPRISE, expected_directions, shortest_arc
from planner.types import FloatArray, SectorTurns

CIRCLE_DEG = 360.0
RULE = SectorTurns(turn_rate=1.0)
"""Where the sector is laid, as the planner has it too; the margin is half a beam and its flank, without which no
maximum is seen, and what a sector wider than the widest leaves out costs less than a second look."""
STEP_DEG = 45.0
NEARLY_DEG = 60.0
"""With less than this left of the circle it is turned whole."""
BRACKET_DEG = 30.0
SURE_QUALITY = 0.8
SURE_SIGMA_DEG = 10.0
"""Of a sweep alone: more than this hardly shows a lobe. Less is no reason to turn on: where echoes make a sector's
bearing uncertain, the rest of the circle seldom makes it better."""
MOST_ELSEWHERE = 0.1
TOLERANCE_DEG = CIRCLE_DEG - WHOLE_DEG
"""A vehicle stops this much short of what it was asked to turn."""

WholeBecause = Literal["first", "again", "unsure", "wide", "several", "pulsed", "second_place"]


@dataclass(frozen=True, slots=True)
class TurnPlan:
    """begin_deg: antenna heading to begin at; None: wherever it points. width_deg: clockwise from there.

    expected: (360,) probability of the directions 0, 1, .. degrees clockwise from north; None: nothing was expected.
    """

    begin_deg: float | None
    width_deg: float
    why: WholeTurn | SectorExpected
    expected: FloatArray | None = None

    @property
    def whole(self) -> bool:
        """All the way round."""
        return self.begin_deg is None


@dataclass(frozen=True, slots=True)
class GoOn:
    """Turn on clockwise by `by_deg` degrees, and look again."""

    by_deg: float
    why: GoOnReason


@dataclass(frozen=True, slots=True)
class Stop:
    """Enough was heard."""

    why: StopReason


def whole_turn(because: WholeBecause) -> TurnPlan:
    """All the way round, from wherever the antenna points."""
    return TurnPlan(None, CIRCLE_DEG, WholeTurn(because))


def must_be_whole(mission: MissionSpec, measured: Sequence[BearingMeasured], attempt: int) -> WholeBecause | None:
    """Why no sector is thought of at all. measured: the counted bearings so far."""
    if any(emitter.kind == "pulsed" for emitter in mission.emitters):
        return "pulsed"
    if len(mission.emitters) != 1:
        return "several"
    if attempt > 1:
        return "again"
    if not measured:
        return "first"
    if whole_places(measured) < mission.sensor.whole_turns:
        return "second_place"
    return None


def whole_places(measured: Sequence[BearingMeasured]) -> int:
    """From how many places all directions were heard."""
    return len(
        {
            fact.place_number
            for fact in measured
            if fact.turn is None or fact.turn.turned_deg > math.degrees(RULE.widest)
        }
    )


def expected_here(
    task: Localization, belief: GridBelief, measured: Sequence[BearingMeasured], place: tuple[float, float]
) -> FloatArray:
    """(360,) probability of a bearing at 0, 1, .. degrees clockwise from north. place: m ENU."""
    sigma = foreseen(task.problem, measured, belief).sigma
    mass = expected_directions(belief, place, sigma)
    # compass b = 90 - angle
    return mass[(90 - np.arange(DIRECTIONS)) % DIRECTIONS]


def planned_turn(expected: FloatArray) -> TurnPlan:
    """The sector around the likeliest directions, or a whole turn when that would be nearly as long."""
    arc = shortest_arc(expected, RULE.share)
    width = math.degrees(RULE.width(arc.width))
    if width >= CIRCLE_DEG - TOLERANCE_DEG:
        return whole_turn("wide")
    middle = math.degrees(arc.begin + 0.5 * arc.width)
    why = SectorExpected(width_deg=width, share_percent=100.0 * RULE.share)
    return TurnPlan((middle - 0.5 * width) % CIRCLE_DEG, width, why, expected)


def look(plan: TurnPlan, begin_deg: float, turned_deg: float, reading: BearingReading | None) -> Stop | GoOn:
    """After `turned_deg` of turning from the antenna heading `begin_deg` on, all of which the reading heard; None:
    nothing came of it."""
    left = CIRCLE_DEG - turned_deg
    if plan.expected is None or left < TOLERANCE_DEG:
        return Stop(WholeCircleSeen())
    further = left if left - STEP_DEG < NEARLY_DEG else STEP_DEG
    if reading is None or not reading.accepted:
        return GoOn(further, NothingFoundYet(further))
    inside_deg, edge = within(reading.bearing_deg, begin_deg, turned_deg)
    if inside_deg < BRACKET_DEG:
        if edge == "beginning":  # never back: the way round leads there, too
            return GoOn(left, MaximumAtEdge("beginning", left))
        return GoOn(further, MaximumAtEdge("end", further))
    if reading.quality < SURE_QUALITY:
        return GoOn(further, QualityPoor(reading.quality, further))
    own_deg = math.sqrt(max(reading.sigma_deg**2 - reading.heading_sigma_deg**2 - reading.pattern_sigma_deg**2, 0.0))
    if own_deg > SURE_SIGMA_DEG:
        return GoOn(further, BearingUncertain(own_deg, further))
    elsewhere = elsewhere_probability(plan.expected, begin_deg, turned_deg, reading)
    if elsewhere > MOST_ELSEWHERE:
        return GoOn(further, ElsewherePossible(100.0 * elsewhere, further))
    return Stop(MaximumSeen(turned_deg, inside_deg, 100.0 * elsewhere))


def within(bearing_deg: float, begin_deg: float, turned_deg: float) -> tuple[float, Literal["beginning", "end"]]:
    """How far a bearing lies within the headings heard, negative: outside them, and the edge that it is nearer to."""
    from_middle = math.remainder(bearing_deg - begin_deg - 0.5 * turned_deg, CIRCLE_DEG)
    return 0.5 * turned_deg - abs(from_middle), "beginning" if from_middle < 0.0 else "end"


def elsewhere_probability(expected: FloatArray, begin_deg: float, turned_deg: float, reading: BearingReading) -> float:
    """Of the directions not heard, after the sweep; as before it when the reading has no likelihood."""
    surprised = (1.0 - SURPRISE) * expected + SURPRISE / DIRECTIONS
    if reading.likelihood is None:
        posterior = surprised
    else:
        posterior = surprised * np.exp(SweepLikelihood.unpacked(reading.likelihood).log_likelihood)
    unheard = (np.arange(DIRECTIONS) - begin_deg) % CIRCLE_DEG > turned_deg
    return float(posterior[unheard].sum() / posterior.sum())


def turn_fact(
    plan: TurnPlan, begin_deg: float, turned_deg: float, steps: Sequence[GoOn], stopped: Stop | GoOn
) -> TurnFact:
    """What is recorded of a turn. begin_deg: the antenna heading at which it began."""
    return TurnFact(
        begin_deg=begin_deg % CIRCLE_DEG,
        planned_deg=plan.width_deg,
        turned_deg=turned_deg,
        planned_because=plan.why,
        went_on_because=[step.why for step in steps],
        stopped_because=stopped.why,
    )
