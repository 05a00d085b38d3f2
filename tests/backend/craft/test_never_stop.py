"""A craft that never stops to turn: where it flies on, where it turns after all, and who still has the last word."""

from __future__ import annotations

import math

import pytest
from craft_inputs import AUTHORITIES, every_craft_input
from craft_walk import CraftWalk, moves, sent
from facts import HOME, OWN, PILOT, SPEC, bearing, belief, plan, rejected

from backend import commands
from backend.craft import effects, inputs
from backend.craft.machine import transition
from backend.craft.state import AUTOMATIC, pilot_has
from backend.events import (
    BearingExcluded,
    BeliefUpdated,
    EstimateFact,
    HeardOnTheWay,
    LegSaid,
    PhaseChanged,
    PlacePassed,
    StretchFact,
)
from backend.reasons.turning import TurnsHere, WayToldEnough
from backend.spec import FIRST_EMITTER, MissionSpec
from planner.reasons import EstimateContradicted, ExpectedErrorTooLarge

NEVER_STOP = SPEC.model_copy(
    update={
        "sensor": SPEC.sensor.model_copy(
            update={
                "bearing_errors": "joint",
                "listen_on_the_way": True,
                "swing_on_the_way": True,
                "never_stop": True,
            }
        ),
    }
)
ESTIMATE = EstimateFact(
    lat=50.0, lon=7.0, expected_rmse_m=30.0, c95=SPEC.area, c95_area_m2=9e3, major_axis_m=30.0, minor_axis_m=20.0,
    major_axis_deg=10.0,
)  # fmt: skip


def leg(number: int, stretches: int = 2) -> HeardOnTheWay:
    drawn = [StretchFact(begin=HOME, end=HOME, turned_deg=90.0)] * stretches
    return HeardOnTheWay(
        emitter_id=FIRST_EMITTER, source=OWN, leg_id=f"leg-{number}", place_number=number, counted=20 * stretches,
        left_out=[], nose=[], stretches=drawn, origin=HOME, readings="packed" if stretches else None, gain_db=[0.0],
        sigma_deg=7.0,
    )  # fmt: skip


def believed(bearings: int, legs: dict[str, float], not_yet: tuple[object, ...], localized: bool) -> BeliefUpdated:
    reasons = [] if localized else [*not_yet] or [ExpectedErrorTooLarge(30.0, 10.0)]
    said = [LegSaid(leg_id=leg_id, said=nats) for leg_id, nats in legs.items()]
    return belief(bearings, localized).model_copy(update={"estimate": ESTIMATE, "not_yet": reasons, "legs": said})


class Walk(CraftWalk):
    def know(self, *not_yet: object, localized: bool = False, said: float = 2.0):
        """The belief is ready; each leg speaks so much for its estimate."""
        emitter = self.search.emitters[FIRST_EMITTER]
        legs = {one.leg_id: said for one in emitter.legs}
        return self.learn(believed(len(emitter.bearing_ids), legs, not_yet, localized))

    def fly_to(self, number: int):
        """The next place is planned and flown to."""
        self.give(inputs.Planned(plan(number)))
        assert self.craft.phase == "flying"


def at_first_place(spec: MissionSpec = NEVER_STOP) -> Walk:
    walk = Walk(spec)
    walk.to("flying")
    return walk


def on_second_leg(spec: MissionSpec = NEVER_STOP) -> Walk:
    """One whole turn was made, and the craft is on its way to the next place."""
    walk = at_first_place(spec)
    walk.give(inputs.Arrived(HOME, 0.3, 9.0, (leg(1),)))
    walk.give(inputs.SweepTaken((bearing(1),)))
    walk.know()
    walk.fly_to(2)
    return walk


def because(walk: CraftWalk) -> object:
    return walk.of_kind(PhaseChanged)[-1].reason


def test_the_first_place_is_turned_at_whatever_the_way_told() -> None:
    walk = at_first_place()
    asked = walk.give(inputs.Arrived(HOME, 0.3, 9.0, (leg(1),)))
    assert isinstance(asked[-1], effects.Measure)
    assert because(walk) == TurnsHere("first")


def test_it_flies_on_once_what_the_way_told_is_believed() -> None:
    walk = on_second_leg()
    asked = walk.give(inputs.Arrived(HOME, 0.3, 9.0, (leg(2),)))
    assert moves(asked) == [], "it hovers while the belief is worked out"
    assert walk.craft.phase == "planning"
    assert not any(isinstance(effect, effects.PlanNext) for effect in asked)
    asked = walk.know()
    assert asked[-1] == effects.PlanNext(3, ())
    assert walk.of_kind(PlacePassed) == [
        PlacePassed(craft_id=walk.craft.craft_id, place_number=2, reason=WayToldEnough(math.exp(2.0)))
    ]
    assert walk.craft.chosen is None


def test_it_turns_where_the_way_told_nothing() -> None:
    walk = on_second_leg()
    asked = walk.give(inputs.Arrived(HOME, 0.3, 9.0, (leg(2, stretches=0),)))
    assert isinstance(asked[-1], effects.Measure)
    assert because(walk) == TurnsHere("told_nothing")


def test_it_turns_where_the_way_contradicts_what_was_believed() -> None:
    walk = on_second_leg()
    walk.give(inputs.Arrived(HOME, 0.3, 9.0, (leg(2),)))
    asked = walk.know(EstimateContradicted(1, 2))
    assert asked[-1] == effects.Measure(2, 1)
    assert because(walk) == TurnsHere("contradicts")
    walk.give(inputs.SweepTaken((rejected(1, 2),)))
    asked = walk.give(inputs.SweepTaken((bearing(2),)))
    assert walk.craft.chosen is None
    assert walk.craft.phase == "planning"


