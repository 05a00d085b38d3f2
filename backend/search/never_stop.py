"""Missions that turn at no place: what they need, what a leg is worth to the planner, and where one turns after all.

Pure. The first place's turn is a whole one, as is every other: a claim rests on at least one look all the way round.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from backend.events import BeliefUpdated, CraftSource, HeardOnTheWay
from backend.reasons.turning import NeverStopNeeds, TurnsHere, WayToldEnough
from backend.search.errors import MissionInputError
from backend.search.state import EmitterState
from backend.spec import MissionSpec
from planner.belief.seen_on_the_way import TELLS
from planner.belief.verdict import TELLING_SIGMA
from planner.reasons import BearingMissesArea, BearingsDisagree, EstimateContradicted
from planner.types import Legs

LEAST_LEG_M = 60.0
"""Of which 10 m at either end count for nothing: two stretches of way."""
LEG_SIGMA_DEG = 7.0
"""Of a bearing from a leg's end that is worth what the leg is: its stretches lie apart, and cross. What a leg says at
the emitter is what one of 20 degrees says (1.5 nats in the mean of 18), but then plans foretold 256 s where 120
followed; with 7 it is 117 and 108, and missions take 12 +- 9 s less (40 pairs of the field world)."""
PAUSE_S = 2.0
"""Between two legs: the belief is updated and the next place chosen."""
ENOUGH = math.log(math.sqrt(2.0 * math.pi) / TELLING_SIGMA)
"""Nats that the way has to say for the estimate if no turn is to be made: as a bearing of TELLING_SIGMA that points at
it. A turn says more, and takes little longer than a leg."""
CONTRADICTIONS = (EstimateContradicted, BearingsDisagree, BearingMissesArea)


def legs_of(mission: MissionSpec) -> Legs | None:
    """As the planner has them; None: a bearing is a turn."""
    return Legs(LEAST_LEG_M, math.radians(LEG_SIGMA_DEG), PAUSE_S) if mission.sensor.never_stop else None


def check_never_stop(mission: MissionSpec) -> None:
    """Raises MissionInputError where the option asks for what the mission has not. Not part of the specification's own
    validation: what was stored must still be read."""
    needs = _needs(mission) if mission.sensor.never_stop else None
    if needs is not None:
        raise MissionInputError(needs, "sensor.never_stop")


def _needs(mission: MissionSpec) -> NeverStopNeeds | None:
    sensor = mission.sensor
    if len(mission.emitters) != 1:
        return NeverStopNeeds("one_emitter")
    (emitter,) = mission.emitters
    if emitter.kind == "pulsed":
        return NeverStopNeeds("carrier")
    if emitter.movement.kind != "still":
        return NeverStopNeeds("still")
    if sensor.bearing_errors != "joint":
        return NeverStopNeeds("joint")
    if not sensor.listen_on_the_way or not sensor.swing_on_the_way:
        return NeverStopNeeds("swings")
    if mission.planner.method != "rollout":
        return NeverStopNeeds("rollouts")
    return None


def turned_before(emitter: EmitterState, source: CraftSource) -> bool:
    """Whether a whole turn of this craft counts."""
    return any(bearing.source == source for bearing in emitter.bearings)


def ways_to(emitter: EmitterState, craft_id: str, place_number: int) -> tuple[HeardOnTheWay, ...]:
    """What counts of this craft's way to a place."""
    source = CraftSource(craft_id=craft_id)
    return tuple(leg for leg in emitter.legs if leg.source == source and leg.place_number == place_number)


def why_turn_before_belief(emitter: EmitterState, craft_id: str, place_number: int) -> TurnsHere | None:
    """Why a turn is needed whatever is believed after the way here."""
    if not turned_before(emitter, CraftSource(craft_id=craft_id)):
        return TurnsHere("first")
    return None if ways_to(emitter, craft_id, place_number) else TurnsHere("told_nothing")


def turn_or_pass(belief: BeliefUpdated | None, ways: Sequence[HeardOnTheWay]) -> TurnsHere | WayToldEnough:
    """By what is believed after the way here; of which the belief says what it tells of the estimate."""
    if belief is None or belief.estimate is None or any(isinstance(one, CONTRADICTIONS) for one in belief.not_yet):
        return TurnsHere("contradicts")
    here = {way.leg_id for way in ways}
    said = sum(leg.said for leg in belief.legs if leg.leg_id in here)
    if said <= -TELLS:
        return TurnsHere("contradicts")
    return WayToldEnough(math.exp(said)) if said >= ENOUGH else TurnsHere("told_nothing")