@pytest.mark.parametrize(("said", "why"), [(1.2, "told_nothing"), (-0.5, "told_nothing"), (-1.2, "contradicts")])
def test_it_turns_where_the_way_told_too_little_or_speaks_against_the_estimate(said: float, why: str) -> None:
    walk = on_second_leg()
    walk.give(inputs.Arrived(HOME, 0.3, 9.0, (leg(2),)))
    asked = walk.know(said=said)
    assert asked[-1] == effects.Measure(2, 1)
    assert because(walk) == TurnsHere(why)  # type: ignore[arg-type]
    assert walk.of_kind(PlacePassed) == []


def test_what_other_legs_told_does_not_count_for_this_one() -> None:
    walk = on_second_leg()
    walk.give(inputs.Arrived(HOME, 0.3, 9.0, (leg(2),)))
    walk.learn(believed(1, {"leg-1": 5.0, "leg-2": 0.4}, (), False))
    assert because(walk) == TurnsHere("told_nothing")


def test_it_turns_again_once_the_only_turn_was_left_out() -> None:
    walk = on_second_leg()
    walk.fold(BearingExcluded(emitter_id=FIRST_EMITTER, bearing_id="b1", by="anna", reason="wrong"))
    walk.give(inputs.Arrived(HOME, 0.3, 9.0, (leg(2),)))
    assert because(walk) == TurnsHere("first")


def test_a_claim_ends_the_search_where_it_is_made() -> None:
    walk = on_second_leg()
    walk.give(inputs.Arrived(HOME, 0.3, 9.0, (leg(2),)))
    asked = walk.know(localized=True)
    assert isinstance(moves(asked)[-1], effects.ReturnHome)
    assert walk.of_kind(PlacePassed) == []


def test_places_are_used_up_by_passing_them_too() -> None:
    walk = on_second_leg()
    for number in (2, 3, 4):
        walk.give(inputs.Arrived(HOME, 0.3, 9.0, (leg(number),)))
        asked = walk.know()
        if number < NEVER_STOP.localization.maximum_bearings:
            walk.fly_to(number + 1)
    assert isinstance(moves(asked)[-1], effects.ReturnHome)


@pytest.mark.parametrize("where", ["leg", "belief", "turn"])
def test_a_hold_in_the_middle_ends_the_work_and_a_resume_goes_on(where: str) -> None:
    walk = on_second_leg()
    if where != "leg":
        walk.give(inputs.Arrived(HOME, 0.3, 9.0, (leg(2, stretches=0 if where == "turn" else 2),)))
    asked = walk.order(commands.Hold())
    assert effects.CancelWork() in asked
    assert effects.HoldVehicle() in asked
    assert not walk.craft.reached
    if where == "belief":
        assert sent(walk.know()) == [], "in hold nothing moves, whatever becomes known"
    asked = walk.order(commands.Resume())
    assert [type(effect) for effect in moves(asked)] == [effects.FlyTo]
    walk.give(inputs.Arrived(HOME, 0.3, 1.0, ()))
    if where == "belief":  # what was heard before the hold counts
        assert walk.of_kind(PlacePassed)[-1].place_number == 2
    else:
        assert because(walk) == TurnsHere("told_nothing")


def test_in_every_state_of_its_own_it_answers_every_input_and_sends_nothing_when_a_pilot_flies() -> None:
    arrived = on_second_leg()
    arrived.give(inputs.Arrived(HOME, 0.3, 9.0, (leg(2),)))
    passed = on_second_leg()
    passed.give(inputs.Arrived(HOME, 0.3, 9.0, (leg(2),)))
    passed.know()
    turning = on_second_leg()
    turning.give(inputs.Arrived(HOME, 0.3, 9.0, (leg(2),)))
    turning.know(EstimateContradicted(1, 2))
    for walk in (on_second_leg(), arrived, passed, turning):
        for authority in AUTHORITIES:
            craft, _ = transition(walk.craft, walk.search, inputs.AuthorityHeard(authority), 1_999.0)
            for given in every_craft_input(craft, walk.search):
                after, asked = transition(craft, walk.search, given, 2_000.0)
                ordered = isinstance(given, inputs.CraftOrdered)
                if pilot_has(after.authority) and not ordered:
                    assert sent(asked) == [], f"{given} in {craft.phase}"
                if ordered and isinstance(given.command, commands.Hold) and craft.phase in AUTOMATIC:
                    assert effects.HoldVehicle() in asked
                    assert effects.CancelWork() in asked
                if after.phase not in AUTOMATIC:
                    assert not after.reached


def test_a_pilot_who_takes_over_in_the_middle_of_a_leg_is_sent_nothing_more() -> None:
    walk = on_second_leg()
    walk.give(inputs.AuthorityHeard(PILOT))
    assert walk.craft.phase == "manual"
    for given in (inputs.Arrived(HOME, 0.3, 9.0, (leg(2),)), inputs.SearchChanged()):
        assert sent(walk.give(given)) == []
    assert walk.of_kind(PlacePassed) == []


def test_a_restart_after_a_place_was_reached_is_in_hold() -> None:
    walk = on_second_leg()
    walk.give(inputs.Arrived(HOME, 0.3, 9.0, (leg(2),)))
    asked = walk.give(inputs.Restarted(walk.craft.authority))
    assert walk.craft.phase == "hold"
    assert moves(asked) == []
